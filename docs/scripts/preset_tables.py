"""The tables of docs/understand/presets.md on bench: `python docs/scripts/preset_tables.py`, after report and audit.

Reads runs/bench_report/metrics.json and runs/bench_audit/audit.json, which `make reports` writes.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from diagnostics.audit.audit import CHANGE, PAIRED, UNPAIRED
from diagnostics.audit.envelope import quantities

RUNS = Path("runs")
DAMAGES = {
    "slight": "small pits",
    **{f"face_{share}": f"{share} % of the face" for share in (20, 40, 80, 95)},
    **{f"through_{size:03d}": f"whole face, {size / 100:g} mm" for size in (40, 50, 60, 70, 80, 90, 100, 125, 150)},
}
Numbers = dict[str, Any]


def limits(found: Numbers) -> str:
    """Return a value with its interval."""
    return f"{found['value']:.2f} ({found['low']:.2f} to {found['high']:.2f})"


def shares(found: Numbers) -> str:
    """Return a share with its interval, in percent."""
    return f"{100 * found['value']:.0f} % ({100 * found['low']:.0f} to {100 * found['high']:.0f})"


def row(*cells: str) -> str:
    """Return a row of a Markdown table."""
    return f"| {' | '.join(cells)} |"


def detectability(audit: Numbers) -> list[str]:
    """Return AUC by damage, one column per way to look."""
    named = {name: audit["detectability"][name] for name in (UNPAIRED, PAIRED, CHANGE)}
    ways = [{entry["state"]: entry["auc"] for entry in way["states"]} for way in named.values()]
    lengths = [f"{name}: {json.dumps(way['profile_length_mm_at_auc'])}" for name, way in named.items()]
    return [
        *(row(text, *(limits(way[state]) for way in ways)) for state, text in DAMAGES.items() if state in ways[0]),
        *lengths,
    ]


def realism(audit: Numbers) -> list[str]:
    """Return how healthy channel-records lie in the ranges of measured gearboxes."""
    titles = {quantity.name: quantity.title for quantity in quantities()}
    found = audit["realism"]["quantities"]
    return [
        *(
            row(
                titles[entry["name"]],
                ", ".join(f"{entry[key]:.3g}" for key in ("q05", "q50", "q95")),
                f"{entry['inside']:.0%}",
            )
            for entry in found
        ),
        f"{sum(entry['inside'] >= 0.8 for entry in found)} of {len(found)} at 80 % or more, least "
        f"{min(entry['inside'] for entry in found):.0%}, {audit['realism']['healthy_channel_records']} channel-records",
    ]


def detection(training: Numbers) -> list[str]:
    """Return AUC of damaged or not by classifier; the network on the other set last."""
    own = [judged["detection"] for judged in training["classifiers"].values()]
    found = [*own, training["classifiers_on_other_set"]["network"]["detection"]]
    titles = [judged["title"] for judged in training["classifiers"].values()]
    return [
        row("healthy against", *titles, "other gears: network"),
        row("all damages", *(limits(each["auroc"]) for each in found)),
        *(row(text, *(limits(each["auroc_by_state"][state]) for each in found)) for state, text in DAMAGES.items()),
    ]


def classifiers(training: Numbers) -> list[str]:
    """Return scores of the classifiers, on the set and on the other one, and their paired differences."""
    rows = []
    for name, judged in training["classifiers"].items():
        other = training["classifiers_on_other_set"][name]
        rows.append(
            row(
                judged["title"],
                *(shares(judged[key]) for key in ("accuracy", "balanced_accuracy")),
                limits(judged["macro_auroc"]),
                shares(other["accuracy"]),
                limits(other["macro_auroc"]),
                limits(other["detection"]["auroc"]),
            )
        )
    pairs = [
        f"{pair['first']} less {pair['second']}: macro-AUROC {limits(pair['macro_auroc'])}, damaged or not "
        f"{limits(pair['detection_auroc'])}"
        for pair in training["comparisons"]
    ]
    return [*rows, *pairs, f"RMS, most severe: {limits(training['rms_severe_auc'])}"]


def main() -> None:
    """Print all tables."""
    audit = json.loads((RUNS / "bench_audit" / "audit.json").read_text(encoding="utf-8"))
    training = json.loads((RUNS / "bench_report" / "metrics.json").read_text(encoding="utf-8"))["training"]
    for lines in (detectability(audit), realism(audit), detection(training), classifiers(training)):
        sys.stdout.write("\n".join(lines) + "\n\n")


if __name__ == "__main__":
    main()
