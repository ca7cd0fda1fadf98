"""The audit of a set as files: `audit.html`, `audit.json` and figures, from the one table of the set."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from diagnostics.audit import figures, page
from diagnostics.audit.attack_tables import shown_ladders
from diagnostics.audit.audit import CHANGE, PAIRED, UNPAIRED, Audit, is_referenced
from diagnostics.audit.audit_numbers import audit_numbers
from diagnostics.audit.bank_detections import ChanceLimit, bank_detections, chance_limit, damaged_states
from diagnostics.audit.best_indicator import best_indicators
from diagnostics.audit.detectability import Detection, detections, features, waveform_change
from diagnostics.audit.envelope import BENCH, realism
from diagnostics.audit.measured_set import MeasuredSet, measured_set
from diagnostics.audit.reference_comparison import reference_comparison
from diagnostics.audit.reference_folder import reference_windows, synthetic_windows
from diagnostics.audit.separability_findings import separability_findings, verdict
from diagnostics.audit.signal_attackers import NETWORK, PREPARED, signal_attackers
from diagnostics.base.extras import missing_packages, require_packages
from diagnostics.base.progress import Stage, silent_stage
from diagnostics.base.single_thread import single_thread
from diagnostics.indicators.own_indicator import OwnIndicator
from diagnostics.page.style import png_bytes, styled
from siggen.dataset.reading import Dataset


@dataclass(frozen=True, slots=True)
class AuditOptions:
    """What is asked of a set besides its traps.

    Attributes
    ----------
    seed : int
        Seed of permutations, folds and bootstrap.
    paired, with_realism : bool
        Whether to judge differences from own healthy records, and to compare with the ranges of healthy gearboxes.
    speed : str
        Range of the speed variation: `bench` or `variable`.
    reference : Path, optional
        Folder of measured healthy recordings to compare with.
    reference_fs_hz : float, optional
        Their sampling frequency [Hz] where files do not state it.
    """

    seed: int = 0
    paired: bool = False
    with_realism: bool = False
    speed: str = BENCH
    reference: Path | None = None
    reference_fs_hz: float | None = None


@single_thread
def audit_set(
    dataset: Dataset,
    options: AuditOptions | None = None,
    own: Sequence[OwnIndicator] = (),
    stage: Stage = silent_stage,
) -> Audit:
    """Audit a set.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    options : AuditOptions, optional
    own : sequence of OwnIndicator
        The user's indicators, tried besides those of the package.
    stage : Stage
        Told of every step.
    """
    options = options or AuditOptions()
    seed, reference = options.seed, options.reference
    require_packages("the audit", "sklearn", "matplotlib")
    # first, so that a wrong folder is said before minutes have passed
    real = reference_windows(reference, options.reference_fs_hz) if reference else None
    started_s = time.perf_counter()
    with stage("measuring", int(dataset.labels(columns=["record_id"]).num_rows)) as advance:
        measured = measured_set(dataset, own, advance)
    seconds = (time.perf_counter() - started_s) / measured.checksums.shape[0]
    with stage("traps", 1):
        findings = separability_findings(measured, seed)
    with stage("detectability", 1):
        found = _detections(measured, seed, options.paired)
        best = best_indicators(measured.matrix(), seed)
    attacked, chance = _attacks(measured, seed, stage)
    found |= attacked
    compared = realism(measured, options.speed) if options.with_realism else None
    beside = None
    if real is not None:
        with stage("windows of healthy records", int(measured.checksums.shape[0])) as advance:
            beside = reference_comparison(real, synthetic_windows(dataset, advance), seed)
    specimens = int(np.unique(measured.labels["specimen_id"]).size)
    return Audit(
        findings=tuple(findings),
        verdict=verdict(findings, specimens, chance),
        realism=compared,
        detections=found,
        notes=tuple(_notes(measured, found, options.with_realism)),
        seconds_per_record=seconds,
        records=int(measured.checksums.shape[0]),
        specimens=specimens,
        channels=len(measured.channels),
        seed=seed,
        best=best,
        chance=chance,
        reference=beside,
    )


def _detections(measured: MeasuredSet, seed: int, paired: bool) -> dict[str, list[Detection]]:
    found = {UNPAIRED: detections(measured, features(measured), seed)}
    if paired:
        found[PAIRED] = detections(measured, features(measured, paired=True), seed)
        found[CHANGE] = detections(measured, waveform_change(measured), seed)
    return found


def _attacks(measured: MeasuredSet, seed: int, stage: Stage) -> tuple[dict[str, list[Detection]], ChanceLimit]:
    """Return what the bank of attackers on waveforms reaches, and what it reaches by chance."""
    with stage("preparing attackers", PREPARED) as advance:
        bank = signal_attackers(measured, seed, advance)
    with stage("attacking", len(bank)) as advance:
        found = bank_detections(measured, bank, seed, advance)
    with stage("permuted states", len(damaged_states(measured))) as advance:
        return found, chance_limit(measured, bank, seed, advance)


def _notes(measured: MeasuredSet, found: dict[str, list[Detection]], with_realism: bool) -> list[str]:
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
        notes.append(f"The {NETWORK} was not tried: it needs PyTorch (pip install 'siggen[cnn]').")
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
            drawn["detectability"] = png_bytes(figures.detectability_figure(shown_ladders(audit)))
    (folder / "figures").mkdir(exist_ok=True)
    for name, png in drawn.items():
        (folder / "figures" / f"{name}.png").write_bytes(png)
    text = json.dumps(audit_numbers(audit, dataset), indent=1, allow_nan=False)
    (folder / "audit.json").write_text(text + "\n", encoding="utf-8")
    path = folder / "audit.html"
    path.write_text(page.audit_page(audit, dataset, drawn), encoding="utf-8")
    return path
