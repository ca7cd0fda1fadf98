"""Indicators, speed and orders of one measured recording: the one call for programs, and what the command prints.

Whether a recording shows the mesh lines of the teeth that its user gave; else orders mean other things.

Indicators of recordings as a folder: a table for programs, and a page with sidebands and every indicator.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import siggen
from diagnostics.indicators.record import record_values
from diagnostics.indicators.registry import indicator_columns
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.page.angle_figure import ANGLE_CAPTION, angle_figure
from diagnostics.page.blocks import Block, Cell, FigureBlock, FigureGrid, Heading, Page, TableBlock, note_blocks
from diagnostics.page.style import png_bytes, styled
from diagnostics.page.tables import table
from diagnostics.page.template import write_page
from diagnostics.prediction.prediction_page import sideband_figure
from diagnostics.recordings.level_alike import level_note
from diagnostics.recordings.measured_recording import MeasuredRecording, read_recording
from diagnostics.recordings.shaft_pulses import ShaftPulses, shaft_pulses
from diagnostics.recordings.taken import RecordingFacts
from diagnostics.records.gear_train import Gearing, GearMesh, gear_names, meshes_of, train_of
from diagnostics.signal.order_domain import SAMPLES_PER_TOOTH, angle_grid, resample_to_angle
from diagnostics.signal.spectrum import OrderLines, noise_density, order_lines
from siggen.columns.drivetrain import GearTrain
from siggen.errors import UsageError

TABLE, PAGE = "indicators.csv", "indicators.html"

HARMONICS = 5
OVER_NOISE = 10.0
"""Power of a line's largest bin over that of the noise beside it; noise alone reaches it in 1 of 20,000 bins."""


def write_recordings(results: Sequence[RecordingIndicators], folder: Path) -> Path:
    """Write `indicators.csv`, one row per recording and channel, and `indicators.html`; return the page's path."""
    import pyarrow as pa

    rows = recording_rows(results)
    columns = list(dict.fromkeys(name for row in rows for name in row))
    siggen.write_csv(pa.table({name: [row.get(name) for row in rows] for name in columns}), folder / TABLE)
    parts: list[Block] = [Heading("Indicators of recordings", 1), _overview(results)]
    for result in results:
        parts += _section(result)
    page = folder / PAGE
    write_page(page, Page("Indicators of recordings", parts))
    return page


def recording_rows(results: Sequence[RecordingIndicators]) -> list[dict[str, Any]]:
    """Return one row per recording and channel: speed and every indicator, None where it is undefined."""
    return [_row(result, channel) for result in results for channel in result.recording.channels]


def _row(result: RecordingIndicators, channel: str) -> dict[str, Any]:
    values = {name: None if np.isnan(value) else value for name, value in result.channel(channel).items()}
    known = {"speed_hz": result.pulses.speed_hz, **result.pulses.facts}
    return {"recording": result.name, "channel": channel, **known, **values}


def _overview(results: Sequence[RecordingIndicators]) -> TableBlock:
    rows = [
        (
            *(one.name, f"{one.pulses.speed_hz:.4f}", f"{one.mesh_hz:.2f}"),
            *(f"{one.revolutions[0]} and {one.revolutions[1]}", one.pulses.origin, f"{one.recording.duration_s:.3g}"),
        )
        for one in results
    ]
    head = ("Recording", "First shaft [Hz]", "Mesh [Hz]", "Turns averaged", "Angle from", "Length [s]")
    return table(head, rows, "What was found in each recording.", text=True)


def _section(result: RecordingIndicators) -> list[Block]:
    blocks: list[Block] = []
    if (angle := result.pulses.angle) is not None:
        with styled():
            blocks.append(FigureBlock(png_bytes(angle_figure(angle)), ANGLE_CAPTION))
    for channel in result.recording.channels if result.pulses.outcome == "angle" else ():
        with styled():
            png = png_bytes(sideband_figure(result.recording, result.mesh, result.pulses, channel))
        blocks.append(FigureBlock(png, f"Order spectrum (Hann) around mesh harmonics: {channel}."))
    names, values = indicator_matrix(result)
    known = indicator_columns(IndicatorSettings(), gear_names(result.train))
    rows = [
        (Cell(known[name].title, small=name), *of_channels)
        for name, of_channels in zip(names, values.tolist(), strict=True)
    ]
    head = ("Indicator", *result.recording.channels)
    caption = f"Indicators of the whole recording. {result.recording.levels_sentence}"
    return [
        Heading(result.name),
        FigureGrid(blocks),
        table(head, rows, caption, ".4g", sortable=True, tall=True),
        *note_blocks([result.note] if result.note else []),
    ]


def check_mesh_lines(recording: MeasuredRecording, pulses: ShaftPulses, train: GearTrain) -> None:
    """Check that one of the first five lines of the first mesh stands 10 dB over the noise on a channel.

    Raises
    ------
    UsageError
        If none does; names the file.
    """
    mesh = meshes_of(train)[0]
    teeth, orders = mesh.teeth, _mesh_orders(mesh)
    grid = angle_grid(pulses.times_s, SAMPLES_PER_TOOTH * teeth[0])
    duration_s = float(pulses.times_s[-1] - pulses.times_s[0])
    for signal in recording.channels.values():
        turns = resample_to_angle(signal, recording.fs_hz, grid).reshape(grid.revolutions, -1)
        if strongest_mesh_line(order_lines(turns, duration_s), teeth, orders) > OVER_NOISE:
            return
    shaft = mesh.names.gears[0]
    raise UsageError(
        f"{recording.path}: no mesh line of {teeth[0]} teeth stands out at {pulses.speed_hz:.4g} Hz of the {shaft}; "
        f"are these the teeth (--teeth), is the tacho on the {shaft}, and was the machine loaded?"
    )


def _mesh_orders(mesh: GearMesh) -> list[float]:
    """Return the orders of the first harmonics; planets that pass move them to multiples of their number."""
    if mesh.planets is None:
        return [float(h * mesh.teeth[0]) for h in range(1, HARMONICS + 1)]
    ring, step = mesh.planets.ring, mesh.planets.passing
    return [round(h * ring / step) * step * mesh.teeth[0] / ring for h in range(1, HARMONICS + 1)]


def strongest_mesh_line(lines: OrderLines, teeth: tuple[int, int], orders: Sequence[float]) -> float:
    """Return the largest ratio of power between a mesh line's bin and the noise beside it, of harmonics 1 ..."""
    ratios = [0.0]
    for h, order in enumerate(orders, start=1):
        noise = noise_density(lines, teeth, h) * 1.5 * lines.bin_hz
        line = lines.line(order)
        if math.isfinite(line) and noise > 0.0:
            ratios.append(0.5 * line**2 / noise)
    return float(np.max(ratios))


@dataclass(frozen=True, slots=True)
class RecordingIndicators:
    """What one recording gave.

    Attributes
    ----------
    name : str
        The file's, with the row of a Parquet file.
    recording : MeasuredRecording
        In m/s².
    train : GearTrain
        The gearbox.
    pulses : ShaftPulses
        Of the first shaft, from the tacho or from the mesh lines; none where these gave the speed only.
    values : dict of str to float
        Indicators of the whole recording, `<indicator>__<channel>`; NaN where undefined.
    revolutions : (int, int)
        Whole revolutions of the first mesh's gears that were averaged.
    note : str
        What is undefined, and why.
    doubts : tuple of str
        What speaks against unit, teeth or tacho.
    """

    name: str
    recording: MeasuredRecording
    train: GearTrain
    pulses: ShaftPulses
    values: dict[str, float]
    revolutions: tuple[int, int]
    note: str
    doubts: tuple[str, ...] = ()

    @property
    def mesh(self) -> GearMesh:
        """The first mesh."""
        return meshes_of(self.train)[0]

    @property
    def mesh_hz(self) -> float:
        """Mean mesh frequency."""
        return self.pulses.pulses_hz * self.mesh.teeth[0]

    def channel(self, name: str) -> dict[str, float]:
        """Return the indicators of one channel by their own names."""
        ending = f"__{name}"
        return {key.removesuffix(ending): value for key, value in self.values.items() if key.endswith(ending)}


def recording_indicators(
    path: Path,
    gears: Gearing,
    facts: RecordingFacts | None = None,
    speed_range_hz: tuple[float, float] | None = None,
) -> RecordingIndicators:
    """Return all indicators of a recording.

    Parameters
    ----------
    path : Path
        Of a format in `diagnostics.recordings.file_columns.READERS`.
    gears : GearTrain or (int, int)
        The gearbox with its teeth, or the teeth of one pair.
    facts : RecordingFacts, optional
        Rate, columns, unit, tacho. Channels are its columns, or else all columns of numbers but time and tacho.
    speed_range_hz : (float, float), optional
        Where to look for the first shaft's speed; needed without a tacho.

    Raises
    ------
    UsageError
        If the file cannot be read or used, or no speed is certain; names the file and the way out.
    """
    facts = facts or RecordingFacts()
    recording = read_recording(path, None, facts)
    train = train_of(gears)
    pulses = shaft_pulses(recording, train, speed_range_hz, speed_alone=True)
    taken = record_values(recording.channels, pulses.times_s, recording.fs_hz, train)
    name = path.name if facts.row is None else f"{path.name}:{facts.row}"
    doubts = _doubts(recording, pulses, train)
    if pulses.outcome != "angle":
        angled = f"{pulses.origin}. Only indicators of the raw signal are given"
        return RecordingIndicators(name, recording, train, pulses, taken.values, (0, 0), angled, doubts)
    return RecordingIndicators(name, recording, train, pulses, taken.values, taken.revolutions, taken.notes, doubts)


def _doubts(recording: MeasuredRecording, pulses: ShaftPulses, train: GearTrain) -> tuple[str, ...]:
    if pulses.outcome != "angle":
        return tuple(text for text in (level_note(recording),) if text)
    try:
        check_mesh_lines(recording, pulses, train)
    except UsageError as error:
        return tuple(text for text in (level_note(recording), str(error)) if text)
    return tuple(text for text in (level_note(recording),) if text)


def indicator_matrix(result: RecordingIndicators) -> tuple[tuple[str, ...], np.ndarray]:
    """Return the indicators' names and their values (indicators, channels); NaN where undefined."""
    channels = list(result.recording.channels)
    names = tuple(dict.fromkeys(key.rpartition("__")[0] for key in result.values))
    values = [[result.values.get(f"{name}__{channel}", np.nan) for channel in channels] for name in names]
    return names, np.array(values, dtype=np.float64).reshape(len(names), len(channels))
