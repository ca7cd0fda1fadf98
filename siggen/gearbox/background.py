"""What is drawn of a background: what a gearbox's machine does beside its meshing teeth, in SI.

`siggen.gearbox.background_numbers` says what the numbers mean and where they come from.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import TypeVar

from siggen.config import Config
from siggen.drivetrain.gear_stage import Base
from siggen.gearbox.background_numbers import (
    BaseNumbers,
    BearingNumbers,
    BurstNumbers,
    ForeignNumbers,
    MachineNumbers,
    RubbingNumbers,
    ShaftNumbers,
)
from siggen.keys.drawing import SomeSection, draw, in_si
from siggen.keys.number import constant
from siggen.keys.section import Section
from siggen.names import MACHINES
from siggen.seeding import Stream, named_uniforms

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class BurstLevels:
    """Bursts of the rubbing."""

    rate_hz: float
    decay_s: float
    peak: float


@dataclass(frozen=True, slots=True)
class RubbingLevels:
    """Rough flanks that rub."""

    correlation_m: float
    roll_off_m: float
    hurst_exponent: float
    asperity_exponent: float
    sliding_exponent: float
    pinion_depth: float
    gear_depth: float
    level_std: float
    level_time_s: float
    replayed_share: float
    bursts: BurstLevels | None


@dataclass(frozen=True, slots=True)
class BearingLevels:
    """Both bearings of a shaft; velocities of the bands in the unit of their class."""

    low_um_s: float
    middle_um_s: float
    high_um_s: float
    compliance_m: float
    ball_pass_order: float
    shaft_depth: float
    level_std: float
    level_time_s: float


@dataclass(frozen=True, slots=True)
class MachineLevels:
    """Noise of both machines beside the gearbox."""

    density_n_per_sqrt_hz: float
    low_corner_hz: float
    low_exponent: float
    high_corner_hz: float
    shaft_depth: float
    level_std: float
    level_time_s: float


@dataclass(frozen=True, slots=True)
class ShaftLevels:
    """Lines of a shaft: force of its coupling [N] at 1x, and of 2x to 4x over it [dB].

    `rotor_kg_m_s` : unbalance of the rotor beside, times its angular speed while the pinion turns at `rated_speed_hz`
    """

    coupling_n: float
    higher_db: tuple[float, float, float]
    rotor_kg_m_s: float
    rated_speed_hz: float


@dataclass(frozen=True, slots=True)
class ForeignLevels:
    """Another mesh; `shaft_order` None: its sidebands are those of the gear."""

    order: float
    shaft_order: float | None
    force_share: float
    decay_exponent: float
    sideband_db: float
    support_hz: float
    support_damping: float


@dataclass(frozen=True, slots=True)
class DrawnBackground:
    """The background of a gearbox; parts that it has not are None or empty.

    Attributes
    ----------
    bearings : shaft, by its name in sections -> of both its bearings
    shafts : the same, of those that lead to `MACHINES`
    foreign : second_stage, auxiliary_drive -> that mesh
    angles_rad : motor, load, auxiliary_drive -> direction of its force, from the horizontal
    """

    base: Base | None
    rubbing: RubbingLevels | None
    bearings: Mapping[str, BearingLevels]
    machines: MachineLevels | None
    shafts: Mapping[str, ShaftLevels]
    foreign: Mapping[str, ForeignLevels]
    angles_rad: Mapping[str, float]


def drawn_background(config: Config, specimen_id: int) -> DrawnBackground | None:
    """Return what belongs to the gearbox; None without a background."""
    section = config.background
    if section is None:
        return None
    uniform = named_uniforms(config.seed, Stream.BACKGROUND, specimen_id)

    def drawn(numbers: type[SomeSection], part: Section, path: str) -> SomeSection:
        return draw(numbers.model_construct(**dict(part)), uniform, f"background.{path}")

    def levels(kind: type[T], numbers: type[Section], part: Section | None, path: str, **more: object) -> T | None:
        return None if part is None else kind(**in_si(drawn(numbers, part, path)), **more)

    rubbing, bearings, shafts = section.rubbing, section.bearings, section.shafts
    bursts = levels(BurstLevels, BurstNumbers, None if rubbing is None else rubbing.bursts, "rubbing.bursts")
    meshes = {"second_stage": section.second_stage, "auxiliary_drive": section.auxiliary_drive}
    turning = config.names.shafts
    turned = {"auxiliary_drive": "auxiliary_drive", **{name: f"machines.{name}" for name in MACHINES}}
    return DrawnBackground(
        base=None if section.base is None else _base(drawn(BaseNumbers, section.base, "base")),
        rubbing=levels(RubbingLevels, RubbingNumbers, rubbing, "rubbing", bursts=bursts),
        bearings={
            shaft.inner: BearingLevels(**in_si(drawn(BearingNumbers, bearings, f"bearings.{shaft.word}")))
            for shaft in turning
            if bearings is not None
        },
        machines=levels(MachineLevels, MachineNumbers, section.machines, "machines"),
        shafts={
            shaft.inner: _shaft(drawn(ShaftNumbers, shafts, f"shafts.{shaft.word}"))
            for shaft in (turning[place] for place in MACHINES.values())
            if shafts is not None
        },
        foreign={
            name: ForeignLevels(**in_si(drawn(ForeignNumbers, mesh, name)))
            for name, mesh in meshes.items()
            if mesh is not None
        },
        angles_rad={name: 2.0 * pi * uniform(f"background.{path}.angle") for name, path in turned.items()},
    )


def _base(section: BaseNumbers) -> Base:
    mass = constant(section.mass_kg)
    return Base(
        mass,
        mass * constant(section.gyration_m) ** 2,
        (constant(section.horizontal_hz), constant(section.vertical_hz), constant(section.rocking_hz)),
        constant(section.damping_ratio),
    )


def _shaft(section: ShaftNumbers) -> ShaftLevels:
    return ShaftLevels(
        coupling_n=constant(section.coupling_stiffness_n_per_um) * constant(section.offset_um),
        higher_db=(constant(section.second_db), constant(section.third_db), constant(section.fourth_db)),
        rotor_kg_m_s=constant(section.rotor_mass_kg) * 1e-3 * constant(section.rotor_grade_mm_s),
        rated_speed_hz=constant(section.rated_speed_hz),
    )
