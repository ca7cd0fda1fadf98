"""Section `background`: what a healthy machine adds to its gears; every part is off unless it is given.

Keys say how large a part is; its other numbers stand in `siggen.gearbox.background_numbers`.

Defaults are wide: few machines were measured. In descriptions, "measured" is the range found on real machines, "source"
a published number, "assumed" an engineering judgement.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, model_validator

from siggen.keys.catalogue import CatalogueWord, with_entries
from siggen.keys.distributions import LogUniform, Uniform
from siggen.keys.number import Number, Within
from siggen.keys.section import Section
from siggen.keys.usual import Usual


class BaseSection(Section):
    """A rigid base under the bolts, on soft mounts; the machines beside the gearbox stand on it too."""

    mass_kg: Annotated[Number, Within(above=0, most=1_000_000)] = Field(
        default=LogUniform(low=50.0, high=300.0), description="of the base with what stands on it (assumed)"
    )
    gyration_m: Annotated[Number, Within(above=0, most=20), Usual(0.02, 5)] = Field(
        default=Uniform(low=0.2, high=0.4), description="radius of gyration in rocking (assumed)"
    )


class Bursts(Section):
    """Rubbing that rises for some milliseconds at random times: dirt, oil, a loose part. Never tied to the state."""


class Rubbing(Section):
    """Rough flanks that roll and slide on each other: broadband force along the line of action, by speed and load."""

    bursts: Bursts | None = Field(default=None, description="null: none")


class Bearings(Section):
    """Waviness of rolling bearings and the passing of balls: displacements in series with each bearing's spring."""


class Machines(Section):
    """Noise of the motor and of what is driven; each presses on the base, or on its shaft without one."""

    density_n_per_sqrt_hz: Annotated[Number, Within(least=0, most=10_000), Usual(0.001, 50)] = Field(
        default=LogUniform(low=0.16, high=1.6),
        description="one-sided, of each machine (derived: 3 to 7 mm/s²/√Hz measured from 40 to 80 Hz, times "
        "75 to 325 kg, over √2)",
    )


class ShaftLines(Section):
    """Lines of motor and load: misaligned couplings, which press on first and last shaft and base, and rotors on it."""

    coupling_stiffness_n_per_um: Annotated[Number, Within(least=0, most=1000), Usual(0.001, 30)] = Field(
        default=LogUniform(low=0.1, high=1.0), description="radial, per coupling (assumed)"
    )
    rotor_mass_kg: Annotated[Number, Within(least=0, most=100_000), Usual(0.05, 1000)] = Field(
        default=LogUniform(low=3.0, high=30.0), description="of motor and load (assumed)"
    )


class ForeignMesh(Section):
    """Lines of an undamaged mesh that is not simulated, with sidebands of a shaft; presses on the housing."""

    order: Annotated[Number, Within(above=0, most=10_000), Usual(0.05, 500)] = Field(
        description="of the mesh, per turn of the input shaft"
    )
    force_share: Annotated[Number, Within(least=0, most=2), Usual(0.0001, 1)] = Field(
        default=LogUniform(low=0.005, high=0.05),
        description="first line over the mean mesh force (derived: mesh 1 is 1 to 4 %, others were measured 6 "
        "to 26 dB lower)",
    )
    shaft_order: Annotated[Number | None, Within(above=0, most=10_000, words=(None,)), Usual(0.005, 100)] = Field(
        default=None, description="of the sidebands' shaft; null: the second shaft"
    )


class Background(Section):
    """A healthy machine around the gears; with this section, noise levels belong to the gearbox."""

    like: Annotated[str | None, CatalogueWord("background")] = Field(
        default=None, description="word of the catalogue whose parts it takes over", exclude=True
    )
    base: BaseSection | None = Field(default=None, description="null: bolts stand on the ground")
    rubbing: Rubbing | None = Field(default=None, description="null: none")
    bearings: Bearings | None = Field(default=None, description="null: none")
    machines: Machines | None = Field(default=None, description="null: none")
    shafts: ShaftLines | None = Field(default=None, description="null: none")
    second_stage: ForeignMesh | None = Field(default=None, description="a stage that shares a shaft; null: none")
    auxiliary_drive: ForeignMesh | None = Field(default=None, description="a pump or other drive; null: none")

    @model_validator(mode="before")
    @classmethod
    def _with_entry(cls, value: Any) -> Any:
        return with_entries(value, like="background")
