"""Gearbox: one drawn machine with its states and sensors; made by `single_stage` and `draw`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from siggen.config import Config, Pair
from siggen.library.arguments import one_of, refused
from siggen.planning.gearbox import inspection_count
from siggen.planning.specimen import Specimen, draw_operating_point, draw_specimen
from siggen.record.labels import gearbox_labels

__all__ = ["Gearbox", "Point", "State", "draw"]


@dataclass(frozen=True)
class State:
    """A condition of health.

    Attributes
    ----------
    name : str
        Lower-case letters, digits, - and _, beginning with a letter.
    """

    name: str


@dataclass(frozen=True)
class Point:
    """Speed [Hz] and torque [N m] of the first shaft; a torque below 0 drives on the back flanks."""

    speed_hz: float
    torque_nm: float


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
    _config: Config

    def __repr__(self) -> str:
        """One line."""
        pairs = ((one.pinion.teeth, one.gear.teeth) for one in self._pairs)
        teeth = ", ".join(f"{first}/{second}" for first, second in pairs)
        return (
            f"Gearbox({teeth} teeth, number {self.number}; states: {', '.join(one.name for one in self.states)}; "
            f"channels: {', '.join(self.channels)})"
        )

    @property
    def seed(self) -> int:
        """Where all that is drawn begins."""
        return self._config.seed

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of what its sensors record."""
        return self._config.channels

    @property
    def labels(self) -> Mapping[str, object]:
        """What the tables of a set say of it as a whole, such as its pair, oil and housing."""
        return gearbox_labels(self._config, self._specimen)

    def state(self, name: str) -> State:
        """Return a state by its name.

        Raises
        ------
        UsageError
            If it has none of this name.
        """
        one_of("state", name, tuple(state.name for state in self.states))
        return next(state for state in self.states if state.name == name)

    @cached_property
    def _specimen(self) -> Specimen:
        return draw_specimen(self._config, self.number)

    @property
    def _pairs(self) -> tuple[Pair, ...]:
        """The drawn pairs of all meshes, in the order of power."""
        return (self._specimen.gears, *(stage.gears for stage in self._specimen.stages))


def draw(config: Config, number: int = 0) -> Gearbox:
    """Return a gearbox of a set: the same that `generate` measures.

    Parameters
    ----------
    config : Config
        What `load_config` returns.
    number : int
        From 0; there is no last one.

    Raises
    ------
    UsageError
        If the number is none.
    """
    if not isinstance(number, int) or isinstance(number, bool) or number < 0:
        raise refused("number", repr(number), "0, 1, 2 and so on")
    states = config.state_names[: inspection_count(config, number)]
    drawn = (draw_operating_point(config, number, i) for i in range(len(config.operating_points)))
    points = tuple(Point(one.speed_hz, one.torque_nm) for one in drawn)
    return Gearbox(number, tuple(map(State, states)), points, config)
