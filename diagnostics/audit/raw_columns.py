"""Numbers of raw records as a stranger would take them: edges, offsets, lines of fixed frequency, repeated samples.

Layers hold only what damage cannot move, since they accuse alone. Levels rise with damage: rms, peak and power in eight
equal bands to the last bin below half the rate. They accuse where they tell a sham.

* Edges: the rank of the first and last block among all blocks of the record, in level, mean and slope. Records start at
  a random angle, so every block has the same law, whatever the damage: the rank is uniform.
* Offsets: the mean of an acceleration. Nothing that vibrates in place has one.
* Lines: a bin over the median of the bins around it, up to the last one below half the rate. Bins near an order of a
  shaft do not count where orders stand out. Of the others those count that stand highest, or vary most, over all
  records of the set: a line of one frequency in gearboxes of all speeds comes from no gear.
* Repeated samples: runs around large samples that two records share bit by bit, wherever they stand.

Source: derived.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from diagnostics.records.channel_quantities import RECORDED
from diagnostics.records.recording import Recording

EDGES, OFFSETS, LINES = "edges", "offsets", "lines"
EDGE_SAMPLES, EDGE_PARTS = (16, 64), 16
"""Blocks of so many samples, and one part of so many of the record."""

SHAPED_SAMPLES = 64
"""Block whose mean and slope count too."""

MARKED_PARTS, MARK_REACH, FEWEST_VALUES = 32, 8, 12
"""Runs of 17 samples around the largest of every part; one of fewer values, such as a clipped one, marks nothing."""

AROUND, POOLED, KEPT_LINES = 80, 8, 12
"""Bins whose median a bin is divided by, bins of which the highest is kept, and frequencies that are columns, twice."""

EIGHTHS = 8
NEAR_ORDER_BINS, REGION, STANDING = 2, 640, 1.5
"""Orders hide lines only in regions of so many bins where the median beside them is 1.5 times that of the others."""

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
    """

    layers: dict[str, dict[str, np.ndarray]] = field(default_factory=dict)
    levels: dict[str, np.ndarray] = field(default_factory=dict)
    marks: list[frozenset[int]] = field(default_factory=list)
    fs_hz: float = math.nan


def raw_columns(records: Iterable[Recording]) -> RawColumns:
    """Return the numbers of all records, in their order."""
    edges, offsets, lines, levels, marks, fs_hz = [], [], [], [], [], math.nan
    for record in records:
        fs_hz = record.fs_hz
        held = {name: np.asarray(signal, dtype=np.float64) for name, signal in record.channels.items()}
        edges.append({f"{what} of {name}": rank for name, x in held.items() for what, rank in edge_ranks(x).items()})
        offsets.append(
            {f"mean of {name}": float(x.mean()) for name, x in held.items() if _is_acceleration(record, name)}
        )
        lines.append({name: line_contrast(x, record.fs_hz, shaft_rates_hz(record)) for name, x in held.items()})
        marks.append(frozenset(mark for signal in record.channels.values() for mark in sample_marks(signal)))
        levels.append({f"{what} of {name}": level for name, x in held.items() for what, level in raw_levels(x).items()})
    if not marks:
        return RawColumns()
    layers = {EDGES: _columns(edges), OFFSETS: _columns(offsets), LINES: line_columns(lines)}
    return RawColumns(layers, _columns(levels), marks, fs_hz)


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


def edge_ranks(signal: np.ndarray) -> dict[str, float]:
    """Return the shares of blocks that lie below the first and the last one, 0 to 1, by name; none of short records.

    Parameters
    ----------
    signal : (n,) float64
    """
    found = {}
    for edge, turned in (("first", signal), ("last", signal[::-1])):
        for size in (*EDGE_SAMPLES, signal.size // EDGE_PARTS):
            if size < EDGE_SAMPLES[0] or signal.size < EDGE_PARTS * size:
                continue
            blocks = turned[: signal.size // size * size].reshape(-1, size)
            found[f"level, {edge} {size} samples"] = _rank(np.square(blocks).mean(axis=1))
            if size == SHAPED_SAMPLES:
                found[f"mean, {edge} {size} samples"] = _rank(blocks.mean(axis=1))
                half = np.square(blocks).reshape(len(blocks), 2, -1).mean(axis=2)
                found[f"slope of the level, {edge} {size} samples"] = _rank(
                    np.log((half[:, 1] + TINY) / (half[:, 0] + TINY))
                )
    return found


def _rank(values: np.ndarray) -> float:
    """Return the share of the others that lie below the first, ties counted half."""
    return float(np.mean(0.5 + 0.5 * np.sign(values[0] - values[1:])))


def shaft_rates_hz(record: Recording) -> tuple[float, ...]:
    """Return the mean speeds of pinion and gear [Hz] by the pulses; none with fewer than two pulses."""
    pulses = np.asarray(record.tacho_s, dtype=np.float64)
    if pulses.size < 2 or not pulses[-1] > pulses[0]:
        return ()
    pinion = float((pulses.size - 1) / (pulses[-1] - pulses[0]))
    return pinion, pinion * float(record.labels["teeth_pinion"]) / float(record.labels["teeth_gear"])


def line_contrast(signal: np.ndarray, fs_hz: float, rates_hz: tuple[float, ...]) -> np.ndarray:
    """Return how far lines stand over the median of the bins around them, (bins / 8,) float32 [dB].

    Parameters
    ----------
    signal : (n,) float64
    fs_hz : float
        Sampling frequency [Hz].
    rates_hz : tuple of float
        Speeds of the shafts [Hz], near whose multiples nothing counts where these stand out: 0 dB there.
    """
    from scipy import fft

    power = np.square(np.abs(fft.rfft((signal - signal.mean()) * np.hanning(signal.size))))[:-1]
    whole = power.size // AROUND * AROUND
    if not whole:
        return np.empty(0, np.float32)
    blocks = power[:whole].reshape(-1, AROUND)
    # the last bins belong to the block before them
    floor = np.append(np.repeat(np.median(blocks, axis=1), AROUND), np.full(power.size - whole, np.median(blocks[-1])))
    decibels = 10.0 * np.log10((power + TINY) / (floor + TINY))
    decibels[:AROUND] = 0.0  # where the floor falls with frequency
    for rate_hz in rates_hz:
        decibels[near_orders(power / (floor + TINY), rate_hz * signal.size / fs_hz)] = 0.0
    padded = np.append(decibels, np.zeros(-power.size % POOLED))
    return np.asarray(padded.reshape(-1, POOLED).max(axis=1), dtype=np.float32)


def near_orders(ratio: np.ndarray, spacing: float) -> np.ndarray:
    """Return the bins near multiples of a spacing, where such bins stand above the others of their region.

    Parameters
    ----------
    ratio : (k,) float64
        Power over its median around.
    spacing : float
        Bins between two orders.
    """
    bins = np.arange(ratio.size)
    apart = np.abs(bins - spacing * np.round(bins / spacing))
    found = apart <= NEAR_ORDER_BINS
    for start in range(0, ratio.size, REGION):
        part = slice(start, start + REGION)
        on, off = (ratio[part][side[part]] for side in (apart <= 1.0, ~found))
        if on.size and off.size and np.median(on) <= STANDING * np.median(off):
            found[part] = False
    return found


def line_columns(rows: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """Return the contrast at the frequencies that stand highest on the average, or vary most, by channel.

    Parameters
    ----------
    rows : list of dict of str to (k,) float32
        By record and channel, as of `line_contrast`; records of another length are left undefined.
    """
    found = {}
    for channel, first in rows[0].items():
        every = np.full((len(rows), first.size), np.nan, dtype=np.float32)
        for place, row in enumerate(rows):
            if row[channel].size == first.size:
                every[place] = row[channel]
        known = every[np.isfinite(every).all(axis=1)]
        chosen = [np.argsort(-rank, kind="stable")[:KEPT_LINES] for rank in (known.mean(axis=0), known.std(axis=0))]
        for k in dict.fromkeys(np.concatenate(chosen).tolist()):
            share = (k + 0.5) / first.size / 2.0
            found[f"line of {channel} at {share:.4f} of the rate"] = every[:, k].astype(np.float64)
    return found


def sample_marks(signal: np.ndarray) -> set[int]:
    """Return a number for the run of samples around the largest sample of every part of a record.

    Parameters
    ----------
    signal : (n,) float
        As it is stored; taken as float32.
    """
    stored = np.ascontiguousarray(signal, dtype="<f4")
    size, found = stored.size // MARKED_PARTS, set[int]()
    if size <= 2 * MARK_REACH:
        return found
    tops = stored[: size * MARKED_PARTS].reshape(MARKED_PARTS, size).argmax(axis=1) + size * np.arange(MARKED_PARTS)
    for top in tops.tolist():
        run = stored[max(top - MARK_REACH, 0) : top + MARK_REACH + 1]
        if run.size == 2 * MARK_REACH + 1 and np.unique(run).size >= FEWEST_VALUES:
            found.add(int.from_bytes(hashlib.blake2b(run.tobytes(), digest_size=8).digest(), "little"))
    return found
