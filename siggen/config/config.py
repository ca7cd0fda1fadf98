"""The whole configuration, its canonical form and its identity."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from functools import cached_property
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, field_serializer, model_validator

from siggen.config.background import Background
from siggen.config.changes import Change
from siggen.config.consistency import places_of
from siggen.config.dynamics import Dynamics
from siggen.config.gears import GearsSection
from siggen.config.housing import Housing, PlateHousing, RigidHousing
from siggen.config.internals import Internals
from siggen.config.life import Life
from siggen.config.machine import MachineSection, Stage, names_in, stages_of, without_inner
from siggen.config.manufacture import Manufacture
from siggen.config.planetary import Planetary
from siggen.config.states import StateSection, changes_of, grown_from
from siggen.config.stiffness import Stiffness
from siggen.config.variation import Variation
from siggen.damage.fault import Fault
from siggen.errors import Problem
from siggen.keys.by_name import ByName, written_by_name
from siggen.keys.merging import in_keys
from siggen.keys.number import Number, Within, bounds
from siggen.keys.problems import refusal
from siggen.keys.section import Real, Section, Whole
from siggen.keys.user_name import SetName
from siggen.keys.usual import Usual
from siggen.keys.wording import AllowedText
from siggen.life.pitting import EXAMPLE
from siggen.names import Names
from siggen.sensors.places import Places
from siggen.sensors.registry import SensorSection

BLOCK = 20
"""Specimens per block in which the splits are met exactly."""
MOST_SPECIMENS = 10_000_000
MOST_REPEATS = 1_000_000


SHARES = "of every 20 gearboxes or pairs: to fit, to choose, to judge"


class Splits(Section):
    """How many of every 20 specimens belong to each split."""

    train: Annotated[Whole, Field(ge=0)] = Field(default=12, description=SHARES)
    validation: Annotated[Whole, Field(ge=0)] = Field(default=4, description=SHARES)
    test: Annotated[Whole, Field(ge=0)] = Field(default=4, description=SHARES)
    by: Literal["gearbox", "pair"] = Field(
        default="gearbox",
        description="what splits never share; pair: test holds gears never seen",
    )

    @model_validator(mode="after")
    def _add_up(self) -> Splits:
        counts = (self.train, self.validation, self.test)
        if sum(counts) != BLOCK:
            received = f"{' + '.join(map(str, counts))} = {sum(counts)}"
            raise refusal([Problem("", received, f"allowed: train, validation and test that add up to {BLOCK}")])
        return self


class OperatingRange(Section):
    """Speed and torque of one operating point, drawn per specimen."""

    speed_hz: Annotated[Number, Within(above=0, most=1e5)] = Field(description="rotation of the input shaft")
    torque_nm: Annotated[Number, Within(least=-1e8, most=1e8)] = Field(
        description="on the input shaft; 0: idle, below 0: the load drives, on the back flanks"
    )


def rated_nm(dynamics: Dynamics, points: Sequence[OperatingRange]) -> float:
    """Return the torque of the motor's slip [N m]: as rated, or the largest of all; 1 without any, and then no slip."""
    return dynamics.rated_torque_nm or max(abs(one) for point in points for one in bounds(point.torque_nm)) or 1.0


VARIATION = AllowedText("a word of the catalogue, laboratory or plant, or a mapping with like, speed and torque")
BACKGROUND = AllowedText(
    "a word of the catalogue, laboratory, or a mapping with like and parts of the background; null"
)
STATES = ByName("{healthy: {}, slight: {damage: {kind: irregular, ...}}}")
SENSORS = ByName("{lid: {place: lid}, side: {place: gear_end}}")
OPERATING_POINTS = AllowedText("a list of at least one mapping with speed_hz and torque_nm")


class Config(Section):
    """Everything a data set follows from."""

    name: SetName = Field(description="name of the set")
    seed: Annotated[Whole, Field(ge=0, lt=2**128)] = Field(description="where all randomness begins")
    specimens: Annotated[Whole, Field(ge=1, le=MOST_SPECIMENS)] = Field(
        description="number of gearboxes; not part of the identity"
    )
    fs_hz: Annotated[Real, Field(gt=0, le=1e7), Usual(200, 5e5)] = Field(default=51_200.0, description="sampling rate")
    duration_s: Annotated[Real, Field(gt=0, le=86_400), Usual(0.02, 600)] = Field(
        default=1.0, description="length of a record"
    )
    mesh_harmonics: Annotated[Whole, Field(ge=1)] = Field(
        default=5, description="mesh harmonic that the sampling rate must carry at the highest speed"
    )
    repeats: Annotated[Whole, Field(ge=1, le=MOST_REPEATS)] = Field(
        default=1, description="records per state and operating point"
    )
    splits: Splits = Field(default=Splits(), description="split of every 20 specimens")
    gears: GearsSection = Field(description="the gear pair; needed without `machine`")
    machine: MachineSection | None = Field(
        default=None, description="shafts, gears and meshes with names of your own, in place of `gears`"
    )
    planetary: Planetary | None = Field(
        default=None, description="null: a pair on two shafts; given: `gears` are sun and planets in a ring"
    )
    stiffness: Stiffness = Field(default=Stiffness(), description="model of the mesh stiffness")
    dynamics: Dynamics = Field(default=Dynamics(), description="model of the gearbox")
    operating_points: Annotated[tuple[OperatingRange, ...], Field(min_length=1), OPERATING_POINTS] = Field(
        description="speeds and torques; ranges are drawn for each entry"
    )
    states: Annotated[tuple[StateSection, ...], Field(min_length=1), STATES] = Field(
        default=(), description="conditions of health, in their order"
    )
    life: Life | None = Field(
        default=None, description="given: gearboxes run until teeth fail, and `states` has no entry"
    )
    sensors: Annotated[tuple[SensorSection, ...], Field(min_length=1), SENSORS] = Field(
        description="what measures, an accelerometer unless `kind` says otherwise; levels of noise are drawn per "
        "record and axis, with `background` per gearbox"
    )
    manufacture: Manufacture | None = Field(default=None, description="errors of the teeth; null: perfect gears")
    variation: Annotated[Variation, BeforeValidator(in_keys, json_schema_input_type=Variation | str), VARIATION] = (
        Field(default=Variation(), description="how speed and torque vary within a record, or a word of the catalogue")
    )
    internals: Internals | None = Field(default=None, description="what no sensor sees; null: not stored")
    housing: Housing = Field(
        default=PlateHousing(),
        description="what carries the bearings with dynamics.model: casing; plates, modal or rigid",
    )
    background: Annotated[
        Background | None, BeforeValidator(in_keys, json_schema_input_type=Background | str | None), BACKGROUND
    ] = Field(default=None, description="what a healthy machine adds, or a word of the catalogue")

    @field_serializer("states", "sensors")
    def _by_name(self, sections: tuple[Section, ...]) -> dict[str, Any]:
        return written_by_name(sections)

    @property
    def samples(self) -> int:
        """Number of samples of a record's channel."""
        return round(self.fs_hz * self.duration_s)

    @property
    def gives_way(self) -> bool:
        """Whether forces of the bearings reach sensors through modes of a housing."""
        return self.dynamics.model == "casing" and not isinstance(self.housing, RigidHousing)

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the channels, `<sensor>_<axis>`, in the order of the file."""
        return tuple(name for sensor in self.sensors for name, _ in sensor.channels)

    @property
    def state_count(self) -> int:
        """Number of states; with `life` the most inspections of a gearbox."""
        return len(self.states) if self.life is None else self.life.most

    @property
    def state_names(self) -> tuple[str, ...]:
        """Names of the states, of all inspections that a gearbox may have."""
        if self.life is None:
            return tuple(state.name for state in self.states)
        return tuple(map(self.life.name_of, range(self.life.most)))

    @property
    def damages(self) -> tuple[Fault, ...]:
        """Sections of damage of all states; with `life` an example of what its inspections show."""
        if self.life is not None:
            return (EXAMPLE,)
        return tuple(section for state in self.states for section in state.damages)

    @property
    def records_per_specimen(self) -> int:
        """Records of one specimen: all states at all operating points, repeats included; with `life` the most."""
        return self.state_count * len(self.operating_points) * self.repeats

    @property
    def stages(self) -> tuple[Stage, ...]:
        """Meshes of the machine behind the first one, in the order of power."""
        return stages_of(self.machine)

    @property
    def names(self) -> Names:
        """What its gears, shafts and meshes are called."""
        return names_in(self.machine, planetary=self.planetary is not None)

    def grown_from(self, state_id: int) -> int | None:
        """Return the index of the state whose damage a state contains, or None."""
        return grown_from(self.states, state_id)

    def changes_of(self, state_id: int) -> tuple[tuple[int, Change], ...]:
        """Return the keys that a state changes, those of its milder states too, each with the state that says so."""
        return () if self.life is not None else changes_of(self.states, state_id)

    @property
    def places(self) -> Places:
        """Where sensors may stand, and what presses on the housing."""
        found = places_of(dict(self))
        assert found is not None, "only sections that are wrong have none"
        return found

    def canonical(self) -> dict[str, Any]:
        """Return the configuration with all defaults, as plain mappings and lists; parsing it gives an equal one."""
        found = {name: _plain(value) for name, value in self.model_dump(mode="json").items()}
        if not self.states:  # which no file may give beside a section life
            del found["states"]
        if self.machine is not None:
            return without_inner(found)
        del found["machine"]
        return found

    @cached_property
    def identity(self) -> str:
        """SHA-256 (hexadecimal) of what differs from the defaults, without `specimens`: what records follow from."""
        content = _identity_content(self)
        del content["specimens"]
        text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()


def _identity_content(value: Any) -> Any:
    """Return a value as plain mappings and lists without the keys that are at their defaults.

    `kind` counts at its default too, unless the section means the same without it.
    """
    match value:
        case Section():
            found: dict[str, Any] = {}
            named = "" if value.understood_kind else "kind"
            for name, field in type(value).model_fields.items():
                item, default = getattr(value, name), field.get_default(call_default_factory=True)
                content = _identity_content(item)
                counts = item != default and (bool(content) or not isinstance(default, Section))
                found |= {name: content} if counts or name == named else {}
            return found
        case tuple():
            return [_identity_content(item) for item in value]
    return _plain(value)


def _plain(value: Any) -> Any:
    """Return a value in which -0.0 is 0.0, so that equal configurations read the same."""
    match value:
        case float():
            return value + 0.0
        case dict():
            return {key: _plain(item) for key, item in value.items()}
        case list():
            return [_plain(item) for item in value]
    return value
