"""README.md of a benchmark and of its test parts: what is asked, by which rules, with which commands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from siggen.errors import counted

RULES = """* One number for each record of the split `test`: `damage`, which rises with damage. Columns of other
  tasks may stand beside it.
* **Alone**: a record is judged by itself. **Beside**: the gearbox's record of the split `train`, which is healthy, may
  be used too; the predictions then have a column `reference` that is true. Other records of the part may not be used.
* Learn and choose on `learn` alone. Nothing is learned from test parts."""


def part_card(title: str, name: str, rows: Sequence[Mapping[str, Any]]) -> str:
    """Return the card of a test part."""
    tests = sum(row["split"] == "test" for row in rows)
    told = len(rows) - tests
    return f"""# {title}, test part {name}

{counted(tests, "record")} without labels in the split `test`. The split `train` has one healthy record of each gearbox
({told}), told as a reference. `state` and all that follows from it say `unknown`, or NaN. Numbers of records and
gearboxes were drawn; order and files tell nothing. `config.yaml` is that of the part to learn from: the one that made
these records is secret until labels are revealed.
"""


def benchmark_card(facts: Mapping[str, Any], learn: Any) -> str:
    """Return the card of the whole benchmark."""
    names = list(facts["parts"])
    rows = "\n".join(f"| `test/{name}` | {facts['records'][name]} |" for name in names)
    front = "\n".join(
        f"- config_name: {name}\n  data_files:\n  - split: test\n    path: test/{name}/data/test-*.parquet\n"
        f"  - split: reference\n    path: test/{name}/data/train-*.parquet"
        for name in names
    )
    return f"""---
pretty_name: {facts["title"]}, {facts["tier"]}
tags: [synthetic, vibration, gearbox, condition-monitoring, benchmark]
configs:
- config_name: learn
  default: true
  data_files:
  - split: train
    path: learn/data/train-*.parquet
  - split: validation
    path: learn/data/validation-*.parquet
  - split: test
    path: learn/data/test-*.parquet
{front}
---
# {facts["title"]}, {facts["tier"]}

Damage of gears in simulated vibration records of {learn.duration_s:g} s at {learn.fs_hz:g} Hz. **The data are
synthetic**: they were computed by siggen, simulation version {facts["simulation_version"]}, not measured. Labels of the
test parts are sealed until their maker reveals them.

| part | records |
|---|---|
| `learn`, with labels | {facts["records"]["learn"]} |
{rows}

## Rules

{RULES}

## Scores

Digest: `{facts["digest"]}`. It is part of every score; a score of another digest is another benchmark's.

    siggen-diagnostics score . mine.parquet                       # once `revealed.json` is here
    siggen-diagnostics score . mine.parquet --labels sealed.json  # its maker, before
    sha256sum revealed.json                                       # is what `commitment.json` says

`commitment.json` holds the SHA-256 of labels, salt, seeds and configurations, published before the first score.
`revealed.json` is that file. `siggen.generate` makes the test parts again from its configurations.
"""
