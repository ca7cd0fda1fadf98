"""Figures of the audit: every quantity against its range, and AUC over the size of the damage."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.audit.detectability import SIZES, TARGETS, Detection, differ_in_length
from diagnostics.audit.envelope import QuantityShare, Realism
from diagnostics.page.style import FAULT_COLOURS, HEALTHY_COLOUR, PINION_COLOUR, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLUMNS = 2
BINS = 40
MARKERS = "osD^v"
RANGE_COLOUR = "#cfe8d5"


def realism_figure(found: Realism) -> Figure:
    """Return one histogram per quantity over its range (green)."""
    rows = -(-len(found.shares) // COLUMNS)
    figure, axes = new_figure(rows, COLUMNS, height_in=1.3 * rows)
    for axis, share in zip(axes.ravel(), found.shares, strict=False):
        _draw_quantity(axis, share)
    for axis in axes.ravel()[len(found.shares) :]:
        axis.set_visible(False)
    return figure


def _draw_quantity(axis: Any, share: QuantityShare) -> None:
    values = share.values[np.isfinite(share.values)]
    ranges = share.quantity.ranges
    low, high = ranges[0][0], ranges[-1][1]
    if values.size:
        # the outermost 2 % would stretch the axis until the range is a line
        points = np.quantile(values, [0.01, 0.99])
        low, high = min(low, points[0]), max(high, points[1])
    margin = 0.06 * (high - low)
    for start, end in ranges:
        axis.axvspan(start, end, color=RANGE_COLOUR, linewidth=0)
    axis.hist(np.clip(values, low, high), bins=np.linspace(low, high, BINS), color=HEALTHY_COLOUR)
    axis.set_xlim(low - margin, high + margin)
    axis.set_yticks([])
    axis.tick_params(labelsize=8)
    colour = PINION_COLOUR if share.inside < 0.5 else "black"
    axis.set_title(f"{share.quantity.title}\n{share.inside:.0%} inside", fontsize=8, color=colour)


def detectability_figure(variants: dict[str, list[Detection]]) -> Figure:
    """Return AUC over profile length with intervals: a panel per variant, a marker per fault; dotted: targets.

    Faults whose states do not differ in length stand in the tables only, unless there are no others.
    """
    lines = [line for line in _ladders(variants) if differ_in_length(line[2])] or _ladders(variants)
    names = list(dict.fromkeys(name for name, _, _ in lines))
    faults = list(dict.fromkeys(fault for _, fault, _ in lines))
    figure, axes = new_figure(len(names), 1, height_in=0.9 + 1.9 * len(names), sharex=True, sharey=True)
    named: set[str] = set()
    for name, fault, entries in lines:
        colour, marker = FAULT_COLOURS[faults.index(fault) % len(FAULT_COLOURS)], MARKERS[faults.index(fault) % 5]
        _draw_ladder(axes[names.index(name), 0], entries, colour, marker, None if fault in named else fault)
        named.add(fault)
    for axis, name in zip(axes[:, 0], names, strict=True):
        _frame(axis, name)
    axes[0, 0].set_xlim(0.0, 1.05 * axes[0, 0].get_xlim()[1])
    axes[-1, 0].set_xlabel("Length of the damage along the profile [mm]")
    figure.supylabel("AUC against healthy [-]", fontsize=10)
    figure.legend(fontsize=8.5, loc="outside upper center", ncols=min(len(faults), 2))
    return figure


def _ladders(variants: dict[str, list[Detection]]) -> list[tuple[str, str, list[Detection]]]:
    """Return what was judged, by variant and fault."""
    found = [
        (name, fault, [entry for entry in entries if entry.fault == fault and np.isfinite(entry.auc.value)])
        for name, entries in variants.items()
        for fault in dict.fromkeys(entry.fault for entry in entries)
    ]
    return [line for line in found if line[2]]


def _draw_ladder(axis: Any, entries: list[Detection], colour: str, marker: str, label: str | None) -> None:
    length = [entry.sizes.get(SIZES[2], entry.sizes[SIZES[0]]) for entry in entries]
    value, low, high = (np.array([getattr(entry.auc, part) for entry in entries]) for part in ("value", "low", "high"))
    limits = np.nan_to_num([value - low, high - value]).clip(0.0)
    axis.errorbar(length, value, limits, marker=marker, markersize=4, color=colour, label=label, capsize=2)


def _frame(axis: Any, name: str) -> None:
    axis.axhline(0.5, color="#9aa7b2", linestyle="--", linewidth=0.8)
    for target in TARGETS:
        axis.axhline(target, color="#9aa7b2", linestyle=":", linewidth=0.8)
    axis.set_ylim(0.3, 1.02)
    axis.set_title(name, loc="left", fontsize=9, fontweight="bold")
