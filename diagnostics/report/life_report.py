"""The report of a set of gearboxes that run to failure: how well baselines tell their remaining life."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa

from diagnostics.audit.life_leaks import Leak, life_leaks
from diagnostics.base.extras import missing_packages, require_packages
from diagnostics.base.progress import Stage, silent_stage
from diagnostics.base.single_thread import single_thread
from diagnostics.explore.look import Look
from diagnostics.explore.set_page import LookOptions, set_look
from diagnostics.page import html
from diagnostics.page.html import Cell
from diagnostics.page.provenance import origin_sentence, provenance
from diagnostics.page.wording import capitalised, counted
from diagnostics.report.life_detection import detection_table, life_block, shown_gearboxes
from diagnostics.report.life_pictures import lives_of
from diagnostics.report.unit_lives import PICTURES, FailureDetection, detections, unit_lives, watches
from diagnostics.scoring.prediction_file import CLASSIFIER, RECORD, SPLIT, write_predictions
from diagnostics.scoring.remaining_life import COLUMNS
from diagnostics.statistics.evaluation import Interval
from diagnostics.statistics.life_scores import BINS, QUANTILES, LifeScores, life_scores
from diagnostics.training.life_baselines import (
    AGE,
    AREAS,
    CONSTANT,
    FOLDS,
    OUTLOOK,
    Inspections,
    baseline_predictions,
)
from diagnostics.training.life_rows import INDICATORS, inspections
from siggen.dataset.reading import Dataset
from siggen.errors import how_to_install
from siggen.file_writing import write_file

PAGE = "report.html"
KNOWN = (CONSTANT, AGE, AREAS, OUTLOOK)
"""Rows that no sensor is behind."""
RESERVATION = "All lives are simulated, by a law whose parameters were published for one test bench."


@single_thread()
def write_life_report(
    dataset: Dataset,
    folder: Path,
    seed: int,
    stage: Stage = silent_stage,
    *,
    network: bool = True,
    amount: LookOptions | None = None,
) -> Path:
    """Write `report.html`, `metrics.json` and `predictions.parquet`; return the page's path.

    The network is trained where it is wanted and PyTorch is installed. `amount` says how many records the page holds.

    Raises
    ------
    UsageError
        If scikit-learn is missing.
    DatasetError
        If fewer than four gearboxes failed.
    """
    require_packages("the report", "sklearn", "matplotlib")
    found = inspections(dataset, stage)
    with stage("baselines", 1) as advance:
        left_out = _left_out(found, wanted=network)
        predicted = baseline_predictions(found, seed, network=not left_out)
        leaks = life_leaks(found, seed)
        advance()
    seen = watches(found)
    scores = {
        name: life_scores(found.rul_h, values, found.specimen, found.median_life_h, seed)
        for name, values in predicted.items()
    }
    baselines = {name: one.numbers() for name, one in scores.items()}
    metrics = {"seed": seed, **_facts(found), "baselines": baselines, "leaks": [leak.numbers() for leak in leaks]}
    detected = detections(found, seen)
    metrics["first_detection"] = {name: one.numbers() for name, one in detected.items()}
    text = json.dumps(metrics, indent=1, allow_nan=False)
    write_file(folder / "metrics.json", f"{text}\n")
    identity = str(dataset.manifest["identity"])
    write_predictions([_predicted_rows(name, found, values) for name, values in predicted.items()], identity, folder)
    page = folder / PAGE
    first, *lives = unit_lives(dataset, found, seen, predicted, shown_gearboxes(found)).values()
    look = set_look(dataset, amount or LookOptions(), stage, lives_of)
    parts = [
        *(html.heading("Records"), look.block, html.heading("Remaining life")),
        *(html.paragraph(sentence) for sentence in (*_sentences(found), _verdict(leaks))),
        *html.notes([left_out] if left_out else []),
        *(_errors(found, scores), _quantiles(scores), html.heading("First detection"), detection_table(detected)),
        *(html.figure_grid([life_block(one) for one in lives]), html.heading("Leaks"), _leaks(leaks)),
    ]
    opening = html.answer(_answer(found, scores, detected), life_block(first))
    write_file(page, _page(dataset, seed, opening, parts, look))
    return page


def _left_out(found: Inspections, *, wanted: bool) -> str:
    """Return why no network is trained, or an empty text."""
    if not wanted:
        return "No sequence network: --no-cnn."
    if missing_packages("torch"):
        return f"No sequence network: PyTorch is not installed: {how_to_install('cnn')}."
    return "" if found.averages else "No sequence network: records hold fewer than two whole turns of the first shaft."


def _predicted_rows(name: str, found: Inspections, predicted_h: np.ndarray) -> pa.Table:
    """Return what a baseline says of the inspections of all splits; lives are never below 0."""
    quantiles = dict(zip(COLUMNS, np.maximum(predicted_h, 0.0).T, strict=True))
    names = {CLASSIFIER: [name] * found.record_id.size, SPLIT: found.split}
    return pa.table({**names, RECORD: pa.array(found.record_id, pa.int64()), **quantiles})


def _facts(found: Inspections) -> dict[str, object]:
    """Return what the scores were taken of."""
    known, third = np.isfinite(found.rul_h), found.median_life_h / BINS
    return {
        "gearboxes_judged": int(np.unique(found.specimen[known]).size),
        "gearboxes_suspended": int(np.unique(found.specimen[~known]).size),
        "inspections_judged": int(known.sum()),
        "median_life_h": found.median_life_h,
        "bins_h": [[0.0, third], [third, 2.0 * third], [2.0 * third, None]],
    }


def _page(dataset: Dataset, seed: int, opening: str, parts: Sequence[str], look: Look) -> str:
    title = f"Remaining life of {dataset.path.name}"
    whole = [
        html.heading(title, 1),
        html.paragraph(f"{origin_sentence(dataset)} {RESERVATION}"),
        *(opening, html.contents(parts), *parts),
        html.paragraph(provenance(dataset, seed), "caption"),
    ]
    return html.page(title, whole, look.live)


def _answer(
    found: Inspections, scores: Mapping[str, LifeScores], detected: Mapping[str, FailureDetection]
) -> list[tuple[str, str]]:
    """Say which baseline tells remaining lives best, when damage is seen, and how sure that is."""
    sensed = {name: one for name, one in scores.items() if name not in KNOWN}
    best = min(sensed, key=lambda name: sensed[name].mae_h[0].value)
    error, by_age = sensed[best].mae_h[0], scores[AGE].mae_h[0]
    seen = max(detected, key=lambda name: (name != PICTURES, detected[name].detected))
    watch = detected[seen]
    facts = _facts(found)
    return [
        (
            "What is found",
            f"**{capitalised(best)}** tell the remaining life to **{error.value:.0f} h** on average, age alone to "
            f"{by_age.value:.0f} h; half of the gearboxes ran for {found.median_life_h:.0f} h. **{capitalised(seen)}** "
            f"show pitting first in {watch.detected} of {watch.gearboxes}, when it covers "
            f"**{100.0 * watch.share:.2g} % of the worst tooth**.",
        ),
        (
            "How sure",
            f"Judged on **{facts['gearboxes_judged']} gearboxes that failed**, each by what was trained on others; "
            f"95 % limits of the error: {error.low:.0f} to {error.high:.0f} h.",
        ),
    ]


def _sentences(found: Inspections) -> list[str]:
    facts = _facts(found)
    judged, taken_out = facts["gearboxes_judged"], facts["gearboxes_suspended"]
    return [
        f"Judged are {counted(int(found.rul_h[np.isfinite(found.rul_h)].size), 'inspection')} of {judged} gearboxes "
        f"that failed. {taken_out} suspended ones have no known remaining life: no error is taken of them, and the "
        f"law of age knows them as at least as long. Half of the failed ones ran for {found.median_life_h:.3g} h.",
        f"Every gearbox is predicted by baselines that were trained on others ({FOLDS} folds). Five indicators: "
        f"{', '.join(INDICATORS)}, of every channel and gear. The last two rows know what no sensor tells.",
    ]


def _errors(found: Inspections, scores: Mapping[str, LifeScores]) -> str:
    third = found.median_life_h / BINS
    bins = ("all", f"below {third:.3g} h", f"{third:.3g} to {2 * third:.3g} h", f"from {2 * third:.3g} h")
    rows = [[Cell(name), *map(_hours, (*one.rmse_h, *one.mae_h))] for name, one in scores.items()]
    head = ["What is known", *(f"{error} [h], {each}" for error in ("RMSE", "MAE") for each in bins)]
    caption = (
        "Error of the predicted median, of all inspections and by true remaining life, with 95 % limits from resampled "
        "gearboxes."
    )
    return html.table(head, rows, caption=caption)


def _quantiles(scores: Mapping[str, LifeScores]) -> str:
    rows = [
        [
            Cell(name),
            *(Cell(f"{loss:.2f}", value=loss) for loss in one.pinball_h),
            _hours(one.coverage, ".2f"),
            Cell(f"{one.nasa:.1f}", value=one.nasa),
        ]
        for name, one in scores.items()
    ]
    head = [
        "What is known",
        *(f"Pinball loss [h], {q:g}" for q in QUANTILES),
        "Coverage of 80 % intervals [-]",
        "NASA score, mean [-]",
    ]
    caption = (
        "Predicted quantiles. NASA score: mean over all inspections of exp(-d/13) - 1 for early and exp(d/10) - 1 for "
        "late predictions; d in units of median life / 200, and at most 60."
    )
    return html.table(head, rows, caption=caption)


def _verdict(leaks: Sequence[Leak]) -> str:
    """Return whether the set tells lives by what should tell nothing."""
    found = [leak.clue for leak in leaks if leak.found]
    if not found:
        return (
            "What should tell nothing (numbers, identities, hours between inspections, bytes) tells no more than age."
        )
    return f"A trap: beside age, {' and '.join(found)} tells the remaining life. Scores on this set mean little."


def _leaks(leaks: Sequence[Leak]) -> str:
    rows = [
        [
            Cell(leak.clue),
            Cell(f"{leak.age_rmse_h - leak.gain_h:.1f}", value=leak.age_rmse_h - leak.gain_h),
            Cell(f"{leak.gain_h:.1f}", f"at least {leak.least_gain_h:.1f}", leak.gain_h),
            Cell("leaks" if leak.found else "tells nothing"),
        ]
        for leak in leaks
    ]
    head = ["Beside age", "RMSE [h]", f"Lower than by age alone ({leaks[0].age_rmse_h:.1f} h) by [h]", "Verdict"]
    caption = (
        "What should tell nothing, learned by the same trees as age alone. Where nothing leaks, one report of twenty "
        "says that something does. Whole histories tell their length by their last inspection: cut them before you "
        "test."
    )
    return html.table(head, rows, caption=caption)


def _hours(found: Interval, form: str = ".1f") -> Cell:
    """Return a value with its limits in small print."""
    if not np.isfinite(found.value):
        return Cell("none", value=found.value)
    limits = "" if np.isnan(found.low) else f"{found.low:{form}} … {found.high:{form}}"
    return Cell(f"{found.value:{form}}", limits, found.value)
