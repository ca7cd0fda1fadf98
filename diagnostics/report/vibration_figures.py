"""Figures of records: waveform per state, and order spectrum around a mesh harmonic with its sidebands marked."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.page.style import GEAR_COLOUR, PINION_COLOUR, new_figure
from diagnostics.report.examples import Example, ExampleSet
from diagnostics.signal.order_spectrum import OrderSpectrum

if TYPE_CHECKING:
    from matplotlib.figure import Figure

REVOLUTIONS_SHOWN = 2
ORDERS_SHOWN = 7.0
SIDEBANDS = 6
DECADES_SHOWN = 5.0
TALLEST_IN = 9.5
"""A figure of half a page's width that is taller does not fit a sheet."""

BEHIND_COLOUR = "#b9c4cd"


def waveform_figure(examples: ExampleSet, colours: dict[str, str]) -> Figure:
    """Return acceleration over two pinion revolutions, one row per state, all on one scale."""
    rows = len(examples.examples)
    figure, axes = new_figure(rows, 1, height_in=_height_in(0.7, 1.1, rows), sharex=True, sharey=True)
    for axis, example in zip(axes[:, 0], examples.examples, strict=True):
        start_s = example.tacho_s[0] if len(example.tacho_s) else 0.0
        first = round(start_s * examples.fs_hz)
        signal = example.signal_m_s2[first : first + round(REVOLUTIONS_SHOWN / examples.speed_hz * examples.fs_hz)]
        axis.plot(1e3 * np.arange(signal.size) / examples.fs_hz, signal, color=colours[example.state], linewidth=0.6)
        axis.set_title(example.state, loc="left", fontweight="bold", color=colours[example.state])
        for pulse in range(REVOLUTIONS_SHOWN + 1):
            axis.axvline(1e3 * pulse / examples.speed_hz, color="#9aa7b2", linewidth=0.7, linestyle=":")
    axes[-1, 0].set_xlabel("Time since a shaft pulse [ms]")
    figure.supylabel("Acceleration [m/s²]", fontsize=10)
    return figure


def _height_in(frame: float, row: float, rows: int) -> float:
    return min(frame + row * rows, max(TALLEST_IN, frame + 0.62 * rows))


def spectrum_figure(examples: ExampleSet, colours: dict[str, str], harmonic: int) -> Figure:
    """Return the order spectrum around one mesh harmonic, one row per state, the healthy state in grey behind."""
    rows = len(examples.examples)
    figure, axes = new_figure(rows, 1, height_in=_height_in(1.0, 1.25, rows), sharex=True, sharey=True)
    top = max(
        _around(example.spectrum, examples, harmonic)[1].max() for example in examples.examples if example.spectrum
    )
    for axis, example in zip(axes[:, 0], examples.examples, strict=True):
        _draw_spectrum(axis, example, examples, harmonic, colours[example.state])
        axis.set_title(example.state, loc="left", fontweight="bold", color=colours[example.state])
    axes[0, 0].set_ylim(2.0 * top / 10**DECADES_SHOWN, 4.0 * top)
    axes[0, 0].set_xlim(-ORDERS_SHOWN, ORDERS_SHOWN)
    mesh_hz = harmonic * examples.teeth[0] * examples.speed_hz
    axes[-1, 0].set_xlabel(f"Offset from {mesh_hz:.0f} Hz [pinion orders of {examples.speed_hz:.3g} Hz]")
    figure.supylabel("Amplitude [m/s²]", fontsize=10)
    _add_legend(axes[0, 0])
    return figure


def _around(spectrum: OrderSpectrum, examples: ExampleSet, harmonic: int) -> tuple[np.ndarray, np.ndarray]:
    centre = harmonic * examples.teeth[0]
    near = np.abs(spectrum.order - centre) <= ORDERS_SHOWN
    return spectrum.order[near] - centre, spectrum.amplitude_m_s2[near]


def _draw_spectrum(axis: Any, example: Example, examples: ExampleSet, harmonic: int, colour: str) -> None:
    healthy = examples.healthy
    if healthy and healthy.spectrum and example is not healthy:
        axis.semilogy(*_around(healthy.spectrum, examples, harmonic), color=BEHIND_COLOUR, linewidth=0.8)
    axis.set_yscale("log")
    if example.spectrum is None:
        return
    offset, amplitude = _around(example.spectrum, examples, harmonic)
    axis.semilogy(offset, amplitude, color=colour)
    ratio = examples.teeth[0] / examples.teeth[1]
    for step, marker, marked in ((ratio, "|", GEAR_COLOUR), (1.0, "v", PINION_COLOUR)):
        lines = np.array([k * step for k in range(-SIDEBANDS, SIDEBANDS + 1) if k])
        height = np.array([_peak(offset, amplitude, line, 1.5 / example.spectrum.revolutions) for line in lines])
        axis.plot(lines, height * 1.9, linestyle="none", marker=marker, markersize=4.5, color=marked)


def _peak(offset: np.ndarray, amplitude: np.ndarray, line: float, reach: float) -> float:
    """Return the largest amplitude within reach of a line."""
    return float(amplitude[np.abs(offset - line) <= reach].max(initial=1e-30))


def _add_legend(axis: Any) -> None:
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], linestyle="none", marker="v", markersize=4.5, color=PINION_COLOUR, label="pinion sidebands"),
        Line2D([], [], linestyle="none", marker="|", markersize=6, color=GEAR_COLOUR, label="gear sidebands"),
        Line2D([], [], color=BEHIND_COLOUR, linewidth=1.5, label="healthy"),
    ]
    axis.legend(
        handles=handles,
        loc="lower right",
        bbox_to_anchor=(1.0, 1.0),
        ncols=3,
        fontsize=8,
        borderpad=0.0,
        columnspacing=1.0,
    )
