"""Figure and tables of presets.md: `python docs/scripts/detectability.py [GEARBOXES] [WORKERS] [SET ...]`.

Makes three sets in runs/ where they are missing, has `siggen-diagnostics audit` look at each of them, and prints
Markdown: the strongest detector by state, without and with the gearbox's own healthy record; what four common
indicators find; and how healthy records lie in measured ranges. 24 gearboxes take some 25 minutes on two cores.
SET is one of bench, parallel, industrial, families, edges, quickstart; without any: bench, parallel,
edges.

* `detect_bench`, `detect_industrial`: presets bench and industrial with the states of STATES; `detect_parallel`: bench
  with the states of SAME and edges parallel to the axis; `detect_families`: all states of families;
* `detect_quickstart`: quickstart with its spall in the sizes of SIZES, from which its states are chosen;
* `detect_edges`: bench with spalls of 1 mm over SHARES of the face, both edges turned together by SKEWS_MM.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from chosen_states import chosen_states
from matplotlib.figure import Figure
from report_pages import run

import siggen
from diagnostics.audit.envelope import quantities
from siggen.config.inheritance import inherited
from siggen.keys.yaml_source import read_yaml

RUNS, CONFIGS, FIGURE = Path("runs"), Path("configs"), Path("docs/figures/presets_detectability.png")
LENGTHS = (10, 20, 30, 40, 60, 80, 100, 150)
"""Of spalls through the face [0.01 mm]."""
FACES = (20, 40, 80, 95)
STATES = (
    "healthy",
    "healthy_again",
    "slight",
    *(f"face_{share}" for share in FACES),
    *(f"through_{i:03d}" for i in LENGTHS),
    "sham",
)
SAME = ("healthy", "healthy_again", "face_80", *(f"through_{i:03d}" for i in LENGTHS))
"""Of bench with parallel edges: enough to compare it with bench."""
FAMILIES = ("healthy", "healthy_again", "slight", "face_40", "face_80", "through")
"""Their sizes are for module 3 mm and grow with it."""
PRESETS = {
    "bench": ("bench", STATES),
    "parallel": ("bench", SAME),
    "industrial": ("industrial", STATES),
    "families": ("families", FAMILIES),
}
"""Folder -> preset and states."""
SHARES, SKEWS_MM = (0.8, 1.0), (0.0, 0.4, 0.8)
"""Shares of the face; by how much one end of both edges lies higher than the other, over a face of 20 mm."""
SIZES = {f"face_{share}": (0.01 * share, 1.0) for share in FACES} | {
    f"through_{size:03d}": (1.0, 0.01 * size) for size in (20, 30, 40, 60, 100)
}
"""Spalls of quickstart: share of the face, length along the profile [mm]."""
HALVES = {"train": 10, "validation": 10, "test": 0}
"""Two shards of one size, for two workers; the audit knows no splits."""
SPALL = {"kind": "irregular", "profile_length_mm": 1.0, "waviness": 0.0, "edge_radius_mm": 0.1}
ALONE, WITH_REFERENCE = "strongest detector alone", "strongest detector with a healthy reference"
UNPAIRED = "logistic regression on four indicators"
"""Names in audit.json."""
SEEN = {
    WITH_REFERENCE: ("strongest detector, with reference", "#1b7837", "o"),
    ALONE: ("strongest detector, without reference", "#2166ac", "s"),
    UNPAIRED: ("four indicators, without reference", "#b2182b", "^"),
}
Entry = dict[str, Any]


def preset(name: str, gearboxes: int, chosen: tuple[str, ...]) -> dict[str, Any]:
    """Return a preset with some of its states."""
    raw = inherited(read_yaml(CONFIGS / f"{name}.yaml"), CONFIGS)
    states = chosen_states(raw["states"], chosen)
    by = {"by": "pair"} if name == "families" else {}
    return {**raw, "specimens": gearboxes, "states": states, "splits": {**HALVES, **by}}


def _irregular(state: dict[str, Any]) -> bool:
    return bool(state.get("damage", {}).get("kind") == "irregular")


def parallel(raw: dict[str, Any]) -> dict[str, Any]:
    """Return a configuration with the edges of all irregular spalls parallel to the axis."""
    straight = {"skew_mm_per_10mm": 0.0, "waviness": 0.0}
    states = {
        name: {**state, "damage": {**state["damage"], **straight}} if name.startswith(("face_", "through_")) else state
        for name, state in raw["states"].items()
    }
    return {**raw, "name": "bench_parallel", "states": states}


def edges(gearboxes: int) -> dict[str, Any]:
    """Return bench with spalls of 1 mm by share of the face and skew of both edges."""
    damaged = {}
    for share in SHARES:
        for skew in SKEWS_MM:
            name = f"share_{100 * share:03.0f}_skew_{100 * skew:03.0f}"
            damage = {**SPALL, "skew_mm_per_10mm": 0.5 * skew, "face_share": share}
            damaged[name] = {"severity": "severe", "damage": damage}
    raw = preset("bench", gearboxes, STATES[:2])
    return {**raw, "name": "edges", "states": {**raw["states"], **damaged}}


def quickstart_sizes(gearboxes: int) -> dict[str, Any]:
    """Return quickstart with its spall in many sizes; skews grow with the length, as in bench."""
    raw = inherited(read_yaml(CONFIGS / "quickstart.yaml"), CONFIGS)
    spall = raw["states"]["slight"]["damage"]
    states: dict[str, Any] = {"healthy": {}, "healthy_again": {}}
    for name, (share, length_mm) in SIZES.items():
        skew = 0.18 * length_mm
        own = {"face_share": share, "profile_length_mm": length_mm, "skew_mm_per_10mm": [-skew, skew]}
        states[name] = {"severity": "severe", "damage": {**spall, **own}}
    return {**raw, "name": "quickstart_sizes", "specimens": gearboxes, "states": states, "splits": HALVES}


def audited(folder: str, raw: dict[str, Any], workers: int) -> dict[str, dict[str, Entry]]:
    """Return way to look -> state -> what `audit` found on a set that is made where it is missing."""
    path, out = RUNS / f"detect_{folder}", RUNS / f"detect_{folder}_audit"
    if not (path / "manifest.json").exists():  # an interrupted set goes on
        print(f"making {path}", file=sys.stderr)
        siggen.generate(siggen.load_config(raw), path, workers=workers)
    if not (out / "audit.json").exists():
        run(f"siggen-diagnostics audit {path} --out {out}")
    found = json.loads((out / "audit.json").read_text(encoding="utf-8"))
    ways = {**found["strongest"], UNPAIRED: found["detectability"][UNPAIRED]}
    failures = siggen.open(path).manifest.get("failures", [])
    print(
        f"\n{path}: {found['specimens']} gearboxes, {found['records']} records, {len(failures)} could not be simulated"
    )
    if found["chance"]:
        limits = [
            f"{state} {law['auc']:.2f} (p {law['p_value']:.3f})" for state, law in found["chance"]["states"].items()
        ]
        print(f"with permuted states the strongest detector stays below, in 95 %: {', '.join(limits)}")
    return {name: {entry["state"]: entry for entry in way["states"]} for name, way in ways.items()}


def auc(entry: Entry) -> str:
    """Return an AUC with its interval."""
    found = entry["auc"]
    return f"{found['value']:.2f} ({found['low']:.2f} to {found['high']:.2f})"


def detector(entry: Entry) -> str:
    """Return the detector's name, without what it chose."""
    name: str = entry["chosen"]
    return name.partition(":")[0].partition(" (")[0]


def title(state: str) -> str:
    """Return a state in words."""
    kind, _, size = state.partition("_")
    if kind == "slight":
        return "small pits"
    if kind == "face":
        return f"{size} % of the face"
    return f"whole face, {int(size) / 100:g} mm" if size else "whole face"


def ladder_table(found: dict[str, dict[str, Entry]]) -> list[str]:
    """Return the Markdown rows of a preset."""
    head = "| damage | area [mm²] | four indicators, without reference | strongest, without reference | by |"
    rows = [f"{head} strongest, with reference | by |", "|---|---|---|---|---|---|---|"]
    ways = (UNPAIRED, ALONE, WITH_REFERENCE)
    for state in (state for state in (*STATES, "through") if all(state in found[way] for way in ways)):
        weak, alone, referenced = (found[way][state] for way in ways)
        cells = (auc(alone), detector(alone), auc(referenced), detector(referenced))
        rows.append(f"| {title(state)} | {alone['damaged_area_mm2']:.1f} | {auc(weak)} | {' | '.join(cells)} |")
    return rows


def edge_table(found: dict[str, dict[str, Entry]]) -> list[str]:
    """Return the Markdown rows of spalls of 1 mm by share and skew."""
    head = "| share of the face | skew over the face | area [mm²] | four indicators | strongest, without reference |"
    rows = [f"{head} strongest, with reference |", "|---|---|---|---|---|---|"]
    for state, alone in sorted(found[ALONE].items()):
        _, share, _, skew = state.split("_")
        cells = (auc(found[way][state]) for way in (UNPAIRED, ALONE, WITH_REFERENCE))
        area = f"{alone['damaged_area_mm2']:.1f}"
        rows.append(f"| {int(share)} % | {int(skew) / 100:g} mm | {area} | {' | '.join(cells)} |")
    return rows


def realism_table(folder: str) -> list[str]:
    """Return the Markdown rows of how healthy channel-records lie in the ranges of measured gearboxes."""
    audit = json.loads((RUNS / f"detect_{folder}_audit" / "audit.json").read_text(encoding="utf-8"))["realism"]
    titles = {quantity.name: quantity.title for quantity in quantities()}
    rows = ["| quantity of healthy records | 5 %, median, 95 % | inside |", "|---|---|---|"]
    for entry in audit["quantities"]:
        spread = ", ".join(f"{entry[key]:.3g}" for key in ("q05", "q50", "q95"))
        rows.append(f"| {titles[entry['name']]} | {spread} | {entry['inside']:.0%} |")
    return [*rows, f"{audit['healthy_channel_records']} channel-records, {audit['share_inside_all']:.0%} inside all"]


def draw(found: dict[str, dict[str, dict[str, Entry]]]) -> None:
    """Draw the AUC over share of the face and length, one row of axes per preset."""
    figure = Figure(figsize=(10.0, 3.3 * len(found)), layout="constrained")
    axes = figure.subplots(len(found), 2, sharey=True, squeeze=False)
    for row, (name, ways) in zip(axes, found.items(), strict=True):
        shares = {f"face_{share}": float(share) for share in FACES} | {"through_100": 100.0}
        lengths = {f"through_{size:03d}": size / 100 for size in LENGTHS}
        for axis, sizes, what in zip(
            row, (shares, lengths), ("share of the face [%], 1 mm long", "mean length [mm], whole face"), strict=True
        ):
            for way, (label, colour, marker) in SEEN.items():
                at = [size for state, size in sizes.items() if state in ways[way]]
                entries = [ways[way][state]["auc"] for state in sizes if state in ways[way]]
                value = [entry["value"] for entry in entries]
                axis.fill_between(
                    at, [e["low"] for e in entries], [e["high"] for e in entries], color=colour, alpha=0.15
                )
                axis.plot(at, value, color=colour, marker=marker, label=label)
            axis.axhline(0.5, color="0.6", linewidth=0.8)
            axis.set(xlabel=what, title=f"{name}: {what.partition(' [')[0]}", ylim=(0.25, 1.02))
        row[0].set_ylabel("AUC against healthy records [-]")
        row[0].set_xlim(15.0, 103.0)
    figure.legend(handles=axes[0, 0].lines[: len(SEEN)], loc="outside lower center", ncols=len(SEEN), fontsize=8)
    figure.savefig(FIGURE, dpi=110)


def main(gearboxes: int, workers: int, chosen: list[str]) -> None:
    """Make sets, audits, figure and tables."""
    RUNS.mkdir(exist_ok=True)
    found = {}
    for folder, (name, states) in PRESETS.items():
        if folder in chosen:
            raw = preset(name, gearboxes, states)
            found[folder] = audited(folder, parallel(raw) if folder == "parallel" else raw, workers)
    for name, ways in found.items():
        print(f"\n{name}\n", *ladder_table(ways), sep="\n")
    drawn = {name: ways for name, ways in found.items() if name != "families"}
    if drawn:
        draw(drawn)
    for folder in (folder for folder in PRESETS if folder in chosen and folder != "parallel"):
        print(f"\nhealthy records of {folder}\n", *realism_table(folder), sep="\n")
    if "quickstart" in chosen:
        table = ladder_table(audited("quickstart", quickstart_sizes(gearboxes), workers))
        print("\nquickstart, its spall in many sizes\n", *table, sep="\n")
    if "edges" in chosen:
        table = edge_table(audited("edges", edges(gearboxes), workers))
        print("\nspalls of 1 mm by share and skew\n", *table, sep="\n")


if __name__ == "__main__":
    numbers = [int(value) for value in sys.argv[1:3]]
    main(
        numbers[0] if numbers else 24,
        numbers[1] if len(numbers) > 1 else 2,
        sys.argv[3:] or ["bench", "parallel", "edges"],
    )
