"""SetDesign: what a file lays down for a set of gearboxes; the one door from a file to what is drawn of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import ceil
from typing import Any

from siggen.config import Config, by_reference, parse
from siggen.config.config import MOST_SPECIMENS
from siggen.config.consistency import SAMPLES_PER_PERIOD, SIDEBANDS, carried_mesh_harmonics
from siggen.config.machine import most_teeth_per_turn, shaft_orders
from siggen.damage.fault import Fault
from siggen.errors import ConfigError, UsageError
from siggen.gearbox.configured import gearbox_config, gearbox_life, inspection_count, pair_of
from siggen.gearbox.draw import draw_operating_point, draw_specimen
from siggen.gearbox.life import Lived
from siggen.gearbox.possible import PossibleGearbox
from siggen.gearbox.specimen import OperatingPoint, Specimen
from siggen.keys.number import bounds
from siggen.keys.yaml_source import STORED_NUMBERS, parse_yaml, yaml_text
from siggen.names import EITHER, Names
from siggen.sensors.places import Places
from siggen.sensors.sensor import SensorBase

STATING = "exponential"
"""The integrator that states an error."""
TRIED = 100
"""Gearboxes of a set of which one at least has to be drawn."""


@dataclass(frozen=True)
class SetDesign:
    """How many gearboxes a set has, in which states, at which points, and what draws each of them.

    Workers receive it as a whole. `config` is for what reads and writes files.
    """

    config: Config

    def __reduce__(self) -> tuple[type[SetDesign], tuple[Config]]:
        """Leave what is drawn of it to where it goes."""
        return SetDesign, (self.config,)

    @property
    def name(self) -> str:
        """Of the set."""
        return self.config.name

    @property
    def seed(self) -> int:
        """Where all that is drawn begins."""
        return self.config.seed

    @property
    def identity(self) -> str:
        """SHA-256 (hexadecimal) of what records follow from: all but the number of gearboxes."""
        return self.config.identity

    @property
    def specimens(self) -> int:
        """Number of gearboxes."""
        return self.config.specimens

    @property
    def most_specimens(self) -> int:
        """Number of gearboxes that a configuration has, in a set or a stream."""
        return MOST_SPECIMENS

    @property
    def fs_hz(self) -> float:
        """Sampling rate."""
        return self.config.fs_hz

    @property
    def duration_s(self) -> float:
        """Length of a record."""
        return self.config.duration_s

    @property
    def samples(self) -> int:
        """Of a record's channel."""
        return self.config.samples

    @property
    def repeats(self) -> int:
        """Records of a gearbox in a state at an operating point."""
        return self.config.repeats

    @property
    def points(self) -> int:
        """Number of operating points."""
        return len(self.config.operating_points)

    @property
    def state_names(self) -> tuple[str, ...]:
        """Names of the states, of all inspections that a gearbox may have."""
        return self.config.state_names

    @property
    def state_count(self) -> int:
        """Number of states; of lives the most inspections of a gearbox."""
        return self.config.state_count

    @property
    def lives(self) -> bool:
        """Whether its gearboxes run to failure, and states are inspections."""
        return self.config.life is not None

    @property
    def records_per_specimen(self) -> int:
        """Records of one gearbox, repeats included; of lives the most."""
        return self.config.records_per_specimen

    def least_rate_hz(self, harmonics: int, speed_hz: float) -> float:
        """Return the sampling rate for so many mesh harmonics with sidebands at a mean speed of the first shaft."""
        fastest_hz = speed_hz * self.config.variation.speed_ratios[1]
        return SAMPLES_PER_PERIOD * (harmonics * self._most_teeth + SIDEBANDS) * fastest_hz

    def carried_harmonics(self, fs_hz: float, speed_hz: float) -> int:
        """Return how many mesh harmonics a sampling rate carries with their sidebands; at most those asked for."""
        fastest_hz = speed_hz * self.config.variation.speed_ratios[1]
        return min(carried_mesh_harmonics(fs_hz, self._most_teeth, fastest_hz), self.config.mesh_harmonics)

    @property
    def _most_teeth(self) -> float:
        return most_teeth_per_turn(dict(self.config))

    @property
    def sensors(self) -> tuple[SensorBase, ...]:
        """What measures, as a file gives it."""
        return self.config.sensors

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of what the sensors record."""
        return self.config.channels

    @property
    def stored(self) -> tuple[str, ...] | None:
        """What no sensor sees and records hold: names, or all; None: nothing."""
        return None if self.config.internals is None else self.config.internals.quantities

    @property
    def stores_all(self) -> bool:
        """Whether records hold all that no sensor sees."""
        return self.config.internals is not None and self.config.internals.stores_all

    @cached_property
    def shares(self) -> tuple[tuple[str, int], ...]:
        """Split -> how many of a block of gearboxes, or of pairs, belong to it."""
        splits = self.config.splits
        return ("train", splits.train), ("validation", splits.validation), ("test", splits.test)

    @property
    def block(self) -> int:
        """Gearboxes, or pairs, in which the shares are met exactly."""
        return sum(count for _, count in self.shares)

    @property
    def split_by_pair(self) -> bool:
        """Whether splits share no pair of gears."""
        return self.config.splits.by == "pair"

    @property
    def pairs(self) -> int:
        """Number of pairs of gears that its gearboxes have one of each; 0 where all have the same."""
        return len(self.config.gears.pairs)

    @property
    def names(self) -> Names:
        """What gears, shafts and meshes are called."""
        return self.config.names

    @property
    def places(self) -> Places:
        """Where sensors may stand, and what presses on the housing."""
        return self.config.places

    @property
    def tolerance(self) -> float | None:
        """Stated error of the delivered signals (relative rms); None where the integrator states none."""
        return self.integration_tolerance if self.method == STATING else None

    @property
    def integration_tolerance(self) -> float:
        """Which error the steps of time are chosen for, whether it is stated or not."""
        return self.config.dynamics.integration_tolerance

    @property
    def method(self) -> str:
        """Name of its integrator."""
        return self.config.dynamics.method

    @property
    def steps_per_sample(self) -> int:
        """Of its integrator, where that has a fixed number."""
        return self.config.dynamics.steps_per_sample

    @property
    def helical_meshes(self) -> tuple[bool, ...]:
        """Whether each mesh of a gearbox is helical; those of each planet with sun and ring are two."""
        if self.config.planetary is not None:
            return (False,) * 2 * len(self.config.planetary.positions_deg)
        pairs = (self.config.gears, *(stage.gears for stage in self.config.stages))
        return tuple(one.helix_deg != 0.0 for one in pairs)

    @cached_property
    def possible(self) -> PossibleGearbox:
        """Any of its gearboxes, at the corners of all numbers: what checks look at."""
        return PossibleGearbox(self.config)

    def canonical(self) -> dict[str, Any]:
        """Return all keys with their defaults, as plain mappings and lists; reading them gives an equal design."""
        return self.config.canonical()

    @cached_property
    def text(self) -> str:
        """The configuration that a set stores: `canonical` as YAML."""
        return yaml_text(self.canonical())

    def gearbox(self, number: int) -> Specimen:
        """Return a gearbox; depends on the seed, the sections that it is drawn from and its number alone.

        Raises
        ------
        ValueError
            If it cannot be made, as a ring that fits no planets.
        """
        return draw_specimen(self.config, number)

    def first(self) -> Specimen:
        """Return the first gearbox whose draw is not refused.

        Raises
        ------
        ValueError
            If all of the first hundred are refused.
        """
        numbers = range(min(TRIED, self.specimens))
        for number in numbers:
            try:
                return self.gearbox(number)
            except ValueError:
                if number == numbers[-1]:
                    raise
        raise AssertionError("a set has gearboxes")

    def life(self, number: int) -> Lived:
        """Return the life of a gearbox of a set of lives."""
        return gearbox_life(self.config, number)

    def inspections(self, number: int) -> int:
        """Return how many states a gearbox has: all, or of a life as many inspections as it lives to see."""
        return inspection_count(self.config, number)

    def pair_of(self, number: int) -> int | None:
        """Return which of the pairs a gearbox has; None where all have the same."""
        return pair_of(self.config, number)

    def damaged_states(self, number: int) -> tuple[int, ...]:
        """Return the last state of a gearbox with every kind of damage; shams remove nothing."""
        states = gearbox_config(self.config, number).states
        kinds = {type(one): i for i, state in enumerate(states) if not state.sham for one in state.damages}
        return tuple(kinds.values())

    def drawn_points(self, number: int) -> tuple[OperatingPoint, ...]:
        """Return speeds and torques of a gearbox; the same for all of its states."""
        own = gearbox_config(self.config, number)
        return tuple(draw_operating_point(own, number, place) for place in range(self.points))

    def with_passed(
        self, sensors: Sequence[SensorBase], shapes: Mapping[str, tuple[tuple[Fault, ...], bool]]
    ) -> SetDesign:
        """Return the design with sensors, and by state with damage and whether that is a sham, which no file names."""
        states = list(self.config.states)
        for name, (faults, sham) in shapes.items():
            if faults:
                place = [one.name for one in states].index(name)
                shown = {} if sham else {"fault": faults[0].word, "severity": name}
                damage = (*states[place].damages, *faults)
                states[place] = states[place].model_copy(update={"damage": damage, "acts": not sham, **shown})
        return self.with_sections(states=tuple(states), sensors=(*self.config.sensors, *sensors))

    def with_sections(self, **sections: Any) -> SetDesign:
        """Return the design with other sections, which are not checked against each other."""
        return SetDesign(self.config.model_copy(update=sections))

    def listed(self, number: int) -> SetDesign:
        """Return the design whose states are the inspections of a gearbox that runs to failure."""
        return self.with_sections(life=None, states=gearbox_config(self.config, number).states)

    def plain(self, duration_s: float) -> SetDesign:
        """Return the design of healthy gearboxes on shafts that do not bend, with records of this length [s]."""
        states = tuple(state.model_copy(update={"damage": None}) for state in self.config.states[:1])
        parallel = self.config.dynamics.model_copy(update={"shafts": None})
        return self.with_sections(dynamics=parallel, states=states, duration_s=duration_s)

    def shortened(self, turns: float) -> SetDesign:
        """Return the design with records of so many turns of the slowest gear with damage, without internals."""
        config = self.config
        slowest_hz = min(abs(bound) for point in config.operating_points for bound in bounds(point.speed_hz))
        wanted_s = turns / (self._damaged_turns * max(slowest_hz, turns / config.duration_s))
        duration_s = min(ceil(wanted_s * config.fs_hz) / config.fs_hz, config.duration_s)
        return self.with_sections(duration_s=duration_s, internals=None)

    @property
    def _damaged_turns(self) -> float:
        """Turns of the slowest gear with damage per turn of the first shaft; 1 without damage."""
        first, stages, names = self.config.gears, self.config.stages, self.names
        orders = shaft_orders(Fraction(first.pinion.teeth, first.gear.teeth), stages)
        meshes = zip(names.meshes, pairwise(orders), strict=False)  # the ring of a planetary set turns no shaft
        turns = {gear.word: order for mesh, ends in meshes for gear, order in zip(mesh.gears, ends, strict=True)}
        either = {word: names.mesh(mesh).driven.word for word, (mesh, side) in names.flanks.items() if side == EITHER}
        hit = (either.get(word, word) for one in self.config.damages for word in one.hit_gears if word)
        return min((turns.get(word, orders[-1]) for word in hit), default=1.0)

    def unrounded(self) -> SetDesign:
        """Return the design with converters that do not round."""
        return self.with_sections(sensors=tuple(one.model_copy(update={"bits": None}) for one in self.config.sensors))

    def by_reference(self, steps: int) -> SetDesign:
        """Return the design, integrated by the reference with so many steps per sample."""
        return self.with_sections(dynamics=by_reference(self.config.dynamics, steps))


def expect_design(design: object) -> None:
    """Refuse what is no design, such as the name of its file.

    Raises
    ------
    UsageError
        If it is none.
    """
    if not isinstance(design, SetDesign):
        raise UsageError(f"design: received {design!r}; allowed: what siggen.load_config returns of a file or preset")


def design_of(raw: Mapping[str, Any], source: str) -> SetDesign:
    """Return the design of a checked configuration, such as a set stores; `source` is for messages.

    Raises
    ------
    ConfigError
        If this version reads it otherwise.
    """
    parsed = parse(raw)
    if parsed.config is None:
        raise ConfigError(parsed.problems, source)
    return SetDesign(parsed.config)


def stored_design(content: bytes, source: str, changes: Mapping[str, Any] | None = None) -> SetDesign:
    """Return the design whose `text` a set stores, with some top-level keys changed. Raises as `design_of`."""
    return design_of({**parse_yaml(content.decode(), source, STORED_NUMBERS), **(changes or {})}, source)
