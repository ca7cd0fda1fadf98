"""The picture of `siggen show`: a record's waveform, and its spectrum around mesh harmonics with sidebands marked."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from siggen.errors import counted
from siggen.views.pictures import save_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from siggen.columns.record import ChannelColumn

HARMONICS = 3
SIDEBANDS = 5
"""Orders of shaft sidebands that are marked on each side of a harmonic."""

SHAFTS = (
    ("pinion_shaft_hz", "C3", "--"), ("gear_shaft_hz", "C2", ":"), ("carrier_hz", "C3", "--"), ("planet_hz", "C2", ":")
)  # fmt: skip
"""Rotations whose sidebands are marked, as far as a record has them."""
OWN = (("C3", "--"), ("C2", ":"))
"""Of a machine with names of its own: the shafts of its first mesh."""


def amplitude_spectrum(signal: np.ndarray, fs_hz: float) -> tuple[np.ndarray, np.ndarray]:
    """Return frequencies [Hz] and amplitudes (n // 2 + 1,) with a Hann window; a tone on a bin shows its amplitude."""
    window = np.hanning(len(signal) + 1)[:-1]
    amplitude = np.abs(np.fft.rfft((signal - signal.mean()) * window)) * 2.0 / window.sum()
    return np.fft.rfftfreq(len(signal), 1.0 / fs_hz), amplitude


def record_figure(record: Mapping[str, Any], channel: ChannelColumn, fs_hz: float) -> Figure:
    """Return the figure of one channel of one record, as `Dataset.record` gives it."""
    from matplotlib.figure import Figure

    signal = np.asarray(record[channel.column], dtype=float)
    harmonics = [h for h in range(1, HARMONICS + 1) if h * _mesh_hz(record) < fs_hz / 2]
    figure = Figure(figsize=(11.0, 6.5), layout="constrained")
    figure.suptitle(_title(record, channel))
    parts = figure.subfigures(2, 1, squeeze=False)[:, 0]
    _draw_waveform(parts[0].subplots(), signal, fs_hz, f"{channel.quantity} [{channel.shown_unit}]")
    if harmonics:
        frequency_hz, amplitude = amplitude_spectrum(signal, fs_hz)
        axes = parts[1].subplots(1, len(harmonics), squeeze=False)[0]
        for harmonic, ax in zip(harmonics, axes, strict=True):
            _draw_harmonic(ax, frequency_hz, amplitude, record, harmonic)
        axes[0].set_ylabel(f"amplitude [{channel.shown_unit}]")
        parts[1].legend(*axes[0].get_legend_handles_labels(), frameon=False, loc="outside lower center", ncols=3)
    return figure


def _title(record: Mapping[str, Any], channel: ChannelColumn) -> str:
    damage = (
        f"{counted(record['damage_count'], 'damage')} on {record['faulty_gear']}, {record['damaged_area_mm2']:.3g} mm²"
    )
    return (
        f"record {record['record_id']} ({record['split']}): {record['state']} "
        f"({record['fault']}, {record['severity']}; {damage})\n"
        f"{record['speed_hz']:.4g} Hz, {record['torque_nm']:.4g} N m, specimen {record['specimen_id']}, "
        f"channel {channel.name} ({channel.place}, {channel.axis})"
    )


def _draw_waveform(ax: Axes, signal: np.ndarray, fs_hz: float, label: str) -> None:
    ax.plot(np.arange(len(signal)) / fs_hz, signal, lw=0.5)
    ax.set_xlabel("time [s]")
    ax.set_ylabel(label)
    ax.margins(x=0)


def _draw_harmonic(
    ax: Axes, frequency_hz: np.ndarray, amplitude: np.ndarray, record: Mapping[str, Any], harmonic: int
) -> None:
    centre_hz = harmonic * _mesh_hz(record)
    shafts = _shafts(record)
    half_width_hz = (SIDEBANDS + 0.5) * max(record[name] for name, *_ in shafts)
    shown = np.abs(frequency_hz - centre_hz) <= half_width_hz
    ax.semilogy(frequency_hz[shown], np.maximum(amplitude[shown], np.finfo(float).tiny), lw=0.9, color="C0")
    ax.axvline(centre_hz, color="0.6", lw=0.8, label="mesh harmonic")
    for name, color, style in shafts:
        for order in range(1, SIDEBANDS + 1):
            for sign in (-1, 1):
                label = f"±k · {name}" if order == sign == 1 else None
                ax.axvline(
                    centre_hz + sign * order * record[name], color=color, ls=style, lw=0.7, alpha=0.7, label=label
                )
    ax.set_xlabel("frequency [Hz]")
    ax.set_title(f"mesh harmonic {harmonic}: {centre_hz:.1f} Hz", fontsize="medium")
    ax.margins(x=0)


def _mesh_hz(record: Mapping[str, Any]) -> float:
    """Return the frequency of the first mesh, whatever its name."""
    return float(next(value for name, value in record.items() if re.fullmatch("mesh_(.*_)?hz", name)))


def _shafts(record: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Return column, colour and style of the rotations whose sidebands are marked."""
    known = [one for one in SHAFTS if one[0] in record]
    own = (name for name in record if name.endswith("_shaft_hz"))
    return known or [(name, *style) for name, style in zip(own, OWN, strict=False)]


def save_record_figure(record: Mapping[str, Any], channel: ChannelColumn, fs_hz: float, path: Path) -> None:
    """Draw a record into a file.

    Raises
    ------
    UsageError
        If matplotlib is missing or the ending is none that it draws.
    """
    save_figure(lambda: record_figure(record, channel, fs_hz), path)
