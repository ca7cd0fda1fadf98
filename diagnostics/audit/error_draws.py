"""Trap: one draw of manufacturing errors for all healthy specimens, seen in the labels or in the averaged waveforms.

Waveforms of two specimens are compared by the phases of their sidebands, shifted against each other by every angle:
amplitudes differ with speed and supports even for equal errors. Of k independent phases the mean phasor exceeds r with
probability exp(-k r^2) at one angle (Rayleigh), which sets the bound for all angles and pairs. Source: derived.
"""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np

from diagnostics.audit.finding import Finding
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.audit.record_groups import column_group

HARMONICS, SIDEBANDS = 5, 6
ANGLES = 2048
FEWEST_LINES = 16
LEAST_LIKENESS = 0.8
CHANCE = 1e-3
SHARE_ALLOWED = 0.1
MOST_SPECIMENS = 24
"""Pairs among the first specimens are enough to see one draw for all."""

MEND = "Draw the manufacturing errors anew for every specimen."


def error_draws(measured: MeasuredSet) -> list[Finding]:
    """Return a finding for equal error labels and one for equal averaged waveforms of healthy specimens."""
    return [*equal_error_labels(measured), *equal_waveforms(measured)]


def equal_error_labels(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if the error labels of all healthy specimens agree though they are not zero."""
    healthy = measured.healthy
    _, first = np.unique(measured.labels["specimen_id"][healthy], return_index=True)
    names = [name for name in measured.labels if (group := column_group(name)) and group.name == "manufacture"]
    columns = {name: measured.labels[name][healthy][first] for name in names}
    numeric = {name: column for name, column in columns.items() if column.dtype.kind in "fiu" and np.any(column != 0)}
    varied = [name for name, column in numeric.items() if len(set(column.tolist())) > 1]
    if len(first) < 2 or not numeric or varied:
        return []
    return [
        Finding(
            "one_error_draw",
            f"all {len(first)} healthy specimens have the same {', '.join(sorted(numeric)[:4])}",
            "specimens must differ",
            MEND,
        )
    ]


def equal_waveforms(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if averaged waveforms of healthy specimens agree after a rotation more often than allowed."""
    healthy = np.flatnonzero(measured.healthy)
    _, first = np.unique(measured.labels["specimen_id"][healthy], return_index=True)
    chosen = healthy[first][:MOST_SPECIMENS]
    pairs = list(combinations(chosen.tolist(), 2))
    judged = [
        (found, lines)
        for a, b in pairs
        for found, lines in [likeness(_sidebands(measured, a), _sidebands(measured, b))]
        if lines >= FEWEST_LINES
    ]
    alike = sum(found > max(LEAST_LIKENESS, chance_bound(lines, len(pairs))) for found, lines in judged)
    if not judged or alike / len(judged) <= SHARE_ALLOWED:
        return []
    return [
        Finding(
            "one_error_draw",
            f"{alike} of {len(judged)} pairs of healthy specimens have the same averaged waveform up to a rotation "
            f"(mean likeness of sideband phases {np.mean([found for found, _ in judged]):.2f})",
            f"a pair counts from likeness {LEAST_LIKENESS:g}, at most {SHARE_ALLOWED:.0%} of the pairs are allowed",
            MEND,
        )
    ]


def _sidebands(measured: MeasuredSet, record: int) -> dict[int, complex]:
    """Return the sidebands of the first channel that stand above its weaker lines, by order."""
    waveform, teeth = measured.waveforms[record][0], int(measured.labels["teeth_pinion"][record])
    offsets = [k * sign for k in range(1, SIDEBANDS + 1) for sign in (-1, 1)]
    orders = [h * teeth + k for h in range(1, HARMONICS + 1) for k in offsets if h * teeth + k < waveform.size]
    # the median over all orders is the noise left in the average: most orders carry no strong line
    floor = float(np.median(np.abs(waveform))) if waveform.size else 0.0
    return {order: complex(waveform[order]) for order in orders if abs(waveform[order]) > 2.0 * floor}


def likeness(first: dict[int, complex], second: dict[int, complex]) -> tuple[float, int]:
    """Return the largest mean phasor of the common lines over all rotations, and how many lines there are."""
    orders = sorted(first.keys() & second.keys())
    if not orders:
        return 0.0, 0
    product = np.array([first[order] * np.conj(second[order]) for order in orders])
    grid = np.zeros(ANGLES, dtype=np.complex128)
    np.add.at(grid, np.array(orders) % ANGLES, product / np.abs(product))
    return float(np.abs(np.fft.fft(grid)).max()) / len(orders), len(orders)


def chance_bound(lines: int, pairs: int) -> float:
    """Return the mean phasor that independent phases exceed anywhere in all pairs with probability 0.001."""
    return math.sqrt(math.log(ANGLES * max(pairs, 1) / CHANCE) / lines)
