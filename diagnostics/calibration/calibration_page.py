"""The page of a calibration: recordings beside the rig and beside the calibrated configuration, and what was fitted.

The page of a calibration from its files: recordings, gearboxes of the rig, gearboxes of the result.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from diagnostics.audit.envelope import BACKGROUND_QUANTITIES
from diagnostics.calibration.calibrated_files import CALIBRATED, TOO_FEW, data_folder, not_identified
from diagnostics.calibration.calibration import Calibration
from diagnostics.calibration.healthy_blocks import FEWEST_RECORDINGS, HealthyBlocks
from diagnostics.calibration.interval_coverage import interval_coverage
from diagnostics.calibration.likeness import (
    LEVELS,
    RANGE,
    Likeness,
    Sample,
    band_edges_hz,
    likeness,
    sample_of,
    simulated_blocks,
)
from diagnostics.calibration.source_library import at_recordings
from diagnostics.page.blocks import (
    Block,
    Cell,
    FigureBlock,
    FigureGrid,
    Heading,
    Page,
    Paragraph,
    TableBlock,
    summary_blocks,
)
from diagnostics.page.style import FAULT_COLOURS, GEAR_COLOUR, HEALTHY_COLOUR, new_figure, png_bytes, styled
from diagnostics.page.tables import cell, table
from diagnostics.page.template import write_page
from diagnostics.statistics.evaluation import Interval

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PAGE = "calibration.html"
MOST_FEATURES = 12
TITLES = {quantity.name: quantity.title for quantity in BACKGROUND_QUANTITIES}
SPECTRA = "Spectra of {}: recordings (red), and 90 % of the gearboxes before (grey) and after calibration (blue)."
PATHS = (
    "Transfer paths to {}: the family that gearboxes draw from. Where it is wide, path and source are not told apart."
)


def calibration_page(
    found: Calibration,
    out: Path,
    held_out: HealthyBlocks | None,
    size: tuple[int, int],
    advance: Callable[[], None],
) -> tuple[Path, list[str]]:
    """Write the page and return it, with what it says first.

    Parameters
    ----------
    found : Calibration
    out : Path
        The calibrated configuration.
    held_out : HealthyBlocks, optional
        Recordings to judge by; those of the calibration without.
    size : (int, int)
        Gearboxes of each configuration, and the seed of the folds.
    advance : callable
        Told of every record.
    """
    names = found.blocks.channels
    read = found.blocks if held_out is None else held_out
    real = sample_of(read.blocks, found.rig.drive.teeth)
    alike = at_recordings(found.rig, found.operating_point, read.fs_hz) | {"sensors": found.rig.sensors}
    before = simulated_blocks(alike, names, size[0], advance)
    after = simulated_blocks(out, names, size[0], advance)
    compared = [likeness(real, sample_of(blocks, found.rig.drive.teeth), size[1]) for blocks in (before, after)]
    sentences = _sentences(compared[0], compared[1], found, held_out)
    return write_calibration_page(found, real, compared[0], compared[1], data_folder(out), sentences), sentences


def write_calibration_page(
    found: Calibration, real: Sample, before: Likeness, after: Likeness, folder: Path, sentences: list[str]
) -> Path:
    """Write the page into a folder, with sentences first; return it."""
    with styled():
        figures = [
            FigureBlock(png_bytes(figure), caption.format(channel.name))
            for number, channel in enumerate(found.channels)
            for figure, caption in (
                (_spectra(found, real, before, after, number), SPECTRA),
                (_paths(found, number), PATHS),
            )
        ]
    parts = [
        Heading(f"Calibration of {found.rig.file.stem}", 1),
        *summary_blocks(sentences),
        _likeness_table(found, before, after),
        FigureGrid(figures),
        Paragraph(
            "Recordings and simulated records over each other, once a set is generated: `siggen-diagnostics explore "
            f"RECORDING... SET --teeth {found.rig.file.name}`."
        ),
        Heading("What gives the set away"),
        *_feature_parts(before, after),
        Heading("Lines, floors, modulation and tails"),
        _level_table(real, before, after),
        Heading("What was fitted"),
        Paragraph(CALIBRATED.stage(found)),
        _fitted_table(found),
        Heading("What recordings do not tell"),
        *(Paragraph(f"{text[:1].upper()}{text[1:]}.") for text in not_identified(found)),
    ]
    path = folder / PAGE
    write_page(path, Page(f"Calibration of {found.rig.file.stem}", parts))
    return path


def _sentences(before: Likeness, after: Likeness, found: Calibration, held_out: HealthyBlocks | None) -> list[str]:
    others = len(held_out.blocks) if held_out is not None else 0
    hold, count = interval_coverage(found, held_out) if held_out is not None else (0, 0)
    return [
        CALIBRATED.distance(before, after),
        CALIBRATED.judged(others, hold, count),
        CALIBRATED.width(before, after),
        "Whether a detector gains by it is another question: see the control in the docs.",
    ]


def _likeness_table(found: Calibration, before: Likeness, after: Likeness) -> TableBlock:
    rows = [(one.name, before.distance_db[k], after.distance_db[k]) for k, one in enumerate(found.channels)]
    return table(("Channel", "Before [dB]", "After [dB]"), rows, "Distance of median spectra.", ".3g")


def _feature_parts(before: Likeness, after: Likeness) -> list[Block]:
    if before.features is None or after.features is None:
        return [Paragraph("Recordings or gearboxes are shorter than a second, or sampled below 9.6 kHz: not judged.")]
    earlier = {gap.name: gap for gap in before.features.gaps}
    rows = [
        (gap.name, earlier[gap.name].auc, gap.auc, gap.measured, gap.synthetic)
        for gap in after.features.gaps[:MOST_FEATURES]
    ]
    head = ("Feature", "AUC before", "AUC after", "Recordings", "Calibrated")
    shown = table(head, rows, "The most telling after calibration.", ".3g", sortable=True)
    return [Paragraph(CALIBRATED.features(before.features, after.features)), shown]


def _level_table(real: Sample, before: Likeness, after: Likeness) -> TableBlock:
    rows = []
    for k, name in enumerate(LEVELS):
        columns = [sample.levels[:, :, k] for sample in (real, before.sample, after.sample)]
        if np.isfinite(columns[0]).any():
            rows.append((TITLES.get(name, name), *map(_spread, columns)))
    head = ("Quantity", "Recordings", "Before", "After")
    return table(head, rows, "Median [5 %, 95 %] over records and channels; dB re the strongest mesh line.")


def _fitted_table(found: Calibration) -> TableBlock:
    rows = []
    for channel in found.channels:
        noise = channel.noise
        facts: dict[str, Interval] = {
            "noise in all [dB re 1 (m/s²)²]": noise.level_db,
            **{
                f"modulation once per {shaft.name} turn": depth
                for shaft, depth in zip(found.rig.drive.shafts, noise.depths, strict=False)
            },
            "random level, standard deviation": noise.level_std,
        }
        facts |= {
            f"{group.name} [dB re 1 (m/s²)²]": level
            for group, level in zip(found.library.groups, channel.levels, strict=True)
            if np.isfinite(level.value) and group.name.startswith("mesh")
        }
        facts |= {f"second stage, {one.name} [dB re 1 (m/s²)²]": one.level_db for one in channel.stage}
        rows += [(channel.name, name, one.value, one.low, one.high) for name, one in facts.items()]
    few = len(found.blocks.blocks) < FEWEST_RECORDINGS
    caption = (
        f"Fitted numbers; {TOO_FEW}." if few else "Fitted numbers with limits of 90 % from leaving recordings out."
    )
    return table(("Channel", "Quantity", "Value", "Low", "High"), rows, caption, ".3g", tall=True)


def _spectra(found: Calibration, real: Sample, before: Likeness, after: Likeness, channel: int) -> Figure:
    edges = band_edges_hz(found.blocks.fs_hz)
    middle = np.sqrt(edges[:-1] * edges[1:])
    figure, axes = new_figure(height_in=3.0)
    axis = axes[0, 0]
    for sample, colour in ((before.sample, HEALTHY_COLOUR), (after.sample, GEAR_COLOUR)):
        low, high = np.quantile(sample.bands_db[:, channel], RANGE, axis=0)
        axis.fill_between(middle, low, high, color=colour, alpha=0.3, linewidth=0)
        axis.plot(middle, np.median(sample.bands_db[:, channel], axis=0), color=colour)
    for row in real.bands_db[:, channel]:
        axis.plot(middle, row, color=FAULT_COLOURS[2], linewidth=0.7)
    return _labelled(figure, axis, "density [dB re 1 (m/s²)²/Hz]")


def _paths(found: Calibration, channel: int) -> Figure:
    figure, axes = new_figure(height_in=3.0)
    axis = axes[0, 0]
    for draw in found.channels[channel].paths:
        axis.plot(found.grid_hz[1:], 20.0 * np.log10(np.abs(draw.accelerance[1:])), color=GEAR_COLOUR, alpha=0.4)
    axis.set_xlim(50.0, 0.45 * found.blocks.fs_hz)
    return _labelled(figure, axis, "accelerance [dB re 1 m/s²/N]")


def _labelled(figure: Figure, axis: object, text: str) -> Figure:
    axis.set_xscale("log")  # type: ignore[attr-defined]
    axis.xaxis.set_major_formatter("{x:g}")  # type: ignore[attr-defined]
    axis.set_xlabel("frequency [Hz]")  # type: ignore[attr-defined]
    axis.set_ylabel(text)  # type: ignore[attr-defined]
    return figure


def _spread(values: np.ndarray) -> Cell:
    known = values[np.isfinite(values)]
    if not known.size:
        return cell(None)
    low, middle, high = np.quantile(known, [RANGE[0], 0.5, RANGE[1]])
    return Cell(f"{middle:.3g} [{low:.3g}, {high:.3g}]", value=float(middle))
