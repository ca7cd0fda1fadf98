"""When damage is first seen, on the page of lives: a table of what sees it, and single gearboxes over their lives."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from diagnostics.page import html
from diagnostics.page.html import Cell
from diagnostics.page.style import png_bytes
from diagnostics.report.life_figure import UnitLife, life_figure
from diagnostics.report.unit_lives import FailureDetection
from diagnostics.statistics.first_detection import IN_A_ROW, QUIET
from diagnostics.training.life_baselines import Inspections

CAPTION = (
    "Pictures: the flank that ends it, with age and damaged share. Middle: what shows damage, over the limit "
    f"that {QUIET:.0%} of other gearboxes' inspections without a pit stay below; diamonds: detected. Bottom: predicted "
    "remaining life with its 80 % interval, beside the true one (dashed)."
)


def shown_gearboxes(found: Inspections) -> list[int]:
    """Return the gearboxes that failed first, in the middle and last."""
    known = np.isfinite(found.rul_h)
    units, first = np.unique(found.specimen[known], return_index=True)
    order = units[np.argsort((found.age_h + found.rul_h)[known][first], kind="stable")]
    return list(dict.fromkeys(int(order[place]) for place in (0, order.size // 2, order.size - 1)))


def detection_table(detected: Mapping[str, FailureDetection]) -> str:
    """Return the table of what sees damage, and when."""
    rows = [
        [
            Cell(name),
            Cell(f"{one.detected} of {one.gearboxes}", value=one.detected),
            _median(100.0 * one.share),
            _median(one.left_h),
            Cell(str(one.early)),
        ]
        for name, one in detected.items()
    ]
    head = [
        "What is watched",
        "Gearboxes detected",
        "Worst tooth then [%]",
        "Hours left then [h]",
        "Detected before any pit",
    ]
    caption = (
        f"First detection in gearboxes that failed, medians. Detected: {IN_A_ROW} inspections in a row above what "
        f"{QUIET:.0%} of other gearboxes' inspections without a pit stay below; pictures: the first that shows a pit."
    )
    return html.table(head, rows, caption=caption)


def life_block(unit: UnitLife) -> str:
    """Return the figure of a gearbox with its caption."""
    return html.figure_block(png_bytes(life_figure(unit)), f"Gearbox {unit.specimen}. {CAPTION}")


def _median(value: float) -> Cell:
    return Cell(f"{value:.1f}" if np.isfinite(value) else "none", value=value)
