"""Gearbox: one drawn machine with its states and sensors; made by `single_stage` and `draw`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from siggen.checks.loading import load_config
from siggen.columns.drivetrain import GearTrain, gear_train
from siggen.columns.record import label_columns
from siggen.errors import UsageError
from siggen.gearbox.design import SetDesign, expect_design
from siggen.gearbox.specimen import Specimen
from siggen.keys.column import Column
from siggen.keys.user_name import SENSOR, SENSOR_TEXT
from siggen.library.arguments import finite, one_of, refused, saying
from siggen.library.damage import BearingSpall, Damage, DamagedPlace, Wear, entries
from siggen.library.sensors import DIRECTIONS, Channel, PassedSensor, Sensor, reading_input
from siggen.library.shape_fault import ShapeFault
from siggen.names import ShaftName, Side
from siggen.record.labels import gearbox_labels
from siggen.sensing.inputs import Input
from siggen.sensors.places import PLATE_OF

__all__ = ["Case", "Gearbox", "Point", "State", "draw"]


@dataclass(frozen=True)
class State:
    """A condition of health.

    Attributes
    ----------
    name : str
        Letters, digits, - and _, beginning with a letter.
    damages : tuple of Damage
        What of gears and bearings is damaged. Of a state that `draw` returned it is left to the set, and empty here.
    sham : bool
        Whether its damage passes everywhere with nothing removed: what tells such a record from a healthy one is a
        leak, not physics.
    """

    name: str
    damages: tuple[Damage, ...] = ()
    sham: bool = False


@dataclass(frozen=True)
class Point:
    """Speed [Hz] and torque [N m] of the first shaft; a torque below 0 drives on the back flanks."""

    speed_hz: float
    torque_nm: float


@dataclass(frozen=True)
class Case:
    """State, point and repeat of one record; repeats differ in noise, start and varying speed.

    Attributes
    ----------
    state : str
    point : Point, or int
        An int is the index of one of the gearbox's points.
    repeat : int
    """

    state: str
    point: Point | int = 0
    repeat: int = 0


@dataclass(frozen=True, repr=False)
class Gearbox:
    """One drawn gearbox: gears with their errors, shafts, bearings, housing, states and sensors.

    Made by `single_stage` and `draw`; the same arguments give the same gearbox. Gearboxes of one drawing with another
    number differ in what is drawn: errors of teeth, bearings, housing, noise.

    Attributes
    ----------
    number : int
        From 0.
    states : tuple of State
        What `run` takes by name.
    points : tuple of Point
        Speeds and torques that were drawn for it; none where `run` has to be told.
    """

    number: int
    states: tuple[State, ...]
    points: tuple[Point, ...]
    _design: SetDesign
    _added: tuple[State, ...] = ()
    sensors: tuple[Sensor, ...] = ()

    def __repr__(self) -> str:
        """One line."""
        pairs = ((one.pair.pinion.teeth, one.pair.gear.teeth) for one in self._specimen.meshes)
        teeth = ", ".join(f"{first}/{second}" for first, second in pairs)
        return (
            f"Gearbox({teeth} teeth, number {self.number}; states: {', '.join(one.name for one in self.states)}; "
            f"channels: {', '.join(self.channels)})"
        )

    @property
    def seed(self) -> int:
        """Where all that is drawn begins."""
        return self._design.seed

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of what its sensors record."""
        return (*self._design.channels, *(one.name for one in self._passed))

    @property
    def readable(self) -> tuple[str, ...]:
        """What sensors of the user's own may read: places, bearings, couplings and gears."""
        return tuple(self._words)

    @property
    def cases(self) -> tuple[Case, ...]:
        """What its set holds of it, in the order of the records; none where it is of no set."""
        repeats = range(self._design.repeats)
        points = range(len(self.points))
        return tuple(Case(state.name, point, k) for state in self.states for point in points for k in repeats)

    @property
    def drivetrain(self) -> GearTrain:
        """What turns in it, as `siggen.open(...).drivetrain` has it of a set."""
        return gear_train(self._specimen)

    @property
    def columns(self) -> tuple[Column, ...]:
        """What the tables of a set say of its records, beside the signals."""
        return label_columns(self._specimen)

    @property
    def labels(self) -> Mapping[str, object]:
        """What the tables of a set say of it as a whole, such as its pair, oil and housing."""
        return gearbox_labels(self._specimen)

    def state(self, name: str) -> State:
        """Return a state by its name.

        Raises
        ------
        UsageError
            If it has none of this name.
        """
        one_of("state", name, tuple(state.name for state in self.states))
        return next(state for state in self.states if state.name == name)

    @property
    def gears(self) -> tuple[str, ...]:
        """Names of its gears, for damages."""
        return tuple(self._seats)

    def with_(self, *more: State | Sensor) -> Gearbox:
        """Return this gearbox with further states and sensors.

        Raises
        ------
        UsageError
            If a state, its damage or a sensor cannot be: names it, what came and what is allowed.
        """
        found = self
        for one in more:
            if isinstance(one, State):
                found = found._with_state(one)
            elif callable(getattr(one, "channels", None)):
                found = replace(found, sensors=(*found.sensors, one))
                again = [name for name in found.channels if found.channels.count(name) > 1]
                if again:
                    raise refused("Channel.name", repr(again[0]), "a name that this gearbox has not yet")
            else:
                raise refused("more", repr(one), "objects of State, or sensors, which have a method channels")
        return found

    def _with_state(self, state: State) -> Gearbox:
        if state.name in {one.name for one in self.states}:
            raise refused("State.name", repr(state.name), "a name that this gearbox has not yet")
        if self._design.lives:
            raise refused("more", repr(state), "no states for a gearbox that lives and fails by its set")
        with saying({"damages": f"State {state.name}: damages"}):
            damage, arguments = entries(state.damages, self._seat)
        entry = {"damage": damage, "acts": not state.sham} if damage else {}
        canonical, key = self._design.canonical(), f"states.{state.name}"
        named = {f"{key}.damage.{place}.": f"State {state.name}: {argument}." for place, argument in arguments.items()}
        named |= {f"{key}.damage": f"damages of {state.name}", f"{key}: received the name": "State.name: received"}
        with saying({**named, key: f"state {state.name}"}):
            design = load_config({**canonical, "states": {**canonical["states"], state.name: entry}})
        made = replace(self, states=(*self.states, state), _design=design, _added=(*self._added, state))
        places = [number for number, one in enumerate(state.damages) if one.is_shape]
        for place, section in zip(places, made._shapes(state), strict=True):
            with saying({"": f"State {state.name}: damages[{place}]."}):
                for problem in section.place_problems(self._seat(section.damage).pair):
                    raise UsageError(str(problem))
        return made

    def _shapes(self, state: State) -> tuple[ShapeFault, ...]:
        own = enumerate(one for one in state.damages if one.is_shape)
        return tuple(ShapeFault(gear=one.on, number=i, damage=one) for i, one in own)

    @cached_property
    def _passed(self) -> tuple[PassedSensor, ...]:
        """The channels of the user's own sensors."""
        return tuple(self._channel(one) for sensor in self.sensors for one in sensor.channels(self))

    def _channel(self, channel: Channel) -> PassedSensor:
        if not isinstance(channel, Channel):
            raise refused("channels", repr(channel), "objects of Channel")
        if not (isinstance(channel.name, str) and re.fullmatch(SENSOR, channel.name)):
            raise refused("Channel.name", repr(channel.name), SENSOR_TEXT)
        finite("Channel.floor", channel.floor, "at least 0", 0.0)
        found: dict[Input, float] = {}
        plates = []
        for reading in channel.reads:
            what, word = self._words[one_of("Reading.of", reading.of, self.readable)]
            directions = () if what in {"coupling", "gear"} else self._directions(word, what, reading.order)
            if directions:
                one_of("Reading.along", reading.along, directions)
            elif reading.order != 0:
                raise refused("Reading.order", repr(reading.order), f"0 of a {what}")
            plates += [word] if word in PLATE_OF else []
            one = reading_input(reading, channel.name, word, what)
            found[one] = found.get(one, 0.0) + finite("Reading.weight", reading.weight, "a number")
        if not found or len(set(plates)) > 1:
            received = f"{len(channel.reads)} readings of {', '.join(one.of for one in channel.reads) or 'nothing'}"
            raise refused("Channel.reads", received, "one reading or more, of at most one place of the housing")
        place = plates[0] if plates else "bearing"
        return PassedSensor(name=channel.name, place=place, channel=channel, inputs=tuple(found.items()))

    def _directions(self, word: str, what: str, order: int) -> tuple[str, ...]:
        """Return the directions in which a place moves, or a bearing presses."""
        places = self._design.places
        if order not in ((0, 2) if what == "bearing" else (2,)):
            raise refused("Reading.order", repr(order), "0 for the force in a bearing, 2 for an acceleration")
        along = word in (places.pressed_along if order == 0 else places.moved_along)
        return (*DIRECTIONS[:2], *(("axial",) if along else ()))

    @property
    def _words(self) -> dict[str, tuple[str, str]]:
        """What can be read -> its kind, and its word in the short form of files."""
        places = self._design.places
        bearings = {f"{called}.bearing": shaft.bearing for called, shaft in self._shafts.items()}
        return {
            **{one: ("place", one) for one in places.motions if one not in (*places.bearings, "casing")},
            **{own: ("bearing", bearing) for own, bearing in bearings.items()},
            **{
                f"{end}.coupling": ("coupling", one)
                for end, one in zip(("input", "output"), places.couplings, strict=False)
            },
            **{one: ("gear", one) for one in places.gears if places.shafts},
        }

    def _with_passed(self, design: SetDesign) -> SetDesign:
        """Return a design of this gearbox with what the user passed in: kinds of damage and sensors."""
        return design.with_passed(
            self._passed, {state.name: (self._shapes(state), state.sham) for state in self._added}
        )

    def _seat(self, damage: Damage) -> DamagedPlace:
        if isinstance(damage, Wear):
            return next(iter(self._seats.values()))
        if isinstance(damage, BearingSpall):
            word = self._bearings[one_of("on", damage.on, tuple(self._bearings))]
            return next(iter(self._seats.values()))._replace(word=word)
        return self._seats[one_of("on", damage.on, tuple(self._seats))]

    @property
    def _seats(self) -> dict[str, DamagedPlace]:
        """Name of every gear -> where it is."""
        specimen, meshes = self._specimen, self._design.names.meshes
        if specimen.planets is not None:
            outer, inner = specimen.planets.pair, specimen.planets.ring
            seats = (("sun", outer, Side.DRIVER), ("planet", outer, Side.DRIVEN), ("ring", inner, Side.DRIVEN))
            return {name: DamagedPlace(one, side, name) for name, one, side in seats}
        return {
            gear.word: DamagedPlace(one.pair, side, gear.word)
            for mesh, one in zip(meshes, specimen.meshes, strict=True)
            for side, gear in zip(Side, mesh.gears, strict=True)
        }

    @property
    def _bearings(self) -> dict[str, str]:
        """Bearing of each of the first two shafts -> its word in a file."""
        if self._specimen.planets is not None:
            return {}
        return {f"{called}.bearing": shaft.bearing for called, shaft in [*self._shafts.items()][:2]}

    @property
    def _shafts(self) -> dict[str, ShaftName]:
        """What the library calls shafts: those of a pair input and output."""
        names = self._design.names
        if self._specimen.planets is not None:
            return {}
        words = [shaft.word for shaft in names.shafts]
        called = words if names.given else ["input", "output", *words[2:]]
        return dict(zip(called, names.shafts, strict=True))

    @cached_property
    def _specimen(self) -> Specimen:
        return self._design.gearbox(self.number)


def draw(design: SetDesign, number: int = 0) -> Gearbox:
    """Return a gearbox of a set: the same that `generate` measures.

    Parameters
    ----------
    design : SetDesign
        What `load_config` returns.
    number : int
        From 0; there is no last one.

    Raises
    ------
    UsageError
        If the number is none.
    """
    expect_design(design)
    if not isinstance(number, int) or isinstance(number, bool) or number < 0:
        raise refused("number", repr(number), "0, 1, 2 and so on")
    states = design.state_names[: design.inspections(number)]
    points = tuple(Point(one.speed_hz, one.torque_nm) for one in design.drawn_points(number))
    return Gearbox(number, tuple(map(State, states)), points, design)
