"""Tables of a report: what the set holds, scores with intervals, every feature's separability.

Links from tables and figures of a page to the records behind them, further up on the same page.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any
from urllib.parse import quote, urlencode

import numpy as np

from diagnostics.judging.judgement import BOOSTING, TITLES
from diagnostics.judging.of_split import Training
from diagnostics.page.blocks import Cell, TableBlock
from diagnostics.page.wording import counted
from diagnostics.statistics.evaluation import Interval


def records_link(**chosen: object) -> str:
    """Return where this page shows records that fit, such as `#state=severe`.

    Parameters
    ----------
    chosen
        What its records have to be: `record`, `state`, `predicted`, `split`, `named` ...; `indicator` is shown of them.
    """
    return f"#{urlencode({name: str(value) for name, value in chosen.items()}, quote_via=quote)}"


def linked_cell(cell: Cell, **chosen: object) -> Cell:
    """Return a cell that leads to the records behind it."""
    return replace(cell, link=records_link(**chosen))


def state_links(states: Iterable[str]) -> dict[str, str]:
    """Return where the records of every state are, by its name."""
    return {name: records_link(state=name) for name in states}


def indicator_links(titles: Mapping[str, str]) -> dict[str, str]:
    """Return where records are shown over each of these columns, by its title; titles come by column."""
    return {title: records_link(indicator=column) for column, title in titles.items()}


def set_table(labels: dict[str, np.ndarray], classes: tuple[str, ...]) -> TableBlock:
    """Return records by state and split, and specimens by split; counts lead to their records."""
    splits = [name for name in ("train", "validation", "test") if (labels["split"] == name).any()]
    rows = [
        [
            Cell(state),
            *(
                linked_cell(cell, state=state, split=name) if count else cell
                for name in splits
                for count in (int(((labels["state"] == state) & (labels["split"] == name)).sum()),)
                for cell in (Cell(str(count), value=float(count)),)
            ),
        ]
        for state in classes
    ]
    count = [np.unique(labels["specimen_id"][labels["split"] == name]).size for name in splits]
    rows.append([Cell("specimens (gearboxes)"), *(Cell(str(number)) for number in count)])
    return TableBlock(["State", *splits], rows, caption="Records by state and split, and gearboxes by split.")


def score_table(training: Training) -> TableBlock:
    """Return accuracy and macro-AUROC of every classifier with intervals, and its permutation control."""
    rows = []
    for judged in training.judged:
        permuted = float(judged.permuted_auroc.mean()) if judged.permuted_auroc.size else math.nan
        rows.append(
            [
                Cell(TITLES[judged.name], _details(judged.name, judged.details)),
                interval_cell(judged.scores.accuracy),
                interval_cell(judged.scores.macro_auroc),
                Cell(f"{permuted:.2f}" if math.isfinite(permuted) else "–", value=permuted),
            ]
        )
    specimens = counted(training.judged[0].scores.specimens, "test specimen")
    caption = (
        f"Scores on {specimens}, with 95 % limits from resampled specimens. Last column: mean macro-AUROC after "
        "training on permuted labels."
    )
    head = ["Classifier", "Accuracy [-]", "Macro-AUROC [-]", "Permuted labels [-]"]
    return TableBlock(head, rows, caption=caption, sortable=True)


def calibration_table(training: Training) -> TableBlock:
    """Return what the probabilities of every classifier are worth without and with its temperature."""
    rows = [
        [
            Cell(TITLES[judged.name]),
            Cell(f"{found.temperature:.2f}", value=found.temperature),
            *(interval_cell(each) for each in (found.brier_before, found.brier, found.before, found.after)),
            Cell(f"{found.honest:.2f}", value=found.honest),
        ]
        for judged in training.judged
        for found in (judged.calibration,)
    ]
    scores, classes = ("Brier score", "Calibration error"), len(training.judged[0].scores.classes)
    head = [
        *("Classifier", "T [-]"),
        *(f"{score}, {which} T [-]" for score in scores for which in ("without", "with")),
        "Calibration error if true [-]",
    ]
    caption = (
        "Probabilities on test specimens without and with the temperature T, with 95 % limits. T comes from validation "
        "specimens. It is 1 where it does not help validation specimens that are left out of its fit. The best Brier "
        f"score is 0; equal probabilities for all classes give {1.0 - 1.0 / classes:.2f}. Chance alone makes the "
        "expected calibration error positive. The last column is its value if these probabilities (with T) were true."
    )
    return TableBlock(head, rows, caption=caption, sortable=True)


def _details(name: str, details: dict[str, Any]) -> str:
    if "strength" in details:
        return f"{counted(details['features'], 'feature')}, {strength_text(name, details['strength'])}"
    return f"averaged revolutions, epoch {details['best_epoch']} of {details['epochs']}"


def strength_text(name: str, strength: float) -> str:
    """Return what was chosen on validation specimens."""
    return f"{strength:g} rounds" if name == BOOSTING else f"C = {strength:g}"


def interval_cell(found: Interval, *, sign: bool = False) -> Cell:
    """Return a value with its limits in small print."""
    form = "+.2f" if sign else ".2f"
    if not math.isfinite(found.value):
        return Cell("undefined", value=math.nan)
    limits = "" if math.isnan(found.low) else f"{found.low:{form}} … {found.high:{form}}"
    return Cell(f"{found.value:{form}}", limits, found.value)
