"""The measured table of docs/understand/families.md: `python docs/scripts/families.py [GEARBOXES] [WORKERS]`.

Makes two sets in runs/ where they are missing, has `siggen-diagnostics audit` attack both, trains classifiers on the
first and tests them on the second, and prints Markdown. 24 gearboxes take some 8 minutes of CPU time.

* `families_one`: the preset families with some of its states and without `gears.pairs`: all have the pair of bench;
* `families_many`: the same with its pairs, each gearbox another one.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from chosen_states import chosen_states
from report_pages import run

import siggen
from siggen.config.inheritance import inherited
from siggen.keys.yaml_source import read_yaml

RUNS, CONFIGS = Path("runs"), Path("configs")
STATES = ("healthy", "healthy_again", "face_80", "through", "sham")
WAYS = (
    "logistic regression on four indicators",
    "strongest detector alone",
    "strongest detector with a healthy reference",
)
Entry = dict[str, Any]


def raw(gearboxes: int, *, many: bool) -> dict[str, Any]:
    """Return the preset with some of its states, with or without its pairs."""
    found = inherited(read_yaml(CONFIGS / "families.yaml"), CONFIGS)
    states = chosen_states(found["states"], STATES)
    found |= {"name": "families_small", "specimens": gearboxes, "states": states}
    if many:
        return found
    gears = {key: value for key, value in found["gears"].items() if key != "pairs"}
    return {**found, "name": "families_one", "gears": gears, "splits": {**found["splits"], "by": "gearbox"}}


def made(folder: str, content: dict[str, Any], workers: int) -> Path:
    """Return the folder of a set that is made where it is missing."""
    path = RUNS / folder
    if not (path / "manifest.json").exists():
        print(f"making {path}", file=sys.stderr)
        siggen.generate(siggen.load_config(content), path, workers=workers)
    return path


def audited(path: Path) -> Entry:
    """Return what `audit` found on a set."""
    out = Path(f"{path}_audit")
    if not (out / "audit.json").exists():
        run(f"siggen-diagnostics audit {path} --out {out}")
    found: Entry = json.loads((out / "audit.json").read_text(encoding="utf-8"))
    return found


def value(entry: Entry) -> str:
    """Return a number with its interval."""
    return f"{entry['value']:.2f} ({entry['low']:.2f} to {entry['high']:.2f})"


def table(audits: dict[str, Entry]) -> list[str]:
    """Return the Markdown rows of what detectors find in either set; of the sham the largest AUC of all."""
    sides = ("four indicators", "strongest, without reference", "strongest, with reference")
    rows = [f"| set | damage | {' | '.join(sides)} |", "|---" * 5 + "|"]
    for name, found in audits.items():
        detection = {**found["detectability"], **found["strongest"]}
        by_way = [{entry["state"]: entry["auc"] for entry in detection[way]["states"]} for way in WAYS]
        for state in by_way[0]:
            rows.append(f"| {name} | {state} | {' | '.join(value(way[state]) for way in by_way)} |")
        shams = [f"{value(one['auc'])}, chance {one['chance']['auc']:.2f}" for one in found["shams"]]
        rows.append(f"| {name} | sham | - | {' | '.join(shams)} |")
    return rows


def transfer(one: Path, many: Path) -> list[str]:
    """Return the Markdown rows of classifiers trained on one pair, on gearboxes of that pair and of others."""
    out = RUNS / "families_transfer"
    if not (out / "metrics.json").exists():
        run(f"siggen-diagnostics report {one} --test {many} --no-cnn --out {out}")
    training = json.loads((out / "metrics.json").read_text(encoding="utf-8"))["training"]
    rows = ["| classifier | same pair, unseen gearboxes | other pairs |", "|---" * 3 + "|"]
    for name, here in training["classifiers"].items():
        there = training["classifiers_on_other_set"][name]
        rows.append(f"| {here['title']} | {value(here['macro_auroc'])} | {value(there['macro_auroc'])} |")
    return rows


def main(gearboxes: int, workers: int) -> None:
    """Make sets, audits and tables."""
    RUNS.mkdir(exist_ok=True)
    one, many = (made(f"families_{name}", raw(gearboxes, many=name == "many"), workers) for name in ("one", "many"))
    audits = {"one pair": audited(one), "a pair for each gearbox": audited(many)}
    for name, path in zip(audits, (one, many), strict=True):
        failures = siggen.open(path).manifest.get("failures", [])
        found = audits[name]
        print(
            f"{name}: {found['specimens']} gearboxes, {found['records']} records; {len(failures)} could not be "
            f"simulated; leaks: {len(found['findings'])}; chance stays below {found['chance']['auc']:.2f} in 95 %"
        )
    print(*table(audits), "", *transfer(one, many), sep="\n")


if __name__ == "__main__":
    given = [int(number) for number in sys.argv[1:]]
    main(given[0] if given else 24, given[1] if len(given) > 1 else 2)
