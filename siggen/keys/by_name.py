"""Sections that a file gives by name, such as states and sensors; they are a tuple in its order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from siggen.errors import Problem
from siggen.keys.distributions import written_text
from siggen.keys.problems import joined, received_text, refusal
from siggen.keys.section import Section

BY_NAME = ("states", "sensors")
NO_NAME = "allowed: no key name here, since the name stands before the entry"
SHOWN = 4
"""Names of a list that its refusal shows in the new form."""


class ByName:
    """Marker of a field that a file gives as a mapping by name, for messages and editors."""

    def __init__(self, example: str) -> None:
        self.allowed_text = f"a mapping by name, such as {example}; null removes what another file gives"

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return the mapping."""
        entry = handler.resolve_ref_schema(handler(schema))["items"]
        return {"type": "object", "additionalProperties": {"anyOf": [entry, {"type": "null"}]}}


class NamedParts(ByName):
    """Marker of such a field inside a section, which reads and writes it; places in problems are those of a list."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Read a mapping by name."""
        written = core_schema.plain_serializer_function_ser_schema(written_by_name)
        return core_schema.no_info_before_validator_function(self._listed, handler(source), serialization=written)

    def _listed(self, value: object) -> object:
        if isinstance(value, tuple):
            return value
        if not isinstance(value, Mapping):
            raise refusal([refused_list("", value, self.allowed_text)])
        entries = {str(key): entry for key, entry in value.items() if entry is not None}
        problems = [
            Problem(joined(key, "name"), received_text(entry["name"]), NO_NAME)
            for key, entry in entries.items()
            if isinstance(entry, Mapping) and "name" in entry
        ]
        if problems:
            raise refusal(problems)
        return [{"name": key, **entry} if isinstance(entry, Mapping) else entry for key, entry in entries.items()]


def without_key_field(schema: dict[str, Any], field: str) -> None:
    """Keep the field that is the key out of the JSON Schema of a section."""
    schema["properties"].pop(field, None)
    schema["required"] = [key for key in schema.get("required", ()) if key != field]


def written_by_name(sections: Sequence[Section]) -> dict[str, Any]:
    """Return sections as a file gives them."""
    written = {}
    for section in sections:
        plain = section.model_dump(mode="json")
        written[plain.pop(section.key_field)] = plain
    return written


def named_entries(name: str, raw: object) -> dict[str, object]:
    """Return the entries of a section by name, without those that are null; nothing where it is no mapping."""
    given = raw.get(name) if isinstance(raw, Mapping) else None
    return {str(key): entry for key, entry in given.items() if entry is not None} if isinstance(given, Mapping) else {}


def refused_list(name: str, value: object, allowed: str) -> Problem:
    """Return the problem of what is no mapping by name; of a list with names, how to write it."""
    entries = [one for one in value if isinstance(one, Mapping)] if isinstance(value, (list, tuple)) else []
    if not entries or not all("name" in one for one in entries):
        return Problem(name, received_text(value), f"allowed: {allowed}")
    shown = {str(one["name"]): written_text({k: v for k, v in one.items() if k != "name"}) for one in entries[:SHOWN]}
    more = ", ..." if len(entries) > SHOWN else ""
    written = ", ".join(f"{key}: {entry}" for key, entry in shown.items())
    return Problem(name, received_text(value), f"write {f'{name}: ' if name else ''}{{{written}{more}}}")
