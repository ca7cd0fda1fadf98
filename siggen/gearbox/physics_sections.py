"""Sections of a published card: what physics is on and off, and where every number comes from."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, TypeAlias

from siggen.config.changes import Change
from siggen.config.inheritance import REPLACED, REPLACED_OF_DYNAMICS
from siggen.errors import Problem
from siggen.gearbox.description import drive_text, friction_text
from siggen.keys.distributions import DRAWN
from siggen.keys.section import Section

if TYPE_CHECKING:
    from siggen.config import Config
    from siggen.gearbox.design import SetDesign

NOT_NUMBERS = ("name", "seed", "specimens", "kind")
_Row: TypeAlias = tuple[str, str, str, bool]
"""Key, value, meaning and whether it is the default."""


def physics_section(design: SetDesign) -> str:
    """Return a table of what the simulation of this set has and has not."""
    lines = [f"| {what} | {'on' if on else 'off'} | {how} |" for what, on, how in _physics(design.config)]
    return "\n".join(["## Physics that is on and off", "", "| what | | how |", "|---|---|---|", *lines, ""])


def _physics(config: Config) -> Iterator[tuple[str, bool, str]]:
    dynamics, mesh, made = config.dynamics, config.dynamics.mesh, config.manufacture
    paths = [sensor for sensor in config.sensors if sensor.through is not None]
    yield (
        "manufacturing errors of the teeth",
        made is not None,
        f"ISO 1328-1 class {made.classes_text}" if made else "perfect gears",
    )
    yield "tooth pairs one by one", mesh.law == "pairs", f"`dynamics.mesh.law: {mesh.law}`"
    yield "contact across the face, damage as geometry", mesh.law == "pairs", f"`dynamics.mesh.law: {mesh.law}`"
    yield "friction of the flanks", dynamics.rubbing != "off", friction_text(config)
    yield "casing that moves", dynamics.model == "casing", f"`dynamics.model: {dynamics.model}`"
    yield "shafts that bend, gears that tilt", dynamics.shafts is not None, "`dynamics.shafts`"
    yield "unbalance", dynamics.unbalance != type(dynamics.unbalance)(), "`dynamics.unbalance`"
    yield "variation within a record", config.variation != type(config.variation)(), drive_text(config)
    yield "housing that gives way", config.gives_way, "`housing`"
    yield "measured path to the sensors", bool(paths), f"{len(paths)} of {len(config.sensors)} sensors"
    yield "background of a healthy machine", config.background is not None, "`background`"


def assumed_numbers_section(design: SetDesign) -> str:
    """Return every number of the configuration with who chose it; none was fitted to the records.

    A default says nothing about any machine: it is what siggen takes where nobody says otherwise.
    """
    config = design.config
    rows = list(_own(config) if config.machine is not None else _numbers("", config))
    chosen = sum(from_default is False for *_, from_default in rows)
    chosen_by = {True: "default", False: "configuration"}
    lines = [f"| `{path}` | {value} | {chosen_by[default]} | {meaning} |" for path, value, meaning, default in rows]
    head = (
        f"## Where the numbers come from\n\n{chosen} numbers and choices were set in the configuration; "
        f"{len(rows) - chosen} are defaults of siggen. Both are assumptions: no number was fitted to these records. A "
        "range is drawn anew for every gearbox. What the defaults rest on is said in the documentation of siggen "
        "(docs/reference/yaml.md).\n"
    )
    return "\n".join([head, "| key | value | chosen by | meaning |", "|---|---|---|---|", *lines, ""])


def _own(config: Config) -> Iterator[_Row]:
    """Yield the rows of a machine in the words of its file."""
    names = config.names
    for path, value, meaning, default in _numbers("", config):
        parts = path.split(".")
        if parts[0] in REPLACED or (parts[0] == "dynamics" and parts[1] in REPLACED_OF_DYNAMICS[:2]):
            continue
        yield names.problem(Problem(path, "", "")).path, value, meaning, default


def _numbers(path: str, section: Section) -> Iterator[_Row]:
    """Yield path, value, meaning and whether it is the default of every leaf of a section."""
    for name, field in type(section).model_fields.items():
        value = getattr(section, name)
        below = f"{path}.{name}" if path else name
        items = value if isinstance(value, tuple) and value and all(isinstance(item, Section) for item in value) else ()
        if (name in NOT_NUMBERS and not path) or name == section.key_field or field.exclude:
            continue
        if items:
            for place, item in enumerate(items):
                if isinstance(item, Change):
                    yield f"{below}.{item.path}", f"{item.how} {item.value}", str(field.description), False
                else:
                    yield from _numbers(f"{below}.{getattr(item, item.key_field or '', place)}", item)
        elif isinstance(value, Section) and not isinstance(value, DRAWN) and "kind" not in type(value).model_fields:
            yield from _numbers(below, value)
        else:
            default = not field.is_required() and value == field.get_default(call_default_factory=True)
            yield below, _text(value), str(field.description or ""), default


def _text(value: object) -> str:
    if isinstance(value, Section) and not isinstance(value, DRAWN):
        parts = value.model_dump()
        kind = parts.pop("kind", "")
        told = [f"{key} {_text(part)}" for key, part in parts.items() if part is not None]
        return f"{kind} {', '.join(told)}".strip()[:120]
    text = "none" if value is None else f"{value:g}" if isinstance(value, float) else str(value)
    return (text if len(text) <= 120 else f"{text[:117]}...").replace("|", "/").replace("\n", " ")
