"""The page of a report: the answer first, then what limits it, then everything else in sections that links lead to.

What classifiers say of test records: confusion matrices, and records named wrongly, with links to the explorer.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.page import html, tables
from diagnostics.page.html import Cell, table
from diagnostics.page.provenance import origin_sentence, provenance
from diagnostics.page.tables import explorer_link, records_line, state_links
from diagnostics.page.wording import capitalised, counted
from diagnostics.records.state_classes import CLASS, ordered_states
from diagnostics.report.answer import answer_sentences
from diagnostics.report.comparison_tables import score_blocks, study_blocks
from diagnostics.report.confusion import confusion_table
from diagnostics.report.detector_table import detection_blocks, detector_table
from diagnostics.report.drawing import Drawing
from diagnostics.report.indicator_figures import term_cell
from diagnostics.report.indicator_tables import definition_html
from diagnostics.report.nested_tables import nested_blocks
from diagnostics.report.sentences import (
    area_sentence,
    comparison_sentence,
    indicator_sentences,
    scores_sentence,
    trust_sentence,
)
from diagnostics.report.your_scores import your_scores
from diagnostics.scoring.score import Scores
from diagnostics.statistics.judgement import TITLES
from diagnostics.statistics.separability import Separability
from diagnostics.training.detectors import Detectors
from diagnostics.training.realism import is_error_free, meaning_of_scores
from diagnostics.training.studies import Studies
from diagnostics.training.training import Training
from siggen.dataset.reading import Dataset

MOST_RECORDS = 100
"""Rows of the table of wrongly named records."""

ANSWER = "answer"
MOST_SHOWN = 500
"""Features in the table: all of two channels; a page of six would be twice as large with all."""
CAPTION = (
    "Black, chosen: each gearbox judged by the detector that is best on others. Above: AUC of healthy against each "
    "state, with 95 % limits of the black one; 0.5 is chance. Lines are dashed by kind of damage, as its name is "
    "underlined below. Below: from the point on (broad), nine of ten records are found; thin: 95 % limits; cross: not "
    "even at the largest size. All limits stand under Detectors."
)


def wrong_records_table(training: Training, matrix: FeatureMatrix, explorer: str = "") -> str:
    """Return the test records that some classifier names wrongly, with what each says; nothing where none does."""
    labels = matrix.rows(training.split.test).labels
    said = {found.name: np.array(found.predictions.classes)[found.predictions.predicted] for found in training.judged}
    wrong = np.stack([names != labels[CLASS] for names in said.values()])
    rows = np.flatnonzero(wrong.any(axis=0))
    if not rows.size:
        return ""
    order = rows[np.argsort(-wrong[:, rows].sum(axis=0), kind="stable")][:MOST_RECORDS]
    true = f"True {training.split.kind}"
    head = ["Record", "Gearbox", "Area [mm²]", true, *(capitalised(TITLES[name]) for name in said)]
    left = f" The first {MOST_RECORDS} are shown." if rows.size > MOST_RECORDS else ""
    caption = (
        f"{counted(int(rows.size), 'test record')} of {labels[CLASS].size} that some classifier names wrongly "
        f"(shaded), those that most name wrongly first.{left}"
    )
    return table(
        head, [_record(labels, row, said, explorer) for row in order], caption=caption, sortable=True, tall=True
    )


def _record(labels: dict[str, np.ndarray], row: int, said: dict[str, np.ndarray], explorer: str) -> list[Cell]:
    number, area = int(labels["record_id"][row]), float(labels["damaged_area_mm2"][row])
    link = explorer_link(explorer, record=number)
    return [
        Cell(str(number), value=float(number), link=link, hint="open in the explorer" if link else ""),
        Cell(str(labels["specimen_id"][row]), value=float(labels["specimen_id"][row])),
        Cell(f"{area:.3g}", value=area),
        Cell(str(labels[CLASS][row])),
        *(Cell(str(names[row]), shade=0.3 if names[row] != labels[CLASS][row] else None) for names in said.values()),
    ]


@dataclass(frozen=True, slots=True)
class Reported:
    """Everything that the page is made of."""

    dataset: Dataset
    seed: int
    matrix: FeatureMatrix
    training: Training | None
    studies: Studies | None
    found: list[Separability]
    detectors: Detectors
    audit: str
    drawing: Drawing
    explorer: str = ""
    yours: Scores | None = None


def report_page(reported: Reported, pictures: Mapping[str, tuple[bytes, str]]) -> str:
    """Return the page.

    Parameters
    ----------
    reported : Reported
    pictures : mapping of str to (bytes, str)
        PNG and caption by name, of all figures of the drawing, and of the answer under its own name.
    """
    title = f"Diagnostics of {reported.dataset.path.name}"
    sections = {name: blocks for name, blocks in _sections(reported, pictures).items() if blocks}
    parts = [part for name, blocks in sections.items() for part in (html.heading(name), *blocks)]
    return html.page(
        title,
        [
            html.heading(title, 1),
            html.paragraph(origin_sentence(reported.dataset)),
            _answer(reported, pictures),
            html.contents(parts),
            *parts,
        ],
    )


def _answer(reported: Reported, pictures: Mapping[str, tuple[bytes, str]]) -> str:
    states = next((tuple(one.states) for one in reported.detectors.alone.values()), ())
    behind = records_line("Records", state_links(reported.explorer, states))
    figure = html.figure_block(*pictures[ANSWER], behind) if ANSWER in pictures else ""
    error_free = is_error_free(reported.dataset.config)
    return html.answer(answer_sentences(reported.detectors, error_free=error_free), figure)


def _sections(reported: Reported, pictures: Mapping[str, tuple[bytes, str]]) -> dict[str, list[str]]:
    """Return the blocks of every section by its title; a section without blocks is left out."""
    drawing, training = reported.drawing, reported.training

    def grid(names: Mapping[str, Any]) -> str:
        return html.figure_grid([html.figure_block(*pictures[name], drawing.behind.get(name, "")) for name in names])

    labels = reported.matrix.labels
    notes = [*drawing.notes, "Shaft angles come from the once-per-revolution pulses."]
    notes.append(provenance(reported.dataset, reported.seed))
    return {
        "What limits the answer": _limits(reported),
        "Detectors": [detector_table(reported.detectors, reported.explorer)] if reported.detectors.alone else [],
        "Records": [*_explore(reported.explorer), tables.set_table(labels, ordered_states(labels), reported.explorer)],
        "Scores": [*_scores(training), grid(drawing.scores)],
        "Your predictions": your_scores(reported.yours),
        "Records named wrongly": _named(reported),
        "Splits and training specimens": [*study_blocks(reported.studies), grid(drawing.studies)] if training else [],
        "Indicators": [*_indicators(reported), grid(drawing.indicators)],
        "Signals": [grid(drawing.vibration)],
        "Damage": [grid(drawing.damage)],
        "Definitions of the indicators": [definition_html({channel.quantity for channel in reported.dataset.channels})],
        "Notes": html.notes(notes),
    }


def _explore(explorer: str) -> list[str]:
    """Return the link to the page on which records are looked at, or how to have it."""
    if not explorer:
        return [
            html.paragraph("`siggen-diagnostics report DIR --explore` adds a page on which every record can be seen.")
        ]
    return [f"<p>{html.link('Look at the records: signals, spectra, flanks and indicators', explorer)}</p>"]


def _limits(reported: Reported) -> list[str]:
    """Return what scores mean here, how far gearboxes and controls carry, what is hardest, and what the audit says."""
    trained = reported.training
    sentences = [meaning_of_scores(reported.dataset.config, scored=trained is not None)]
    sentences += [trust_sentence(trained)] if trained else []
    sentences += [*indicator_sentences(reported.found), reported.audit]
    return [html.paragraph(sentence) for sentence in sentences]


def _scores(training: Training | None) -> list[str]:
    if training is None:
        return [html.paragraph("No classifier was trained. The notes give the reason.")]
    return [
        html.paragraph(scores_sentence(training)),
        html.paragraph(comparison_sentence(training)),
        tables.score_table(training),
        tables.calibration_table(training),
        *detection_blocks(training),
        *score_blocks(training),
        *nested_blocks(training.nested, training.split.kind),
    ]


def _named(reported: Reported) -> list[str]:
    """Return confusion matrices and wrongly named records; the explorer shows what the first classifier names."""
    training, explorer = reported.training, reported.explorer
    if training is None:
        return []
    matrices = [
        confusion_table(found.scores, TITLES[found.name], explorer="" if place else explorer, kind=training.split.kind)
        for place, found in enumerate(training.judged)
    ]
    wrong = wrong_records_table(training, reported.matrix, explorer)
    return [html.figure_grid([f"<div>{matrix}</div>" for matrix in matrices]), *([wrong] if wrong else [])]


def _indicators(reported: Reported) -> list[str]:
    found = reported.found
    shown = found[:MOST_SHOWN]
    has = f"all {counted(len(found), 'feature')}"
    if len(shown) < len(found):
        has = f"the {len(shown)} strongest of {counted(len(found), 'feature')} (all: separability.csv)"
    text = (
        f"The table has {has} on all specimens. Nothing is trained here, so no "
        "specimen is held out. An AUC of 0.5 means no separation; 0 and 1 mean a perfect one."
    )
    return [
        html.paragraph(" ".join([*area_sentence(found), text])),
        tables.separability_html(shown, term_cell, reported.explorer),
    ]
