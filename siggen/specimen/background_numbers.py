"""Numbers of the background that no file sets, with their sources; drawn per gearbox, by name, like its keys.

"measured" is the range found on real machines, "source" a published number, "assumed" an engineering judgement.
"""

from __future__ import annotations

from typing import Annotated, TypeVar

from siggen.config import Background, Base, Bursts, Floor, ForeignMesh, Rubbing, ShaftLines
from siggen.keys.distributions import LogUniform, Uniform
from siggen.keys.number import Number, Within
from siggen.keys.section import Section

MESH_STIFFNESS_N_PER_UM_MM = 20.0
"""Mean stiffness per face width that the forces meet (source: ISO 6336-1, steel)."""
FOREIGN_LINES = 15
"""Lines of another mesh (measured)."""

Drawn = Annotated[Number, Within()]
SomeSection = TypeVar("SomeSection", bound=Section)


class BaseNumbers(Base):
    """Of the base on its mounts: `mount_hz`, drawn for each motion, and rubber's damping (assumed)."""

    horizontal_hz: Drawn
    vertical_hz: Drawn
    rocking_hz: Drawn
    damping_ratio: Drawn = Uniform(low=0.05, high=0.15)


class BurstNumbers(Bursts):
    """Time constant, and rise over the rms of the rubbing (assumed)."""

    decay_ms: Drawn = Uniform(low=2.0, high=10.0)
    peak: Drawn = LogUniform(low=1.0, high=4.0)


class RubbingNumbers(Rubbing):
    """Of the force k r n(t) √M along the line of action.

    Roughness averages over face/correlation (assumed). n has the power (1 + (f/corner)²)^-steepness, from where the
    contact's width cuts: rolling speed/(2 pi half-width) (assumed range). The force grows with the rolling speed, 1 at
    3 m/s (source; exponent assumed), and with the line load, 1 at 50 N/mm (assumed); M with a power of the sliding
    speed of a pair (assumed). The shafts modulate it (measured: 0.1 to 0.5 and 0.06 to 0.42), and a share of its power
    returns with every turn of pinion and gear, half each (measured). The level changes within 10 ms (measured).
    """

    correlation_mm: Drawn = LogUniform(low=0.05, high=1.0)
    corner_hz: Drawn = LogUniform(low=1500.0, high=5000.0)
    steepness: Drawn = Uniform(low=1.0, high=2.0)
    speed_exponent: Drawn = Uniform(low=0.5, high=1.0)
    load_exponent: Drawn = Uniform(low=0.3, high=0.7)
    sliding_exponent: Drawn = Uniform(low=0.5, high=1.0)
    pinion_depth: Drawn = LogUniform(low=0.05, high=0.8)
    gear_depth: Drawn = LogUniform(low=0.03, high=0.4)
    level_time_ms: Drawn = LogUniform(low=1.0, high=8.0)
    replayed_share: Drawn = LogUniform(low=0.01, high=0.08)
    bursts: BurstNumbers | None


class FloorNumbers(Floor):
    """Of noise of density √(1 + (low_corner/f)^low_exponent) (measured shape; assumed).

    `elsewhere` is the density at each bearing over the mesh's (assumed). A shaft modulates that of its bearings
    (assumed), whose random level changes within 10 ms (measured).
    """

    elsewhere: Drawn = Uniform(low=0.3, high=1.0)
    low_corner_hz: Drawn = LogUniform(low=15.0, high=120.0)
    low_exponent: Drawn = Uniform(low=2.0, high=3.0)
    shaft_depth: Drawn = LogUniform(low=0.03, high=0.4)
    level_time_ms: Drawn = LogUniform(low=1.0, high=8.0)


class ShaftNumbers(ShaftLines):
    """Forces of a coupling at 2x to 4x over 1x, and the balance of the rotor beside.

    Measured: velocity at -22 to -4, -26 to -8 and -32 to -12 dB. Grades G2.5 to G16 of ISO 21940-11, at the rated speed
    of the pinion's shaft; the gear's by the ratio.
    """

    second_db: Drawn = Uniform(low=-16.0, high=2.0)
    third_db: Drawn = Uniform(low=-16.5, high=1.5)
    fourth_db: Drawn = Uniform(low=-20.0, high=0.0)
    rotor_grade_mm_s: Drawn = LogUniform(low=2.5, high=16.0)
    rated_speed_hz: Drawn = 50.0


class ForeignNumbers(ForeignMesh):
    """Line h has h to minus `decay_exponent` of the first (measured), and two sidebands beside it (measured)."""

    decay_exponent: Drawn = Uniform(low=0.5, high=1.2)
    sideband_db: Drawn = Uniform(low=-25.0, high=-10.0)


class BackgroundNumbers(Background):
    """The section `background` with all that is drawn for it."""

    base: BaseNumbers | None
    rubbing: RubbingNumbers | None
    floor: FloorNumbers | None
    shafts: ShaftNumbers | None
    second_stage: ForeignNumbers | None
    auxiliary_drive: ForeignNumbers | None


def background_numbers(section: Background) -> BackgroundNumbers:
    """Return what a section says, and what no file says."""
    base, rubbing = section.base, section.rubbing
    mounts = {} if base is None else dict.fromkeys(("horizontal_hz", "vertical_hz", "rocking_hz"), base.mount_hz)
    bursts = None if rubbing is None else _completed(BurstNumbers, rubbing.bursts)
    return BackgroundNumbers.model_construct(
        redraw=section.redraw,
        base=_completed(BaseNumbers, base, **mounts),
        rubbing=_completed(RubbingNumbers, rubbing, bursts=bursts),
        floor=_completed(FloorNumbers, section.floor),
        shafts=_completed(ShaftNumbers, section.shafts),
        second_stage=_completed(ForeignNumbers, section.second_stage),
        auxiliary_drive=_completed(ForeignNumbers, section.auxiliary_drive),
    )


def _completed(kind: type[SomeSection], section: Section | None, **more: object) -> SomeSection | None:
    return None if section is None else kind.model_construct(**{**dict(section), **more})
