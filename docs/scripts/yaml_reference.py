"""Print docs/reference/yaml.md: `python docs/scripts/yaml_reference.py > docs/reference/yaml.md`, or `make reference`.

Meaning, range and default come from the JSON Schema that `siggen init` writes.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from schema_keys import Key, Schema, is_number_part

from siggen.config.expert_keys import schema_text
from siggen.keys.catalogue import CATALOGUE
from siggen.keys.distributions import Choice, LogUniform, Normal, Uniform, is_written_number, written_text

SECTION_DEFAULT = "by its keys"
SECTION_KIND = "section (kind: "

HEAD = """# Keys of the YAML file

Begin with [the twenty keys that matter](twenty_keys.md). `make reference` prints this page.

* **x** is a number or a [range](#ranges) such as `[1, 2]`, drawn once per gearbox; **c** is a number alone, **n** a whole one.
* A key without a default is required wherever its section stands.
* The end of a key is its unit: `_mm`, `_um` (µm), `_deg` and `_gpa` for gears, SI for the rest; `n_s_per_m` is N s/m.
* Heights of pits are along the tooth's axis. Heights and profile lengths of spalls are along the flank.
* `a.b` is key `b` in section `a`, `a[].b` in each entry of a list, `a.NAME.b` in each name. On the command line: `--set a.b=VALUE`,
  `--set a.0.b=VALUE`, `--set states.severe.b=VALUE`.
* Keys of one meaning share a line, with slashes where they differ. Lines of `pinion` and `shafts.driver` hold for `gear` and
  `shafts.driven` too.
* **extends** merges mappings key by key, [states](../understand/states.md) and sensors by name, and replaces all else.
"""
RANGES_TEXT = """## Ranges

Every gearbox draws its own value, except where a key says otherwise. `{each: [1.0, [0.9, 1.1]]}` gives one for each of several things,
where a key says so; a place `[x, y]` has two.
"""

CATALOGUES_TEXT = """## Catalogues

A word stands for the numbers of its line. Keys next to it go first: `{model: laboratory, range_m_s2: 2000}`;
`background: {like: laboratory, base: null}`. `all` holds for every word.
"""
EXAMPLES = {
    "splits": "splits: {train: 10, validation: 5, test: 5}",
    "gears": "gears: {module_mm: 2.5, face_width_mm: 20, pinion: {teeth: 23, bore_radius_mm: 12}}",
    "stiffness": "stiffness: {beam: rack_trochoid}",
    "dynamics": "dynamics: {friction: {oil: ISO VG 100}, mesh: {tip_relief_um: [2, 10]}}",
    "operating_points": "operating_points: [{speed_hz: [14, 37], torque_nm: 40}]",
    "states": "states: {worse: {grows: slight, damage: {face_share: 0.9}}}",
    "states.damage": """\
states:
  others: null
  healthy: {}
  rows: {damage: {kind: layered, layers: 1, pits_per_layer: 9, semi_axis_face_mm: 0.3, semi_axis_profile_mm: 0.2, depth_mm: 0.4}}
  pits: {damage: {kind: clustered, count: 12, spread_profile_mm: 0.3, semi_axis_face_mm: 0.3, semi_axis_profile_mm: 0.2, depth_mm: 0.2}}
  block: {damage: {kind: spall, face_length_mm: 12, profile_length_mm: 1.5, depth_mm: 0.4}}
  spall: {damage: {kind: irregular, profile_length_mm: 1, face_share: 0.4}}
  crack: {damage: {kind: crack, depth_share: 0.25}}
  chip: {damage: {kind: chip, height_mm: 1}}
  wear: {damage: {kind: wear, depth_um: 20}}
  bearing: {damage: {kind: bearing_spall, element: outer, length_mm: 2}}""",
    "sensors": """\
sensors:
  others: null
  lid: {place: lid, axes: [vertical], model: laboratory, mount: stud}
  first: {kind: encoder, place: pinion}
  second: {kind: encoder, place: gear}
  error: {kind: transmission_error, driver_encoder: first, driven_encoder: second}
  flange: {kind: coupling_torque, range_nm: 200}
  washer: {kind: bearing_force, range_n: 10000}
  clamp: {kind: motor_current, rated_torque_nm: 60, range_a: 100}""",
    "manufacture": "manufacture: {accuracy_class: {one_of: [5, 6, 7]}, tolerance_share: [0.3, 0.5]}",
    "variation": "variation: {like: laboratory, speed: {start_ratio: 0.8}}",
    "internals": "internals: {quantities: [mesh_force_n]}",
    "housing": "housing: {material: steel, wall_mm: 12}",
    "background": "background: {like: laboratory, second_stage: null}",
}
"""Section, without NAME -> how it is written, on top of quickstart."""
PLACES_OF_WORDS = {
    "variation": "variation",
    "background": "background",
    "model": "sensors.NAME.model",
    "mount": "sensors.NAME.mount",
}


def digits(value: float) -> str:
    """Return a limit or default as one would write it."""
    return str(value) if isinstance(value, int) else f"{value:.6g}"


def limits(schema: Mapping[str, Any], letter: str) -> str:
    """Return the range of a number in signs, or its letter alone."""
    low, high = (
        [(sign, digits(schema[key])) for key, sign in signs.items() if key in schema]
        for signs in ({"exclusiveMinimum": "<", "minimum": "≤"}, {"exclusiveMaximum": "<", "maximum": "≤"})
    )
    if high and "9223372036854775808" not in high[0][1]:
        return f"{low[0][1]}{low[0][0]}{letter}{high[0][0]}{high[0][1]}" if low else letter + "".join(high[0])
    return f"{letter}{low[0][0].replace('<', '>').replace('≤', '≥')}{low[0][1]}" if low else letter


def allowed(schema: Schema, value: Mapping[str, Any]) -> str:
    """Return what a key may hold."""
    if "const" in value:
        return f"`{value['const']}`"
    if "enum" in value:
        return words_of(value["enum"])
    if "$ref" in value:
        found = schema.resolved(value)
        kind = found.get("properties", {}).get("kind", {}).get("const")
        return f"{SECTION_KIND}{kind})" if kind else "section"
    alternatives = value.get("anyOf") or value.get("oneOf")
    if alternatives is not None:
        # what may be listed too is described once
        listed = [part.get("items") for part in alternatives if part.get("type") == "array"]
        text = several(schema, [part for part in alternatives if part.get("items") not in alternatives])
        return f"{text} or a list of them" if any(items in alternatives for items in listed) else text
    if value.get("type") == "array":
        return listing(schema, value)
    words = {"string": "text", "null": "`null`", "boolean": "yes or no"}
    words["object"] = (
        "sections by name" if isinstance(value.get("additionalProperties"), Mapping) else "mapping of keys"
    )
    letter = {"integer": "n", "number": "c"}.get(value["type"])
    return limits(value, letter) if letter else words[value["type"]]


def words_of(words: list[str]) -> str:
    """Return words that a key may hold; what all begin with stands once."""
    begins = {word.rpartition(" ")[0] for word in words}
    if len(begins) == 1 and (begin := begins.pop()):
        return f"`{begin}` {', '.join(word.removeprefix(f'{begin} ') for word in words)}"
    return ", ".join(f"`{word}`" for word in words)


def several(schema: Schema, alternatives: list[Mapping[str, Any]]) -> str:
    """Return the alternatives of a value; plain number and distribution together are a Number."""
    drawn = [part for part in alternatives if any(is_number_part(each) for each in [part, *part.get("oneOf", ())])]
    rest = [part for part in alternatives if part not in drawn]
    found = []
    for part in rest:
        if drawn and part.get("type") == "number":
            found.append(limits(part, "x"))
        else:
            found.append(allowed(schema, part))
    if found.count("section") > 1:  # told apart by the keys that they need
        needed = [schema.resolved(part).get("required", ()) for part in rest if "$ref" in part]
        found = [f"section with {', '.join(f'`{key}`' for key in keys)}" for keys in needed] + found[len(needed) :]
    kinds = [each.removeprefix(SECTION_KIND).rstrip(")") for each in found if each.startswith(SECTION_KIND)]
    if len(kinds) > 1:
        found = ["section of a kind", *(each for each in found if not each.startswith(SECTION_KIND))]
    return " or ".join(dict.fromkeys(found))


def listing(schema: Schema, value: Mapping[str, Any]) -> str:
    """Return what a list may hold."""
    if "prefixItems" in value:
        return f"list of {len(value['prefixItems'])} numbers"
    if value.get("minItems") == value.get("maxItems") is not None:
        return f"list of {value['minItems']}, each {allowed(schema, value['items'])}"
    least = f" ≥{value['minItems']}" if value.get("minItems") else ""
    return f"list{least} of {allowed(schema, value['items'])}"


def default(key: Key) -> str:
    """Return the default of a key; sections have theirs in their own rows."""
    if key.required:
        return ""
    if "default" not in key.schema:
        return ""
    value = key.schema["default"]
    if isinstance(value, dict) and value:
        return f"`{written_text(value)}`" if is_written_number(value) else SECTION_DEFAULT
    if isinstance(value, float):
        return f"`{digits(value)}`"
    return f"`{value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)}`"


def row(*cells: str) -> str:
    """Return a row of a Markdown table."""
    return f"|{'|'.join(cell.replace('|', chr(92) + '|') for cell in cells)}|"


def described(schema: Schema, value: Mapping[str, Any]) -> str:
    """Return what a key means; a section without a description of its own says what it is."""
    text = value.get("description") or schema.resolved(value).get("description", "")
    return " ".join(str(text).split())


TWINS = {"pinion": "gear", "shafts.driver": "shafts.driven"}
"""Section whose keys stand for those of the other one too."""
TAKEN_OVER = {
    "machine.shafts.NAME": ("dynamics.gear",),
    "machine.gears.NAME": ("gears.gear",),
    "machine.meshes.NAME": ("gears",),
}
"""Section with keys of its own -> the sections whose other keys it repeats with the same meaning."""


@dataclass(frozen=True)
class Entry:
    """A key wherever it stands in one list with the same meaning: described once, counted once."""

    keys: tuple[Key, ...]
    start: str

    @property
    def names(self) -> list[str]:
        """The key as it is written in each place, from the list's beginning on."""
        return list(dict.fromkeys(re.sub(BEGINNING.format(self.start), "", key.path) for key in self.keys))

    @property
    def kinds(self) -> list[str]:
        """Kinds of the section that have the key."""
        return list(dict.fromkeys(kind for key in self.keys for kind in re.findall(r"\(kind: (\w+)\)", key.path)[-1:]))

    @property
    def defaults(self) -> list[str]:
        """Defaults in these places."""
        return list(dict.fromkeys(default(key) for key in self.keys))

    def values(self, schema: Schema) -> str:
        """Return what it may hold in these places."""
        found: dict[str, str] = {}
        for key in self.keys:
            text = allowed(schema, key.schema)
            found.setdefault(text.lower(), text)
        return " / ".join(found.values())

    def is_section(self, schema: Schema) -> bool:
        """Whether it is a section, or a list of some: keys that hold values stand in it."""
        return any(True for _ in schema.sections(self.keys[0].schema))

    def is_plain(self, schema: Schema) -> bool:
        """Whether it is a section that holds nothing but its keys."""
        return self.values(schema) == "section" and set(self.defaults) <= {"", SECTION_DEFAULT}


BEGINNING = r"^{}(?:\[\]|\.NAME)?(?: \(kind: \w+\))?(?:\.\w+ \(kind: \w+\))?\."
"""Of the paths of a top-level key: an entry of its list and its kind, and a section with kinds."""


def entries(schema: Schema, keys: list[Key], top: str) -> list[list[Entry]]:
    """Return the lists of one top-level key: its own keys, then those of every section with kinds."""
    found: dict[str, dict[str, list[Key]]] = {}
    for key in keys:
        begins = re.match(BEGINNING.format(top), key.path)
        if begins is not None:
            place = re.sub(r" \(kind: \w+\)|\[\]|\.NAME", "", begins[0])
            found.setdefault(place, {}).setdefault(described(schema, key.schema) or key.path, []).append(key)
    return [[Entry(tuple(same), top) for same in place.values()] for place in found.values()]


def without_repeated(schema: Schema, keys: list[Key]) -> list[Key]:
    """Return the keys without those that sections take over from another one."""
    meanings = {key.path: (described(schema, key.schema), allowed(schema, key.schema)) for key in keys}
    left = []
    for key in keys:
        mixed = next((one for one in TAKEN_OVER if key.path.startswith(f"{one}.")), "")
        others = (meanings.get(of + key.path.removeprefix(mixed)) for of in TAKEN_OVER.get(mixed, ()))
        if meanings[key.path] not in others:
            left.append(key)
    return left


def shown_names(entry: Entry) -> list[str]:
    """Return the names of a key without those that a twin stands for."""
    alike = {name.replace(a, b) for a, b in TWINS.items() for name in entry.names if a in name}
    return [name for name in entry.names if name not in alike]


def listed(schema: Schema, entry: Entry, place: str) -> str:
    """Return the line of a key in the table of a section."""
    first = entry.keys[0]
    values = entry.values(schema)
    defaults = "" if entry.defaults == [""] else " / ".join(each or "required" for each in entry.defaults)
    names = ", ".join(f"`{name.removeprefix(f'{place}.')}`" for name in shown_names(entry))
    if defaults == "`null`":
        values = values.removesuffix(" or `null`")
    if (of := TAKEN_OVER.get(f"{first.path}.NAME")) is not None:
        values += f"; keys as in {' and '.join(f'`{one}`' for one in of)}, and its own"
    return row(names, described(schema, first.schema), values, defaults)


LEAST_ROWS = 3
"""A section with fewer keys has no table of its own: they stand with their whole names in the one around it."""


def by_section(rows: list[Entry]) -> dict[str, list[Entry]]:
    """Return section, empty for the top one -> its keys; those of several sections stand in the top one."""
    held = []
    for entry in rows:
        places = {name.rpartition(".")[0] for name in shown_names(entry)}
        held.append(places.pop() if len(places) == 1 else "")
    while few := [place for place in held if place and held.count(place) < LEAST_ROWS]:
        deepest = max(few, key=lambda place: place.count("."))
        held = [place.rpartition(".")[0] if place == deepest else place for place in held]
    found: dict[str, list[Entry]] = {"": []}
    for entry, place in zip(rows, held, strict=True):
        found.setdefault(place, []).append(entry)
    return found


def listing_of(schema: Schema, rows: list[Entry], heading: str = "") -> Iterator[str]:
    """Yield the lines of a section: keys of the same kinds together, and sections inside it with many keys apart."""
    rows = [entry for entry in rows if not entry.is_plain(schema)]
    kinds = list(dict.fromkeys(tuple(entry.kinds) for entry in rows))
    for group in kinds:
        alike = by_section([entry for entry in rows if tuple(entry.kinds) == group])
        for place, lines in alike.items():
            if not lines:
                continue
            if len(kinds) > 1:
                kind = f"Kind {', '.join(group)}" if group else "All kinds"
                yield from (f"{kind}, in `{place}`:" if place else f"{kind}:", "")
            elif place:
                yield from (f"### {heading}.{place}", "")
            yield from (row("key", "meaning", "values", "default"), row("---", "---", "---", "---"))
            yield from (*(listed(schema, entry, place) for entry in lines), "")


def page() -> str:
    """Return the page."""
    schema = Schema(json.loads(schema_text()))
    keys_everywhere = list(schema.keys(schema.content))
    keys = without_repeated(schema, keys_everywhere)
    tops = [(key, entries(schema, keys, key.path)) for key in keys if key.path in schema.content["properties"]]
    plain = [Entry((key,), "") for key, _ in tops]
    every = [*plain, *(entry for _, tables in tops for rows in tables for entry in rows)]
    count = sum(not entry.is_section(schema) for entry in every)
    places = sum(not Entry((key,), "").is_section(schema) for key in keys_everywhere)
    lines = [HEAD, f"There are {count} keys to learn, in {places} places.", ""]
    alone = [Entry((key,), "") for key, tables in tops if not tables]
    lines += ["## Top level", "", *listing_of(schema, alone)]
    for top, tables in tops:
        text = described(schema, top.schema)
        listed = " Keys of each entry:" if top.schema.get("type") == "array" else ""
        listed = " By name; keys of each:" if "additionalProperties" in top.schema else listed
        need = " Required." if top.required else ""
        for number, rows in enumerate(tables):
            if number == 0:
                lines += [f"## {top.path}", "", f"{text[:1].upper()}{text[1:]}.{need}{listed}", ""]
            else:
                place = rows[0].keys[0].path.rpartition(" (kind")[0]
                place = re.sub(r" \(kind: \w+\)", "", place)
                lines += [f"### {place}", ""]
            place = top.path if number == 0 else place
            lines += [*example_of(place), *listing_of(schema, rows, place)]
    lines += [RANGES_TEXT, *ranges(schema), "", CATALOGUES_TEXT, *catalogues()]
    return "\n".join(lines).rstrip() + "\n"


def example_of(place: str) -> Iterator[str]:
    """Yield how a section is written."""
    example = EXAMPLES.get(place.replace(".NAME", ""))
    if example is not None:
        yield from (*(f"    {line}" for line in example.splitlines()), "")


def ranges(schema: Schema) -> Iterator[str]:
    """Yield the table of ranges."""
    yield row("form", "meaning")
    yield row("---", "---")
    for model in (Uniform, LogUniform, Normal, Choice):
        yield row(f"`{model.form}`", described(schema, schema.content["$defs"][model.__name__]))


def catalogues() -> Iterator[str]:
    """Yield the table of the words of all catalogues."""
    yield row("key", "word", "stands for", "source")
    yield row("---", "---", "---", "---")
    for key, words in CATALOGUE.items():
        held = [entry.keys for entry in words.values()]
        alike = {
            name: value
            for name, value in held[0].items()
            if len(held) > 1 and all(name in one and one[name] == value for one in held)
        }
        yield from ([row(f"`{PLACES_OF_WORDS[key]}`", "all", written_keys(alike), "")] if alike else [])
        for word, entry in words.items():
            own = {name: value for name, value in entry.keys.items() if name not in alike}
            yield row(f"`{PLACES_OF_WORDS[key]}`", f"`{word}`", written_keys(own), entry.source)


def written_keys(keys: Mapping[str, Any]) -> str:
    """Return keys and values as a file writes them."""
    return "; ".join(f"`{name}: {written_text(value)}`" for name, value in keys.items())


if __name__ == "__main__":
    print(page(), end="")
