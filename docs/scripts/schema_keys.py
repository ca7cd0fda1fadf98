"""The keys of the JSON Schema of a configuration, one by one, for `yaml_reference.py`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

NUMBERS = ("Uniform", "LogUniform", "Normal", "Choice", "Each")


@dataclass(frozen=True)
class Key:
    """One key of the configuration: where it stands, and what the schema says of it."""

    path: str
    schema: Mapping[str, Any]
    required: bool


class Schema:
    """The JSON Schema of a configuration, walked key by key."""

    def __init__(self, content: Mapping[str, Any]) -> None:
        self.content = content

    def resolved(self, schema: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return a schema with its reference replaced by what it refers to."""
        reference = schema.get("$ref")
        if reference is None:
            return schema
        return self.content["$defs"][reference.rsplit("/", 1)[1]]

    def keys(self, schema: Mapping[str, Any], prefix: str = "") -> Iterator[Key]:
        """Yield the keys of an object, each before the keys inside it."""
        for name, value in schema["properties"].items():
            path = f"{prefix}{name}"
            # the kind of a section stands beside its keys; what siggen fills in is no key of users
            if "const" not in value and not value.get("readOnly", False):
                yield Key(path, value, name in schema.get("required", schema.get("else", {}).get("required", ())))
            for ending, section in self.sections(value):
                yield from self.keys(section, f"{path}{ending}.")

    def sections(self, value: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
        """Yield (how a path goes on, section) for the sections that a value may hold; what may be listed too once."""
        found = list(self.options(value))
        for option, ending in found:
            if ending and (option, "") in found:
                continue
            section = self.resolved(option)
            if is_number_part(option) or "properties" not in section:
                continue
            kind = section["properties"].get("kind", {}).get("const")
            label = f" (kind: {kind})" if kind else ""
            yield ending + label, section

    def options(self, value: Mapping[str, Any], ending: str = "") -> Iterator[tuple[Mapping[str, Any], str]]:
        """Yield the alternatives of a value, and how its path goes on to them: as entries of a list, or by name."""
        alternatives = value.get("anyOf") or value.get("oneOf")
        if alternatives is not None:
            for alternative in alternatives:
                yield from self.options(alternative, ending)
        elif value.get("type") == "array" and "items" in value:
            yield from self.options(value["items"], "[]")
        elif isinstance(value.get("additionalProperties"), Mapping):
            yield from self.options(value["additionalProperties"], ".NAME")
        else:
            yield value, ending


def is_number_part(option: Mapping[str, Any]) -> bool:
    """Tell whether an alternative is one of the ranges of a number, or a number for each of several things."""
    return option.get("$ref", "").rsplit("/", 1)[-1] in NUMBERS
