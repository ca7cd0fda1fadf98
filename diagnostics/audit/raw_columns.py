"""Numbers of raw records as a stranger would take them, by layer; every layer is described where it is computed.

Layers hold only what damage cannot move, since they accuse alone. Levels rise with damage: rms, peak and power in eight
equal bands to the last bin below half the rate. They accuse where they tell a sham, or small damage as well as large.
Source: derived.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from diagnostics.audit.mesh_clock import clock_drift, pulse_roughness
from diagnostics.audit.quiet_ends import quiet_ends
from diagnostics.audit.raw_edges import edge_ranks, offsets
from diagnostics.audit.raw_lines import line_columns, line_contrast, shaft_rates_hz
from diagnostics.audit.stored_samples import sample_marks, stored_numbers, without_ends
from diagnostics.audit.time_templates import level_course, template_products, whitened_codes
from diagnostics.records.channel_quantities import RECORDED
from diagnostics.records.recording import Recording

EDGES, OFFSETS, LINES, STORED, ENDS, CLOCK = "edges", "offsets", "lines", "samples", "ends", "clock"
EIGHTHS = 8
TINY = 1e-30


@dataclass(frozen=True, slots=True)
class RawColumns:
    """Numbers of all records of a set.

    Attributes
    ----------
    layers : dict of str to dict of str to (records,) float64
        Columns by layer.
    levels : dict of str to (records,) float64
        Columns that damage moves too [dB].
    marks : list of frozenset of int
        Runs of samples of every record.
    fs_hz : float
        Sampling frequency [Hz].
    templates : dict of str to (records, records) float64
        Products of records, of what stands at fixed times, by what it is.
    """

    layers: dict[str, dict[str, np.ndarray]] = field(default_factory=dict)
    levels: dict[str, np.ndarray] = field(default_factory=dict)
    marks: list[frozenset[int]] = field(default_factory=list)
    fs_hz: float = math.nan
    templates: dict[str, np.ndarray] = field(default_factory=dict)

    def of(self, rows: np.ndarray) -> RawColumns:
        """Return the numbers of some records, by their rows (k,) int."""
        return replace(
            self,
            layers={layer: {n: v[rows] for n, v in columns.items()} for layer, columns in self.layers.items()},
            levels={name: values[rows] for name, values in self.levels.items()},
            marks=[self.marks[row] for row in rows.tolist()] if self.marks else [],
            templates={what: product[np.ix_(rows, rows)] for what, product in self.templates.items()},
        )


@dataclass(frozen=True, slots=True)
class _RawRecord:
    """What one record gives: columns by layer, contrast by channel, levels, marks, and what stands at fixed times."""

    layers: dict[str, dict[str, float]]
    lines: dict[str, np.ndarray]
    levels: dict[str, float]
    marks: frozenset[int]
    codes: np.ndarray
    course: np.ndarray


def raw_columns(records: Iterable[Recording]) -> RawColumns:
    """Return the numbers of all records, in their order."""
    found, fs_hz = [], math.nan
    for record in records:
        found.append(_raw_record(record))
        fs_hz = record.fs_hz
    if not found:
        return RawColumns()
    layers = {layer: _columns([one.layers[layer] for one in found]) for layer in found[0].layers}
    layers[STORED] = without_ends(layers[STORED])
    layers[LINES] = line_columns([one.lines for one in found])
    templates = template_products([one.codes for one in found], [one.course for one in found])
    return RawColumns(layers, _columns([one.levels for one in found]), [one.marks for one in found], fs_hz, templates)


def _raw_record(record: Recording) -> _RawRecord:
    held = {name: np.asarray(signal, dtype=np.float64) for name, signal in record.channels.items()}
    rates, teeth = shaft_rates_hz(record), record.teeth[0]
    accelerations = {name: x for name, x in held.items() if _is_acceleration(record, name)}
    layers = {
        EDGES: {f"{what} of {name}": rank for name, x in held.items() for what, rank in edge_ranks(x).items()},
        OFFSETS: {f"{what} of {name}": v for name, x in accelerations.items() for what, v in offsets(x).items()},
        STORED: {f"{what} of {name}": v for name, x in held.items() for what, v in stored_numbers(x).items()},
        ENDS: quiet_ends(held, record.fs_hz),
        CLOCK: {
            "roughness of the pulses": pulse_roughness(record.tacho_s),
            **{f"drift of {name}": clock_drift(x, record.fs_hz, record.tacho_s, teeth) for name, x in held.items()},
        },
    }
    return _RawRecord(
        layers,
        {name: line_contrast(x, record.fs_hz, rates) for name, x in held.items()},
        {f"{what} of {name}": level for name, x in held.items() for what, level in raw_levels(x).items()},
        frozenset(mark for signal in record.channels.values() for mark in sample_marks(signal)),
        np.concatenate([whitened_codes(x) for x in held.values()]),
        np.concatenate([level_course(x) for x in held.values()]),
    )


def _is_acceleration(record: Recording, channel: str) -> bool:
    return record.quantities.get(channel, RECORDED.word) == RECORDED.word


def _columns(rows: list[dict[str, float]]) -> dict[str, np.ndarray]:
    names = dict.fromkeys(name for row in rows for name in row)
    return {name: np.array([row.get(name, np.nan) for row in rows]) for name in names}


def raw_levels(signal: np.ndarray) -> dict[str, float]:
    """Return rms, peak and power in equal bands up to half the rate, in dB, of samples (n,) float64."""
    from scipy import fft

    power = np.square(np.abs(fft.rfft(signal - signal.mean())))[1:-1]
    found = {"rms": np.square(signal).mean(), "peak": np.square(signal).max()}
    found |= {
        f"power in eighth {k + 1} of the band": part.sum() for k, part in enumerate(np.array_split(power, EIGHTHS))
    }
    return {name: float(10.0 * np.log10(value + TINY)) for name, value in found.items()}
