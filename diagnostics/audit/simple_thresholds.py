"""Trap: a threshold on one simple number finds the slightest damage on specimens that were never seen.

Where gearboxes differ more in level than a trap does, the level beside the gearbox's own healthy record gives it away.
That slight damage changes the level a little is physics; that it doubles the power is not.
"""

from __future__ import annotations

import numpy as np

from diagnostics.audit.finding import Finding
from diagnostics.audit.measured_set import MeasuredSet, reference_records
from diagnostics.statistics.evaluation import bootstrap_weights, interval, weighted_auc

QUANTITIES = ("rms", "kurtosis")
LARGEST_AUC = 0.9
LEAST_CHANGE_DB = 3.0
"""Twice the power: small pits cannot do that, a gain can (assumed); the AUC of the change has to be large too."""
FEWEST_SPECIMENS = 3
RESAMPLES = 200


def slight_states(measured: MeasuredSet) -> tuple[str, ...]:
    """Return the states of severity slight, or the one with the least damaged area where there is none."""
    labels, damaged = measured.labels, ~measured.healthy
    slight = damaged & (labels["severity"] == "slight")
    if slight.any():
        return tuple(dict.fromkeys(labels["state"][slight].tolist()))
    area = {
        state: float(np.mean(labels["damaged_area_mm2"][labels["state"] == state]))
        for state in dict.fromkeys(labels["state"][damaged].tolist())
    }
    return (min(area, key=lambda state: area[state]),) if area else ()


def simple_thresholds(measured: MeasuredSet, seed: int = 0) -> list[Finding]:
    """Return a finding for each of RMS and kurtosis that separates slight damage from healthy in some channel."""
    found = []
    for quantity in QUANTITIES:
        best = _best(measured, measured.values[quantity], seed)
        if best and best[0] > LARGEST_AUC:
            found.append(_finding(quantity, *best))
    return found or _change_of_level(measured, seed)


def _best(measured: MeasuredSet, values: np.ndarray, seed: int) -> tuple[float, str, str] | None:
    """Return lower limit of the AUC, state and channel where values (records, channels) separate best."""
    return max(
        (
            (_distance(measured, values[:, channel], state, seed), state, name)
            for state in slight_states(measured)
            for channel, name in enumerate(measured.channels)
        ),
        default=None,
    )


def _change_of_level(measured: MeasuredSet, seed: int) -> list[Finding]:
    """Return a finding if rms beside the healthy reference tells slight damage, by 3 dB or more."""
    reference, rms = reference_records(measured), measured.values["rms"]
    known = reference >= 0
    change_db = np.full(rms.shape, np.nan)
    with np.errstate(divide="ignore", invalid="ignore"):
        change_db[known] = 20.0 * np.log10(rms[known] / rms[reference[known]])
    # the size is asked first: among states that are told without fail the one with the gain is not always the first
    large = (
        (_distance(measured, change_db[:, channel], state, seed), state, name, median_db)
        for state in slight_states(measured)
        for channel, name in enumerate(measured.channels)
        if abs(median_db := _median(change_db[measured.labels["state"] == state, channel])) >= LEAST_CHANGE_DB
    )
    best = max(large, default=None)
    return [_level_finding(*best)] if best and best[0] > LARGEST_AUC else []


def _median(values: np.ndarray) -> float:
    """Return the median of what is finite, 0 where nothing is."""
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else 0.0


def _distance(measured: MeasuredSet, values: np.ndarray, state: str, seed: int) -> float:
    """Return the lower limit of the AUC, turned so that it is above 0.5; the AUC itself with very few specimens."""
    labels = measured.labels
    chosen = np.isfinite(values) & (measured.healthy | (labels["state"] == state))
    specimen = labels["specimen_id"][chosen]
    positive = ~measured.healthy[chosen]
    if positive.all() or not positive.any() or np.unique(specimen).size < FEWEST_SPECIMENS:
        return 0.5
    area = weighted_auc(values[chosen], positive, bootstrap_weights(specimen, seed, RESAMPLES), specimen)
    return interval(area if area[0] > 0.5 else 1.0 - area, int(np.unique(specimen).size)).low


def _finding(quantity: str, auc: float, state: str, channel: str) -> Finding:
    return Finding(
        f"slight_separable_by_{quantity}",
        f"a threshold on the {quantity} of {channel} alone separates {state} from healthy with an AUC of at least "
        f"{auc:.2f} (lower 95 % limit over specimens)",
        f"at most {LARGEST_AUC:g} is allowed",
        "Use smaller damage, larger manufacturing errors, more noise or a wider spread of speed and torque.",
    )


def _level_finding(auc: float, state: str, channel: str, change_db: float) -> Finding:
    return Finding(
        "slight_separable_by_rms",
        f"the rms of {channel} beside the gearbox's own healthy record separates {state} with an AUC of at least "
        f"{auc:.2f} (lower 95 % limit over specimens) and changes by {change_db:+.1f} dB (median)",
        f"at most {LARGEST_AUC:g}, or less than {LEAST_CHANGE_DB:g} dB, is allowed",
        "Record all states of a gearbox at the same gain; if they are, use smaller damage.",
    )
