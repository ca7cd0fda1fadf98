"""Trap: a threshold on one simple number finds the slightest damage on specimens that were never seen."""

from __future__ import annotations

import numpy as np

from diagnostics.audit.finding import Finding
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.statistics.evaluation import bootstrap_weights, interval, weighted_auc

QUANTITIES = ("rms", "kurtosis")
LARGEST_AUC = 0.9
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
        best = max(
            (
                (_distance(measured, quantity, channel, state, seed), state, name)
                for state in slight_states(measured)
                for channel, name in enumerate(measured.channels)
            ),
            default=None,
        )
        if best and best[0] > LARGEST_AUC:
            found.append(_finding(quantity, *best))
    return found


def _distance(measured: MeasuredSet, quantity: str, channel: int, state: str, seed: int) -> float:
    """Return the lower limit of the AUC, turned so that it is above 0.5; the AUC itself with very few specimens."""
    labels = measured.labels
    values = measured.values[quantity][:, channel]
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
