"""What the rest of siggen asks a kind of sensor: the common part of all sections of sensors.

A kind is one module here: its section with the answers below. `kinds.py` names the kind; nothing else knows kinds.
Where it reads what the model does not give yet, the model gives a new kind of `Input`.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Self, get_args

import numpy as np
from pydantic import ConfigDict, Field, model_validator

from siggen.arrays import ComplexArray, FloatArray
from siggen.errors import Problem, counted
from siggen.keys.by_name import without_key_field
from siggen.keys.distributions import DRAWN
from siggen.keys.number import Each, Number, Within, at, bounds
from siggen.keys.problems import BRANCHES, refusal
from siggen.keys.section import Section
from siggen.keys.user_name import SensorName
from siggen.keys.usual import Usual
from siggen.noise.source import Source
from siggen.seeding import Stream, generator
from siggen.sensing.inputs import FORCE, Input
from siggen.sensing.measurement import converter_step
from siggen.sensors.converter import BITS_TEXT, FROM_NOISE, Bits, bits_of_noise
from siggen.sensors.path import MeasuredPath
from siggen.sensors.places import Places
from siggen.sensors.quantity import Quantity
from siggen.sensors.transducer import Transducer

SIZE = "size"
"""What `Grows` says of lengths that follow the gearbox, such as a position on its casing."""


@dataclass(frozen=True, slots=True)
class AxisDraws:
    """Draws the numbers of one axis of one gearbox by their names."""

    uniform: Callable[[str], float]
    path: str
    named: Callable[[str], np.random.Generator]

    def __call__(self, number: Number, name: str) -> float:
        """Return the value of a number of the section."""
        return at(number, self.uniform(f"{self.path}.{name}"))

    def of_sensor(self, number: Number, name: str) -> float:
        """Return the value of a number that all axes of the sensor share."""
        return at(number, self.uniform(f"{self.path.rpartition('.')[0]}.{name}"))

    def generator(self, name: str) -> np.random.Generator:
        """Return the generator of what takes many numbers."""
        return self.named(f"{self.path}.{name}")


class SensorBase(Section):
    """Base of the sections of sensors; its field `kind` is a Literal of one word.

    Numbers of the sensor belong to the gearbox, those of noise to the record. A kind names its range and the sizes of
    its noise with the suffix of its unit.
    """

    quantity: ClassVar[Quantity]
    """What its channels hold."""

    acts: ClassVar[str] = ""
    """A sentence of the card on how it reads the model, where that needs one."""

    plausible: ClassVar[tuple[float, float, str]] = (0.0, float("inf"), "")
    """Range that nobody wonders about, and what to ask beyond it."""

    key_field: ClassVar[str] = "name"
    model_config = ConfigDict(json_schema_extra=lambda schema: without_key_field(schema, "name"))

    kind: str
    name: SensorName = Field(description="part of the channel's name")
    place: str = Field(description="where it is mounted")
    axes: Annotated[tuple[str, ...], Field(min_length=1)] = Field(description="what it measures, one channel each")
    gain: Annotated[Number | Each, Within(above=0, each=True), Usual(0.05, 20)] = Field(
        default=1.0,
        description="reading per true value, drawn per axis; {each: [a, b]}: one per axis",
    )
    bits: Bits = Field(default=16, description=BITS_TEXT)

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        """Make the kind known to the messages, in whose paths it is no key."""
        if words := get_args(cls.model_fields["kind"].annotation):
            BRANCHES.add(str(words[0]))

    @classmethod
    def kind_word(cls) -> str:
        """Return the word of its `kind:`."""
        return str(get_args(cls.model_fields["kind"].annotation)[0])

    @abstractmethod
    def shows(self, axis: str, draw: AxisDraws) -> Mapping[Input, float]:
        """Return what of the model a channel shows, with factors, in its unit; what a path adds comes by itself."""

    @property
    @abstractmethod
    def limit(self) -> float:
        """Its range: readings are clipped at plus and minus this, in its unit."""

    @property
    @abstractmethod
    def limit_key(self) -> str:
        """The key of its range."""

    @property
    def noise_floor(self) -> Number | None:
        """Standard deviation of its white noise in its unit, drawn per record and axis; with `background` per gearbox.

        None: it has none.
        """
        return None

    @property
    def converter_bits(self) -> int | None:
        """Bits of its converter, of all records the same; None: not quantised."""
        if self.bits != FROM_NOISE:
            return self.bits
        return bits_of_noise(self.limit, bounds(self.noise_floor or 0.0)[0])

    @property
    def converter_step(self) -> float:
        """Step of its converter, in its unit; 0: not quantised."""
        return converter_step(self.limit, self.converter_bits)

    @property
    def sources(self) -> tuple[Source, ...]:
        """What is added to its channels beside the white noise; `SourceKeys` has a key for each."""
        return ()

    @property
    def through(self) -> MeasuredPath | None:
        """The measured path from the bearing forces to it."""
        return None

    @property
    def shown_inputs(self) -> frozenset[Input]:
        """What of the model it shows along its axes; what a path adds comes by itself."""
        middle = AxisDraws(lambda _: 0.5, "", lambda _: generator(0, Stream.SENSOR, 0))
        return frozenset(one for axis in self.axes for one in self.shows(axis, middle))

    @property
    def reads(self) -> frozenset[str]:
        """Kinds of `Input` that it needs: those that it shows, and forces where they come through a path."""
        return frozenset({one.kind for one in self.shown_inputs} | (set() if self.through is None else {FORCE}))

    @property
    def drawn_by_name(self) -> bool:
        """Whether a gearbox draws numbers of it by its name, so that two of them differ in more than their noise."""
        return any(_is_drawn(getattr(self, key)) for key in type(self).model_fields)

    @property
    def plate(self) -> str | None:
        """The plate of a housing that it stands on; None for none."""
        return None

    @property
    def place_on_casing_mm(self) -> tuple[Number, ...]:
        """Distances from the casing's centre of gravity or the middle of its plate; nothing unless it needs them."""
        return ()

    @property
    def fitted(self) -> bool:
        """Whether it holds what was fitted to recordings."""
        return any(source.fitted for source in self.sources)

    def response(self, draw: AxisDraws, frequency_hz: FloatArray) -> ComplexArray | None:  # noqa: ARG002
        """Return what the sensor itself does to its quantity at frequencies (k,); None for nothing."""
        return None

    def transducer(self, axis: str, draw: AxisDraws) -> Transducer | None:  # noqa: ARG002
        """Return what makes a channel's reading of a whole record; None where it reads what it shows."""
        return None

    def coupling_hz(self, draw: AxisDraws) -> float | None:  # noqa: ARG002
        """Return the corner of the capacitor that couples it, None without."""
        return None

    def weights(self, axis: str, draw: AxisDraws) -> dict[str, float]:  # noqa: ARG002
        """Return direction -> sensitivity of a channel."""
        return {axis: 1.0}

    def own_problems(self) -> Iterator[Problem]:
        """Yield what cannot be within the section, beside axes and gains."""
        yield from ()

    def model_problems(self, places: Places) -> Iterator[Problem]:
        """Yield what does not go with the model of the gearboxes: a place that it has not."""
        yield from places.problems(self.place, places.motions)

    def duration_problems(self, turns: Mapping[str, float]) -> Iterator[Problem]:  # noqa: ARG002
        """Yield what does not go with how often shafts turn in the slowest record, by shaft."""
        yield from ()

    def beside_problems(self, others: Mapping[str, SensorBase], places: Places) -> Iterator[Problem]:  # noqa: ARG002
        """Yield what does not go with the other sensors of the set, by name."""
        yield from ()

    def channel_name(self, axis: str) -> str:
        """Return the name of the channel of an axis."""
        return f"{self.name}_{axis}"

    @property
    def channels(self) -> tuple[tuple[str, str], ...]:
        """Channel name and axis of each channel."""
        return tuple((self.channel_name(axis), axis) for axis in self.axes)

    @property
    def gains(self) -> tuple[Number, ...]:
        """The gain of each axis."""
        return self.gain.each if isinstance(self.gain, Each) else (self.gain,) * len(self.axes)

    def drawn(self, uniform: Callable[[str], float]) -> Self:
        """Return the sensor of one specimen: gains are drawn, what belongs to records is left."""
        axes = zip(self.gains, self.axes, strict=True)
        drawn = (at(gain, uniform(f"sensors.{self.name}.{axis}.gain")) for gain, axis in axes)
        return self.model_copy(update={"gain": Each(each=tuple(drawn))})

    @model_validator(mode="after")
    def _axes_agree(self) -> Self:
        problems = []
        if len(set(self.axes)) < len(self.axes):
            problems.append(Problem("axes", ", ".join(self.axes), "allowed: each axis once"))
        if isinstance(self.gain, Each) and len(self.gain.each) != len(self.axes):
            received, axes = f"one for each of {len(self.gain.each)}", counted(len(self.axes), "axis", "axes")
            problems.append(Problem("gain", received, f"allowed: one number or range, or one for each of {axes}"))
        if self.bits == FROM_NOISE and not bounds(self.noise_floor or 0.0)[0]:
            allowed = "allowed: a whole number or null without a noise floor, or with one that may be 0"
            problems.append(Problem("bits", FROM_NOISE, allowed))
        problems += self.own_problems()
        if problems:
            raise refusal(problems)
        return self


def _is_drawn(value: object) -> bool:
    if isinstance(value, Section) and not isinstance(value, DRAWN):
        return any(_is_drawn(getattr(value, key)) for key in type(value).model_fields)
    return any(map(_is_drawn, value)) if isinstance(value, tuple) else isinstance(value, DRAWN)
