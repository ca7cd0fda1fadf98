"""A trial of a set: short records of some states and gearboxes: what is lost, and what damage does.

A record is lost where the motion leaves the model. It does so within the first turns: of three machines with 8
gearboxes each, records of 8 and of 60 turns lost the same number in all 15 states, 0 to 5 of 8.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import sqrt
from statistics import median
from typing import TYPE_CHECKING

from siggen.columns.record import RecordFailure, non_finite
from siggen.gearbox.plan import record_ids_of
from siggen.sets import physics as contents
from siggen.sets.record_cost import RecordTime, SetCost, set_cost, timed

if TYPE_CHECKING:
    from siggen.columns.record import SimulatedRecord
    from siggen.gearbox.design import SetDesign

RECORDS = 3
"""That are tried unless told otherwise: of as many states, evenly spread over two gearboxes, or of a new and a pitted
one and a new other. Where gears are dear, one healthy record."""
DEAR = 3
"""As many meshes take as long as three pairs of spur gears; one of helical gears does."""
SIZES = 15
"""Damaged pairs that are sized: of as many gearboxes as have so many, at least one."""
TURNS = 8
"""Of the slower shaft that carries damage."""
LOOKED_THROUGH = 20
"""Gearboxes, at most, among which one is sought that shows both whole and pitted teeth."""
NORMAL_95 = 1.96
FOUND_LOSS, BESIDE_LOSS, FOUND_LENGTH_MM = 0.15, 0.03, 0.2
"""Of the preset bench: what is found alone and what beside a healthy record (docs/understand/presets.md). Not through
the face: 1 to 2 % of the mesh stiffness, AUC 0.50 to 0.53 alone and 0.68 to 0.90 beside; 4 %, 0.59 and 1.00; 20 %,
0.99. Through the face: 0.1 mm along the profile, 0.61 and 1.00; 0.2 mm, 0.84."""


@dataclass(frozen=True, slots=True)
class StateTrial:
    """What a trial found of one state.

    Attributes
    ----------
    state : str
    tried, lost : int
        Gearboxes of which a record was tried, and those that lost it.
    reason : str
        Why the first one did.
    stiffness_loss, area_share, profile_length_mm : float
        Largest relative loss of mesh stiffness, damaged share of the flank, longest single damage: medians of
        gearboxes.
    through_face : bool
        Whether damage takes the whole contact length, of any gearbox.
    """

    state: str
    tried: int
    lost: int
    reason: str = ""
    stiffness_loss: float = 0.0
    area_share: float = 0.0
    profile_length_mm: float = 0.0
    through_face: bool = False

    @property
    def share(self) -> float:
        """Share of the records that is lost."""
        return self.lost / max(self.tried, 1)

    @property
    def interval(self) -> tuple[float, float]:
        """Where the share of all gearboxes lies with 95 % (Wilson's interval)."""
        if not self.tried:
            return 0.0, 1.0
        n, z2 = self.tried, NORMAL_95**2
        middle = (self.share + 0.5 * z2 / n) / (1.0 + z2 / n)
        half = NORMAL_95 * sqrt(self.share * (1.0 - self.share) / n + 0.25 * z2 / n**2) / (1.0 + z2 / n)
        return max(middle - half, 0.0), min(middle + half, 1.0)

    @property
    def found(self) -> str:
        """What is found at that size, in words; nothing of a state without pits or spalls."""
        if self.area_share <= 0.0:
            return ""
        if self.through_face and self.profile_length_mm >= FOUND_LENGTH_MM:
            return "yes"
        if not self.through_face and self.stiffness_loss >= FOUND_LOSS:
            return "yes"
        if self.through_face or self.stiffness_loss >= BESIDE_LOSS:
            return "beside a healthy record"
        return "hardly"


@dataclass(frozen=True, slots=True)
class SetTrial:
    """States in the order of the configuration, gearboxes whose damage was sized, and what records cost."""

    states: tuple[StateTrial, ...]
    sized: int
    cost: SetCost


def trial(
    design: SetDesign, gearboxes: int | None = None, progress: Callable[[int, int], None] | None = None
) -> SetTrial:
    """Return what short records of the first gearboxes of a set lose, what damage does, and what all records cost.

    Parameters
    ----------
    design : SetDesign
    gearboxes : int, optional
        Of which every state is tried, at most as many as the set has; with several operating points each gearbox runs
        at one of them in turn. By default `RECORDS` records.
    progress : callable, optional
        Called with (records done, records of the trial), first before any record.
    """
    short, physics = design.shortened(TURNS), contents.physics()
    meshes = _meshes(design)
    sample = _sample(design, meshes) if gearboxes is None else _every_state(design, gearboxes)
    found: dict[str, list[SimulatedRecord | RecordFailure]] = {name: [] for name in design.state_names}
    times: list[RecordTime] = []
    fresh = 0  # place of the second gearbox's first record
    count = sum(len(picked) for _, picked in sample)
    if progress is not None:
        progress(0, count)
    for specimen, picked in sample:
        fresh = fresh or len(times)
        ids = _record_ids(short, specimen)  # a gearbox may fail before its last inspection
        places = [i for i in picked if i < len(ids)]
        results = iter(physics.simulate(short, [ids[i] for i in places]))
        for i, result in zip(places, timed(results, times), strict=True):
            if progress is not None:
                progress(len(times), count)
            found[design.state_names[i]].append(result)
    sized = 0 if design.lives else min(max(1, SIZES // (meshes * design.state_count)), design.specimens)
    sizes = [physics.damage_sizes(design, specimen) for specimen in range(sized)]
    states = tuple(
        _state_trial(name, results, [one[name] for one in sizes if name in one]) for name, results in found.items()
    )
    cost = set_cost(times, fresh, short.duration_s)
    return SetTrial(tuple(one for one in states if one.tried or sized), sized, cost)


def _meshes(design: SetDesign) -> int:
    """Return how many pairs of spur gears take as long as the meshes of a gearbox."""
    return sum(DEAR if helical else 1 for helical in design.helical_meshes)


Sample = Sequence[tuple[int, Sequence[int]]]
"""Gearboxes, each with the states, or inspections, of it that are tried."""


def _every_state(design: SetDesign, gearboxes: int) -> Sample:
    return [(specimen, range(design.state_count)) for specimen in range(min(gearboxes, design.specimens))]


def _sample(design: SetDesign, meshes: int) -> Sample:
    """Return what stands for all: the first record loads code, so a second gearbox tells what one costs."""
    if design.lives:
        specimen, inspections = _pitted(design)
        return [(specimen, inspections), *([((specimen + 1) % design.specimens, (0,))] if design.specimens > 1 else [])]
    if meshes >= DEAR:
        return [(0, (0,))]
    picked = _spread(design.state_count, RECORDS)
    return [(0, picked[-1:]), (1, picked[: RECORDS - 1])] if design.specimens > 1 else [(0, picked)]


def _pitted(design: SetDesign) -> tuple[int, tuple[int, ...]]:
    """Return a gearbox that shows both whole and pitted teeth, and an inspection of each."""
    for specimen in range(min(design.specimens, LOOKED_THROUGH)):
        found = design.life(specimen)
        pitted = [k for k, age in enumerate(found.ages_h) if found.clock.time(age) >= found.course.ends.first_pit]
        if pitted and pitted[0] > 0:
            return specimen, (0, pitted[len(pitted) // 2])
    return 0, (0, len(design.life(0).ages_h) - 1)


def _spread(count: int, most: int) -> list[int]:
    """Return so many of the first whole numbers, the first and the last among them."""
    steps = min(count, most) - 1
    return [i * (count - 1) // max(steps, 1) for i in range(steps + 1)]


def _record_ids(design: SetDesign, specimen: int) -> Sequence[int]:
    """Return one record of every state, all at one operating point."""
    each = design.points * design.repeats
    point = specimen % design.points
    return record_ids_of(design, specimen)[point * design.repeats :: each]


def _state_trial(
    name: str, results: Sequence[SimulatedRecord | RecordFailure], sizes: Sequence[Mapping[str, object]]
) -> StateTrial:
    reasons = [reason for result in results if (reason := _lost(result))]
    labels = sizes or [result.labels for result in results if not isinstance(result, RecordFailure)]

    def middle(column: str) -> float:
        return float(median([float(str(row.get(column, 0.0))) for row in labels] or [0.0]))

    return StateTrial(
        *(name, len(results), len(reasons), reasons[0] if reasons else ""),
        stiffness_loss=middle("mesh_stiffness_loss"),
        area_share=middle("damaged_area_share"),
        profile_length_mm=middle("damage_profile_length_mm"),
        through_face=any(bool(row.get("through_face", False)) for row in labels),
    )


def _lost(result: SimulatedRecord | RecordFailure) -> str:
    if isinstance(result, RecordFailure):
        return f"{result.status} ({result.reason})"
    return non_finite(result) or ""
