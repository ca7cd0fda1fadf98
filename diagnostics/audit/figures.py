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
    """Return AUC over profile length with intervals; a colour per variant, a marker per fault; dotted: targets.

    Faults whose states do not differ in length stand in the tables only, unless there are no others.
    """
    figure, axes = new_figure(height_in=4.2)
    axis = axes[0, 0]
    lines = [
        (name, fault, [entry for entry in entries if entry.fault == fault and np.isfinite(entry.auc.value)])
        for name, entries in variants.items()
        for fault in dict.fromkeys(entry.fault for entry in entries)
    ]
    lines = [line for line in lines if line[2]]
    lines = [line for line in lines if differ_in_length(line[2])] or lines
    variant, kind = (list(dict.fromkeys(line[place] for line in lines)).index for place in (0, 1))
    for name, fault, entries in lines:
        length = [entry.sizes.get(SIZES[2], entry.sizes[SIZES[0]]) for entry in entries]
        value = np.array([entry.auc.value for entry in entries])
        low = np.array([entry.auc.low for entry in entries])
        high = np.array([entry.auc.high for entry in entries])
        limits = np.nan_to_num([value - low, high - value]).clip(0.0)
        colour, marker = FAULT_COLOURS[variant(name) % len(FAULT_COLOURS)], MARKERS[kind(fault) % len(MARKERS)]
        axis.errorbar(
            length, value, limits, marker=marker, markersize=4, color=colour, label=f"{fault}, {name}", capsize=2
        )
    axis.axhline(0.5, color="#9aa7b2", linestyle="--", linewidth=0.8)
    for target in TARGETS:
        axis.axhline(target, color="#9aa7b2", linestyle=":", linewidth=0.8)
    axis.set_ylim(0.3, 1.02)
    axis.set_xlim(0.0, 1.05 * axis.get_xlim()[1])
    axis.set_xlabel("Length of the damage along the profile [mm]")
    axis.set_ylabel("AUC against healthy [-]")
    figure.legend(fontsize=8, loc="outside upper center")
    return figure
