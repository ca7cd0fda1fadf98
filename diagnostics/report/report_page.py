"""The page of a report: the answer first, then its records, then what limits it and everything else in sections.

What classifiers say of test records: confusion matrices, and records named wrongly, with links to the records.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from diagnostics.explore.look import Look
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.judging.alarms import Detectors
from diagnostics.judging.judgement import TITLES
from diagnostics.judging.of_split import Training
from diagnostics.page import tables
from diagnostics.page.blocks import (
    Block,
    Cell,
    ContentsLinks,
    FigureBlock,
    FigureGrid,
    FoldedBlocks,
    Heading,
    Opening,
    Page,
    Paragraph,
    RecordLinks,
    RecordsPlace,
    TableBlock,
    note_blocks,
)
from diagnostics.page.provenance import origin_sentence, provenance
from diagnostics.page.tables import cell, records_link, state_links, table
from diagnostics.page.wording import capitalised
from diagnostics.records.state_classes import CLASS, ordered_states
from diagnostics.report.answer import ANSWERS, answer_sentences
from diagnostics.report.classifier_tables import (
    calibration_table,
    confusion_table,
    detection_blocks,
    detector_table,
    nested_blocks,
    score_blocks,
    score_table,
    your_scores,
)
from diagnostics.report.drawing import Drawing
from diagnostics.report.indicators import (
    Evaluated,
    detail_blocks,
    evaluation_notes,
    hardest_sentence,
    own_ranks,
    ranking_blocks,
    term_table,
)
from diagnostics.report.sentences import (
    CLASSIFIERS,
    area_sentence,
    comparison_sentence,
    scores_sentence,
    trust_sentence,
)
from diagnostics.scoring.score import Scores
from diagnostics.statistics.indicator_statistics import Separability
from diagnostics.training.realism import is_error_free, meaning_of_scores
from siggen.dataset.reading import Dataset

MOST_RECORDS = 100
"""Rows of the table of wrongly named records."""

FIRST, ANSWER = "first", "answer"
"""Names of the figure that opens the page, and of that of all detectors."""
CAPTION = (
    "Black, chosen: each gearbox judged by the detector that is best on others. Above: AUC of healthy against each "
    "state, with 95 % limits of the black one; 0.5 is chance. Lines are dashed by kind of damage, as its name is "
    "underlined below. Below: from the point on (broad), nine of ten records are found; thin: 95 % limits; cross: not "
    "even at the largest size. All limits stand under Detectors."
)


def wrong_records_table(training: Training, matrix: FeatureMatrix) -> TableBlock:
    """Return the test records that some classifier names wrongly, with what each says; nothing where none does."""
    labels = matrix.rows(training.split.test).labels
    said = {
        judged.name: np.array(judged.predictions.classes)[judged.predictions.predicted] for judged in training.judged
    }
    wrong = np.stack([names != labels[CLASS] for names in said.values()])
    rows = np.flatnonzero(wrong.any(axis=0))
    order = rows[np.argsort(-wrong[:, rows].sum(axis=0), kind="stable")][:MOST_RECORDS]
    true = f"True {training.split.kind}"
    head = ["Record", "Gearbox", "Area [mm²]", true, *(capitalised(TITLES[name]) for name in said)]
    caption = CLASSIFIERS.named_wrongly(int(rows.size), labels[CLASS].size, MOST_RECORDS)
    return table(head, [_record(labels, row, said) for row in order], caption, sortable=True, tall=True)


def _record(labels: dict[str, np.ndarray], row: int, said: dict[str, np.ndarray]) -> list[object]:
    number, true = int(labels["record_id"][row]), labels[CLASS][row]
    return [
        Cell(str(number), value=float(number), link=records_link(record=number), hint="show this record"),
        *(labels["specimen_id"][row], cell(float(labels["damaged_area_mm2"][row]), ".3g"), true),
        *(Cell(str(names[row]), shade=0.3 if names[row] != true else None) for names in said.values()),
    ]


@dataclass(frozen=True, slots=True)
class Reported:
    """Everything that the page is made of."""

    dataset: Dataset
    seed: int
    matrix: FeatureMatrix
    training: Training | None
    separabilities: list[Separability]
    detectors: Detectors
    audit: str
    drawing: Drawing
    evaluated: Evaluated
    look: Look
    yours: Scores | None = None


def report_page(reported: Reported, pictures: Mapping[str, tuple[bytes, str]]) -> Page:
    """Return the page.

    Parameters
    ----------
    reported : Reported
    pictures : mapping of str to (bytes, str)
        PNG and caption by name, of all figures.
    """
    title = f"Diagnostics of {reported.dataset.path.name}"
    sections = {name: blocks for name, blocks in _sections(reported, pictures).items() if any(blocks)}
    parts = [part for name, blocks in sections.items() for part in (Heading(name), *blocks)]
    origin = Paragraph(origin_sentence(reported.dataset))
    whole = [Heading(title, 1), origin, _answer(reported, pictures), ContentsLinks(), *parts]
    return Page(title, whole, reported.look.live)


def _answer(reported: Reported, pictures: Mapping[str, tuple[bytes, str]]) -> Opening:
    detectors = reported.detectors
    states = next((tuple(one.states) for one in detectors.alone.values()), ())
    figure = next((pictures[name] for name in (FIRST, ANSWER) if name in pictures), None)
    shown = FigureBlock(*figure, RecordLinks("Records", state_links(states))) if figure else None
    sure = ANSWERS.first_certainty(detectors, error_free=is_error_free(reported.dataset.config), audit=reported.audit)
    ranks = own_ranks(reported.evaluated)
    asked = [("Your indicators" if len(ranks) > 1 else "Your indicator", " ".join(ranks))] if ranks else []
    said = [*asked, ("What is found", ANSWERS.first_answer(detectors)), ("How sure", sure)]
    return Opening(said, shown)


def _detectors(reported: Reported, pictures: Mapping[str, tuple[bytes, str]]) -> list[Block]:
    error_free = is_error_free(reported.dataset.config)
    figure = [FigureBlock(*pictures[ANSWER])] if {FIRST, ANSWER} <= set(pictures) else []
    table = [detector_table(reported.detectors)] if reported.detectors.alone else []
    told = answer_sentences(reported.detectors, error_free=error_free)
    said = [Paragraph(text, lead=f"{question}.") for question, text in told]
    return [*said, FigureGrid(figure), *table]


def _sections(reported: Reported, pictures: Mapping[str, tuple[bytes, str]]) -> dict[str, Sequence[Block]]:
    """Return the blocks of every section by its title; a section without blocks is left out."""
    drawing, training = reported.drawing, reported.training

    def grid(names: Mapping[str, Any]) -> FigureGrid:
        return FigureGrid([FigureBlock(*pictures[name], drawing.behind.get(name)) for name in names])

    labels = reported.matrix.labels
    notes = [*drawing.notes, *evaluation_notes(reported.dataset, reported.evaluated)]
    notes += ["Shaft angles come from the once-per-revolution pulses.", provenance(reported.dataset, reported.seed)]
    return {
        "Records": [RecordsPlace(), tables.set_table(labels, ordered_states(labels))],
        "Which damage is found": _detectors(reported, pictures),
        "What limits the answer": _limits(reported),
        "Features": _features(reported, pictures),
        "Scores": [*_scores(training), grid(drawing.scores)],
        "Your predictions": your_scores(reported.yours),
        "Records named wrongly": _named(reported),
        "Damage": [grid(drawing.damage)],
        "Definitions of the indicators": [term_table({channel.quantity for channel in reported.dataset.channels})],
        "Notes": note_blocks(list(dict.fromkeys(notes))),
    }


def _features(reported: Reported, pictures: Mapping[str, tuple[bytes, str]]) -> list[Block]:
    evaluated = reported.evaluated
    details = FoldedBlocks("The best features over severity and size", detail_blocks(evaluated, pictures))
    return [*ranking_blocks(reported.dataset, evaluated), details]


def _limits(reported: Reported) -> list[Block]:
    """Return what scores mean here, how far gearboxes and controls carry, what is hardest, and what the audit says."""
    trained = reported.training
    sentences = [meaning_of_scores(reported.dataset.config, scored=trained is not None)]
    sentences += [trust_sentence(trained)] if trained else []
    sentences += [hardest_sentence(reported.evaluated), area_sentence(reported.separabilities), reported.audit]
    return [Paragraph(sentence) for sentence in sentences if sentence]


def _scores(training: Training | None) -> list[Block]:
    if training is None:
        return [Paragraph("No classifier was trained. The notes give the reason.")]
    return [
        Paragraph(scores_sentence(training)),
        Paragraph(comparison_sentence(training)),
        score_table(training),
        calibration_table(training),
        *detection_blocks(training),
        *score_blocks(training),
        *nested_blocks(training.nested, training.split.kind),
    ]


def _named(reported: Reported) -> list[Block]:
    """Return confusion matrices and wrongly named records; the list of records has what the first classifier names."""
    training = reported.training
    if training is None:
        return []
    matrices = [
        confusion_table(judged.scores, TITLES[judged.name], kind=training.split.kind, linked=place == 0)
        for place, judged in enumerate(training.judged)
    ]
    wrong = wrong_records_table(training, reported.matrix)
    return [FigureGrid(matrices), wrong]
