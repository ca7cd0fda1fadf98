"""AUC over gearboxes seen: `python docs/scripts/learning_curve.py FOLDER [--gearboxes N] [--png FILE]`.

Streams gearboxes of `quickstart` with records of 0.5 s: healthy, and with a spall over 40 % and 80 % of the face. The
first 48 are judged on, the others are learnt from, in the order of the stream. FOLDER keeps what was taken of each
gearbox, so that a second call goes on. The network learns the synchronous averages from nothing; logistic regression
and boosting learn all indicators. Prints the AUC of each state against healthy records, with 95 % limits by drawing
the judged gearboxes anew. A quarter of the gearboxes of the network choose when it stops; its AUC is the mean of three
trainings.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from contextlib import closing
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

import siggen
from diagnostics.indicators.record import record_values
from diagnostics.statistics.evaluation import weighted_auc
from diagnostics.training.average_rows import AveragedRecords, padded_lines
from diagnostics.training.classifiers import BoostingBaseline, LogisticBaseline
from diagnostics.training.cnn import network_probability, train_network
from diagnostics.training.splits import SpecimenSplit
from siggen.file_writing import write_file
from siggen.gearbox.design import SetDesign
from siggen.plain_json import json_text

JUDGED, SIZES = 48, (12, 24, 48, 96, 192, 384, 512)
TEETH = 18, 47
STATES = "moderate", "severe"
DAMAGE = {
    "kind": "irregular", "profile_length_mm": 1.0, "skew_mm_per_10mm": [-0.18, 0.18], "waviness": [0.05, 0.1],
    "edge_radius_mm": [0.02, 0.2],
}  # fmt: skip
DRAWS, SEEDS = 1000, 3
NETWORK, LOGISTIC, BOOSTING = "network on averages", "indicators, logistic regression", "indicators, boosting"
Taken = dict[str, np.ndarray]
"""Name -> (records, ...): `state`, `gearbox`, `values` of indicators, `lines` of averages."""
Curves = dict[tuple[str, str], list[tuple[float, float, float]]]
"""Detector and state -> AUC and its limits by number of gearboxes."""


def design() -> SetDesign:
    """Return the design; the judged gearboxes are its set, the others stream behind it."""
    base = siggen.load_config("quickstart").canonical()
    states = {
        "healthy": {},
        "moderate": {"damage": {**DAMAGE, "face_share": 0.4}},
        "severe": {"grows": "moderate", "damage": {"face_share": 0.8}},
    }
    return siggen.load_config(
        {**base, "name": "learning_curve", "duration_s": 0.5, "specimens": JUDGED, "states": states}
    )


def taken(folder: Path, count: int) -> Taken:
    """Return what is taken of so many gearboxes, from the first judged one on; streams what the folder lacks."""
    made, plan = design(), folder / "stream.json"
    place = json_text({name: siggen.stream(made).state_dict()[name] for name in ("configuration", "sources")})
    if plan.exists() and plan.read_text(encoding="utf-8") != place:
        raise SystemExit(f"{folder}: holds gearboxes of another version of siggen or of this script; name a new folder")
    write_file(plan, place)
    for number in range(count):
        if not _file(folder, number).exists():
            stream = siggen.stream(made, first_gearbox=number, mixed=1, executor="serial")
            with closing(stream.blocks()) as blocks:  # type: ignore[type-var]
                found = [record for record in next(blocks) if record is not None]
            store(folder, number, found, {one.name: one.column for one in stream.channels}, made.fs_hz)
    parts = [np.load(_file(folder, number)) for number in range(count)]
    return {name: np.concatenate([one[name] for one in parts]) for name in parts[0]}


def store(folder: Path, number: int, found: Sequence[dict[str, Any]], columns: dict[str, str], fs_hz: float) -> None:
    """Keep what is taken of the records of a gearbox."""
    each = [
        record_values({name: one[column] for name, column in columns.items()}, one["tacho_s"], fs_hz, TEETH)
        for one in found
    ]
    names, content = list(each[0].values), BytesIO()
    np.savez(
        content,
        state=[one["state"] for one in found],
        gearbox=[one["specimen_id"] for one in found],
        values=np.array([[one.values[name] for name in names] for one in each]),
        lines=padded_lines([list(one.waveforms.values()) for one in each]),
    )
    write_file(_file(folder, number), content.getvalue())


def _file(folder: Path, number: int) -> Path:
    return folder / f"{number:05d}.npz"


def scores(data: Taken, size: int) -> dict[str, np.ndarray]:
    """Return the scores (trainings, records) of the judged records by all that learnt from so many gearboxes.

    Large is damage.
    """
    damaged = (data["state"] != "healthy").astype(np.int64)
    judged = data["gearbox"] < JUDGED
    learn = ~judged & (data["gearbox"] < JUDGED + size)
    validation = learn & (data["gearbox"] % 4 == 0)
    values = data["values"][:, np.isfinite(data["values"]).all(axis=0)]
    found = {}
    for name, model in ((LOGISTIC, LogisticBaseline()), (BOOSTING, BoostingBaseline())):
        model.fit(values[learn], damaged[learn], data["gearbox"][learn])
        found[name] = model.predict_proba(values[judged])[None, :, 1]
    averages = AveragedRecords(data["lines"], np.full(judged.size, TEETH[0]), ("lid", "side"))
    split = SpecimenSplit(learn & ~validation, validation, judged, ("healthy", "damaged"))
    asked = averages.chosen(np.flatnonzero(judged))
    trained = [train_network(averages, damaged, split, seed).network for seed in range(SEEDS)]
    return {NETWORK: np.stack([network_probability(network, asked)[:, 1] for network in trained]), **found}


def limits(score: np.ndarray, state: np.ndarray, gearbox: np.ndarray, wanted: str) -> tuple[float, float, float]:
    """Return the AUC of a state against healthy records of other gearboxes, and its 95 % limits."""
    kept = np.isin(state, [wanted, "healthy"])
    rng = np.random.default_rng(65)
    drawn = np.stack([np.ones(JUDGED), *rng.multinomial(JUDGED, np.full(JUDGED, 1.0 / JUDGED), DRAWS).astype(float)])
    own = gearbox[kept]
    area = np.mean([weighted_auc(one[kept], state[kept] == wanted, drawn[:, own], own) for one in score], axis=0)
    low, high = np.percentile(area[1:], (2.5, 97.5))
    return float(area[0]), float(low), float(high)


def draw(curves: Curves, sizes: Sequence[int], path: Path) -> None:
    """Draw the AUC over the number of gearboxes, a panel for each state."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    panels = dict(zip(STATES, figure.subplots(1, 2, sharey=True), strict=True))
    for (name, state), found in curves.items():
        value, low, high = np.array(found).T
        panels[state].plot(sizes, value, marker="o", ms=4, label=name)
        panels[state].fill_between(sizes, low, high, alpha=0.15, lw=0)
    for (state, panel), share in zip(panels.items(), (40, 80), strict=True):
        panel.set_xscale("log")
        panel.set_xticks(sizes, [str(size) for size in sizes], fontsize=8)
        panel.minorticks_off()
        panel.set(title=f"{state}: {share} % of the face", xlabel="gearboxes seen", ylim=(0.45, 1.02))
        panel.axhline(0.5, color="0.6", lw=0.8)
        panel.grid(alpha=0.3)
    panels[STATES[0]].set_ylabel("AUC against healthy records [-]")
    panels[STATES[0]].legend(fontsize=8, loc="upper left")
    figure.savefig(path, dpi=110)


def main() -> None:
    """Print the table, and draw the figure if it is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--gearboxes", type=int, default=SIZES[-1])
    parser.add_argument("--png", type=Path)
    asked = parser.parse_args()
    if asked.gearboxes < SIZES[0]:
        parser.error(f"--gearboxes: received {asked.gearboxes}; allowed: {SIZES[0]} or more")
    sizes = sorted({*(size for size in SIZES if size < asked.gearboxes), asked.gearboxes})
    data, curves = taken(asked.folder, JUDGED + asked.gearboxes), Curves()
    judged = data["gearbox"] < JUDGED
    for size in sizes:
        for name, score in scores(data, size).items():
            for state in STATES:
                area = limits(score, data["state"][judged], data["gearbox"][judged], state)
                curves.setdefault((name, state), []).append(area)
                print(f"{size:4d} {name:32s} {state:9s} {area[0]:.2f} ({area[1]:.2f} to {area[2]:.2f})", flush=True)
    if asked.png:
        draw(curves, sizes, asked.png)


if __name__ == "__main__":
    main()
