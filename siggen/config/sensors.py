"""Section `sensors`: where accelerations are measured, and what the instrument does to them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Annotated, Literal

from pydantic import Field, model_validator

from siggen.config.density import LineTable, SensorDensity
from siggen.config.instrument import Inverter, Mains, PinkNoise, Resonance, Tones
from siggen.config.path import PATH, ModalPath, TransferPath
from siggen.errors import Problem
from siggen.keys.number import Number, Within, at
from siggen.keys.problems import received_text, refusal
from siggen.keys.section import Real, Section, Whole
from siggen.keys.wording import AllowedText

POSITION = AllowedText(
    "two numbers, [horizontal, vertical] in mm from the casing's centre of gravity; a distribution is drawn per gearbox"
)
SENSOR_NAME = AllowedText("lower-case letters, digits and _, beginning with a letter, at most 200")


class NoiseFloor(Section):
    """White noise of a given size; a distribution is drawn for every record and axis."""

    floor_m_s2: Annotated[Number, Within(least=0)] = Field(description="standard deviation of the noise")


class Sensor(Section):
    """An accelerometer with up to three axes.

    Horizontal and vertical are meant as in the model: across from pinion to gear without, from gear to pinion with a
    casing; vertical along the pitch-line velocity of the pinion. Tangential is the motion of a gear's base circle.
    Axial is along the shafts, where only a transfer path leads.
    """

    name: Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]{0,199}$"), SENSOR_NAME] = Field(
        description="part of the channel's name"
    )
    place: Literal["pinion_bearing", "gear_bearing", "casing", "pinion_rim", "gear_rim"] = Field(
        default="pinion_bearing",
        description="where it is mounted; casing needs the model casing or a path, rims the model torsional",
    )
    position_mm: Annotated[tuple[Number, ...] | None, Within(words=(None,), many=True), POSITION] = Field(
        default=None,
        description="horizontal and vertical distance from the casing's centre of gravity (place: casing); needed "
        "where the motion of the rigid casing is measured",
    )
    axes: Annotated[tuple[Literal["vertical", "horizontal", "tangential", "axial"], ...], Field(min_length=1)] = Field(
        default=("vertical",), description="directions it measures, one channel each"
    )
    gain: Annotated[Number | tuple[Number, ...], Within(above=0, many=True)] = Field(
        default=1.0,
        description="reading per true acceleration, drawn per specimen and axis; a list: one number per axis",
    )
    noise: Annotated[NoiseFloor | None, AllowedText("null, or a mapping with floor_m_s2")] = Field(
        default=None, description="added before clipping and quantisation"
    )
    range_m_s2: Annotated[Real, Field(gt=0)] = Field(
        default=500.0, description="readings are clipped at plus and minus this"
    )
    bits: Annotated[Whole, Field(ge=4, le=24)] | None = Field(
        default=16, description="of the converter; null: not quantised"
    )
    path: Annotated[Annotated[TransferPath, Field(discriminator="kind")] | None, PATH] = Field(
        default=None,
        description="from the bearing forces to the sensor (place: casing); null: it moves as the model does",
    )
    high_pass_hz: Annotated[Number | None, Within(above=0, words=(None,))] = Field(
        default=None, description="corner of the coupling capacitor (first order); null: none"
    )
    mounting: Resonance | None = Field(default=None, description="of the sensor on its stud or magnet; null: rigid")
    resonance: Resonance | None = Field(default=None, description="of the sensor itself; null: none")
    cross_axis: Annotated[Number, Within(least=0, most=0.2)] = Field(
        default=0.0, description="sensitivity across the axis over that along it, in a direction drawn per gearbox"
    )
    pink_noise: PinkNoise | None = Field(default=None, description="of the electronics; null: none")
    noise_spectrum: SensorDensity | None = Field(
        default=None, description="noise of any density beside the white and the pink one; null: none"
    )
    lines: LineTable | None = Field(
        default=None, description="lines of given orders or frequencies, such as those found in recordings; null: none"
    )
    mains: Mains | None = Field(default=None, description="null: none")
    tones: Tones | None = Field(default=None, description="null: none")
    inverter: Inverter | None = Field(default=None, description="null: none")

    @model_validator(mode="after")
    def _axes_agree(self) -> Sensor:
        problems = []
        if len(set(self.axes)) < len(self.axes):
            problems.append(Problem("axes", ", ".join(self.axes), "allowed: each axis once"))
        if isinstance(self.gain, tuple) and len(self.gain) != len(self.axes):
            received = received_text(self.gain)
            problems.append(
                Problem("gain", received, f"allowed: one number, or a list of {len(self.axes)} (one per axis)")
            )
        problems += self._place_problems()
        if problems:
            raise refusal(problems)
        return self

    def _place_problems(self) -> Iterator[Problem]:
        """Yield what does not go with the place: position, axes, path."""
        on_casing = self.place == "casing"
        if self.position_mm is not None and (isinstance(self.position_mm, float) or len(self.position_mm) != 2):
            yield Problem("position_mm", received_text(self.position_mm), f"allowed: {POSITION.allowed_text}")
            return
        if self.path is not None and not on_casing:
            yield Problem("path", f"kind: {self.path.kind} at place {self.place}", "allowed: null, or place: casing")
        if self.position_mm is None and self.sees_model and on_casing:
            allowed = (
                "allowed: a position [horizontal, vertical] with place: casing, and only there; or a path without "
                "rigid motion"
            )
            yield Problem("position_mm", received_text(None), allowed)
        if self.position_mm is not None and not on_casing:
            allowed = "allowed: a position [horizontal, vertical] with place: casing, and only there"
            yield Problem("position_mm", received_text(self.position_mm), allowed)
        if self.place.endswith("_rim") and self.cross_axis != 0.0:
            yield Problem("cross_axis", str(self.cross_axis), f"allowed: 0 at place {self.place}, which has one axis")
        axes = "tangential" if self.place.endswith("_rim") else "vertical, horizontal"
        if on_casing and self.path is not None:
            axes += ", axial"
        if any(axis not in axes.split(", ") for axis in self.axes):
            with_path = "; axial with a path" if on_casing and self.path is None else ""
            yield Problem("axes", ", ".join(self.axes), f"allowed: {axes} at place {self.place}{with_path}")

    @property
    def sees_model(self) -> bool:
        """Whether it sees the motion of the model itself, alone or beside what a path adds."""
        return self.path is None or (isinstance(self.path, ModalPath) and self.path.rigid)

    @property
    def motion_place(self) -> str:
        """Name of the motion that it measures: its place, with its own name where it stands on the casing."""
        return f"casing_{self.name}" if self.place == "casing" else self.place

    def drawn(self, uniform: Callable[[str], float]) -> Sensor:
        """Return the sensor of one specimen: gains and position are drawn, what belongs to records is left."""
        gains = self.gain if isinstance(self.gain, tuple) else (self.gain,) * len(self.axes)
        drawn = (
            at(gain, uniform(f"sensors.{self.name}.{axis}.gain")) for gain, axis in zip(gains, self.axes, strict=True)
        )
        place = self.position_mm
        if place is not None:
            path = f"sensors.{self.name}.position_mm"
            place = tuple(at(number, uniform(f"{path}.{i}")) for i, number in enumerate(place))
        return self.model_copy(update={"gain": tuple(drawn), "position_mm": place})
