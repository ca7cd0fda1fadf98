"""Pitting: teeth pit by a Poisson process in damage time, pits grow as exponentials with scatter, and outlines spread.

Defaults reproduce the growth published for a test bench (11 and 21 teeth, 200 N m): first pit at 6.9e6 turns with
0.45 % of a flank, 4 % after 3.5e6 turns more. Scatter of the rate is that of its fitted teeth; wander is assumed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.irregular import ListedIrregular
from siggen.damage.pits import ListedPits
from siggen.keys.distributions import Uniform
from siggen.life.flank import Flank
from siggen.life.growth import STEP, Grown, Seeds, grown
from siggen.life.initiation import Begun, begun, tooth_scale
from siggen.life.law import Ends, Named, PartTruth, Picture, ToothTruth, Wearing
from siggen.life.outline import Edges, PitShape, drawn_shape, sizes_m, through, union_m2
from siggen.life.outlook import Chances, Now, failing_times, through_share
from siggen.life.picture import flank_png
from siggen.names import Side

SLOPE = 2.5
"""Weibull slope of the first pit, of a tooth and of a gearbox."""
TORQUE_EXPONENT = Uniform(low=4.3, high=8.8)
"""Life falls with the torque to this power, until the first pit and after it; drawn per gearbox. 4.3: load and life of
tested spur gears (NASA), 6.6 and 8.8: case-hardened flanks of ISO 6336-2 without pits and with some (memory)."""
UNIT_REV = 6.9e6
"""Weibull scale of a gearbox's first pit, in turns of the pinion at reference torque."""
RATE_PER_REV = 0.62e-6
"""Median growth of a pit's logarithm per turn of its gear at reference torque."""
RATE_SD = 0.35
"""Of that rate's logarithm from pit to pit."""
WANDER_SD = 0.3
"""Of the rate's logarithm over a pit's life; forgotten within 5e5 turns times scale (assumed)."""
FIRST_SHARE = 0.0045
"""Median share of a flank with which a pit begins."""
FIRST_SHARE_SD = 0.5
"""Of the logarithm of the first share; published as 0.45 % with 0.2 to 0.3 %."""
RATED_TOOTH, RATED_GEAR = 0.04, 0.01
"""Shares of one flank, and of all flanks of a gear, at which a gear counts as failed in tests (FZG, ISO 6336)."""
LEAST_THROUGH = 0.05
"""Share of a flank below which nobody asks whether land is left."""
FORESEEN, MORE, MOST_STEPS = 160, 160, 20_000
"""Steps of the grid that are integrated at first and added while no end is reached, and most of all."""
ANY_PITS = 32
"""Pits of either gear of which an outlook takes how new ones spread."""


@dataclass(frozen=True, slots=True)
class PitBirth:
    """What a pit is born with; `owner` numbers the teeth of both gears."""

    begun: Begun
    owner: int
    share: float
    rate: float
    shape: PitShape


@dataclass(frozen=True)
class PittingCourse:
    """Pits of one gearbox over damage time."""

    torque_exponent: float
    wearing: Wearing
    functional_share: float

    @cached_property
    def begins(self) -> list[Begun]:
        """When pits begin, by time; those too that begin after the end."""
        return begun(self.wearing.flanks, self.wearing.nominal, UNIT_REV, SLOPE, self.wearing.named)

    @cached_property
    def ends(self) -> Ends:
        """When the gearbox has its first pit, reaches the rated damage, and fails."""
        return self._lived[1]

    @property
    def parts(self) -> tuple[PartTruth, ...]:
        """The pits that begin before the end."""
        return tuple(
            PartTruth(
                pit.begun.gear, pit.begun.tooth, pit.begun.number, pit.begun.time, pit.share, pit.rate,
                pit.shape.middle_m, pit.shape.arc_m,
            )
            for pit in self.pits
            if pit.begun.time <= self.ends.functional
        )  # fmt: skip

    @property
    def pits(self) -> list[PitBirth]:
        """The pits that were followed."""
        return self._lived[2]

    def shares(self, time: float) -> FloatArray:
        """Return the share of its tooth that each of `pits` has at a damage time (n,), as growth has it."""
        return self._lived[0].shares(time)

    def teeth(self, time: float) -> tuple[ToothTruth, ...]:
        """Return the pitted teeth at a damage time; areas are those of the unions of their outlines."""
        return tuple(self._truth(pits, outlines) for pits, outlines in self._outlined(time))

    def damage(self, time: float) -> ListedPits | None:
        """Return the section of damage at a damage time; heights are arcs, every outline with all its digits."""
        listed = tuple(
            _listed(pit, edges, size)
            for pits, outlines, sizes in self._sized(time)
            for pit, edges, size in zip(pits, outlines, sizes, strict=True)
        )
        return ListedPits(outlines=listed) if listed else None

    def removed_m3(self, time: float) -> float:
        """Return the volume of all pits at a damage time [m³]: what each adds to the area of its tooth, times depth."""
        shares = {pit.begun: share for pit, share in zip(self.pits, self.shares(time).tolist(), strict=True)}
        volumes = [
            shares[pit.begun] * self._flank(pit.begun.gear).area_m2 * pit.shape.depth_m(size)
            for pits, _, sizes in self._sized(time)
            for pit, size in zip(pits, sizes, strict=True)
        ]
        return float(sum(volumes))

    def pictures(self, time: float) -> tuple[Picture, ...]:
        """Return pictures of the pitted flanks at a damage time, or of the first one of each gear before any pit."""
        pitted = tuple(
            Picture(
                pits[0].begun.gear,
                pits[0].begun.tooth,
                flank_png(
                    self._flank(pits[0].begun.gear),
                    outlines,
                    [pit.shape.depth_m(size) for pit, size in zip(pits, sizes, strict=True)],
                ),
            )
            for pits, outlines, sizes in self._sized(time)
        )
        return pitted or tuple(Picture(one.gear, 0, flank_png(one, (), ())) for one in self.wearing.flanks)

    def outlook(self, time: float, runs: int) -> FloatArray:
        """Return when the gearbox would fail in so many continuations from its true state (runs,) [turns]."""
        lived, flanks = self._lived[0], self.wearing.flanks
        shares = lived.shares(time)
        own = np.flatnonzero(shares)
        sizes = [one.teeth for one in flanks]
        eta = tooth_scale(UNIT_REV, self.wearing.nominal, SLOPE)
        hazards = [
            (one.turns / eta) ** SLOPE * one.area_m2 / nominal.area_m2
            for one, nominal in zip(flanks, self.wearing.nominal, strict=True)
        ]
        now = Now(
            time,
            shares[own],
            lived.seeds.rate[own],
            lived.wander(time, WANDER_SD)[own],
            lived.seeds.owner[own],
            np.array([self._through(self.pits[i]) for i in own]),
            np.repeat(hazards, sizes),
            np.repeat([one.turns for one in flanks], sizes),
            np.repeat([self._first_share(one.gear) for one in flanks], sizes),
            np.repeat(self._through_any, sizes, axis=0),
        )
        chances = Chances(
            SLOPE, FIRST_SHARE_SD, RATE_PER_REV, RATE_SD, WANDER_SD,
            self.functional_share,
        )  # fmt: skip
        return failing_times(now, chances, runs, self.wearing.named(f"outlook/{time!r}"))

    def _through(self, pit: PitBirth) -> float:
        return through_share(pit.shape, self._flank(pit.begun.gear).area_m2)

    @cached_property
    def _through_any(self) -> FloatArray:
        """Shares at which pits leave no land, of any pits of either gear (2, `ANY_PITS`)."""

        def shape(flank: Flank, number: int) -> PitShape:
            named = partial(_numbered, self.wearing.named, f"{flank.gear}/{number}")
            return drawn_shape(flank, self.torque_exponent, named)

        return np.array([
            [through_share(shape(flank, number), flank.area_m2) for number in range(ANY_PITS)]
            for flank in self.wearing.flanks
        ])  # fmt: skip

    def _first_share(self, gear: Side) -> float:
        """Return the median share of a young pit: its area is that on the nominal flank."""
        nominal = self.wearing.nominal[gear.number]
        return FIRST_SHARE * (nominal.area_m2 / self._flank(gear).area_m2)

    def _flank(self, gear: Side) -> Flank:
        return self.wearing.flanks[gear.number]

    def _truth(self, pits: list[PitBirth], outlines: list[Edges]) -> ToothTruth:
        one = pits[0].begun
        flank = self._flank(one.gear)
        area = union_m2(outlines, flank.face_m)
        return ToothTruth(one.gear, one.tooth, one.time, len(pits), area, area / flank.area_m2)

    def _outlined(self, time: float) -> Iterable[tuple[list[PitBirth], list[Edges]]]:
        return ((pits, outlines) for pits, outlines, _ in self._sized(time))

    def _sized(self, time: float) -> Iterable[tuple[list[PitBirth], list[Edges], list[float]]]:
        """Yield the pits of every pitted tooth, the oldest first, with their outlines and sizes."""
        shares = self.shares(time)
        by_tooth: dict[int, list[int]] = {}
        for index in np.flatnonzero(shares):
            by_tooth.setdefault(self.pits[index].owner, []).append(int(index))
        for _, own in sorted(by_tooth.items()):
            pits = [self.pits[i] for i in own]
            flank = self._flank(pits[0].begun.gear)
            shapes, areas = [pit.shape for pit in pits], [flank.area_m2 * float(shares[i]) for i in own]
            sizes = sizes_m(shapes, areas, flank.face_m)
            yield pits, [shape.edges(size) for shape, size in zip(shapes, sizes, strict=True)], sizes

    @cached_property
    def _lived(self) -> tuple[Grown, Ends, list[PitBirth]]:
        """Integrate until the gearbox fails; what is drawn does not depend on how far."""
        steps = FORESEEN
        while True:
            pits, course = self._followed(steps)
            end = _failing(self, pits, course)
            if end is not None:
                return course, end, pits
            if steps >= MOST_STEPS:
                raise ValueError(f"no end within {steps} steps of {STEP:g} turns; allowed: a larger torque")
            steps += MORE if steps < 4 * FORESEEN else steps

    def _followed(self, steps: int) -> tuple[list[PitBirth], Grown]:
        first = self.begins[0].time // STEP
        pits = [self._pit(one) for one in self.begins if one.time < STEP * (first + steps)]
        seeds = Seeds(
            np.array([pit.begun.time for pit in pits]),
            np.array([pit.share for pit in pits]),
            np.array([pit.rate * self._flank(pit.begun.gear).turns for pit in pits]),
            np.array([pit.owner for pit in pits]),
            np.array([self._named(pit.begun)("wander").standard_normal(steps) for pit in pits]),
        )
        return pits, grown(seeds, WANDER_SD, steps, sum(one.teeth for one in self.wearing.flanks))

    def _pit(self, one: Begun) -> PitBirth:
        named = self._named(one)
        own, flank = one.gear.number, self._flank(one.gear)
        size, rate = named("growth").standard_normal(2).tolist()
        share = self._first_share(one.gear) * np.exp(FIRST_SHARE_SD * size)
        owner = one.tooth + own * self.wearing.flanks[0].teeth
        shape = drawn_shape(flank, self.torque_exponent, named)
        return PitBirth(one, owner, float(share), float(RATE_PER_REV * np.exp(RATE_SD * rate)), shape)

    def _named(self, one: Begun) -> Callable[[str], np.random.Generator]:
        return lambda name: self.wearing.named(f"{one.gear}/{one.tooth}/{one.number}/{name}")


def _failing(course: PittingCourse, pits: list[PitBirth], grown_pits: Grown) -> Ends | None:
    """Return the ends of a gearbox, or None if it has not failed yet."""
    flanks = course.wearing.flanks
    teeth = [flanks[0].teeth, flanks[1].teeth]
    owners = np.array([pit.owner for pit in pits])

    def of_teeth(time: float) -> FloatArray:
        return np.asarray(np.bincount(owners, grown_pits.shares(time), sum(teeth)), dtype=np.float64)

    def rated(time: float) -> bool:
        shares = of_teeth(time)
        means = shares[: teeth[0]].mean(), shares[teeth[0] :].mean()
        return bool(shares.max() >= RATED_TOOTH or max(means) >= RATED_GEAR)

    def landless(time: float, owner: int) -> bool:
        own = [i for i in np.flatnonzero(grown_pits.shares(time)) if pits[i].owner == owner]
        flank, shares = course._flank(pits[own[0]].begun.gear), grown_pits.shares(time)
        shapes = [pits[i].shape for i in own]
        sizes = sizes_m(shapes, [flank.area_m2 * float(shares[i]) for i in own], flank.face_m)
        outlines = [shape.edges(size) for shape, size in zip(shapes, sizes, strict=True)]
        return through(outlines, [shape.arc_m for shape in shapes], flank.face_m)

    def failed(time: float) -> int | None:
        shares = of_teeth(time)
        worst = np.argsort(shares)[::-1]
        if shares[worst[0]] >= course.functional_share:
            return int(worst[0])
        return next((int(i) for i in worst if shares[i] >= LEAST_THROUGH and landless(time, int(i))), None)

    if failed(grown_pits.last) is None:
        return None
    functional = _first(lambda time: failed(time) is not None, pits[0].begun.time, grown_pits.last)
    owner = failed(functional)
    assert owner is not None
    gear = int(owner >= teeth[0])
    return Ends(
        pits[0].begun.time,
        _first(rated, pits[0].begun.time, grown_pits.last),
        functional,
        tuple(Side)[gear],
        owner - gear * teeth[0],
    )


def _numbered(named: Named, number: str, what: str) -> np.random.Generator:
    return named(f"outlook/{number}/{what}")


def _first(reached: Callable[[float], bool], low: float, high: float) -> float:
    """Return the time from which something holds that never ends, to 1e-9 of a step."""
    while high - low > 1e-9 * STEP and low < (middle := 0.5 * (low + high)) < high:
        low, high = (low, middle) if reached(middle) else (middle, high)
    return high


def _listed(pit: PitBirth, edges: Edges, size_m: float) -> ListedIrregular:
    """Return a pit as a user would list it."""
    rows = tuple(tuple(row) for row in (1e3 * np.array(edges).T).tolist())
    return ListedIrregular(
        gear=pit.begun.gear,
        tooth=pit.begun.tooth,
        edges_mm=rows,
        depth_mm=1e3 * pit.shape.depth_m(size_m),
        edge_radius_mm=1e3 * pit.shape.edge_radius_m,
    )


_ANY = ListedIrregular(edges_mm=((0.0, 1.0, 1.0), (1.0, 1.0, 1.0)), depth_mm=0.1, edge_radius_mm=0.1)
EXAMPLE = ListedPits(outlines=(_ANY,))
"""The kind of damage that a state with pits has, for whoever asks what a set's damage is."""
