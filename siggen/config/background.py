"""Section `background`: what a healthy machine adds to its gears; every part is off unless it is given.

Defaults are wide: few machines were measured. In descriptions, "measured" is the range found on real machines, "source"
a published number, "assumed" an engineering judgement.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from siggen.config.density import Density
from siggen.keys.distributions import LogUniform, Uniform
from siggen.keys.number import Number, Within
from siggen.keys.section import Section, Whole


class Base(Section):
    """A rigid base under the bolts, on soft mounts; the machines beside the gearbox stand on it too."""

    mass_kg: Annotated[Number, Within(above=0, most=1_000_000)] = Field(
        default=LogUniform(low=50.0, high=300.0), description="of the base with what stands on it (assumed)"
    )
    gyration_m: Annotated[Number, Within(above=0, most=20)] = Field(
        default=Uniform(low=0.2, high=0.4), description="radius of gyration in rocking (assumed)"
    )
    horizontal_hz: Annotated[Number, Within(above=0, most=1000)] = Field(
        default=LogUniform(low=10.0, high=60.0), description="natural frequency on its mounts (assumed)"
    )
    vertical_hz: Annotated[Number, Within(above=0, most=1000)] = Field(
        default=LogUniform(low=10.0, high=60.0), description="the same (assumed)"
    )
    rocking_hz: Annotated[Number, Within(above=0, most=1000)] = Field(
        default=LogUniform(low=10.0, high=60.0), description="the same (assumed)"
    )
    damping_ratio: Annotated[Number, Within(least=0.02, below=1)] = Field(
        default=Uniform(low=0.05, high=0.15), description="of the base on its mounts (assumed: rubber)"
    )


class Bursts(Section):
    """Rubbing that rises for some milliseconds at random times: dirt, oil, a loose part. Never tied to the state."""

    rate_hz: Annotated[Number, Within(least=0, most=100)] = Field(
        default=LogUniform(low=0.2, high=5.0), description="mean number per second, Poisson (assumed)"
    )
    decay_ms: Annotated[Number, Within(above=0, most=100)] = Field(
        default=Uniform(low=2.0, high=10.0), description="time constant, drawn per burst (assumed)"
    )
    peak: Annotated[Number, Within(least=0, most=100)] = Field(
        default=LogUniform(low=1.0, high=4.0), description="rise over the rms of the rubbing, per burst (assumed)"
    )


class Rubbing(Section):
    """Rough flanks that slide: broadband force along the line of action, k r n(t) √M, M of mean 1."""

    roughness_um: Annotated[Number, Within(least=0, most=20)] = Field(
        default=LogUniform(low=0.2, high=0.6), description="composite Rq along the flank (source: ground flanks)"
    )
    correlation_mm: Annotated[Number, Within(above=0, most=1000)] = Field(
        default=LogUniform(low=0.05, high=1.0),
        description="correlation length across the face, which averages roughness over face/correlation (assumed)",
    )
    corner_hz: Annotated[Number, Within(above=0, most=1_000_000)] = Field(
        default=LogUniform(low=1500.0, high=5000.0),
        description="from which the contact's width cuts: rolling speed/(2 pi half-width) (assumed range)",
    )
    steepness: Annotated[Number, Within(least=0.75, most=4)] = Field(
        default=Uniform(low=1.0, high=2.0), description="m of the power (1 + (f/corner)²)^-m (assumed)"
    )
    speed_exponent: Annotated[Number, Within(least=0, most=3)] = Field(
        default=Uniform(low=0.5, high=1.0), description="force over rolling speed, 1 at 3 m/s (assumed; grows: source)"
    )
    load_exponent: Annotated[Number, Within(least=0, most=3)] = Field(
        default=Uniform(low=0.3, high=0.7), description="force over line load, 1 at 50 N/mm (assumed)"
    )
    sliding_exponent: Annotated[Number, Within(least=0, most=2)] = Field(
        default=Uniform(low=0.5, high=1.0), description="power of M over the sliding speed of a pair (assumed)"
    )
    pinion_depth: Annotated[Number, Within(least=0, most=2)] = Field(
        default=LogUniform(low=0.05, high=0.8), description="modulation by the pinion's shaft (measured: 0.1 to 0.5)"
    )
    gear_depth: Annotated[Number, Within(least=0, most=2)] = Field(
        default=LogUniform(low=0.03, high=0.4), description="modulation by the gear's shaft (measured: 0.06 to 0.42)"
    )
    level_std: Annotated[Number, Within(least=0, most=2)] = Field(
        default=LogUniform(low=0.1, high=1.25),
        description="s of the random level exp(s U - s²/2); kurtosis 3 exp(s²) (measured: 0.1 to 0.6; assumed beyond)",
    )
    level_time_ms: Annotated[Number, Within(above=0, most=1000)] = Field(
        default=LogUniform(low=1.0, high=8.0), description="correlation time of the level (measured: below 10)"
    )
    replayed_share: Annotated[Number, Within(least=0, most=1)] = Field(
        default=LogUniform(low=0.01, high=0.08),
        description="power that returns with every turn of pinion and gear, half each (measured)",
    )
    bursts: Bursts | None = Field(default=None, description="null: none")


class Floor(Section):
    """Noise of forces in the mesh, at every bearing and of both machines, independent of each other."""

    density_n_per_sqrt_hz: Annotated[Number, Within(least=0, most=1000)] = Field(
        default=LogUniform(low=0.03, high=0.3), description="one-sided, in the mesh (assumed; gives measured floors)"
    )
    elsewhere: Annotated[Number, Within(least=0, most=100)] = Field(
        default=Uniform(low=0.3, high=1.0), description="density at each bearing over the mesh's (assumed)"
    )
    machines_n_per_sqrt_hz: Annotated[Number, Within(least=0, most=10_000)] = Field(
        default=LogUniform(low=0.16, high=1.6),
        description="one-sided, of each machine beside the gearbox, on the base or its shaft (derived: measured 3 to 7 "
        "mm/s²/√Hz from 40 to 80 Hz, times 75 to 325 kg, over √2 for two machines)",
    )
    low_corner_hz: Annotated[Number, Within(above=0, most=100_000)] = Field(
        default=LogUniform(low=15.0, high=120.0), description="f_r of √(1 + (f_r/f)^q) (assumed; measured shape)"
    )
    low_exponent: Annotated[Number, Within(least=0, most=4)] = Field(
        default=Uniform(low=2.0, high=3.0), description="q of the same (assumed)"
    )
    shaft_depth: Annotated[Number, Within(least=0, most=2)] = Field(
        default=LogUniform(low=0.03, high=0.4), description="modulation of a bearing's noise by its shaft (assumed)"
    )
    level_std: Annotated[Number, Within(least=0, most=2)] = Field(
        default=0.0,
        description="s of the random level exp(s U - s²/2) of the bearings' noise, one course per shaft; kurtosis "
        "3 exp(s²); 0: Gaussian",
    )
    level_time_ms: Annotated[Number, Within(above=0, most=1000)] = Field(
        default=LogUniform(low=1.0, high=8.0), description="correlation time of that level (measured: below 10)"
    )
    spectrum: Density | None = Field(
        default=None, description="factor on all densities over frequency; null: 1 at all frequencies"
    )


class ShaftLines(Section):
    """Lines of both shafts: misaligned couplings, which press on shaft and base, and machine rotors on the base."""

    coupling_stiffness_n_per_um: Annotated[Number, Within(least=0, most=1000)] = Field(
        default=LogUniform(low=0.1, high=1.0), description="radial, per coupling (assumed)"
    )
    offset_um: Annotated[Number, Within(least=0, most=5000)] = Field(
        default=LogUniform(low=10.0, high=100.0), description="misalignment and run-out of each coupling (assumed)"
    )
    second_db: Annotated[Number, Within(least=-200, most=60)] = Field(
        default=Uniform(low=-16.0, high=2.0), description="force at 2x over 1x (measured: velocity -22 to -4 dB)"
    )
    third_db: Annotated[Number, Within(least=-200, most=60)] = Field(
        default=Uniform(low=-16.5, high=1.5), description="force at 3x over 1x (measured: velocity -26 to -8 dB)"
    )
    fourth_db: Annotated[Number, Within(least=-200, most=60)] = Field(
        default=Uniform(low=-20.0, high=0.0), description="force at 4x over 1x (measured: velocity -32 to -12 dB)"
    )
    rotor_mass_kg: Annotated[Number, Within(least=0, most=100_000)] = Field(
        default=LogUniform(low=3.0, high=30.0), description="of the machine on each shaft (assumed)"
    )
    rotor_grade_mm_s: Annotated[Number, Within(least=0, most=5000)] = Field(
        default=LogUniform(low=2.5, high=16.0), description="balance quality of that machine (source: ISO 21940-11)"
    )
    rated_speed_hz: Annotated[Number, Within(above=0, most=2000)] = Field(
        default=50.0, description="speed of the pinion's shaft that the grade belongs to; the gear's by the ratio"
    )


class ForeignMesh(Section):
    """Lines of an undamaged mesh that is not simulated, with sidebands of a shaft; presses on the housing."""

    order: Annotated[Number, Within(above=0, most=10_000)] = Field(description="of the mesh, per turn of the pinion")
    force_share: Annotated[Number, Within(least=0, most=2)] = Field(
        default=LogUniform(low=0.005, high=0.05),
        description="first line over the mean mesh force (measured: 6 to 26 dB below mesh 1, here 10 % of the mean)",
    )
    harmonics: Annotated[Whole, Field(ge=1, le=60)] = Field(default=15, description="number of lines (measured)")
    decay_exponent: Annotated[Number, Within(least=0, most=4)] = Field(
        default=Uniform(low=0.5, high=1.2), description="line h has h to minus this of the first (measured)"
    )
    sideband_db: Annotated[Number, Within(least=-200, most=0)] = Field(
        default=Uniform(low=-25.0, high=-10.0), description="each of two beside every line (measured)"
    )
    shaft_order: Annotated[Number | None, Within(above=0, most=10_000, words=(None,))] = Field(
        default=None, description="turns of the sidebands' shaft per turn of the pinion; null: the gear's shaft"
    )


class Background(Section):
    """A healthy machine around the gears; with this section, noise levels belong to the gearbox."""

    redraw: Literal["gearbox", "record"] = Field(
        default="gearbox",
        description="what levels of noise, forces and sensors alike, are drawn for; gearbox: all states share them, "
        "record: each record has its own, and a state cannot be told by them either",
    )
    mesh_stiffness_n_per_um_mm: Annotated[Number, Within(above=0, most=200)] = Field(
        default=20.0, description="mean stiffness per face width that the forces meet (source: ISO 6336-1, steel)"
    )
    base: Base | None = Field(default=None, description="null: bolts stand on the ground")
    rubbing: Rubbing | None = Field(default=None, description="null: none")
    floor: Floor | None = Field(default=None, description="null: none")
    shafts: ShaftLines | None = Field(default=None, description="null: none")
    second_stage: ForeignMesh | None = Field(default=None, description="a stage that shares a shaft; null: none")
    auxiliary_drive: ForeignMesh | None = Field(default=None, description="a pump or other drive; null: none")
