"""Section `housing`: the flexible modes between bearings and sensors, and the noise of the forces that excite them."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from siggen.keys.distributions import LogUniform, Uniform
from siggen.keys.number import Number, Within
from siggen.keys.section import Real, Section


class ForceNoise(Section):
    """Broadband noise on every bearing force, each independent of the others; levels are drawn for every record."""

    density_n_per_sqrt_hz: Annotated[Number, Within(least=0)] = Field(
        default=0.0, description="one-sided density of each force"
    )
    share_per_sqrt_hz: Annotated[Number, Within(least=0, most=1)] = Field(
        default=0.0, description="density as a share of the mean mesh force; both densities add as powers"
    )
    corner_hz: Annotated[Number | None, Within(above=0, words=(None,))] = Field(
        default=None, description="frequency from which the power falls as 1/f², drawn per record; null: white"
    )


class Housing(Section):
    """Flexible modes that all sensors of a gearbox share; their shapes differ from place to place."""

    modes: Annotated[Number, Within(least=1, most=60)] = Field(
        default=Uniform(low=5.5, high=15.5), description="number of modes per gearbox, rounded to a whole number"
    )
    frequency_hz: Annotated[Number, Within(above=0)] = Field(
        default=LogUniform(low=300.0, high=8000.0),
        description="natural frequencies; each mode is drawn from its own equal share of the distribution",
    )
    damping_ratio: Annotated[Number, Within(above=0, below=0.5)] = Field(
        default=Uniform(low=0.01, high=0.04), description="drawn per mode"
    )
    modal_mass_kg: Annotated[Number | None, Within(above=0, words=(None,))] = Field(
        default=20.0,
        description="modal mass of the lowest mode, whose shape has the mean square 1; drawn per gearbox; null: the "
        "mass of `dynamics.casing`",
    )
    residue_exponent: Annotated[Real, Field(ge=0, le=6)] = Field(
        default=2.0, description="residues fall as frequency to minus this power"
    )
    settle_s: Annotated[Real, Field(gt=0, le=10)] = Field(
        default=0.4, description="history of the forces before the first sample; the modes must have decayed over it"
    )
    force_noise: ForceNoise | None = Field(default=None, description="null: the bearing forces carry no noise")
