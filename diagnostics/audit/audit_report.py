"""The audit of a set as files: `audit.html`, `audit.json` and figures, from the one table of the set."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.audit import figures, page
from diagnostics.audit.audit import Audit
from diagnostics.audit.audit_sentences import audit_summary
from diagnostics.audit.best_indicator import best_indicators
from diagnostics.audit.detectability import TARGETS, Detection, detections, features, length_at, waveform_change
from diagnostics.audit.envelope import BENCH, Realism, realism
from diagnostics.audit.measured_set import MeasuredSet, measured_set
from diagnostics.audit.separability_findings import separability_findings, verdict
from diagnostics.base.extras import require_packages
from diagnostics.base.progress import Stage, silent_stage
from diagnostics.indicators.own_indicator import OwnIndicator
from diagnostics.page.style import png_bytes, styled
from siggen.dataset.reading import Dataset

UNPAIRED = "logistic regression on four indicators"
PAIRED, CHANGE = "six indicators minus own healthy record", "change of the averaged waveform"


def audit_set(
    dataset: Dataset,
    seed: int = 0,
    own: Sequence[OwnIndicator] = (),
    *,
    with_realism: bool = False,
    paired: bool = False,
    speed: str = BENCH,
    stage: Stage = silent_stage,
) -> Audit:
    """Audit a set.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    seed : int
        Seed of permutations, folds and bootstrap.
    own : sequence of OwnIndicator
        The user's indicators, tried besides those of the package.
    with_realism, paired : bool
        Whether to compare with the ranges of healthy gearboxes, and to judge differences from own healthy records.
    speed : str
        Range of the speed variation: `bench` or `variable`.
    stage : Stage
        Told of every step.
    """
    require_packages("the audit", "sklearn", "matplotlib")
    started_s = time.perf_counter()
    with stage("measuring", int(dataset.labels(columns=["record_id"]).num_rows)) as advance:
        measured = measured_set(dataset, own, advance)
    seconds = (time.perf_counter() - started_s) / measured.checksums.shape[0]
    with stage("traps", 1):
        findings = separability_findings(measured, seed)
    with stage("detectability", 1):
        found = _detections(measured, seed, paired)
        best = best_indicators(measured.matrix(), seed)
    compared = realism(measured, speed) if with_realism else None
    specimens = int(np.unique(measured.labels["specimen_id"]).size)
    return Audit(
        findings=tuple(findings),
        verdict=verdict(findings, specimens),
        realism=compared,
        detections=found,
        notes=tuple(_notes(measured, found, with_realism)),
        seconds_per_record=seconds,
        records=int(measured.checksums.shape[0]),
        specimens=specimens,
        channels=len(measured.channels),
        seed=seed,
        best=best,
    )


def _detections(measured: MeasuredSet, seed: int, paired: bool) -> dict[str, list[Detection]]:
    found = {UNPAIRED: detections(measured, features(measured), seed)}
    if paired:
        found[PAIRED] = detections(measured, features(measured, paired=True), seed)
        found[CHANGE] = detections(measured, waveform_change(measured), seed)
    return found


def _notes(measured: MeasuredSet, found: dict[str, list[Detection]], with_realism: bool) -> list[str]:
    notes = []
    for name, entries in found.items():
        lacking = [entry.state for entry in entries if not math.isfinite(entry.auc.value)]
        if lacking:
            why = (
                "fewer than 4 specimens with defined values in a class"
                if name == UNPAIRED
                else "in 4 specimens, a healthy record needs another healthy one of its specimen within 1 % in torque "
                "and 0.2 % in speed (`repeats: 2` or more)"
            )
            notes.append(f"No AUC from {name} for {', '.join(lacking)}: {why}.")
    if with_realism and not measured.healthy.any():
        notes.append("No comparison with healthy gearboxes: the set has no healthy records.")
    if with_realism and len(measured.channels) < 3:
        notes.append("No spread between sensors: at least three channels are needed.")
    return notes


def write_audit(audit: Audit, dataset: Dataset, folder: Path) -> Path:
    """Write page, JSON and figures; return the page's path."""
    folder.mkdir(parents=True, exist_ok=True)
    with styled():
        drawn = {}
        if audit.realism:
            drawn["realism"] = png_bytes(figures.realism_figure(audit.realism))
        if any(math.isfinite(entry.auc.value) for entries in audit.detections.values() for entry in entries):
            drawn["detectability"] = png_bytes(figures.detectability_figure(audit.detections))
    (folder / "figures").mkdir(exist_ok=True)
    for name, png in drawn.items():
        (folder / "figures" / f"{name}.png").write_bytes(png)
    text = json.dumps(audit_numbers(audit, dataset), indent=1, allow_nan=False)
    (folder / "audit.json").write_text(text + "\n", encoding="utf-8")
    path = folder / "audit.html"
    path.write_text(page.audit_page(audit, dataset, drawn), encoding="utf-8")
    return path


def audit_numbers(audit: Audit, dataset: Dataset) -> dict[str, Any]:
    """Return the content of `audit.json`; undefined numbers are null."""
    return {
        "set": dataset.path.name,
        "identity": dataset.manifest["identity"],
        "records": audit.records,
        "specimens": audit.specimens,
        "channels": audit.channels,
        "seed": audit.seed,
        "verdict": audit.verdict,
        "summary": audit_summary(audit),
        "findings": [asdict(finding) for finding in audit.findings],
        "realism": _realism_numbers(audit.realism) if audit.realism else None,
        "detectability": {
            name: {
                "states": [
                    {
                        "state": entry.state,
                        "fault": entry.fault,
                        "specimens": entry.specimens,
                        **{size: _number(value) for size, value in entry.sizes.items()},
                        "auc": entry.auc.numbers(),
                    }
                    for entry in entries
                ],
                "profile_length_mm_at_auc": {
                    str(target): {
                        fault: asdict(reached) if reached else None
                        for fault, reached in length_at(entries, target).items()
                    }
                    for target in TARGETS
                },
            }
            for name, entries in audit.detections.items()
        },
        "best_single_indicator": {
            state: {
                "indicator": found.column,
                "tried": found.tried,
                "auc_chosen_on_the_same_gearboxes": found.auc.numbers(),
                "auc_chosen_on_other_gearboxes": _number(found.held_out),
            }
            for state, found in audit.best.items()
        },
        "notes": list(audit.notes),
        "seconds_per_record": audit.seconds_per_record,
    }


def _realism_numbers(found: Realism) -> dict[str, Any]:
    return {
        "healthy_channel_records": found.channel_records,
        "mean_share_inside": found.mean_inside,
        "share_inside_all": found.all_inside,
        "quantities": [
            {
                "name": share.quantity.name,
                "ranges": share.quantity.ranges,
                **{name: _number(v) for name, v in zip(("q05", "q50", "q95"), share.quantiles, strict=True)},
                "inside": share.inside,
                "undefined": share.undefined,
            }
            for share in found.shares
        ],
        "sensor_spread": [
            {"name": s.name, "spread_db": _number(s.spread_db), "wanted_db": s.wanted_db} for s in found.spreads
        ],
    }


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
