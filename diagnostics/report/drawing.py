"""All figures of a report by file name, with their captions; what cannot be drawn becomes a note."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from diagnostics.indicators.indicator import base_name
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.page.explorer_link import explorer_link, indicator_links, records_line, state_links
from diagnostics.page.provenance import without_path
from diagnostics.page.style import state_colours
from diagnostics.records.state_classes import HEALTHY
from diagnostics.report import score_figures, stiffness_figures, vibration_figures
from diagnostics.report.examples import example_set
from diagnostics.report.indicator_terms import column_title
from diagnostics.signal.order_spectrum import strongest_harmonic
from diagnostics.statistics.separability import Separability
from diagnostics.training.studies import Studies
from diagnostics.training.training import Training
from siggen.dataset.reading import Dataset

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FIRST_HARMONICS = (1, 2)
INDICATORS_SHOWN = 4


@dataclass(slots=True)
class Drawing:
    """Figures with captions by file name, by section of the report; notes on what is missing; links to records."""

    vibration: dict[str, tuple[Figure, str]] = field(default_factory=dict)
    damage: dict[str, tuple[Figure, str]] = field(default_factory=dict)
    scores: dict[str, tuple[Figure, str]] = field(default_factory=dict)
    indicators: dict[str, tuple[Figure, str]] = field(default_factory=dict)
    studies: dict[str, tuple[Figure, str]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    behind: dict[str, str] = field(default_factory=dict)

    def figures(self) -> dict[str, tuple[Figure, str]]:
        """Return all figures by file name."""
        return {**self.vibration, **self.damage, **self.scores, **self.indicators, **self.studies}


def draw(
    dataset: Dataset,
    matrix: FeatureMatrix,
    classes: tuple[str, ...],
    training: Training | None,
    found: list[Separability],
    studies: Studies | None = None,
    explorer: str = "",
) -> Drawing:
    """Draw everything the report shows; figures lead to records on the page to explore, where there is one."""
    healthy = {state for state in classes if (matrix.labels["fault"][matrix.labels["state"] == state] == HEALTHY).all()}
    colours = state_colours(classes, healthy)
    drawing = Drawing()
    _draw_vibration(drawing, dataset, colours, explorer)
    _draw_damage(drawing, dataset, classes, colours, explorer)
    if training:
        _draw_scores(drawing, training, explorer)
    if studies:
        figure = score_figures.learning_curve_figure(studies.curve)
        caption = (
            "Macro-AUROC on the test specimens over the number of training specimens: mean and range of the draws."
        )
        drawing.studies["learning_curve"] = (figure, caption)
    shown = distinct_features(found, INDICATORS_SHOWN)
    if shown:
        figure = score_figures.indicator_figure(matrix, shown, classes, colours)
        drawing.indicators["indicators"] = (
            figure,
            "The strongest single indicators of different definitions, on all specimens.",
        )
        titles = {entry.feature: column_title(entry.feature) for entry in shown}
        drawing.behind["indicators"] = records_line("All records by", indicator_links(explorer, titles))
    return drawing


def distinct_features(found: list[Separability], count: int) -> list[Separability]:
    """Return the strongest features of different definition (one in two channels or bands counts once)."""
    chosen: dict[str, Separability] = {}
    for entry in found:
        chosen.setdefault(base_name(entry.feature), entry)
    return list(chosen.values())[:count]


def _draw_vibration(drawing: Drawing, dataset: Dataset, colours: dict[str, str], explorer: str) -> None:
    examples = example_set(dataset)
    which = (
        f"specimen {examples.specimen_id}, channel {examples.channel}, {examples.speed_hz:.3g}\u00a0Hz, "
        f"{examples.torque_nm:.3g}\u00a0N\u00a0m"
    )
    figure = vibration_figures.waveform_figure(examples, colours)
    shown = {each.state: explorer_link(explorer, record=each.record_id) for each in examples.examples}
    behind = records_line("Records", shown)
    drawing.behind["waveforms"] = behind
    drawing.vibration["waveforms"] = (figure, f"Waveform in each state: {which}. Dotted: one pinion revolution.")
    spectra = [example.spectrum for example in examples.examples if example.spectrum]
    if not spectra:
        drawing.notes.append("No order spectra: the example records hold no whole pinion revolution.")
        return
    for harmonic in sorted({*FIRST_HARMONICS, strongest_harmonic(spectra[0], examples.teeth[0])}):
        figure = vibration_figures.spectrum_figure(examples, colours, harmonic)
        window = f"Hann, {spectra[0].revolutions} pinion revolutions"
        caption = f"Order spectrum ({window}) around mesh harmonic {harmonic}: {which}."
        drawing.vibration[f"spectrum_h{harmonic}"] = (figure, caption)
        drawing.behind[f"spectrum_h{harmonic}"] = behind


def _draw_damage(
    drawing: Drawing, dataset: Dataset, classes: tuple[str, ...], colours: dict[str, str], explorer: str
) -> None:
    losses, meaning = stiffness_figures.loss_of_specimens(dataset)
    figure = stiffness_figures.stiffness_loss_figure(losses, classes, colours)
    caption = f"Largest relative loss of mesh stiffness against healthy, from the labels: {meaning}."
    drawing.damage["stiffness_loss"] = (figure, caption)
    drawing.behind["stiffness_loss"] = records_line("Records", state_links(explorer, classes))
    try:
        import siggen

        # provided lazily by the package, computed from the configuration; a set can be read without its physics
        config = siggen.load_config(dataset.config)
        curves = siggen.mesh_stiffness_curves(config)
        meaning = siggen.mesh_stiffness_meaning(config)
        figure = stiffness_figures.stiffness_figure(curves, colours)
    except Exception as error:
        drawing.notes.append(f"No stiffness curves: {type(error).__name__}: {without_path(error, dataset)}")
        return
    caption = f"Specimen 0 in every state while the damaged teeth mesh: {meaning}."
    drawing.damage["stiffness"] = (figure, caption)
    records = {"specimen 0": explorer_link(explorer, specimen_id=0)}
    drawing.behind["stiffness"] = records_line("Records", records)


def _draw_scores(drawing: Drawing, training: Training, explorer: str) -> None:
    specimens = training.judged[0].scores.specimens
    caption = f"Scores on {specimens} test specimens, with 95 % intervals from resampled specimens. Dashed: chance."
    drawing.scores["scores"] = (score_figures.score_figure(training), caption)
    named = {f"{said} named": explorer_link(explorer, split="test", named=said) for said in ("wrongly", "rightly")}
    drawing.behind["scores"] = records_line("Test records", named)
    caption = "Permutation control: training with shuffled labels (dots) must give values around 0.5."
    drawing.scores["permuted"] = (score_figures.permutation_figure(training), caption)
