"""Keys for experts: those that no shipped configuration sets, since its defaults serve every one of them (derived)."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from siggen.config.config import Config
from siggen.config.inheritance import EXTENDS, inherited
from siggen.config.parsing import parse
from siggen.config.presets import presets
from siggen.config.states import StateSection
from siggen.damage.kinds import KINDS
from siggen.keys.distributions import is_written_number
from siggen.keys.section import Section
from siggen.keys.yaml_source import read_yaml

DRAFT = "https://json-schema.org/draft/2020-12/schema"
EXPERT = "x-expert"
"""What the JSON Schema says of such a key, beside its type and description."""


def schema_with_experts() -> dict[str, Any]:
    """Return the JSON Schema of a configuration; a property that is for experts has `x-expert: true`.

    What a section cannot do without is never for experts, though the section may be.
    """
    schema = Config.model_json_schema(mode="validation")
    schema["properties"][EXTENDS] = {
        "type": "string",
        "description": "preset or file whose values hold where this file gives none",
    }
    used = keys_of_presets()
    for name, found in ((Config.__name__, schema), *schema.get("$defs", {}).items()):
        known = used.get(name, set()) | set(found.get("required", ())) | {"kind", EXTENDS}
        for key, described in found.get("properties", {}).items():
            if key not in known:
                described[EXPERT] = True
    return schema


def schema_text() -> str:
    """Return the JSON Schema as editors read it; a file or a damage that takes others over needs no key of its own."""
    schema = schema_with_experts()
    required = [key for key in schema.pop("required") if key != "gears"]
    sections = schema["$defs"]
    kinds = [sections[kind.__name__] for kind in KINDS]
    known = sorted({key for kind in kinds for key in kind["properties"]})
    taken_over = {"type": "object", "not": {"required": ["kind"]}, "propertyNames": {"enum": known}}
    sections[StateSection.__name__]["properties"]["damage"]["anyOf"].append(taken_over)
    either = [{"anyOf": [{"required": [key]} for key in pair]} for pair in (("gears", "machine"), ("states", "life"))]
    needed = {"if": {"required": [EXTENDS]}, "else": {"required": required, "allOf": either}}
    return json.dumps({"$schema": DRAFT, **schema, **needed}, indent=2) + "\n"


def keys_of_presets() -> dict[str, set[str]]:
    """Return section -> keys that any shipped configuration sets in it."""
    used: dict[str, set[str]] = {}
    for path in presets().values():
        raw = inherited(read_yaml(path), path.parent)
        for section, keys in _written(parse(raw).config, raw):
            used.setdefault(section, set()).update(keys)
    return used


def _written(value: object, raw: object) -> Iterator[tuple[str, Iterable[str]]]:
    """Yield name and written keys of a section and of those in it."""
    if isinstance(value, tuple) and isinstance(raw, Mapping) and all(getattr(one, "key_field", "") for one in value):
        raw = [entry for entry in raw.values() if entry is not None]
    if isinstance(value, tuple) and isinstance(raw, list):
        for item, of_item in zip(value, raw, strict=True):
            yield from _written(item, of_item)
    if isinstance(value, Section) and isinstance(raw, Mapping) and not is_written_number(raw):
        yield type(value).__name__, raw
        for key in raw:
            yield from _written(getattr(value, key), raw[key])
