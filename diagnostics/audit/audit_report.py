"""The audit of a set as files: `audit.html`, `audit.json` and figures, from the one table of the set.

The content of `audit.json`: everything that the audit found, in numbers.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from pathlib import Path
from shlex import quote
from typing import Any

import numpy as np

from diagnostics.audit.audit import ALONE, CHANGE, PAIRED, UNPAIRED, WITH_REFERENCE, Audit, is_referenced
from diagnostics.audit.audit_page import audit_page, audit_summary, detectability_figure, realism_figure, shown_ladders
from diagnostics.audit.bank import (
    ChanceLimit,
    ShamFound,
    bank_detections,
    chance_limit,
    damaged_states,
    sham_leaks,
    shams_found,
)
from diagnostics.audit.condition_leaks import level_detectors
from diagnostics.audit.detectability import (
    TARGETS,
    Detectability,
    area_at,
    best_indicators,
    detections,
    features,
    waveform_change,
)
from diagnostics.audit.envelope import QuantityShare, Realism, realism
from diagnostics.audit.leaks import separability_findings, verdict
from diagnostics.audit.measured_set import MeasuredSet, measured_set
from diagnostics.audit.reference_comparison import reference_comparison, reference_windows, synthetic_windows
from diagnostics.audit.signal_detectors import NETWORK, PREPARED, signal_detectors
from diagnostics.base.extras import missing_packages, require_packages
from diagnostics.base.progress import Stage, silent_stage
from diagnostics.base.single_thread import single_thread
from diagnostics.indicators.own_indicator import OwnIndicator
from diagnostics.judging.evaluation import Entry
from diagnostics.page.style import png_bytes, styled
from diagnostics.page.template import write_page
from diagnostics.records.recording import names_of
from siggen.dataset.reading import Dataset
from siggen.errors import how_to_install
from siggen.file_writing import write_file
from siggen.plain_json import json_text

VERIFIED = 10
"""Records to simulate again before an audit: one that changed all damaged ones is missed once in a thousand."""

SEEN_ALONE, BESIDE = "alone", "beside a healthy record"
"""What detectors see of a record."""


def audit_numbers(audit: Audit, dataset: Dataset) -> dict[str, Any]:
    """Return the content of `audit.json`, where undefined numbers are null."""
    return {
        "set": dataset.path.name,
        "identity": dataset.manifest["identity"],
        "records": audit.records,
        "specimens": audit.specimens,
        "channels": audit.channels,
        "seed": audit.seed,
        "verdict": audit.verdict,
        "too_few_gearboxes": audit.tells_too_little,
        "gearboxes_needed": audit.gearboxes_needed,
        "summary": audit_summary(audit),
        "findings": audit.findings,
        "realism": _realism_numbers(audit.realism) if audit.realism else None,
        "reference": audit.reference,
        "detectability": {name: _entries_numbers(entries, audit) for name, entries in audit.detections.items()},
        "strongest": {
            name: _entries_numbers(audit.ladder(referenced=side), audit)
            for name, side in ((ALONE, False), (WITH_REFERENCE, True))
        },
        "shams": [one.numbers() for one in audit.shams],
        "chance": audit.chance,
        "best_single_indicator": {
            state: {
                "indicator": found.column,
                "tried": found.tried,
                "auc_chosen_on_the_same_gearboxes": found.auc,
                "auc_chosen_on_other_gearboxes": found.held_out,
            }
            for state, found in audit.best.items()
        },
        "notes": list(audit.notes),
        "seconds_per_record": audit.seconds_per_record,
    }


def _entries_numbers(entries: list[Detectability], audit: Audit) -> dict[str, Any]:
    return {
        "states": [
            {
                "state": entry.state,
                "fault": entry.fault,
                "specimens": entry.specimens,
                "chosen": entry.basis,
                "tried": entry.tried,
                **entry.sizes,
                "auc": entry.auc,
            }
            for entry in entries
        ],
        "damaged_area_mm2_at_auc": {
            str(target): {
                fault: None if audit.gearboxes_needed else reached
                for fault, reached in area_at(entries, target).items()
            }
            for target in TARGETS
        },
    }


def _realism_numbers(found: Realism) -> dict[str, Any]:
    return {
        "healthy_channel_records": found.channel_records,
        "mean_share_inside": found.mean_inside,
        "share_inside_all": found.all_inside,
        "quantities": _share_numbers(found.shares),
        "background": {
            "mean_share_inside": found.background_inside,
            "quantities": _share_numbers(found.background),
        },
        "sensor_spread": found.spreads,
    }


def _share_numbers(shares: tuple[QuantityShare, ...]) -> list[dict[str, Any]]:
    return [
        {
            "name": share.quantity.name,
            "ranges": share.quantity.ranges,
            **dict(zip(("q05", "q50", "q95"), share.quantiles, strict=True)),
            "inside": share.inside,
            "undefined": share.undefined,
        }
        for share in shares
    ]


@single_thread()
def audit_set(
    dataset: Dataset,
    seed: int = 0,
    reference: Path | None = None,
    own: Sequence[OwnIndicator] = (),
    stage: Stage = silent_stage,
) -> Audit:
    """Audit a set.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    seed : int
        Of permutations, folds and bootstrap.
    reference : Path, optional
        Folder of measured healthy recordings to compare with.
    own : sequence of OwnIndicator
        The user's indicators, tried besides those of the package.
    stage : Stage
        Told of every step.
    """
    require_packages("the audit", "sklearn", "matplotlib")
    # first, so that a wrong folder is said before minutes have passed
    real = reference_windows(reference) if reference else None
    started_s = time.perf_counter()
    with stage("measuring", int(dataset.labels(columns=["record_id"]).num_rows)) as advance:
        measured = measured_set(dataset, own, advance)
    seconds = (time.perf_counter() - started_s) / measured.checksums.shape[0]
    with stage("leaks", 1):
        findings = separability_findings(measured, seed)
    with stage("detectability", 1):
        found = _detections(measured, seed)
        best = best_indicators(measured.matrix(), seed)
    detected, chance, shams = _bank_on_signals(measured, seed, stage)
    found |= detected
    findings += sham_leaks(shams)
    compared = None if names_of(dataset)[0].planetary else realism(measured)
    beside = None
    if real is not None:
        with stage("windows of healthy records", int(measured.checksums.shape[0])) as advance:
            beside = reference_comparison(real, synthetic_windows(dataset, advance), seed)
    specimens = int(np.unique(measured.labels["specimen_id"]).size)
    missing = "damaged" if measured.healthy.all() else "" if measured.healthy.any() else "healthy"
    return Audit(
        findings=tuple(findings),
        verdict=verdict(findings, specimens, chance, missing),
        realism=compared,
        detections=found,
        notes=tuple(_notes(measured, found, names_of(dataset)[0].planetary)),
        seconds_per_record=seconds,
        records=int(measured.checksums.shape[0]),
        specimens=specimens,
        channels=len(measured.channels),
        seed=seed,
        best=best,
        chance=chance,
        reference=beside,
        shams=shams,
        missing=missing,
        made_again=_made_again(dataset),
    )


def _made_again(dataset: Dataset) -> str:
    """Return the command that simulates records of a set again; empty for recordings and sealed sets."""
    return f"siggen verify {quote(str(dataset.path))} --sample {VERIFIED}" if dataset.is_simulated else ""


def _detections(measured: MeasuredSet, seed: int) -> dict[str, list[Detectability]]:
    return {
        UNPAIRED: detections(measured, features(measured), seed),
        PAIRED: detections(measured, features(measured, paired=True), seed),
        CHANGE: detections(measured, waveform_change(measured), seed),
    }


def _bank_on_signals(
    measured: MeasuredSet, seed: int, stage: Stage
) -> tuple[dict[str, list[Detectability]], ChanceLimit, tuple[ShamFound, ...]]:
    """Return what the bank of detectors on waveforms reaches, by chance too, and on shams."""
    with stage("preparing detectors", PREPARED) as advance:
        bank = signal_detectors(measured, seed, advance)
    with stage("detecting", len(bank)) as advance:
        found = bank_detections(measured, bank, seed, advance)
    with stage("permuted states", len(damaged_states(measured))) as advance:
        chance = chance_limit(measured, bank, seed, advance)
    return found, chance, shams_found(measured, sham_sides(measured, bank), seed)


def sham_sides(measured: MeasuredSet, bank: list[Entry]) -> dict[str, list[Entry]]:
    """Return who is asked about shams, by what they see: a bank of detectors on signals, and those on raw levels."""
    return {
        side: [
            *(one for one in bank if is_referenced(one.name) == (side == BESIDE)),
            *level_detectors(measured, referenced=side == BESIDE),
        ]
        for side in (SEEN_ALONE, BESIDE)
    }


def _notes(measured: MeasuredSet, found: dict[str, list[Detectability]], planetary: bool) -> list[str]:
    notes = []
    for name, entries in found.items():
        lacking = [entry.state for entry in entries if not math.isfinite(entry.auc.value)]
        if lacking:
            why = (
                "fewer than 4 specimens with defined values in a class"
                if not is_referenced(name)
                else "in 4 specimens, a healthy record needs another healthy one of its specimen within 1 % in torque "
                "and 0.2 % in speed (`repeats: 2` or more)"
            )
            notes.append(f"No AUC from {name} for {', '.join(lacking)}: {why}.")
    if missing_packages("torch"):
        notes.append(f"The {NETWORK} was not tried: it needs PyTorch: {how_to_install('cnn')}.")
    if planetary:
        notes.append("No comparison with healthy gearboxes: its ranges were measured on pairs of gears.")
    elif not measured.healthy.any():
        notes.append("No comparison with healthy gearboxes: the set has no healthy records.")
    elif len(measured.channels) < 3:
        notes.append("No spread between sensors: at least three channels are needed.")
    return notes


def write_audit(audit: Audit, dataset: Dataset, folder: Path) -> Path:
    """Write page, JSON and figures; return the page's path."""
    with styled():
        drawn = {}
        if audit.realism:
            drawn["realism"] = png_bytes(realism_figure(audit.realism))
        if any(math.isfinite(entry.auc.value) for entries in audit.detections.values() for entry in entries):
            drawn["detectability"] = png_bytes(detectability_figure(shown_ladders(audit)))
    for name, png in drawn.items():
        write_file(folder / "figures" / f"{name}.png", png)
    write_file(folder / "audit.json", json_text(audit_numbers(audit, dataset)))
    path = folder / "audit.html"
    write_page(path, audit_page(audit, dataset, drawn))
    return path
