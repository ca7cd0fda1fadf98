"""Order spectrum of a recording around mesh harmonics with the sidebands of both shafts marked."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.page.style import GEAR_COLOUR, PINION_COLOUR, new_figure
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import ShaftPulses
from diagnostics.signal.order_spectrum import OrderSpectrum, order_spectrum

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HARMONICS_SHOWN = 4
ORDERS_SHOWN = 4.5
SIDEBANDS = 4
DECADES_SHOWN = 5.0
LINE_COLOUR = "#5b6b7b"


def sideband_figure(recording: MeasuredRecording, teeth: tuple[int, int], pulses: ShaftPulses, channel: str) -> Figure:
    """Return the spectrum of a channel around its first mesh harmonics, one row each, all on one scale."""
    speed_hz = pulses.speed_hz
    spectrum = order_spectrum(recording.channels[channel], pulses.times_s, recording.fs_hz, teeth[0])
    highest = int((0.45 * recording.fs_hz / speed_hz - ORDERS_SHOWN) / teeth[0])
    harmonics = range(1, min(HARMONICS_SHOWN, max(1, highest)) + 1)
    figure, axes = new_figure(len(harmonics), 1, height_in=1.0 + 1.3 * len(harmonics), sharex=True, sharey=True)
    top = 0.0
    for axis, harmonic in zip(axes[:, 0], harmonics, strict=True):
        top = max(top, _draw(axis, spectrum, teeth, harmonic))
        title = f"{channel}, mesh harmonic {harmonic}: {harmonic * teeth[0] * speed_hz:.1f} Hz"
        axis.set_title(title, loc="left", fontweight="bold")
    axes[0, 0].set_ylim(2.0 * top / 10**DECADES_SHOWN, 4.0 * top)
    axes[0, 0].set_xlim(-ORDERS_SHOWN, ORDERS_SHOWN)
    axes[-1, 0].set_xlabel(f"Offset from the mesh line [pinion orders of {speed_hz:.4g} Hz]")
    figure.supylabel("Amplitude [m/s²]", fontsize=10)
    _legend(figure)
    return figure


def _draw(axis: Any, spectrum: OrderSpectrum, teeth: tuple[int, int], harmonic: int) -> float:
    near = np.abs(spectrum.order - harmonic * teeth[0]) <= ORDERS_SHOWN
    offset, amplitude = spectrum.order[near] - harmonic * teeth[0], spectrum.amplitude_m_s2[near]
    axis.semilogy(offset, amplitude, color=LINE_COLOUR)
    for step, marker, colour in ((teeth[0] / teeth[1], "|", GEAR_COLOUR), (1.0, "v", PINION_COLOUR)):
        lines = np.array([k * step for k in range(-SIDEBANDS, SIDEBANDS + 1) if k])
        reach = 1.5 / spectrum.revolutions
        height = np.array([amplitude[np.abs(offset - line) <= reach].max(initial=1e-30) for line in lines])
        axis.plot(lines, 1.9 * height, linestyle="none", marker=marker, markersize=4.5, color=colour)
    return float(amplitude.max(initial=1e-30))


def _legend(figure: Figure) -> None:
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], linestyle="none", marker="v", markersize=4.5, color=PINION_COLOUR, label="pinion sidebands"),
        Line2D([], [], linestyle="none", marker="|", markersize=6, color=GEAR_COLOUR, label="gear sidebands"),
    ]
    figure.legend(handles=handles, loc="outside upper right", ncols=2, fontsize=8)
