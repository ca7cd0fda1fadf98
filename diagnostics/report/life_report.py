"""The report of gearboxes that run to failure: remaining life, when damage is first seen, pictures of lives."""

from __future__ import annotations

import base64
import io
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from diagnostics.audit.life_leaks import Leak, life_leaks
from diagnostics.base.extras import missing_packages, require_packages
from diagnostics.base.progress import Stage, silent_stage
from diagnostics.base.single_thread import single_thread
from diagnostics.explore.look import Look
from diagnostics.explore.set_page import Lives, LookOptions, set_look
from diagnostics.indicators.table import RecordTable
from diagnostics.page.blocks import (
    Block,
    Cell,
    ContentsLinks,
    FigureBlock,
    FigureGrid,
    Heading,
    Opening,
    Page,
    Paragraph,
    RecordsPlace,
    TableBlock,
    note_blocks,
)
from diagnostics.page.provenance import origin_sentence, provenance
from diagnostics.page.sentences import Sentences
from diagnostics.page.style import WIDTH_IN, png_bytes, styled
from diagnostics.page.tables import cell, table
from diagnostics.page.template import write_page
from diagnostics.scoring.prediction_file import CLASSIFIER, RECORD, SPLIT, write_predictions
from diagnostics.scoring.remaining_life import COLUMNS
from diagnostics.statistics.first_detection import IN_A_ROW, QUIET, Watch, rise, watched
from diagnostics.statistics.life_scores import BINS, QUANTILES, LifeScores, life_scores
from diagnostics.training.lives import (
    AGE,
    AREAS,
    CONSTANT,
    FOLDS,
    HISTORY,
    INDICATORS,
    OUTLOOK,
    Inspections,
    baseline_predictions,
    history_predictions,
    inspections,
    inspections_of,
)
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError, how_to_install
from siggen.file_writing import write_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_SHOWN = 5
HEIGHT_IN = 4.6
COLOURS = ("#1f6f8b", "#b01e3c", "#e3a21a", "#6a1b6e")
TRUTH_COLOUR, BAND_COLOUR, MARK_COLOUR = "#1c2733", "#8a97a3", "#5b6b7b"
LOWEST = 0.1
"""Of an index over its limit that is drawn; below it nothing is told apart."""


@dataclass(frozen=True, slots=True)
class FlankPicture:
    """The flank of the tooth that fails, as a camera saw it."""

    age_h: float
    share: float
    png: bytes


@dataclass(frozen=True, slots=True)
class UnitLife:
    """One gearbox at its inspections.

    Attributes
    ----------
    specimen : int
    age_h : (n,) float64
    watches : mapping of str to ((n,) float64, float)
        What shows damage: its index over its limit, and the age at which it is detected; NaN where it is not.
    marks_h : mapping of str to float
        Ages of its ends.
    pictures : sequence of FlankPicture
    end_h : float
        At which it fails, or would have.
    predicted_h : mapping of str to (n, 3) float64
        Quantiles of the remaining life, by what is known.
    """

    specimen: int
    age_h: np.ndarray
    watches: Mapping[str, tuple[np.ndarray, float]]
    marks_h: Mapping[str, float]
    pictures: Sequence[FlankPicture]
    end_h: float
    predicted_h: Mapping[str, np.ndarray]


def life_figure(unit: UnitLife) -> Figure:
    """Return the figure: pictures above, indices over age, remaining life over age."""
    from matplotlib.figure import Figure

    with styled():
        figure = Figure(figsize=(WIDTH_IN, HEIGHT_IN), layout="constrained")
        grid = figure.add_gridspec(3, MOST_SHOWN, height_ratios=[0.75, 1.2, 1.2])
        _draw_pictures(figure, grid, unit)
        indices = figure.add_subplot(grid[1, :])
        remaining = figure.add_subplot(grid[2, :], sharex=indices)
        _draw_indices(indices, unit)
        _draw_remaining(remaining, unit)
    return figure


def _draw_pictures(figure: Figure, grid: Any, unit: UnitLife) -> None:
    from matplotlib.image import imread

    count = len(unit.pictures)
    chosen = np.unique(np.linspace(0, count - 1, min(count, MOST_SHOWN)).round().astype(int)).tolist()
    for place, number in enumerate(chosen):
        one, axis = unit.pictures[number], figure.add_subplot(grid[0, place])
        axis.imshow(imread(io.BytesIO(one.png), format="png"), cmap="gray", vmin=0.0, vmax=1.0)
        axis.set_title(f"{one.age_h:.0f} h, {100.0 * one.share:.1f} %", fontsize=8)
        axis.set_xticks([])
        axis.set_yticks([])
        axis.grid(visible=False)


def _draw_indices(axis: Any, unit: UnitLife) -> None:
    axis.axhline(1.0, color=MARK_COLOUR, linestyle=":", linewidth=1.0)
    for colour, (name, (index, detected_h)) in zip(COLOURS, unit.watches.items(), strict=False):
        axis.plot(unit.age_h, np.maximum(index, LOWEST), color=colour, marker="o", markersize=3, label=name)
        if np.isfinite(detected_h):
            at = float(np.maximum(index[unit.age_h == detected_h], LOWEST)[0])
            axis.plot(detected_h, at, color=colour, marker="D", markersize=8, fillstyle="none", linestyle="none")
    axis.set_yscale("log")
    axis.set_ylabel("Index / limit [-]")
    axis.tick_params(labelbottom=False)
    axis.legend(loc="upper left", fontsize=7)
    _draw_marks(axis, unit, named=True)


def _draw_remaining(axis: Any, unit: UnitLife) -> None:
    for (name, values), colour in zip(unit.predicted_h.items(), (COLOURS[0], BAND_COLOUR), strict=False):
        low, middle, high = np.maximum(values, 0.0).T
        axis.fill_between(unit.age_h, low, high, color=colour, alpha=0.2, linewidth=0)
        axis.plot(unit.age_h, middle, color=colour, marker="o", markersize=3, label=name)
    axis.plot([0.0, unit.end_h], [unit.end_h, 0.0], color=TRUTH_COLOUR, linestyle="--", label="true")
    axis.set_ylim(bottom=0.0)
    axis.set_xlim(left=0.0)
    axis.set_xlabel("Age [h]")
    axis.set_ylabel("Remaining life [h]")
    axis.legend(loc="upper right", fontsize=7)
    _draw_marks(axis, unit, named=False)


def _draw_marks(axis: Any, unit: UnitLife, *, named: bool) -> None:
    for name, age_h in unit.marks_h.items():
        axis.axvline(age_h, color=MARK_COLOUR, linewidth=0.8)
        if named:
            axis.text(
                age_h, 1.01, name, transform=axis.get_xaxis_transform(), fontsize=7, ha="center", va="bottom",
                color=MARK_COLOUR,
            )  # fmt: skip


PICTURES, DEBRIS, FIVE, WITH_HISTORY = "pictures", "oil debris", "five indicators", "NA4 and NB4"


def watches(fleet: Inspections) -> dict[str, Watch]:
    """Return what shows damage: pictures from their first pit on, the others by their limits."""
    whole = fleet.worst_shares[:, 0] == 0.0
    five = np.concatenate(list(fleet.indicators.values()), axis=1)
    of = {
        DEBRIS: fleet.debris_mg,
        FIVE: rise(five, fleet.specimen, whole),
        WITH_HISTORY: rise(fleet.history, fleet.specimen, whole),
    }
    seen = {
        int(unit): int(np.flatnonzero((fleet.specimen == unit) & ~whole)[0])
        for unit in np.unique(fleet.specimen[~whole])
    }
    pictures = Watch(np.where(whole, 0.0, 1.0), seen)
    return {PICTURES: pictures, **{name: watched(index, fleet.specimen, whole) for name, index in of.items()}}


@dataclass(frozen=True, slots=True)
class FailureDetection:
    """What of the failed gearboxes is detected by one thing.

    Attributes
    ----------
    gearboxes, detected, early : int
        That failed; of these detected while a tooth is pitted; with an alarm that counts before any pit.
    share, left_h : float
        Medians over the detected ones: area of the worst tooth, and hours until the end; NaN without any.
    """

    gearboxes: int
    detected: int
    early: int
    share: float
    left_h: float

    def numbers(self) -> dict[str, float | int | None]:
        """Return it for JSON."""
        medians = {"worst_share": self.share, "left_h": self.left_h}
        counts = {"gearboxes": self.gearboxes, "detected": self.detected, "before_any_pit": self.early}
        return {**counts, **{name: value if np.isfinite(value) else None for name, value in medians.items()}}


def detections(fleet: Inspections, seen: Mapping[str, Watch]) -> dict[str, FailureDetection]:
    """Return what each watch detects of the gearboxes that failed."""
    failed = set(np.unique(fleet.specimen[np.isfinite(fleet.rul_h)]).tolist())
    return {name: _detection(fleet, watch, failed) for name, watch in seen.items()}


def _detection(fleet: Inspections, watch: Watch, failed: set[int]) -> FailureDetection:
    rows = np.array([row for unit, row in watch.detected.items() if unit in failed], dtype=int)
    pitted = fleet.worst_shares[rows, 0] > 0.0
    right = rows[pitted]
    share, left_h = fleet.worst_shares[right, 0], fleet.rul_h[right]
    medians = (float(np.median(values)) if right.size else float("nan") for values in (share, left_h))
    return FailureDetection(len(failed), int(right.size), int((~pitted).sum()), *medians)


def unit_lives(
    dataset: Dataset,
    fleet: Inspections,
    seen: Mapping[str, Watch],
    predicted: Mapping[str, np.ndarray],
    chosen: Sequence[int],
) -> dict[int, UnitLife]:
    """Return some gearboxes for figures; of predictions those that indicators with their history and the truth give."""
    units = {row["specimen_id"]: row for row in dataset.life("units").to_pylist()}
    shown = {name: values for name, values in predicted.items() if name in (HISTORY, OUTLOOK)}
    return {unit: _unit_life(dataset, fleet, seen, shown, units[unit]) for unit in chosen}


def _unit_life(
    dataset: Dataset,
    fleet: Inspections,
    seen: Mapping[str, Watch],
    predicted: Mapping[str, np.ndarray],
    row: Mapping[str, object],
) -> UnitLife:
    unit = int(str(row["specimen_id"]))
    rows = np.flatnonzero(fleet.specimen == unit)
    at = {name: fleet.age_h[one.detected[unit]] if unit in one.detected else np.nan for name, one in seen.items()}
    ends = {"first pit": "first_pit_h", "rated": "rated_h"}
    marks = {name: float(str(row[column])) for name, column in ends.items()}
    ended = "failed" if row["event"] == "failed" else "taken out"
    observed_h = float(str(row["observed_h"]))
    return UnitLife(
        specimen=unit,
        age_h=fleet.age_h[rows],
        watches={name: (one.index[rows], float(at[name])) for name, one in seen.items() if name != PICTURES},
        marks_h={**{name: age for name, age in marks.items() if age < observed_h}, ended: observed_h},
        pictures=_pictures(dataset, unit, str(row["end_gear"]), int(str(row["end_tooth"])), fleet),
        end_h=float(str(row["failure_h"])),
        predicted_h={name: values[rows] for name, values in predicted.items()},
    )


def _pictures(dataset: Dataset, unit: int, gear: str, tooth: int, fleet: Inspections) -> list[FlankPicture]:
    """Return the pictures of one tooth in order of age; that of a whole flank stands for those before its first pit."""
    table, shares = dataset.life("pictures"), dataset.life("teeth")
    rows = table.filter(pc.equal(table.column("specimen_id"), unit)).to_pylist()
    of_teeth = shares.filter(pc.equal(shares.column("specimen_id"), unit)).to_pylist()
    share = {(row["inspection"], row["gear"], row["tooth"]): row["area_share"] for row in of_teeth}
    ages_h = dict(zip(fleet.record_id.tolist(), fleet.age_h.tolist(), strict=True))
    wanted = [row for row in rows if row["gear"] == gear and (row["inspection"] == 0 or row["tooth"] == tooth)]
    return [
        FlankPicture(ages_h[row["record_id"]], share.get((row["inspection"], gear, tooth), 0.0), row["png"])
        for row in sorted(wanted, key=lambda one: one["inspection"])
        if row["record_id"] in ages_h
    ]


LIVES = Sentences(
    Path(__file__).with_name("templates") / "lives.txt",
    folds=FOLDS,
    in_a_row=IN_A_ROW,
    indicators=INDICATORS,
    quiet=QUIET,
)


def shown_gearboxes(fleet: Inspections) -> list[int]:
    """Return the gearboxes that failed first, in the middle and last."""
    known = np.isfinite(fleet.rul_h)
    units, first = np.unique(fleet.specimen[known], return_index=True)
    order = units[np.argsort((fleet.age_h + fleet.rul_h)[known][first], kind="stable")]
    return list(dict.fromkeys(int(order[place]) for place in (0, order.size // 2, order.size - 1)))


def detection_table(detected: Mapping[str, FailureDetection]) -> TableBlock:
    """Return the table of what sees damage, and when."""
    rows = [
        (name, Cell(f"{one.detected} of {one.gearboxes}", value=one.detected), 100.0 * one.share, one.left_h, one.early)
        for name, one in detected.items()
    ]
    head = ["What is watched", "Gearboxes detected", "Worst tooth then [%]", "Hours left then [h]"]
    return table([*head, "Detected before any pit"], rows, LIVES.first_detection(), ".1f")


def life_block(unit: UnitLife) -> FigureBlock:
    """Return the figure of a gearbox with its caption."""
    return FigureBlock(png_bytes(life_figure(unit)), f"Gearbox {unit.specimen}. {LIVES.life()}")


SEED = 0
"""Of the folds that the predictions on the page come from; those of a report are its own."""
LIFE_COLUMNS = (("age_h", "Age [h]"), ("rul_h", "Remaining life [h]"))


def lives_of(dataset: Dataset, table: RecordTable) -> Lives:
    """Return age and remaining life of all records, and what draws a gearbox over its life."""
    ages = of_records(dataset, dataset.labels(columns=["record_id"]).column("record_id").to_pylist())
    labels = {name: np.array([row[name] for row in ages], dtype=object) for name, _ in LIFE_COLUMNS}
    return Lives(labels, LIFE_COLUMNS, figure_of(dataset, table))


def of_records(dataset: Dataset, record_ids: Sequence[int]) -> list[dict[str, float | None]]:
    """Return age and remaining life of records; None where a gearbox was taken out, or a benchmark does not tell."""
    rows = sorted(dataset.life("inspections").to_pylist(), key=lambda row: row["record_id"])
    first = np.array([row["record_id"] for row in rows])  # of an inspection's records
    places = np.searchsorted(first, np.asarray(record_ids), side="right") - 1
    return [{name: rows[place].get(name) for name, _ in LIFE_COLUMNS} for place in places.tolist()]


def figure_of(dataset: Dataset, table: RecordTable) -> Callable[[int], dict[str, str]] | None:
    """Return what draws a gearbox over its life, with its caption; None where too few failed to learn from."""
    try:
        fleet = inspections_of(dataset, table)
    except DatasetError:
        return None
    predicted = {HISTORY: history_predictions(fleet, SEED), OUTLOOK: fleet.outlook_h}
    seen = watches(fleet)

    def figure(gearbox: int) -> dict[str, str]:
        (life,) = unit_lives(dataset, fleet, seen, predicted, [gearbox]).values()
        with styled():
            return {"png": base64.b64encode(png_bytes(life_figure(life))).decode("ascii"), "caption": LIVES.life()}

    return figure


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
) -> Path:
    """Write `report.html`, `metrics.json` and `predictions.parquet`; return the page's path.

    The network is trained where it is wanted and PyTorch is installed.

    Raises
    ------
    UsageError
        If scikit-learn is missing.
    DatasetError
        If fewer than four gearboxes failed.
    """
    require_packages("the report", "sklearn", "matplotlib")
    fleet = inspections(dataset, stage)
    with stage("baselines", 1) as advance:
        left_out = _left_out(fleet, wanted=network)
        predicted = baseline_predictions(fleet, seed, network=not left_out)
        leaks = life_leaks(fleet, seed)
        advance()
    seen = watches(fleet)
    scores = {
        name: life_scores(fleet.rul_h, values, fleet.specimen, fleet.median_life_h, seed)
        for name, values in predicted.items()
    }
    baselines = {name: one.numbers() for name, one in scores.items()}
    facts = _facts(fleet)
    metrics = {"seed": seed, **facts, "baselines": baselines, "leaks": [leak.numbers() for leak in leaks]}
    detected = detections(fleet, seen)
    metrics["first_detection"] = {name: one.numbers() for name, one in detected.items()}
    text = json.dumps(metrics, indent=1, allow_nan=False)
    write_file(folder / "metrics.json", f"{text}\n")
    identity = str(dataset.manifest["identity"])
    write_predictions([_predicted_rows(name, fleet, values) for name, values in predicted.items()], identity, folder)
    page = folder / PAGE
    first, *lives = unit_lives(dataset, fleet, seen, predicted, shown_gearboxes(fleet)).values()
    look = set_look(dataset, LookOptions(), stage, lives_of)
    parts: list[Block] = [
        *(Heading("Records"), RecordsPlace(), Heading("Remaining life")),
        *(
            Paragraph(sentence)
            for sentence in (
                LIVES.judged(facts),
                LIVES.predicted(),
                LIVES.verdict([leak.clue for leak in leaks if leak.found]),
            )
        ),
        *note_blocks([left_out] if left_out else []),
        *(_errors(fleet, scores), _quantiles(scores), Heading("First detection"), detection_table(detected)),
        *(FigureGrid([life_block(one) for one in lives]), Heading("Leaks"), _leaks(leaks)),
    ]
    opening = Opening(_answer(facts, scores, detected), life_block(first))
    write_page(page, _page(dataset, seed, opening, parts, look))
    return page


def _left_out(fleet: Inspections, *, wanted: bool) -> str:
    """Return why no network is trained, or an empty text."""
    if not wanted:
        return "No sequence network: --no-cnn."
    if missing_packages("torch"):
        return f"No sequence network: PyTorch is not installed: {how_to_install('cnn')}."
    return "" if fleet.averages else "No sequence network: records hold fewer than two whole turns of the first shaft."


def _predicted_rows(name: str, fleet: Inspections, predicted_h: np.ndarray) -> pa.Table:
    """Return what a baseline says of the inspections of all splits; lives are never below 0."""
    quantiles = dict(zip(COLUMNS, np.maximum(predicted_h, 0.0).T, strict=True))
    names = {CLASSIFIER: [name] * fleet.record_id.size, SPLIT: fleet.split}
    return pa.table({**names, RECORD: pa.array(fleet.record_id, pa.int64()), **quantiles})


def _facts(fleet: Inspections) -> dict[str, object]:
    """Return what the scores were taken of."""
    known, third = np.isfinite(fleet.rul_h), fleet.median_life_h / BINS
    return {
        "gearboxes_judged": int(np.unique(fleet.specimen[known]).size),
        "gearboxes_suspended": int(np.unique(fleet.specimen[~known]).size),
        "inspections_judged": int(known.sum()),
        "median_life_h": fleet.median_life_h,
        "bins_h": [[0.0, third], [third, 2.0 * third], [2.0 * third, None]],
    }


def _page(dataset: Dataset, seed: int, opening: Opening, parts: Sequence[Block], look: Look) -> Page:
    title = f"Remaining life of {dataset.path.name}"
    whole: list[Block] = [
        Heading(title, 1),
        Paragraph(f"{origin_sentence(dataset)} {RESERVATION}"),
        *(opening, ContentsLinks(), *parts),
        Paragraph(provenance(dataset, seed), "caption"),
    ]
    return Page(title, whole, look.live)


def _answer(
    facts: Mapping[str, object], scores: Mapping[str, LifeScores], detected: Mapping[str, FailureDetection]
) -> list[tuple[str, str]]:
    """Say which baseline tells remaining lives best, when damage is seen, and how sure that is."""
    sensed = {name: one.mae_h[0] for name, one in scores.items() if name not in KNOWN}
    best = min(sensed, key=lambda name: sensed[name].value)
    seen = max(detected, key=lambda name: (name != PICTURES, detected[name].detected))
    found = LIVES.what_is_found(best, sensed[best], scores[AGE].mae_h[0], seen, detected[seen], facts)
    return [("What is found", found), ("How sure", LIVES.how_sure(sensed[best], facts))]


def _errors(fleet: Inspections, scores: Mapping[str, LifeScores]) -> TableBlock:
    third = fleet.median_life_h / BINS
    bins = ("all", f"below {third:.3g} h", f"{third:.3g} to {2 * third:.3g} h", f"from {2 * third:.3g} h")
    rows = [(name, *one.rmse_h, *one.mae_h) for name, one in scores.items()]
    head = ["What is known", *(f"{error} [h], {each}" for error in ("RMSE", "MAE") for each in bins)]
    return table(head, rows, LIVES.errors(), ".1f")


def _quantiles(scores: Mapping[str, LifeScores]) -> TableBlock:
    rows = [(name, *one.pinball_h, one.coverage, cell(one.nasa, ".1f")) for name, one in scores.items()]
    losses = (f"Pinball loss [h], {q:g}" for q in QUANTILES)
    head = ["What is known", *losses, "Coverage of 80 % intervals [-]", "NASA score, mean [-]"]
    return table(head, rows, LIVES.quantiles())


def _leaks(leaks: Sequence[Leak]) -> TableBlock:
    rows = [
        (
            *(leak.clue, leak.age_rmse_h - leak.gain_h),
            Cell(f"{leak.gain_h:.1f}", f"at least {leak.least_gain_h:.1f}", leak.gain_h),
            "leaks" if leak.found else "tells nothing",
        )
        for leak in leaks
    ]
    head = ["Beside age", "RMSE [h]", f"Lower than by age alone ({leaks[0].age_rmse_h:.1f} h) by [h]", "Verdict"]
    return table(head, rows, LIVES.leaks(), ".1f")
