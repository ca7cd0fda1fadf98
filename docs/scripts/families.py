"""The measured table of docs/understand/families.md: `python docs/scripts/families.py [GEARBOXES] [WORKERS]`.

Makes two sets in runs/ where they are missing, has `siggen-diagnostics audit` attack both, trains classifiers on the
first and tests them on the second, and prints Markdown. 24 gearboxes take some 10 minutes of CPU time.

* `families_one`: the preset families with three of its states and without `gears.pairs`: all have the pair of bench;
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
STATES = ("healthy", "face_80", "through")
WAYS = ("logistic regression on four indicators", "strongest detector alone")
Entry = dict[str, Any]


def raw(gearboxes: int, *, many: bool) -> dict[str, Any]:
    """Return the preset with three states, with or without its pairs."""
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
    """Return the Markdown rows of what detectors find in either set."""
    rows = ["| set | gearboxes | records | damage | four indicators | strongest detector | by |", "|---" * 7 + "|"]
    for name, found in audits.items():
        weak = {entry["state"]: entry for entry in found["detectability"][WAYS[0]]["states"]}
        for entry in found["strongest"][WAYS[1]]["states"]:
            by = entry["chosen"].partition(":")[0].partition(" (")[0]
            cells = (value(weak[entry["state"]]["auc"]), value(entry["auc"]), by)
            rows.append(
                f"| {name} | {found['specimens']} | {found['records']} | {entry['state']} | {' | '.join(cells)} |"
            )
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
        chance = (audits[name]["chance"] or {}).get("auc", float("nan"))
        print(f"{name}: {len(failures)} records could not be simulated; chance stays below {chance:.2f} in 95 %")
    print(*table(audits), "", *transfer(one, many), sep="\n")


if __name__ == "__main__":
    given = [int(number) for number in sys.argv[1:]]
    main(given[0] if given else 24, given[1] if len(given) > 1 else 2)
