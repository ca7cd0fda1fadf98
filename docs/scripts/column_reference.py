"""Print docs/reference/columns.md: `python docs/scripts/column_reference.py > docs/reference/columns.md`.

Names, types, units and meanings are those that the files of a set carry; which section of the YAML file brings a column
is found by leaving that section out.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import pyarrow as pa

import siggen
from siggen.columns.labels import HOUSING_COLUMNS
from siggen.columns.record import damage_schema, record_schema
from siggen.names import PAIR as PAIR_NAMES
from siggen.record.quantities import quantity_column
from siggen.record.quantity_names import available_quantities
from siggen.sets.drawn import set_columns

CONFIGS = Path(__file__).resolve().parents[2] / "configs"
FULL = CONFIGS / "industrial.yaml"
BARE = ("manufacture=null", "variation={}", "background=null", "sensors.lid.position_mm=[0, 0]", "states.sham=null")
"""Without what the preset has of the sections that are added one by one; with a place that grows with the gears."""
MADE = "manufacture={accuracy_class: 6, helix: iso_1328, crowning_um: 5, flank_waves: on}"
PAIR = "gears.pairs=[{teeth: [18, 47], module_mm: 3, face_width_mm: 20}]"
OILS = "dynamics.friction.oil=[ISO VG 100, ISO VG 220]"
AROUND = (
    "background={rubbing: {bursts: {}}, bearings: {}, machines: {}, shafts: {}, second_stage: {order: 7}, "
    "auxiliary_drive: {order: 20}}"
)
SHAM = "states.sham={acts: false, damage: {kind: spall, face_length_mm: 8, profile_length_mm: 1, depth_mm: 0.3}}"
ADDED = {
    "manufacture": MADE,
    "variation": "variation.speed.random_rms=0.001",
    "gears.pairs": PAIR,
    "dynamics.friction.oil": OILS,
    "background": AROUND,
    "states.NAME.acts": SHAM,
}
"""With these a configuration that has every part with columns of its own."""
PLATES = "`housing.kind: plates`"
SENSOR_PARTS = ("pink_noise", "mains")
HEAD = """# Columns of a set

The files carry these texts as metadata; `make reference` prints them. `CHANNEL` stands for `SENSOR_AXIS`, such as
`lid_vertical`. **A name with \\* is there for the gear too**: `teeth_pinion`, `teeth_gear`. The type is double where
none stands. Sets with numbers from files have `path_number_CHANNEL` and `noise_spectrum_CHANNEL_m_s2` too.

|role|what it is|may a classifier have it|may it tell the state|
|---|---|---|---|
|`key`|names a record, or what it belongs to|no|yes|
|`signal`|what a sensor gave|yes|yes|
|`condition`|known with the signal, such as speed and load|yes|no|
|`measured`|what anybody can compute from the signal|yes|yes|
|`consequence`|follows from the damage; the simulation alone knows it|no|yes|
|`target`|what the damage is: to be predicted|no|yes|
|`provenance`|what was drawn; the simulation alone knows it|no|no|

The manifest lists the roles (`columns`). A column that it does not list is a condition.
"""


def schema(overrides: Iterable[str] = (), without: str = "") -> pa.Schema:
    """Return the columns of the full configuration with overrides, or without one of the added sections."""
    added = [text for section, text in ADDED.items() if section != without]
    return record_schema(set_columns(siggen.load_config(FULL, [*BARE, *added, *overrides])))


def general(name: str, channels: Iterable[str]) -> str:
    """Return a name with the channel left open."""
    for channel in sorted(channels, key=len, reverse=True):
        name = name.replace(channel, "CHANNEL")
    return name


def needs(full: pa.Schema) -> dict[str, str]:
    """Return column -> section that brings it."""
    found: dict[str, str] = {}
    for section in ADDED:
        found |= dict.fromkeys(set(full.names) - set(schema(without=section).names), f"`{section}`")
    for key, off in (("helix", "off"), ("crowning_um", "0"), ("flank_waves", "off")):
        less = schema([f"manufacture.{key}={off}"])
        found |= dict.fromkeys(set(full.names) - set(less.names), f"`manufacture.{key}`")
    sensors = [one.name for one in siggen.load_config(FULL).sensors]
    for part in SENSOR_PARTS:
        keys = [f"sensors.{name}.{part}=null" for name in sensors]
        left = {general(name, channels(full)) for name in schema(keys).names}
        found |= {name: f"`sensors.NAME.{part}`" for name in full.names if general(name, channels(full)) not in left}
    found |= {column.name: PLATES for column in HOUSING_COLUMNS}
    return found | {name: f"{PLATES}, or `sensors.NAME.path`" for name in full.names if name.startswith("path_")}


def channels(full: pa.Schema) -> list[str]:
    """Return the names of the channels of a schema."""
    facts = [field.metadata or {} for field in full]
    return [f"{fact[b'sensor'].decode()}_{fact[b'axis'].decode()}" for fact in facts if b"sensor" in fact]


COLUMN_TABLE = ("|column|unit, type|meaning|", "|---|---|---|")


def rows(fields: Iterable[pa.Field], brought: Mapping[str, str], named: Iterable[str]) -> Iterator[str]:
    """Yield one line for every column, channels together, by the section that brings it and by role."""
    fields, seen = list(fields), set()
    groups: dict[tuple[str, str], list[str]] = {}
    names = {general(field.name, named) for field in fields}
    for field in fields:
        name = general(field.name, named)
        if name in seen or is_twin(name, names):
            continue
        seen.add(name)
        facts = {key.decode(): value.decode() for key, value in (field.metadata or {}).items()}
        meaning = general(facts.get("meaning", "signal of the channel" if "sensor" in facts else ""), named)
        kind = re.sub(r"<element: (\w+)[^>]*>(\[\d+\])?", r" of \1", str(field.type)).replace("fixed_size_list", "list")
        known = ", ".join(part for part in (facts.get("unit", ""), "" if kind == "double" else kind) if part)
        group = groups.setdefault((brought.get(field.name, ""), facts["role"]), [])
        group.append(f"|{marked(name, names)}|{known}|{meaning}|")
    few = [
        f"{line}{needed}|`{role}`|"
        for (needed, role), lines in groups.items()
        if is_few(needed, lines)
        for line in lines
    ]
    for (needed, role), lines in sorted(groups.items(), key=lambda one: bool(one[0][0])):
        if not is_few(needed, lines):
            yield from (f"With {needed}, `{role}`:" if needed else f"`{role}`:", "", *COLUMN_TABLE, *lines, "")
    yield from (
        ("With a key:", "", "|column|unit, type|meaning|with|role|", "|---|---|---|---|---|", *few, "") if few else ()
    )


def is_few(needed: str, lines: Sequence[str]) -> bool:
    """Tell whether a section brings so few columns that they stand in a table with others."""
    return bool(needed) and len(lines) < 3


def is_twin(name: str, names: Iterable[str]) -> bool:
    """Tell whether a name is there for the pinion too, which stands for both."""
    return "gear" in name and name.replace("gear", "pinion") in names


def marked(name: str, names: Iterable[str]) -> str:
    """Return a name; with a mark if it is there for the gear too."""
    return f"`{name}`" + ("\\*" if "pinion" in name and name.replace("pinion", "gear") in names else "")


NOWHERE = "; NaN while the pair does not touch on its drive flank"


def internals() -> Iterator[str]:
    """Yield the internal quantities of a gearbox with casing, tooth pairs and oil friction, a line for each meaning."""
    lines: dict[str, list[str]] = {}
    quantities = available_quantities(siggen.load_config(CONFIGS / "quickstart.yaml").possible)
    names = [re.sub(r"pair_\d+", "pair_k", name) for name in quantities]
    for name, shown in zip(quantities, names, strict=True):
        if is_twin(shown, names):
            continue
        column = quantity_column(name, PAIR_NAMES)
        text = marked(shown, names) + ("†" if NOWHERE in column.meaning else "")
        same = lines.setdefault(f"{column.unit}|{column.meaning.replace(NOWHERE, '')}|", [])
        same += [text] if text not in same else []
    yield from ("|quantity|unit|meaning|", "|---|---|---|")
    yield from (f"|{', '.join(same)}|{text}" for text, same in lines.items())


def page() -> str:
    """Return the page."""
    full = schema()
    brought, named = needs(full), channels(full)
    signals = [field for field in full if pa.types.is_fixed_size_list(field.type) or field.name == "tacho_s"]
    labels = [field for field in full if field not in signals]
    return "\n".join(
        (
            HEAD,
            "## Labels",
            "",
            "In `data/*.parquet` and, without signals, in `labels.parquet`.",
            "",
            *rows(labels, brought, named),
            "## Signals",
            "",
            "In `data/*.parquet` only.",
            "",
            *rows(signals, brought, named),
            "## Damage",
            "",
            "In `damage.parquet`: one row per pit or spall of a record.",
            "",
            *rows(damage_schema(set_columns(siggen.load_config(FULL))), {}, ()),
            "## Internal quantities",
            "",
            "In `internals/*.parquet`, with `internals` in the YAML file; of one record by `siggen show --internals`.",
            "The list is that of `quickstart`. `pair_k` is a pair of teeth in reach of contact.",
            "† NaN while it does not touch on its drive flank.",
            "",
            *internals(),
        )
    )


if __name__ == "__main__":
    print(page())
