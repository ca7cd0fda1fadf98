"""What a state changes about the healthy gearbox: keys with another number, or with theirs times or plus another one.

The numbers of the gearbox stay drawn as they are: a factor or a shift acts on what was drawn, so that a changed gearbox
is the healthy one but for these keys.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import BeforeValidator, PlainSerializer, ValidationError, WithJsonSchema
from pydantic_core import PydanticCustomError

from siggen.config.machine import drivetrain
from siggen.errors import Problem
from siggen.keys.distributions import DRAWN, Changed
from siggen.keys.distributions import WORDS as WORDS_OF_NUMBERS
from siggen.keys.number import Each, Number, Within, at, each_of
from siggen.keys.problems import (
    joined,
    nearest,
    received_text,
    refusal,
    refused_problems,
    section_problems,
    unknown_keys,
)
from siggen.keys.section import Section
from siggen.keys.wording import AllowedText, keys_of
from siggen.names import Side

SECTIONS = ("dynamics", "housing", "background", "variation", "manufacture", "sensors")
"""Where a state may change keys; what lies elsewhere is what records of all states share, or what names them."""
SHAFTS = "machine.shafts"
"""Where it may change those of a machine."""
WORDS = ("oil",)
"""Keys that hold a word and may be changed; all others hold numbers."""
FIXED = ("position_mm", "span_mm", "integration_tolerance", "steps_per_sample")
"""Numbers that say where a channel is or how it is computed."""
MADE = ("dynamics.rated_torque_nm", "dynamics.rated_speed_hz")
"""How a gearbox was made, and for which load, which no state changes."""
HOW = ("times", "add")
NUMBERS = (float, Each, *DRAWN)
ALLOWED = "a number, a range such as [1, 2] or {log: [1, 2]}, {times: x} or {add: x}"


class Change(Section):
    """One key and what becomes of it."""

    path: str
    how: Literal["to", "times", "add"] = "to"
    value: Any

    @property
    def text(self) -> str:
        """The change in words."""
        sign = {"to": "=", "times": "times", "add": "plus"}[self.how]
        return f"{self.path} {sign} {f'{self.value:g}' if isinstance(self.value, float) else self.value}"

    def drawn(self, uniform: Callable[[str], float], state: str, count: int) -> Change:
        """Return it with its own number drawn, by the name of the state and its key; one for each of `count` things."""
        if not isinstance(self.value, DRAWN):
            return self
        name = f"changes.{state}.{self.path}"
        each = tuple(at(self.value, uniform(f"{name}.{index}")) for index in range(count))
        return self.model_copy(update={"value": Each(each=each) if count else at(self.value, uniform(name))})


def _parsed(value: object) -> object:
    """Return the changes that a mapping stands for, in the order of their keys; anything else as it is."""
    if not isinstance(value, Mapping):
        return value
    found, problems = [], []
    for path, given in sorted(value.items(), key=lambda item: str(item[0])):
        try:
            found.append(_change(str(path), given))
        except PydanticCustomError as error:
            problems += refused_problems(error, str(path))
    if problems:
        raise refusal(problems)
    return tuple(found)


def _change(path: str, given: object) -> Change:
    if isinstance(given, Mapping) and not any(key in WORDS_OF_NUMBERS for key in given):
        if len(given) != 1 or next(iter(given)) not in HOW:
            raise refusal([Problem("", received_text(given), f"allowed: {ALLOWED}")])
        how = next(iter(given))
        return Change(path=path, how=how, value=Within().parse(given[how]))
    if isinstance(given, str):
        return Change(path=path, value=given)
    if given is None or isinstance(given, bool):
        raise refusal([Problem("", received_text(given), f"allowed: {ALLOWED}")])
    return Change(path=path, value=Within().parse(given))


def _written(changes: Sequence[Change]) -> dict[str, Any]:
    plain = ((one, one.value.model_dump() if isinstance(one.value, Section) else one.value) for one in changes)
    return {one.path: value if one.how == "to" else {one.how: value} for one, value in plain}


Changes: TypeAlias = Annotated[
    tuple[Change, ...],
    BeforeValidator(_parsed),
    PlainSerializer(_written),
    WithJsonSchema({"type": "object", "additionalProperties": True}),
    AllowedText(f"a mapping from keys, such as dynamics.friction.oil_temperature_c, to {ALLOWED}"),
]


def changed_sections(sections: Mapping[str, Any], changes: Sequence[Change]) -> dict[str, Any]:
    """Return the sections with these keys changed, by name; those that stay are left out.

    Parameters
    ----------
    sections : mapping
        Valid sections of a configuration; sensors as a tuple or by name.
    changes : sequence of Change

    Raises
    ------
    PydanticCustomError
        With the key's path, where a key is none or may not become that.
    """
    found: dict[str, Any] = {}
    machine = sections.get("machine")
    known = SECTIONS if machine is None else (SHAFTS, *SECTIONS)
    for one in changes:
        name, *below = one.path.split(".")
        if not below or not one.path.startswith(tuple(f"{key}." for key in known)):
            near = nearest(one.path, _paths(sections)) if name not in sections else ""
            allowed = f"allowed: keys below {', '.join(known)}; all else is the same in all states{near}"
            raise _refused(one, allowed)
        if one.path.startswith(MADE):
            raise _refused(one, "allowed: sizes that follow from it, such as those of dynamics.pinion.bearing.geometry")
        if machine is not None and name == "dynamics" and below[0] in tuple(Side):
            raise _refused(one, f"allowed with a machine: keys below {SHAFTS}")
        found[name] = _replaced({**sections, **found}.get(name), below, one)
    if "machine" in found:
        *_, rotors = drivetrain(found["machine"])
        if (dynamics := found.get("dynamics", sections.get("dynamics"))) is not None:
            found["dynamics"] = dynamics.model_copy(update=rotors)
    return found


def _replaced(value: Any, parts: Sequence[str], change: Change) -> Any:
    """Return a section, or a list of them, with the key at a path below it changed."""
    if isinstance(value, (tuple, Mapping)):
        return _in_list(value, parts, change)
    if not isinstance(value, Section) or isinstance(value, NUMBERS):
        above = change.path.removesuffix("." + ".".join(parts))
        held = {type(None): "null", str: "a word"}.get(type(value), "a number, changed as a whole")
        raise _refused(change, f"allowed: keys of sections that the file has; {above} is {held}")
    name, *below = parts
    fields = type(value).model_fields
    if name not in keys_of(type(value)):
        (problem,) = unknown_keys([(change.path.removesuffix(".".join(("", *below))), None)], keys_of(type(value)))
        raise _refused(change, problem.allowed)
    own = getattr(value, name)
    new = _replaced(own, below, change) if below else _leaf(value, name, own, change)
    try:
        return type(value).model_validate({**{key: getattr(value, key) for key in fields}, name: new})
    except ValidationError as error:
        problem = section_problems(type(value), error.errors(include_url=False))[0]
        raise _refused(change, problem.allowed, problem.received) from None


def _in_list(entries: Any, parts: Sequence[str], change: Change) -> Any:
    """Return sensors or shafts of which that of a name is changed."""
    named = dict(entries) if isinstance(entries, Mapping) else {one.name: one for one in entries}
    if parts[0] not in named:
        raise _refused(change, f"allowed: a key of one of {', '.join(named)}{nearest(parts[0], [*named])}")
    if len(parts) == 1:
        keys = ", ".join(keys_of(type(named[parts[0]])))
        raise _refused(change, f"allowed: a key below {change.path}: {keys}")
    named[parts[0]] = _replaced(named[parts[0]], parts[1:], change)
    return named if isinstance(entries, Mapping) else tuple(named.values())


def _leaf(section: Section, name: str, own: Any, change: Change) -> Any:
    """Return what a key becomes."""
    field = type(section).model_fields[name]
    numeric = isinstance(own, float) or any(isinstance(mark, Within) for mark in field.metadata)
    if name in FIXED:
        raise _refused(change, "allowed: other keys; this one is the same in all states")
    if not (numeric or name in WORDS):
        raise _refused(change, "allowed: keys with numbers of the machine or of a sensor, and dynamics.friction.oil")
    if change.how == "to":
        return change.value
    if not isinstance(own, NUMBERS):
        raise _refused(change, f"allowed: a number or a range in its place, since the key is {received_text(own)}")
    for several in (own, change.value):
        if isinstance(several, Each):
            pairs = zip(each_of(own, len(several.each)), each_of(change.value, len(several.each)), strict=True)
            return several.model_copy(update={"each": tuple(_number(*pair, change.how) for pair in pairs)})
    return _number(own, change.value, change.how)


def _number(own: Any, value: Any, how: str) -> Number:
    if isinstance(own, float) and isinstance(value, float):
        return own * value if how == "times" else own + value
    return Changed(own, times=value) if how == "times" else Changed(own, add=value)


def drawn_changes(
    sections: Mapping[str, Any], changes: Sequence[tuple[Change, Callable[[str], float], str]]
) -> list[Change]:
    """Return valid changes, each with its uniforms and the name of its state, as a gearbox has them."""
    return [one.drawn(uniform, state, _count(sections, one.path.split("."))) for one, uniform, state in changes]


def _count(value: Any, parts: Sequence[str]) -> int:
    """Return how many numbers of one law a key holds, such as those of both directions; 0 for a single one."""
    name, *below = parts
    if not below:
        return max((one.count for one in type(value).model_fields[name].metadata if isinstance(one, Within)), default=0)
    listed = {one.name: one for one in value} if isinstance(value, tuple) else value
    return _count(listed[name] if isinstance(listed, Mapping) else getattr(listed, name), below)


def _refused(change: Change, allowed: str, received: str = "") -> PydanticCustomError:
    return refusal([Problem(change.path, received or change.text, allowed)])


def _paths(sections: Mapping[str, Any]) -> list[str]:
    return [joined(name, path) for name in SECTIONS for path in _keys(sections.get(name))]


def _keys(value: Any) -> Iterator[str]:
    if isinstance(value, Section):
        for name in type(value).model_fields:
            yield name
            yield from (f"{name}.{path}" for path in _keys(getattr(value, name)))
