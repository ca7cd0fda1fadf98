"""The report of a set: features, training, figures, metrics and one page that says what it all means."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa

from diagnostics.base.extras import missing_packages, require_packages
from diagnostics.base.process_pool import second_process
from diagnostics.base.progress import Stage, silent_stage
from diagnostics.base.single_thread import single_thread
from diagnostics.explore.look import Look
from diagnostics.explore.set_page import LIMIT, LookOptions, set_look
from diagnostics.indicators.classifier_table import feature_matrix, table_settings, with_kinds, write_table
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.own_indicator import OwnIndicator
from diagnostics.indicators.ranking_table import IndicatorTable, ranking_table
from diagnostics.indicators.table import RecordTable
from diagnostics.judging.alarms import Detectors, judged_detectors, with_networks
from diagnostics.judging.of_split import NetworkOptions, Training, train_models, training_metrics
from diagnostics.judging.sets import OtherSet, checked_table, measured_table, other_table
from diagnostics.page.provenance import without_path
from diagnostics.page.style import png_bytes, styled
from diagnostics.page.template import write_page
from diagnostics.page.wording import counted
from diagnostics.prediction.model_facts import FACTS_FILE
from diagnostics.prediction.released_model import written_model
from diagnostics.prediction.saved_models import save_models
from diagnostics.records.channel_quantities import channel_quantities
from diagnostics.records.record_classes import set_classes
from diagnostics.records.state_classes import ordered_states
from diagnostics.report.answer import ANSWERS, answer_figure, answer_sentences, first_figure
from diagnostics.report.audit_words import audit_beside, audit_sentence
from diagnostics.report.drawing import draw, example_set, reported_gearboxes
from diagnostics.report.indicators import Evaluated, evaluated, figures, hardest_sentence, own_ranks, write_evaluation
from diagnostics.report.report_page import ANSWER, CAPTION, FIRST, Reported, report_page
from diagnostics.report.sentences import comparison_sentence, scores_sentence, trust_sentence
from diagnostics.scoring.score import Scores, score
from diagnostics.statistics.indicator_statistics import AssessmentSettings, Separability, by_strength
from diagnostics.training.realism import is_error_free, meaning_of_scores
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError, how_to_install
from siggen.file_writing import write_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True)
class PageOptions:
    """What a report holds besides its judgement.

    Attributes
    ----------
    predictions : Path, optional
        The user's predictions, which get a row beside the classifiers.
    states : sequence of str
        Damaged states that features are judged on; all where empty.
    limit, full : int, bool
        Of how many records the page holds the signals, and whether with every sample.
    workers : int
        Processes that take indicators; with more than one, indicators are judged while classifiers learn.
    """

    predictions: Path | None = None
    states: Sequence[str] = ()
    limit: int = LIMIT
    full: bool = False
    workers: int = 1


ALL_RECORDS = PageOptions()


@single_thread()
def write_report(
    dataset: Dataset,
    folder: Path,
    seed: int,
    *,
    network: NetworkOptions | None = None,
    other: Any = None,
    own: Sequence[OwnIndicator] = (),
    page: PageOptions = ALL_RECORDS,
    stage: Stage = silent_stage,
) -> Path:
    """Compute everything and write `report.html`, `metrics.json`, tables, figures and models; return the page's path.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    folder : Path
        Created where missing; files of an earlier report are replaced.
    seed : int
        Seeds bootstrap, permutations and network.
    network : NetworkOptions, optional
        What a class is, whether and how to train the network; without torch the
        network is left out with a note.
    other : siggen Dataset, optional
        Another set to judge on.
    own : sequence of OwnIndicator
        The user's indicators.
    page : PageOptions
    stage : Stage
        Told of every step.

    Raises
    ------
    UsageError
        If matplotlib or scikit-learn are missing, or predictions cannot be used.
    """
    require_packages("the report", "matplotlib", "sklearn", "skops")
    network = network or NetworkOptions()
    _scored(dataset, page, None, network)  # what is wrong with predictions is said before minutes have passed
    with second_process(worth=page.workers > 1, first=_nothing) as begin:
        records = measured_table(dataset, stage, own=own, workers=page.workers)
        table = checked_table(records, dataset)
        second = other_table(other, stage, own) if other is not None else None
        matrix = with_kinds(feature_matrix(table, set_classes(dataset, network.classes)), dataset)
        ranked = ranking_table(records, dataset, states=page.states, leave_out=True)
        evaluation = begin(_evaluated, ranked, AssessmentSettings(seed=seed))
        on_indicators = begin(judged_detectors, matrix, seed, dataset)
        training, notes = _trained(dataset, table, folder / "models", seed, network, second, stage)
        with stage("evaluation", 2) as advance:
            judged = evaluation()
            advance()
            detectors = on_indicators()
            advance()
    if training is not None:
        detectors = with_networks(detectors, matrix, training, seed)
    known = set(matrix.names)
    separabilities = by_strength(result.separability for result in judged.results if result.column in known)
    classes = ordered_states(matrix.labels)
    with stage("figures", 1) as advance, styled():
        drawing = draw(dataset, matrix, classes, training)
        opening = _opening(dataset, matrix, classes, detectors)
        in_detail = figures(judged, channel_quantities(dataset))
        advance()
    drawing.notes += [*notes, *clipping_notes(dataset), *undefined_notes(table)]
    write_table(table, folder / "features.parquet")
    write_evaluation(dataset, judged, folder)
    audit = audit_sentence(dataset, audit_beside(dataset))
    answer = answer_sentences(detectors, error_free=is_error_free(dataset.config))
    meaning = meaning_of_scores(dataset.config, scored=training is not None)
    told = [scores_sentence(training), comparison_sentence(training), trust_sentence(training)] if training else []
    sentences = [*(text for _, text in answer), meaning, *told, hardest_sentence(judged), audit]
    metrics = report_metrics(dataset, table, seed, sentences, training, separabilities, drawing.notes)
    metrics["headline"] = " ".join([*own_ranks(judged), ANSWERS.first_answer(detectors).replace("**", "")])
    metrics["detectors"] = {
        side: {family: detector.numbers() for family, detector in getattr(detectors, side).items()}
        for side in ("alone", "referenced")
    }
    yours = _scored(dataset, page, folder if training else None, network)
    metrics["yours"] = yours.numbers() if yours else None
    write_file(folder / "metrics.json", json.dumps(metrics, indent=1, allow_nan=False) + "\n")
    look = _look(dataset, records, judged, folder / "models" if training else None, page, own, stage)
    reported = Reported(dataset, seed, matrix, training, separabilities, detectors, audit, drawing, judged, look, yours)
    path = folder / "report.html"
    with stage("page", 1):
        drawn = {**opening, **drawing.figures(), **in_detail}
        pictures = _write_pictures(folder, drawn)
        write_page(path, report_page(reported, pictures))
    return path


def _nothing() -> None:
    """Take no time behind the import of this module, which another process does with it."""


@single_thread()
def _evaluated(table: IndicatorTable, settings: AssessmentSettings) -> Evaluated:
    """Return how every feature separates damage."""
    return evaluated(table, settings)


def _opening(
    dataset: Dataset, matrix: FeatureMatrix, classes: tuple[str, ...], detectors: Detectors
) -> dict[str, tuple[Figure, str]]:
    """Return the figures that open the page: spectra by size, and all detectors."""
    examples = example_set(dataset)
    first, every = first_figure(examples, matrix, classes, detectors.strongest), answer_figure(detectors)
    shown = {FIRST: (first, ANSWERS.spectra(examples)), ANSWER: (every, CAPTION)}
    return {name: (figure, text) for name, (figure, text) in shown.items() if figure is not None}


def _look(
    dataset: Dataset,
    records: RecordTable,
    judged: Evaluated,
    models: Path | None,
    page: PageOptions,
    own: Sequence[OwnIndicator],
    stage: Stage,
) -> Look:
    """Return the records on the page, with what the first classifier names them; those of its figures come first."""
    known = written_model(models, own) if models is not None and (models / FACTS_FILE).is_file() else None
    options = LookOptions(
        *(page.limit, page.full),
        model=known,
        own=own,
        first=reported_gearboxes(dataset),
        ranked=[result.column for result in judged.shown],
    )
    return set_look(dataset, options, stage, table=records)


def _scored(dataset: Dataset, page: PageOptions, models: Path | None, options: NetworkOptions) -> Scores | None:
    """Return the scores of the user's predictions beside those of the models in a folder; None without predictions."""
    if page.predictions is None:
        return None
    return score(dataset, page.predictions, baselines=models, classes=options.classes)


def _write_pictures(folder: Path, figures: dict[str, tuple[Figure, str]]) -> dict[str, tuple[bytes, str]]:
    """Write all figures and return them with their captions."""
    pictures = {name: (png_bytes(figure), caption) for name, (figure, caption) in figures.items()}
    for name, (png, _) in pictures.items():
        write_file(folder / "figures" / f"{name}.png", png)
    return pictures


def _trained(
    dataset: Dataset,
    table: pa.Table,
    folder: Path,
    seed: int,
    options: NetworkOptions,
    other: OtherSet | None,
    stage: Stage,
) -> tuple[Training | None, list[str]]:
    """Train what the set allows; what it does not allow becomes a note, since the rest of the report stands."""
    notes = []
    missing = missing_packages("torch", "safetensors") if options.cnn else ()
    if missing:
        notes.append(f"No network: {', '.join(missing)} is not installed: {how_to_install('cnn')}.")
    if not options.cnn:
        notes.append("The networks were left out (--no-cnn). The same command without it trains and judges them.")
    for with_network in dict.fromkeys((options.cnn and not missing, False)):
        try:
            chosen = replace(options, cnn=with_network)
            training = train_models(dataset, table, seed, network=chosen, other=other, stage=stage)
        except DatasetError as error:
            notes.append(f"{'No network' if with_network else 'No classifier'}: {without_path(error, dataset)}")
            continue
        with stage("saving the models", 1):
            saved = save_models(training, table, dataset, folder)
        return training, [*dict.fromkeys(notes), *training.notes, *saved]
    return None, notes[-1:]


def undefined_notes(table: pa.Table) -> list[str]:
    """Return how often each reason for undefined indicators occurs."""
    reasons, counts = np.unique([note for note in table.column("notes").to_pylist() if note], return_counts=True)
    records = counted(table.num_rows, "record")
    return [f"{count} of {records}: {reason}." for reason, count in zip(reasons, counts, strict=True)]


def clipping_notes(dataset: Dataset) -> list[str]:
    """Return how many records each channel clips: their spectra carry lines that no gear made."""
    notes = []
    for channel in dataset.channels:
        name = f"clipped_share_{channel.name}"
        share = np.array(dataset.labels(columns=[name]).column(name).to_pylist(), dtype=np.float64)
        if (share > 0).any():
            notes.append(
                f"Channel {channel.name} clips in {int((share > 0).sum())} of {counted(share.size, 'record')}, in up "
                f"to {share.max():.1%} of the samples. Clipping adds lines to the spectra that no gear makes."
            )
    return notes


def report_metrics(
    dataset: Dataset,
    table: pa.Table,
    seed: int,
    sentences: list[str],
    training: Training | None,
    separabilities: list[Separability],
    notes: list[str],
) -> dict[str, Any]:
    """Return the content of `metrics.json`; undefined numbers are null."""
    settings = table_settings(table)
    return {
        "set": dataset.path.name,
        "identity": dataset.manifest["identity"],
        "records": table.num_rows,
        "seed": seed,
        "summary": sentences,
        "notes": notes,
        "feature_settings": {name: getattr(settings, name) for name in type(settings).__dataclass_fields__},
        "training": training_metrics(training) if training else None,
        "separability": {"specimens": "all", "features": [_entry(entry) for entry in separabilities]},
    }


def _entry(entry: Separability) -> dict[str, Any]:
    return {
        "feature": entry.feature,
        "auc": {state: area.numbers() for state, area in entry.auc.items()},
        "spearman_damaged_area": entry.spearman.numbers(),
        "defined_share": entry.defined_share if math.isfinite(entry.defined_share) else None,
    }
