"""README.md of a set: what it holds, how it was made, what it can teach and what it cannot, and how to load it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pyarrow as pa
import yaml

from siggen.columns.internals import internals_schema
from siggen.columns.record import ChannelColumn, RecordFailure, SetColumns, damage_schema, record_schema
from siggen.columns.versions import SCHEMA_VERSION, SIMULATION_VERSION
from siggen.dataset.inventory import ListedSplit
from siggen.dataset.object_name import DAMAGE, LABELS
from siggen.errors import counted
from siggen.gearbox.description import faults, faults_text, machine_word, making, tolerances_text
from siggen.gearbox.design import SetDesign

TAGS = (
    "synthetic",
    "vibration",
    "gearbox",
    "condition-monitoring",
    "predictive-maintenance",
    "time-series",
)
SIZE_LIMITS = ((1_000, "n<1K"), (10_000, "1K<n<10K"), (100_000, "10K<n<100K"), (1_000_000, "100K<n<1M"))
LARGEST_SIZE = "1M<n<10M"


Splits = Mapping[str, ListedSplit]


def card(
    design: SetDesign,
    splits: Splits,
    failures: Sequence[RecordFailure],
    environment: Mapping[str, str],
    columns: SetColumns,
) -> str:
    """Return the card as Markdown with YAML front matter that Hugging Face reads; the same set gives the same bytes."""
    rows = sum(split.rows for split in splits.values())
    sections = (
        _front_matter(design, tuple(splits), rows, with_internals=bool(columns.quantities)),
        _summary(design, columns.channels, rows),
        _contents(design, splits),
        making(design),
        _limits(design),
        _failures(failures),
        _columns("Columns of `data/`", record_schema(columns)),
        _columns("Columns of `damage.parquet`", damage_schema(columns)),
        _internals(columns),
        _loading(design, columns.channels[0].column, next(iter(splits))),
        _identity(design, environment),
    )
    return "\n".join(section for section in sections if section)


def tags(design: SetDesign) -> tuple[str, ...]:
    """Return the words by which repositories find a set."""
    return (*TAGS, *(f"gear-{fault}" for fault in faults(design)))


def quantities_text(channels: Sequence[ChannelColumn]) -> str:
    """Return what the channels of a set hold."""
    words = list(dict.fromkeys(channel.quantity for channel in channels))
    return " and ".join(part for part in (", ".join(words[:-1]), words[-1]) if part)


def channels_text(channels: Sequence[ChannelColumn]) -> str:
    """Return the channels with their places, by unit."""
    by_unit: dict[str, list[str]] = {}
    for channel in channels:
        by_unit.setdefault(channel.unit, []).append(f"`{channel.name}` ({channel.place}, {channel.axis})")
    return "; ".join(f"{', '.join(named)}, in {unit}" for unit, named in by_unit.items())


def _front_matter(design: SetDesign, splits: Sequence[str], rows: int, *, with_internals: bool) -> str:
    internals = [_view("internals", {split: f"internals/{split}-*.parquet" for split in splits})]
    facts = {
        "pretty_name": f"{design.name}: synthetic gearbox vibration, {faults_text(design)}",
        "tags": list(tags(design)),
        "size_categories": [next((size for limit, size in SIZE_LIMITS if rows < limit), LARGEST_SIZE)],
        "configs": [
            _view("signals", {split: f"data/{split}-*.parquet" for split in splits}, default=True),
            _view("labels", {"records": LABELS}),
            _view("damage", {"records": DAMAGE}),
            *(internals if with_internals else []),
        ],
    }
    return f"---\n{yaml.safe_dump(facts, sort_keys=False, allow_unicode=True)}---\n"


def _view(name: str, paths: dict[str, str], *, default: bool = False) -> dict[str, object]:
    files = [{"split": split, "path": path} for split, path in paths.items()]
    return {"config_name": name, **({"default": True} if default else {}), "data_files": files}


def _summary(design: SetDesign, channels: Sequence[ChannelColumn], rows: int) -> str:
    records = counted(rows, f"labelled {quantities_text(channels)} record")
    return f"""# {design.name}

{records} of a simulated {machine_word(design)}, {design.duration_s:g} s each at {design.fs_hz:g} Hz.
Channels: {channels_text(channels)}. Every record is simulated from its own gearbox, state, speed, load and noise;
none is a copy or a cut of another one. **The data are synthetic**: they were computed, not measured.
"""


def _contents(design: SetDesign, splits: Splits) -> str:
    names = ["inspections"] if design.lives else list(design.state_names)
    lines = ["## Contents", "", f"| split | specimens | records | {' | '.join(names)} | MB |"]
    lines.append("|---" * (len(names) + 4) + "|")
    for name, split in splits.items():
        rows_of = [split.states[state] for state in design.state_names]
        states = [str(count) for count in (rows_of if not design.lives else [_inspections(design, rows_of)])]
        lines.append(f"| {name} | {split.specimens} | {split.rows} | {' | '.join(states)} | {split.bytes / 1e6:.1f} |")
    return "\n".join(
        [
            *lines,
            "",
            "A *specimen* is one gearbox with its own geometry, supports, sensors and damage; its records share them.",
            "Splits never share a specimen, so a score on `test` is a score on gearboxes that were not seen.",
            "",
        ]
    )


def _inspections(design: SetDesign, records: Sequence[int]) -> int:
    """Return how many inspections records are of; each has them at every operating point, repeats included."""
    return sum(records) // (design.points * design.repeats)


def _limits(design: SetDesign) -> str:
    gears = tolerances_text(design)
    return f"""## What it can teach, and what it cannot

{gears}* No casing and no transfer path beyond the model above, no wear of other parts, no temperature.
* A model that is trained here has to be tested on measurements before it is trusted on them.
"""


def _failures(failures: Sequence[RecordFailure]) -> str:
    if not failures:
        return ""
    listed = [f"| {failure.record_id} | {failure.status} | {failure.reason} |" for failure in failures[:50]]
    more = [f"\nThe remaining {len(failures) - 50} are in `manifest.json`."] if len(failures) > 50 else []
    failed = counted(len(failures), "planned record")
    head = f"## Failed records\n\n{failed} could not be simulated and are not among the rows.\n"
    return "\n".join([head, "| record | status | reason |", "|---|---|---|", *listed, *more, ""])


def _internals(columns: SetColumns) -> str:
    """Say which records have internal quantities, and how to join them."""
    if not columns.quantities:
        return ""
    table = _columns("Columns of `internals/`", internals_schema(columns))
    return f"""{table}
What no sensor sees, of every record, at the instants of the samples; join by `record_id`. Accelerations and bearing
forces are low-passed like the signals, everything else is taken at the instant.
"""


def _columns(title: str, schema: pa.Schema) -> str:
    lines = [f"## {title}", "", "| column | type | unit | meaning |", "|---|---|---|---|"]
    for field in schema:
        facts = {key.decode(): value.decode() for key, value in (field.metadata or {}).items()}
        meaning = facts.get("meaning") or "{quantity} at {place}, {axis}, {fs_hz} Hz".format(**facts)
        lines.append(f"| `{field.name}` | {_type_name(field.type)} | {facts.get('unit', '')} | {meaning} |")
    return "\n".join([*lines, ""])


def _type_name(kind: pa.DataType) -> str:
    if isinstance(kind, pa.FixedSizeListType):
        return f"{kind.value_type}[{kind.list_size}]"
    return f"list of {kind.value_type}" if isinstance(kind, pa.ListType) else str(kind)


def _loading(design: SetDesign, column: str, split: str) -> str:
    return f"""## Loading

```python
from pathlib import Path

from datasets import load_dataset

here = str(Path(".").resolve())                         # datasets wants a folder with a name, which "." has not
records = load_dataset(here, split="{split}").with_format("numpy")     # labels alone: load_dataset(here, "labels")

import numpy as np, pandas as pd
frame = pd.read_parquet("data/{split}-00000.parquet", columns=["record_id", "state", "{column}"])
signals = np.stack(frame["{column}"])                   # (rows, samples)

import polars as pl
labels = pl.read_parquet("labels.parquet").filter(pl.col("split") == "{split}")
frame = pl.scan_parquet("data/{split}-*.parquet").filter(pl.col("state") == "{design.state_names[-1]}").collect()

import pyarrow.dataset as ds
for batch in ds.dataset("data", format="parquet").to_batches(columns=["{column}"], batch_size=32):
    signals = batch["{column}"].flatten().to_numpy().reshape(len(batch), -1)

import duckdb
duckdb.sql("SELECT state, count(*) FROM 'data/{split}-*.parquet' GROUP BY state")

import siggen
dataset = siggen.open(".")
values, states, gearboxes = dataset["{split}"].arrays(dataset.channels[0].name)   # for a fit
record = dataset.record(0)                              # labels and signals of one record
```

Signals are `FixedSizeList<float32>`: every reader above keeps or restores their length. Rows of `data/` and of
`labels.parquet` are in the same order and share `record_id`; splits follow each other.
"""


def _identity(design: SetDesign, environment: Mapping[str, str]) -> str:
    made_with = f"siggen {environment['siggen']}, numpy {environment['numpy']}"
    specimens = counted(design.specimens, "specimen")
    return f"""## Identity

* Configuration: `config.yaml`; identity (SHA-256 of the configuration without the number of specimens):
  `{design.identity}`
* Seed {design.seed}, {specimens}; made with {made_with}.
* Schema version {SCHEMA_VERSION}, simulation version {SIMULATION_VERSION}.
* Every random number follows from seed, stage and owner, so `siggen generate config.yaml --out NEW` makes the same set
  again: bit for bit on the same CPU family and versions (`manifest.json`), elsewhere within a step of the converter.
* `siggen verify .` checks every file against `manifest.json` and simulates a sample of records again.
"""
