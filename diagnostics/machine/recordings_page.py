"""Indicators of recordings as a folder: a table for programs, and a page with sidebands and every indicator."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import siggen
from diagnostics.machine.recording_indicators import RecordingIndicators, indicator_matrix, indicator_title
from diagnostics.page import html
from diagnostics.page.style import png_bytes, styled
from diagnostics.prediction.prediction_page import sideband_figure

TABLE, PAGE = "indicators.csv", "indicators.html"


def write_recordings(found: Sequence[RecordingIndicators], folder: Path) -> Path:
    """Write `indicators.csv`, one row per recording and channel, and `indicators.html`; return the page's path."""
    import pyarrow as pa

    folder.mkdir(parents=True, exist_ok=True)
    rows = [_row(one, channel) for one in found for channel in one.recording.channels]
    columns = list(dict.fromkeys(name for row in rows for name in row))
    siggen.write_csv(pa.table({name: [row.get(name) for row in rows] for name in columns}), folder / TABLE)
    parts = [html.heading("Indicators of recordings", 1), _overview(found)]
    for one in found:
        parts += _section(one)
    page = folder / PAGE
    page.write_text(html.page("Indicators of recordings", parts), encoding="utf-8")
    return page


def _row(found: RecordingIndicators, channel: str) -> dict[str, Any]:
    values = {name: None if np.isnan(value) else value for name, value in found.channel(channel).items()}
    return {"recording": found.name, "channel": channel, "speed_hz": found.pulses.speed_hz, **values}


def _overview(found: Sequence[RecordingIndicators]) -> str:
    rows = [
        [
            html.Cell(one.name),
            html.Cell(f"{one.pulses.speed_hz:.4f}"),
            html.Cell(f"{one.mesh_hz:.2f}"),
            html.Cell(f"{one.revolutions[0]} and {one.revolutions[1]}"),
            html.Cell(one.pulses.origin),
            html.Cell(f"{one.recording.duration_s:.3g}"),
        ]
        for one in found
    ]
    head = ("Recording", "Pinion [Hz]", "Mesh [Hz]", "Turns averaged", "Speed from", "Length [s]")
    return html.table(head, rows, caption="What was found in each recording.", text=True)


def _section(found: RecordingIndicators) -> list[str]:
    blocks = []
    for channel in found.recording.channels:
        with styled():
            png = png_bytes(sideband_figure(found.recording, found.teeth, found.pulses, channel))
        blocks.append(html.figure_block(png, f"Order spectrum (Hann) around mesh harmonics: {channel}."))
    names, values = indicator_matrix(found)
    rows = [
        [html.Cell(indicator_title(name), small=name), *(_cell(value) for value in of_channels)]
        for name, of_channels in zip(names, values.tolist(), strict=True)
    ]
    head = ("Indicator", *found.recording.channels)
    caption = "Indicators of the whole recording. Levels in m/s², ratios without unit."
    return [
        html.heading(found.name),
        html.figure_grid(blocks),
        html.table(head, rows, caption=caption, sortable=True, tall=True),
        *html.notes([found.note] if found.note else []),
    ]


def _cell(value: float) -> html.Cell:
    return html.Cell("undefined" if np.isnan(value) else f"{value:.4g}", value=value)
