"""README.md of a benchmark: what is asked, by which rules, with which commands."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from diagnostics.bench.question import Words
from diagnostics.scoring.benchmark import LEARN, TESTS

CLOSING, LICENCE = "## Licence, authors, citation\n", "license: "


def benchmark_card(facts: Mapping[str, Any], learn: Any, card: str, words: Words) -> str:
    """Return the card of the whole benchmark; licence, authors and citation are those of the card to learn from."""
    _, closing, said = card.partition(CLOSING)
    licence = next((line for line in card.splitlines() if line.startswith(LICENCE)), "")
    rows = "\n".join(f"| `{TESTS}/{name}` | {facts['records'][name]} |" for name in facts["parts"])
    return f"""{_front_matter(facts, licence, words.train)}# {facts["title"]}, {facts["tier"]}

{words.subject} in simulated vibration records of {learn.duration_s:g} s at {learn.fs_hz:g} Hz. **The data are
synthetic**: they were computed by siggen, simulation version {facts["simulation_version"]}, not measured. Labels of the
test parts are sealed until their maker reveals them.

| part | records |
|---|---|
| `{LEARN}`, with labels | {facts["records"][LEARN]} |
{rows}

## Rules

{words.rules}

## Scores

Digest: `{facts["digest"]}`. It is part of every score; a score of another digest is another benchmark's.

    siggen-diagnostics score . mine.parquet   # its maker; others once `revealed.json` is here
    sha256sum revealed.json                   # is what `commitment.json` says

`commitment.json` holds the SHA-256 of labels, salt, seeds and configurations, published before the first score.
`revealed.json` is that file. `siggen.generate` makes the test parts again from its configurations.
{closing}{said}"""


def _front_matter(facts: Mapping[str, Any], licence: str, train: str) -> str:
    """Return what Hugging Face reads: every part as a configuration of its own."""
    learn = "\n".join(_files(split, f"{LEARN}/data/{split}-*.parquet") for split in ("train", "validation", "test"))
    tests = "\n".join(
        f"- config_name: {name}\n  data_files:\n"
        + _files("test", f"{TESTS}/{name}/data/test-*.parquet")
        + "\n"
        + _files(train, f"{TESTS}/{name}/data/train-*.parquet")
        for name in facts["parts"]
    )
    said = f"{licence}\n" if licence else ""
    return f"""---
pretty_name: {facts["title"]}, {facts["tier"]}
{said}tags: [synthetic, vibration, gearbox, condition-monitoring, benchmark]
configs:
- config_name: {LEARN}
  default: true
  data_files:
{learn}
{tests}
---
"""


def _files(split: str, path: str) -> str:
    return f"  - split: {split}\n    path: {path}"
