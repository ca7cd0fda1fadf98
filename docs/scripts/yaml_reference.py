"""Print docs/reference/yaml.md: `python docs/scripts/yaml_reference.py > docs/reference/yaml.md`, or `make reference`.

Meaning, range and default come from `siggen schema`; the shipped configurations say which of them set a key, and the
remarks beside their values which source a value has.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import yaml
from typer.testing import CliRunner

from siggen.cli.app import app

CONFIGS = Path(__file__).resolve().parents[2] / "configs"
NULL = {"type": "null"}
DISTRIBUTIONS = ("Uniform", "LogUniform", "Normal", "Choice")
UNITS = {
    "n_per_um_mm": "N/(µm mm)", "n_per_um": "N/µm", "n_s_per_m": "N s/m", "nm_s_per_rad": "N m s/rad",
    "n_per_m": "N/m", "nm_per_rad": "N m/rad",
    "m_s2_per_sqrt_hz": "m/s²/√Hz", "n_per_sqrt_hz": "N/√Hz", "per_sqrt_hz": "1/√Hz",
    "um_per_mm2": "µm/mm²", "kg_m2": "kg m²", "m_s2": "m/s²", "mm_s": "mm/s",
    "m_s": "m/s", "pa_s": "Pa s", "mm": "mm", "um": "µm", "deg": "°", "gpa": "GPa", "hz": "Hz", "us": "µs", "s": "s",
    "kg": "kg", "nm": "N m", "rad": "rad", "db": "dB", "n": "N", "c": "°C",
}  # fmt: skip
"""Unit by the ending of a key, longer endings first."""
SOURCE = re.compile(r"paper [AB]|assumed|published|ISO \d|derived", re.IGNORECASE)

HEAD = """# Keys of the YAML file

This page is printed by `python docs/scripts/yaml_reference.py` from `siggen schema` and the files in `configs/`.

* **Number** in the column "allowed" is a physical number. It may be a constant, or a distribution that siggen draws once
  per gearbox ([below](#distributions)).
* **extends** names a preset or another file. Its values hold wherever this file gives none. Mappings are merged key by
  key; numbers, lists, null, and distributions are replaced. The set's own `config.yaml` holds the result.
* **required**: the key has no default. Where its section is optional, it is required only in that section.
* **expert**: no shipped configuration sets the key. Its default serves, unless you know why it should not.
* Units are part of the key names: mm, µm, degrees and GPa for gears, SI for the rest.
* `a.b` is key `b` in section `a`; `a[].b` is key `b` of every entry of the list `a`. On the command line a value is
  replaced by `--set a.b=VALUE`, or `--set a.0.b=VALUE` for the first entry.
"""
DISTRIBUTION_TEXT = """## Distributions

Any Number may be written as one of these mappings. Every gearbox draws its own value, except where a key says
otherwise.
"""


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
            if "const" not in value:  # the kind of a section stands in its heading
                yield Key(path, value, name in schema.get("required", ()))
            for ending, section in self.sections(value):
                yield from self.keys(section, f"{path}{ending}.")

    def sections(self, value: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
        """Yield (how a path goes on, section) for the sections that a value may hold."""
        for option, listed in self.options(value):
            section = self.resolved(option)
            if is_number_part(option) or "properties" not in section:
                continue
            kind = section["properties"].get("kind", {}).get("const")
            label = f" (kind: {kind})" if kind else ""
            yield ("[]" if listed else "") + label, section

    def options(self, value: Mapping[str, Any], listed: bool = False) -> Iterator[tuple[Mapping[str, Any], bool]]:
        """Yield the alternatives of a value, and whether they are entries of a list."""
        alternatives = value.get("anyOf") or value.get("oneOf")
        if alternatives is not None:
            for alternative in alternatives:
                yield from self.options(alternative, listed)
        elif value.get("type") == "array" and "items" in value:
            yield from self.options(value["items"], True)
        else:
            yield value, listed


def is_number_part(option: Mapping[str, Any]) -> bool:
    """Tell whether an alternative is one of the distributions."""
    return option.get("$ref", "").rsplit("/", 1)[-1] in DISTRIBUTIONS


def digits(value: float) -> str:
    """Return a limit or default as one would write it."""
    return str(value) if isinstance(value, int) else f"{value:.6g}"


def limits(schema: Mapping[str, Any]) -> str:
    """Return the range of a number in signs, or nothing."""
    signs = {"exclusiveMinimum": ">", "minimum": "≥", "exclusiveMaximum": "<", "maximum": "≤"}
    parts = [f"{sign} {digits(schema[key])}" for key, sign in signs.items() if key in schema]
    return ", ".join(part for part in parts if "9223372036854775808" not in part)


def allowed(schema: Schema, value: Mapping[str, Any]) -> str:
    """Return what a key may hold."""
    if "const" in value:
        return f"`{value['const']}`"
    if "enum" in value:
        return ", ".join(f"`{word}`" for word in value["enum"])
    if "$ref" in value:
        found = schema.resolved(value)
        kind = found.get("properties", {}).get("kind", {}).get("const")
        return f"section (kind: {kind})" if kind else "section"
    alternatives = value.get("anyOf") or value.get("oneOf")
    if alternatives is not None:
        return several(schema, alternatives)
    if value.get("type") == "array":
        return listing(schema, value)
    words = {"integer": "whole number", "number": "number", "string": "text", "null": "`null`", "boolean": "yes or no"}
    return f"{words[value['type']]} {limits(value)}".strip()


def several(schema: Schema, alternatives: list[Mapping[str, Any]]) -> str:
    """Return the alternatives of a value; plain number and distribution together are a Number."""
    drawn = [part for part in alternatives if any(is_number_part(each) for each in [part, *part.get("oneOf", ())])]
    rest = [part for part in alternatives if part not in drawn]
    found = []
    for part in rest:
        if drawn and part.get("type") == "number":
            found.append(f"Number {limits(part)}".strip())
        else:
            found.append(allowed(schema, part))
    if found.count("section") > 1:  # told apart by the keys that they need
        needed = [schema.resolved(part).get("required", ()) for part in rest if "$ref" in part]
        found = [f"section with {', '.join(f'`{key}`' for key in keys)}" for keys in needed] + found[len(needed) :]
    return " or ".join(dict.fromkeys(found))


def listing(schema: Schema, value: Mapping[str, Any]) -> str:
    """Return what a list may hold."""
    if "prefixItems" in value:
        return f"list of {len(value['prefixItems'])} numbers"
    least = f" (at least {value['minItems']})" if value.get("minItems") else ""
    return f"list{least} of: {allowed(schema, value['items'])}"


def default(key: Key) -> str:
    """Return the default of a key; sections have theirs in their own rows."""
    if key.required:
        return "required"
    if "default" not in key.schema:
        return "see meaning"
    value = key.schema["default"]
    if isinstance(value, dict):
        return f"`{mapping(value)}`" if "kind" in value else "by its keys"
    if value is None:
        return "`null`"
    if isinstance(value, float):
        return f"`{digits(value)}`"
    return f"`{value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)}`"


def mapping(value: Mapping[str, Any]) -> str:
    """Return a distribution as one would write it."""
    return (
        f"{{{', '.join(f'{key}: {digits(each) if isinstance(each, float) else each}' for key, each in value.items())}}}"
    )


def unit(path: str) -> str:
    """Return the unit that the ending of a key names."""
    name = path.rsplit(".", 1)[-1]
    return next((text for ending, text in UNITS.items() if name.endswith(f"_{ending}")), "")


@dataclass(frozen=True)
class Shipped:
    """One shipped configuration: the keys it sets, and the sources that remarks beside them name."""

    path: Path

    @cached_property
    def lines(self) -> list[str]:
        """The file, line by line."""
        return self.path.read_text(encoding="utf-8").splitlines()

    def set_keys(self, schema: Schema) -> dict[str, str]:
        """Return key -> remark of its line, where that names a source, else nothing."""
        root = yaml.compose(self.path.read_text(encoding="utf-8"), Loader=yaml.SafeLoader)
        return dict(self._walk(schema, schema.content, root, ""))

    def _walk(self, schema: Schema, section: Mapping[str, Any], node: Any, prefix: str) -> Iterator[tuple[str, str]]:
        for name_node, value_node in pairs(node):
            value = section.get("properties", {}).get(name_node.value)
            if value is None:
                continue
            path = f"{prefix}{name_node.value}"
            yield path, self._remark(name_node.value, value_node)
            entries = value_node.value if isinstance(value_node, yaml.SequenceNode) else [value_node]
            for ending, inner in schema.sections(value):
                kind = inner["properties"].get("kind", {}).get("const")
                for entry in entries:
                    if isinstance(entry, yaml.MappingNode) and kind in (None, kind_of(entry)):
                        yield from self._walk(schema, inner, entry, f"{path}{ending}.")

    def _remark(self, name: str, value: Any) -> str:
        if not isinstance(value, yaml.ScalarNode):
            return ""
        text = self.lines[value.end_mark.line].partition(" #")[2].strip()
        if not SOURCE.search(text):
            return ""
        # "teeth: paper A, section 4.2; bore assumed" beside several keys of one line: each takes its own part
        parts = [part for part in re.split(r"; |, (?=\w+ assumed)", text) if name.split("_", maxsplit=1)[0] in part]
        return (parts[0] if len(parts) == 1 and text.count(";") else text).removeprefix(f"{name}: ")


def pairs(node: Any) -> Iterator[tuple[Any, Any]]:
    """Yield the keys and values of a mapping, those of merged mappings included."""
    if not isinstance(node, yaml.MappingNode):
        return
    for name, value in node.value:
        if name.tag == "tag:yaml.org,2002:merge":
            for merged in value.value if isinstance(value, yaml.SequenceNode) else [value]:
                yield from pairs(merged)
        else:
            yield name, value


def kind_of(node: Any) -> str | None:
    """Return the value of the key `kind`; an own one goes before a merged one."""
    found = [value.value for name, value in pairs(node) if name.value == "kind"]
    return found[-1] if found else None


def row(*cells: str) -> str:
    """Return a row of a Markdown table."""
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"


def described(schema: Schema, value: Mapping[str, Any]) -> str:
    """Return what a key means; a section without a description of its own says what it is."""
    text = value.get("description") or schema.resolved(value).get("description", "")
    return " ".join(str(text).split())


def table(schema: Schema, keys: list[Key], users: Mapping[str, list[str]], start: str = "") -> Iterator[str]:
    """Yield a table of keys whose paths begin alike."""
    yield row("key", "meaning", "unit", "allowed", "default", "use")
    yield row(*["---"] * 6)
    for key in keys:
        shown = key.path.removeprefix(start)
        # What a section cannot do without is never for experts, as in `siggen schema`.
        marks = "" if users[key.path] or key.path == "extends" or default(key) == "required" else "expert"
        cells = (described(schema, key.schema), unit(key.path), allowed(schema, key.schema), default(key))
        yield row(f"`{shown}`", *cells, marks)


def sources(keys: list[Key], remarks: Mapping[str, list[str]]) -> Iterator[str]:
    """Yield the sources that shipped configurations name for values of these keys."""
    named = [(key.path, remarks[key.path]) for key in keys if remarks[key.path]]
    if named:
        yield ""
        yield "Sources named in shipped configurations:"
        yield ""
        yield from (f"* `{path}`: {'; '.join(dict.fromkeys(said))}" for path, said in named)


def groups(keys: list[Key], top: str) -> Iterator[tuple[str, str, list[Key]]]:
    """Yield (heading, common beginning, keys) of one top-level key: its own keys, then those of every kind in it."""
    found: dict[str, list[Key]] = {}
    for key in keys:
        begins = re.match(rf"{top}(?:.*\(kind: \w+\)|\[\])?\.", key.path)
        if begins is not None:
            found.setdefault(begins[0], []).append(key)
    for start, inside in found.items():
        name = start.removesuffix(".")
        mapping_too = len(found) > 1 and name == top and f"{top}[]." in found
        heading = f"### {top} as one mapping" if mapping_too else f"### {name}" if "(kind" in name else ""
        yield heading, start, inside


def page() -> str:
    """Return the page."""
    schema = Schema(json.loads(CliRunner().invoke(app, ["schema"], catch_exceptions=False).output))
    keys = list(schema.keys(schema.content))
    users: dict[str, list[str]] = {key.path: [] for key in keys}
    remarks: dict[str, list[str]] = {key.path: [] for key in keys}
    for path in sorted(CONFIGS.glob("*.yaml")):
        for key, remark in Shipped(path).set_keys(schema).items():
            if key in users:
                users[key].append(path.stem)
                remarks[key] += [f"{path.stem}.yaml: {remark}"] if remark else []
    expert = sum(not found for found in users.values())
    lines = [HEAD, f"There are {len(users)} keys, {expert} of them expert.", ""]
    tops = [(key, list(groups(keys, key.path))) for key in keys if key.path in schema.content["properties"]]
    plain = [key for key, inside in tops if not inside]
    lines += ["## Top level", "", *table(schema, plain, users), *sources(plain, remarks), ""]
    for top, inside in tops:
        if not inside:
            continue
        text = described(schema, top.schema)
        listed = " A list; these are the keys of an entry." if top.schema.get("type") == "array" else ""
        need = "Required." if top.required else "Optional."
        lines += [f"## {top.path}", "", f"{text[:1].upper()}{text[1:]}. {need}{listed}", ""]
        for heading, start, group in inside:
            lines += [heading, ""] if heading else []
            lines += [*table(schema, group, users, start), *sources(group, remarks), ""]
    lines += [DISTRIBUTION_TEXT, *distributions(schema)]
    return "\n".join(lines).rstrip() + "\n"


def distributions(schema: Schema) -> Iterator[str]:
    """Yield the table of distributions."""
    yield row("mapping", "meaning")
    yield row("---", "---")
    for name in DISTRIBUTIONS:
        found = schema.content["$defs"][name]
        names = ", ".join(
            f"{key}: {value['const']}" if "const" in value else f"{key}: ..."
            for key, value in found["properties"].items()
        )
        yield row(f"`{{{names}}}`", described(schema, found))


if __name__ == "__main__":
    print(page(), end="")
