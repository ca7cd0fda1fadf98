"""A prediction as a folder: JSON, a sideband plot per channel, and one page with both.

What a prediction says, in sentences written from its numbers.

Order spectrum of a recording around mesh harmonics with the sidebands of both shafts marked.

A prediction as JSON and as lines for the terminal.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import siggen
from diagnostics.base.extras import require_packages
from diagnostics.page.blocks import (
    Block,
    FigureBlock,
    FigureGrid,
    Heading,
    Page,
    note_blocks,
    summary_blocks,
)
from diagnostics.page.style import (
    ORDERS_SHOWN,
    draw_mesh_line,
    frame_mesh_lines,
    mark_handles,
    new_figure,
    order_words,
    png_bytes,
    styled,
)
from diagnostics.page.tables import table
from diagnostics.page.template import write_page
from diagnostics.page.wording import capitalised, counted, percent
from diagnostics.prediction.gearbox_answer import GearboxAnswer
from diagnostics.prediction.known_reasons import OwnState
from diagnostics.prediction.model_facts import ModelFacts
from diagnostics.prediction.prediction import Nearness, Prediction, Vote
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import ShaftPulses
from diagnostics.records.gear_train import GearMesh, first_teeth, meshes_of
from diagnostics.records.record_classes import STATE
from diagnostics.signal.spectrum import order_spectrum
from siggen.file_writing import write_file
from siggen.plain_json import json_text, plain

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MEANING = (
    "The models were trained on simulated records only. No measured pitting was used. A probability compares the "
    "simulated states: it says which of them the recording is most like. It is not the probability that the gear is "
    "damaged."
)

MEANING_OF_NETWORK = (
    "The network has learnt from simulated gearboxes only. No measured damage was used. No damage seen does not mean "
    "that there is none."
)

HARMONICS_SHOWN = 4
LINE_COLOUR = "#5b6b7b"

INDICATORS_SHOWN = 400


def prediction_facts(found: Prediction, facts: ModelFacts) -> dict[str, Any]:
    """Return everything about a prediction as JSON can hold it; undefined numbers are null."""
    middle = [_median(column) for column in found.pieces.values.T]
    return {
        "file": str(found.recording.path),
        found.class_kind: found.state,
        "reasons_to_abstain": list(found.reasons),
        "contradiction": found.contradiction or None,
        "against_own_healthy_state": _own_state(found.own_state),
        "probabilities": {
            vote.classifier: {
                **dict(zip(found.classes, vote.probability.tolist(), strict=True)),
                "share_of_pieces_that_agree": vote.agreement,
                "test_accuracy": vote.accuracy,
            }
            for vote in found.votes
        },
        "distance": _nearness(found.nearness),
        "distance_without_reference": _nearness(found.plain_nearness),
        "speed_hz": found.pulses.speed_hz,
        "mesh_frequency_hz": found.pulses.speed_hz * first_teeth(found.train)[0],
        "speed_from": found.pulses.origin,
        **found.pulses.facts,
        "teeth": list(first_teeth(found.train)),
        "pieces": len(found.pieces.values),
        "revolutions_per_piece": found.pieces.revolutions,
        "notes": list(found.notes),
        "meaning": MEANING,
        "model": {
            "set": facts.set_name,
            "classes_are": facts.class_kind,
            "identity": facts.identity,
            "manifest_digest": facts.manifest_digest,
        },
        "indicators": dict(zip(found.pieces.names, middle, strict=True)),
    }


def _median(values: np.ndarray) -> float:
    finite = values[np.isfinite(values)]
    return float(np.median(finite)) if finite.size else math.nan


def _own_state(found: OwnState | None) -> dict[str, Any] | None:
    return None if found is None else {"verdict": found.verdict, "reason": found.reason}


def _nearness(found: Nearness) -> dict[str, Any]:
    return {
        "value": found.distance,
        "threshold": found.threshold,
        "outside": found.outside,
        "farthest_off_in_spreads": dict(found.strangest),
    }


def prediction_headline(found: Prediction) -> str:
    """Return what was found, or why nothing is said, in one line."""
    own = found.own_state
    told = [] if own is None else [own.verdict if own.score is not None else "nothing can be said of a change"]
    if found.reasons:
        return "; ".join([*told, f"no {found.class_kind} is named: {found.reasons[0]}"])
    share = percent(float(found.votes[0].probability.max()))
    weak = ", a weak answer" if found.contradiction else ""
    kind = "" if found.class_kind == STATE else f"the {found.class_kind} "
    return "; ".join([*told, f"most like {kind}{found.state} ({share}{weak})"])


def prediction_rows(found: Prediction) -> list[tuple[str, str]]:
    """Return what the terminal and the page show first: label and text."""
    pulses, mesh = found.pulses, meshes_of(found.train)[0]
    shaft, mesh_hz = mesh.names.gears[0], pulses.speed_hz * mesh.teeth[0]
    pieces = counted(len(found.pieces.values), "piece")
    own = found.own_state
    rows = [
        *([] if own is None else [("against its own healthy state", f"{own.verdict} ({own.reason})")]),
        ("answer" if found.class_kind == STATE else f"answer ({found.class_kind})", found.state),
        (f"{shaft} speed", f"{pulses.speed_hz:.4f} Hz ({pulses.origin}); mesh {mesh_hz:.2f} Hz"),
        ("averaged", f"{pieces} of {found.pieces.revolutions} or more {shaft} revolutions"),
    ]
    for vote in found.votes:
        rows.append((f"by {vote.classifier}", _vote_text(found, vote)))
    near = found.nearness
    rows.append(("distance to training", f"{near.distance:.2f}, threshold {near.threshold:.2f}"))
    if found.plain_nearness is not found.nearness:
        plain = found.plain_nearness
        rows.append(("without reference", f"{plain.distance:.2f}, threshold {plain.threshold:.2f}"))
    rows += [("abstains because", reason) for reason in found.reasons]
    rows += [("weak answer", found.contradiction)] if found.contradiction else []
    return [*rows, *(("note", note) for note in found.notes)]


def _vote_text(found: Prediction, vote: Vote) -> str:
    shares = ", ".join(f"{state} {share:.2f}" for state, share in zip(found.classes, vote.probability, strict=True))
    agree = "" if vote.agreement is None else f"; {vote.agreement:.0%} of pieces agree"
    right = "" if vote.accuracy is None else f"; right in {vote.accuracy.value:.0%} of its test records"
    return f"{shares}{agree}{right}{' (do not use)' if found.reasons else ''}"


def model_provenance(facts: ModelFacts) -> str:
    """Return which program made the page, and which set the models were trained on."""
    return (
        f"Made by siggen-diagnostics {siggen.__version__} with models trained on the set {facts.set_name}, identity "
        f"{facts.identity}."
    )


def sideband_figure(recording: MeasuredRecording, mesh: GearMesh, pulses: ShaftPulses, channel: str) -> Figure:
    """Return the spectrum of a channel around its first mesh harmonics, one row each, all on one scale."""
    speed_hz, teeth = pulses.pulses_hz, mesh.teeth
    spectrum = order_spectrum(recording.channels[channel], pulses.times_s, recording.fs_hz, teeth[0])
    highest = int((0.45 * recording.fs_hz / speed_hz - ORDERS_SHOWN) / teeth[0])
    harmonics = range(1, min(HARMONICS_SHOWN, max(1, highest)) + 1)
    figure, axes = new_figure(len(harmonics), 1, height_in=1.0 + 1.3 * len(harmonics), sharex=True, sharey=True)
    top = 0.0
    for axis, harmonic in zip(axes[:, 0], harmonics, strict=True):
        top = max(top, draw_mesh_line(axis, spectrum, mesh, harmonic, LINE_COLOUR))
        title = f"{channel}, mesh harmonic {harmonic}: {harmonic * teeth[0] * speed_hz:.1f} Hz"
        axis.set_title(title, loc="left", fontweight="bold")
    frame_mesh_lines(axes[0, 0], top)
    axes[-1, 0].set_xlabel(f"Offset from the mesh line [{order_words(mesh)} of {speed_hz:.4g} Hz]")
    figure.supylabel(f"Amplitude [{recording.shown_unit(channel)}]", fontsize=10)
    figure.legend(handles=mark_handles(mesh), loc="outside upper right", ncols=3, fontsize=8)
    return figure


def write_prediction(found: Prediction, facts: ModelFacts, folder: Path) -> Path:
    """Write `prediction.json`, `sidebands_<channel>.png` and `prediction.html`; return the page's path.

    Parameters
    ----------
    found : Prediction
        What to write.
    facts : ModelFacts
        Of the model that answered.
    folder : Path
        Created where missing.

    Raises
    ------
    UsageError
        If matplotlib is missing.
    """
    content = prediction_facts(found, facts)
    measured = table(
        ("Indicator and channel", "Median"),
        list(plain(content["indicators"]).items())[:INDICATORS_SHOWN],
        f"Median of each indicator over the pieces of the recording. {found.recording.levels_sentence}",
        ".4g",
        sortable=True,
        tall=True,
    )
    lead = [f"{capitalised(prediction_headline(found).rstrip('.'))}.", MEANING]
    heads = found.state, lead, prediction_rows(found)
    return _written(folder, content, found, heads, [Heading("Indicators"), measured], model_provenance(facts))


def write_answer(found: GearboxAnswer, folder: Path) -> Path:
    """Write the answer of the network that comes with the package, as `write_prediction` does."""
    lead = [f"{capitalised(found.headline.rstrip('.'))}.", MEANING_OF_NETWORK]
    note = f"Made by siggen-diagnostics {siggen.__version__} with the network that comes with it."
    return _written(folder, found.facts, found, (found.verdict, lead, found.rows), [], note)


def _written(
    folder: Path,
    content: dict[str, Any],
    found: Prediction | GearboxAnswer,
    heads: tuple[str, list[str], list[tuple[str, str]]],
    more: list[Block],
    provenance: str,
) -> Path:
    """Write JSON, plots and the page with answer and sentences, rows, plots and what else there is."""
    require_packages("the plots of a prediction", "matplotlib")
    write_file(folder / "prediction.json", json_text(content))
    recording, (answer, lead, rows) = found.recording, heads
    figures: list[Block] = []
    for channel in recording.channels:
        with styled():
            png = png_bytes(sideband_figure(recording, meshes_of(found.train)[0], found.pulses, channel))
        write_file(folder / f"sidebands_{channel}.png", png)
        figures.append(FigureBlock(png, f"Order spectrum (Hann) around mesh harmonics: {channel}."))
    blocks = [
        Heading(f"{recording.path.name}: {answer}", 1),
        *summary_blocks(lead),
        table(("Question", "Answer"), rows, "What is said about this recording.", text=True),
        Heading("Sidebands"),
        FigureGrid(figures),
        *more,
        Heading("Notes"),
        *note_blocks([provenance]),
    ]
    page = folder / "prediction.html"
    write_page(page, Page(f"Prediction for {recording.path.name}", blocks))
    return page
