"""Accelerometers: where accelerations are measured, and what the instrument does to them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from math import cos, pi, sin
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from siggen.arrays import ComplexArray, FloatArray
from siggen.errors import Problem
from siggen.keys.catalogue import CatalogueWord, with_entries
from siggen.keys.number import Number, Within, at
from siggen.keys.problems import received_text
from siggen.keys.scaling import Grows
from siggen.keys.section import Real, Section
from siggen.keys.usual import Usual
from siggen.keys.wording import AllowedText
from siggen.noise.registry import SourceKeys
from siggen.sensing.inputs import MOTION, Input
from siggen.sensing.responses import high_pass_response, resonance_response
from siggen.sensors.path import DIRECTIONS, PATH, MeasuredPath
from siggen.sensors.places import IN_MOTION, MODAL, PLACE_TEXT, PLATE_OF, Places
from siggen.sensors.quantity import ACCELERATION, Quantity
from siggen.sensors.sensor import SIZE, AxisDraws, SensorBase


class Resonance(Section):
    """A second-order low-pass with a peak: a mass on a spring."""

    frequency_hz: Annotated[Number, Within(above=0), Usual(300, 100000)] = Field(description="natural frequency")
    damping_ratio: Annotated[Number, Within(above=0, most=1), Usual(0.002, 1)] = Field(
        default=0.05, description="the peak is 1 / (2 damping_ratio) high"
    )


class NoiseFloor(Section):
    """White noise of a given size; a distribution is drawn for every record and axis."""

    floor_m_s2: Annotated[Number, Within(least=0), Usual(0.0001, 0.5)] = Field(
        description="standard deviation of the white noise"
    )


class Accelerometer(SourceKeys, SensorBase):
    """An accelerometer with up to three axes.

    Horizontal and vertical are meant as in the model: across from pinion to gear without, from gear to pinion with a
    casing; vertical along the pitch-line velocity of the pinion. Tangential is the motion of a gear's base circle.
    Axial is along the shafts.
    """

    quantity: ClassVar[Quantity] = ACCELERATION
    plausible: ClassVar[tuple[float, float, str]] = (1.0, 2e4, "is it in m/s², not g?")
    understood_kind: ClassVar[bool] = True

    kind: Literal["accelerometer"] = Field(default="accelerometer", description="acceleration of a place")
    place: Annotated[str, IN_MOTION] = Field(
        default="pinion_bearing",
        description=PLACE_TEXT,
    )
    position_mm: Annotated[tuple[Number, ...] | None, Within(words=(None,), size=2), Grows(SIZE)] = Field(
        default=None,
        description="from the centre of gravity of a casing or the middle of a wall: horizontal, vertical; "
        "lid: horizontal, axial; ends: vertical, axial; null: up to 15 mm, drawn",
    )
    axes: Annotated[tuple[Literal["vertical", "horizontal", "axial"], ...], Field(min_length=1)] = Field(
        default=("vertical",), description="what it measures, one channel each"
    )
    model: Annotated[str | None, CatalogueWord("model")] = Field(
        default=None, description="word of the catalogue; keys next to it go first", exclude=True
    )
    mount: Annotated[str | None, CatalogueWord("mount")] = Field(
        default=None, description="how it is fixed, by the catalogue: its `mounting`", exclude=True
    )
    noise: Annotated[NoiseFloor | None, AllowedText("null, or a mapping with floor_m_s2")] = Field(
        default=None, description="added before clipping and quantisation"
    )
    range_m_s2: Annotated[Real, Field(gt=0)] = Field(
        default=500.0, description="readings are clipped at plus and minus this"
    )
    path: Annotated[MeasuredPath | None, PATH] = Field(
        default=None, description="measured from the bearing forces to the sensor (place: casing)"
    )
    high_pass_hz: Annotated[Number | None, Within(above=0, words=(None,)), Usual(0.01, 50)] = Field(
        default=None, description="corner of the coupling capacitor (first order); null: none"
    )
    mounting: Resonance | None = Field(default=None, description="of the sensor on its stud or magnet; null: rigid")
    resonance: Resonance | None = Field(default=None, description="of the sensor itself; null: none")
    cross_axis: Annotated[Number, Within(least=0, most=0.2), Usual(0.002, 0.2)] = Field(
        default=0.0, description="sensitivity across over along the axis, in a direction drawn per gearbox"
    )

    @model_validator(mode="before")
    @classmethod
    def _with_entries(cls, value: Any) -> Any:
        return with_entries(value, model="model", mount="mount")

    @property
    def drawn_by_name(self) -> bool:
        """Its numbers, the direction of its cross axis, or its place on a plate."""
        placed = self.plate not in {None, "floor"} and self.position_mm is None
        return placed or self.cross_axis != 0.0 or super().drawn_by_name

    def own_problems(self) -> Iterator[Problem]:
        """Yield what does not go with the place: position, axes, path."""
        has_position = self.place == "casing" or self.plate not in {None, "floor"}
        if self.path is not None and self.place != "casing":
            yield Problem("path", f"a path at place {self.place}", "allowed: null, or place: casing")
        if self.position_mm is not None and not has_position:
            yield Problem("position_mm", received_text(self.position_mm), f"allowed: null at place {self.place}")

    def model_problems(self, places: Places) -> Iterator[Problem]:
        """Yield what does not go with the model: its place, or what its path leaves out or has in it."""
        if self.path is None:
            yield from super().model_problems(places)
            if "axial" in self.axes and self.place not in places.moved_along:
                allowed = (
                    "allowed: vertical, horizontal; axial needs housing.kind: plates or modal, a path, or helical "
                    "teeth with dynamics.model: 8dof"
                )
                yield Problem("axes", ", ".join(self.axes), allowed)
            yield from self._position_problems(places.model)
            return
        if not places.bearings:
            yield Problem(
                "path",
                "a measured path",
                "allowed: null in a planetary set, whose forces are those of sun, carrier and ring",
            )
        if self.cross_axis != 0.0:
            allowed = "allowed: 0; a measured response has the cross-axis sensitivity in it"
            yield Problem("cross_axis", str(self.cross_axis), allowed)

    def _position_problems(self, model: str) -> Iterator[Problem]:
        """Yield a position that a rigid casing needs, or that given modes know already."""
        if model == MODAL and self.position_mm is not None:
            allowed = f"allowed: null; housing.modes says how the place {self.name} moves"
            yield Problem("position_mm", received_text(self.position_mm), allowed)
        if model != MODAL and self.place == "casing" and self.path is None and self.position_mm is None:
            allowed = "allowed: a position [horizontal, vertical] from the centre of gravity; or a measured path"
            yield Problem("position_mm", received_text(None), allowed)

    @property
    def plate(self) -> str | None:
        """The plate of a housing that it stands on."""
        return PLATE_OF.get(self.place)

    @property
    def motion_place(self) -> str:
        """Name of the motion that it measures: its place, with its own name where it stands on the casing."""
        return f"casing_{self.name}" if self.place == "casing" or self.plate else self.place

    @property
    def limit(self) -> float:
        """Its range [m/s²]."""
        return self.range_m_s2

    @property
    def limit_key(self) -> str:
        """The key of its range."""
        return "range_m_s2"

    @property
    def noise_floor(self) -> Number | None:
        """Standard deviation of its white noise [m/s²]."""
        return None if self.noise is None else self.noise.floor_m_s2

    @property
    def through(self) -> MeasuredPath | None:
        """The measured path from the bearing forces to it."""
        return self.path

    @property
    def place_on_casing_mm(self) -> tuple[Number, ...]:
        """Its position."""
        return self.position_mm or ()

    @property
    def fitted(self) -> bool:
        """Whether lines or paths are those of recordings."""
        return super().fitted or (self.path is not None and self.path.is_family)

    def drawn(self, uniform: Callable[[str], float]) -> Self:
        """Return the sensor of one specimen: gains and position are drawn, what belongs to records is left."""
        place = self.position_mm
        if place is not None:
            path = f"sensors.{self.name}.position_mm"
            place = tuple(at(number, uniform(f"{path}.{i}")) for i, number in enumerate(place))
        return super().drawn(uniform).model_copy(update={"position_mm": place})

    def shows(self, axis: str, draw: AxisDraws) -> Mapping[Input, float]:
        """Return the motions that a channel sees; several with cross-axis sensitivity, none behind a measured path."""
        seen = {} if self.path is not None else self.weights(axis, draw)
        return {Input(MOTION, f"{self.motion_place}/{direction}"): weight for direction, weight in seen.items()}

    def weights(self, axis: str, draw: AxisDraws) -> dict[str, float]:
        """Return direction -> sensitivity: 1 along the axis, and what leaks in from across it at a drawn angle."""
        leak = draw(self.cross_axis, "cross_axis")
        if leak == 0.0:
            return {axis: 1.0}
        first, second = (direction for direction in DIRECTIONS if direction != axis)
        angle = 2.0 * pi * draw.uniform(f"{draw.path}.cross_axis.angle")
        return {axis: 1.0, first: leak * cos(angle), second: leak * sin(angle)}

    def response(self, draw: AxisDraws, frequency_hz: FloatArray) -> ComplexArray | None:
        """Return what mounting, sensor and coupling do at frequencies (k,)."""
        parts = [
            resonance_response(
                frequency_hz,
                draw(section.frequency_hz, f"{name}.frequency_hz"),
                draw(section.damping_ratio, f"{name}.damping_ratio"),
            )
            for name, section in (("mounting", self.mounting), ("resonance", self.resonance))
            if section is not None
        ]
        corner_hz = self.coupling_hz(draw)
        parts += [] if corner_hz is None else [high_pass_response(frequency_hz, corner_hz)]
        return np.prod(parts, axis=0) if parts else None

    def coupling_hz(self, draw: AxisDraws) -> float | None:
        """Return the corner of its coupling capacitor."""
        return None if self.high_pass_hz is None else draw(self.high_pass_hz, "high_pass_hz")
