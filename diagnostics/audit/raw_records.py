"""Numbers of raw records as a stranger would take them, by layer.

Layers hold only what damage cannot move, since they accuse alone. Levels rise with damage: rms, peak and power in eight
equal bands to the last bin below half the rate. They accuse where they tell a sham, or small damage as well as large.

* Edges: the rank of the first and last block among all blocks of the record, in level, mean and slope. Records start at
  a random angle, so every block has the same law, whatever the damage: the rank is uniform.
* Offsets: mean of an acceleration, and rise of a straight line through it. Nothing that vibrates in place has one.
* Lines that come from no gear, at one frequency in all records, beside the orders of the shafts. A line is a bin over
  the median of the bins around it. Bins near an order of a shaft do not count where orders stand out. Of the others
  those count that stand highest, or vary most, over all records of the set.
* Ends: level below 8 Hz, where no shaft turns, and in the last thirty-second below half the rate, where converters have
  filtered lines away; and what channels share there: the mean product of their spectra, over blocks of bins, each
  divided by its own level. Two channels with a noise of their own share nothing.
* Clock: a gear turns with its shaft. So the phase of a mesh line, beside the angle that the pulses give, stays where it
  is over a record, whatever damage there is: a drift is one of clocks.
* Samples as they are stored: neighbours that are equal, beside those that differ by one to three steps of the
  converter, of which small differences are equally frequent, however strong a signal is; samples as large as the
  largest, whose end does not count where several records reach it; ranks of the first and the last difference; runs
  around large samples ("marks"), by which two records that share them bit by bit are found, wherever they stand.
* Codes: the law of what a converter gives (`stored_codes`).
* Course: how the level of a record goes over its time, by a straight line and two cosines and sines, in the median bin
  of a spectrum, so that no line rules it, and in the roughest part. Records start at a random angle, so neither a gear
  nor its damage has a course of its own.
* Blocks: the roughness of samples at the edges of blocks of equal length, beside that at all other places.
* Phases: of lines of orders that are no whole ones, from the first pulse on, those that have most of an angle in common
  in the set. What turns with another machine has no angle of its own against the gears.
* Templates: what is alike in records at the same time after their first sample. On the average over records a machine
  adds nothing to a sample, however damaged. A spectrum is divided by its own floor, since strong lines would hide what
  is alike, and cut where lines stand out. Four parts of it, of two octaves each but the lowest, are products of their
  own: one tone is lost among all lines. The course of the level is the power of 64 parts of the record in decibels,
  less their mean. A second spectrum begins at the first pulse.
* Locked, low bits, echoes: phases of fixed frequencies, lowest bits of fixed samples, fixed lags (`fixed_times`).

Source: derived.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import combinations, pairwise

import numpy as np

from diagnostics.audit.fixed_times import (
    component_columns,
    echo_codes,
    echo_columns,
    locked_columns,
    parity_bits,
    parity_product,
    phase_codes,
    phase_product,
)
from diagnostics.audit.spectral_shape import floor_levels
from diagnostics.audit.stored_codes import code_law
from diagnostics.judging.evaluation import Entry
from diagnostics.judging.learners import GroupRidge
from diagnostics.records.channel_quantities import RECORDED
from diagnostics.records.recording import Recording

EDGE_SAMPLES, EDGE_PARTS = (16, 64), 16
"""Blocks of so many samples, and one part of so many of the record."""

SHAPED_SAMPLES = 64
"""Block whose mean and slope count too."""

TINY = 1e-30


def edge_ranks(signal: np.ndarray) -> dict[str, float]:
    """Return the shares of blocks that lie below the first and the last one, 0 to 1, by name; none of short records.

    Parameters
    ----------
    signal : (n,) float64
    """
    ranks = {}
    for edge, turned in (("first", signal), ("last", signal[::-1])):
        for size in (*EDGE_SAMPLES, signal.size // EDGE_PARTS):
            if size < EDGE_SAMPLES[0] or signal.size < EDGE_PARTS * size:
                continue
            blocks = turned[: signal.size // size * size].reshape(-1, size)
            ranks[f"level, {edge} {size} samples"] = rank_of_first(np.square(blocks).mean(axis=1))
            if size == SHAPED_SAMPLES:
                ranks[f"mean, {edge} {size} samples"] = rank_of_first(blocks.mean(axis=1))
                half = np.square(blocks).reshape(len(blocks), 2, -1).mean(axis=2)
                ranks[f"slope of the level, {edge} {size} samples"] = rank_of_first(
                    np.log((half[:, 1] + TINY) / (half[:, 0] + TINY))
                )
    return ranks


def offsets(signal: np.ndarray) -> dict[str, float]:
    """Return the mean of samples (n,) float64, and by how much a straight line rises over the record."""
    course = np.linspace(-0.5, 0.5, signal.size) if signal.size > 1 else np.zeros(signal.size)
    mean = float(signal.mean())
    return {"mean": mean, "size of the mean": abs(mean), "rise": 12.0 * float(np.mean(signal * course))}


PIECES, FRAME = 2, 1024
"""Cosines and sines of a course, beside a straight line, and samples of a frame."""


def course_numbers(signal: np.ndarray) -> dict[str, float]:
    """Return how the level of samples (n,) float64 goes over time, by name [dB]; none with too few frames.

    Median over the bins of a spectrum; and of fourth differences, which are noise for the most part.
    """
    from scipy import fft

    frames = signal[: signal.size // FRAME * FRAME].reshape(-1, FRAME) * np.hanning(FRAME)
    if len(frames) < 4 * PIECES:
        return {}
    bins = 20.0 * np.log10(np.abs(fft.rfft(frames, axis=1))[:, 4:-4] + TINY)
    rough = level_course(np.diff(signal, 4)).astype(np.float64)[:, None]
    numbers = {}
    for what, course in (("level", bins), ("noise", rough)):
        time = (np.arange(len(course)) + 0.5) / len(course)
        parts = {"rise": 12.0 * (time - 0.5)}
        for k in range(1, PIECES + 1):
            parts |= {
                f"cosine {k}": 2.0 * np.cos(2 * np.pi * k * time),
                f"sine {k}": 2.0 * np.sin(2 * np.pi * k * time),
            }
        for name, wave in parts.items():
            numbers[f"{name} of the {what}"] = float(np.median(wave @ course) / time.size)
    return numbers


BLOCK_LENGTHS = (100, 128, 250, 256, 500, 512, 1000, 1024, 2000, 2048, 4096)
FEWEST_BLOCKS = 4


def block_edges(signal: np.ndarray) -> dict[str, float]:
    """Return by how many standard deviations blocks of samples (n,) float64 are rougher at their ends than elsewhere.

    The first samples of the first block, which every record has, do not count.
    """
    bent = np.log(np.square(np.diff(signal, 4)) + TINY)  # bent[k] is of the samples around k + 2
    bent -= bent.mean()
    spread, roughness = float(bent.std()) + TINY, {}
    for length in BLOCK_LENGTHS:
        edges = np.arange(length, signal.size - 4, length) - 2
        if edges.size >= FEWEST_BLOCKS:
            for name, apart in (("last", -1), ("first", 0)):
                rough = float(bent[edges + apart].mean() / spread * math.sqrt(edges.size))
                roughness[f"{name} of every {length} samples"] = rough
    return roughness


def rank_of_first(values: np.ndarray) -> float:
    """Return the share of the others that lie below the first, ties counted half."""
    return float(np.mean(0.5 + 0.5 * np.sign(values[0] - values[1:])))


LINE_AROUND, POOLED, KEPT_LINES = 80, 8, 12
"""Bins whose median a bin is divided by, bins of which the highest is kept, and frequencies that are columns, twice."""

LOW_AROUND = 16
"""In place of `LINE_AROUND` where the floor falls with frequency: below the 80th bin. Of the first 16 none counts."""

NEAR_ORDER_BINS, REGION, STANDING = 2, 640, 1.5
"""Orders hide lines only in regions of so many bins where the median beside them is 1.5 times that of the others."""


def shaft_rates_hz(record: Recording) -> tuple[float, ...]:
    """Return the mean speeds of the first two shafts [Hz] by the pulses; none with fewer than two pulses."""
    pulses = np.asarray(record.tacho_s, dtype=np.float64)
    if pulses.size < 2 or not pulses[-1] > pulses[0]:
        return ()
    first, (driver, driven) = float((pulses.size - 1) / (pulses[-1] - pulses[0])), record.teeth
    return first, first * driver / driven


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
    whole = power.size // LINE_AROUND * LINE_AROUND
    if not whole:
        return np.empty(0, np.float32)
    low, blocks = power[:LINE_AROUND].reshape(-1, LOW_AROUND), power[:whole].reshape(-1, LINE_AROUND)
    # the last bins belong to the block before them
    floor = np.append(
        np.repeat(np.median(blocks, axis=1), LINE_AROUND), np.full(power.size - whole, np.median(blocks[-1]))
    )
    floor[:LINE_AROUND] = np.repeat(np.median(low, axis=1), LOW_AROUND)
    decibels = 10.0 * np.log10((power + TINY) / (floor + TINY))
    decibels[:LOW_AROUND] = 0.0
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
    near = apart <= NEAR_ORDER_BINS
    for start in range(0, ratio.size, REGION):
        part = slice(start, start + REGION)
        on, off = (ratio[part][side[part]] for side in (apart <= 1.0, ~near))
        if on.size and off.size and np.median(on) <= STANDING * np.median(off):
            near[part] = False
    return near


def line_columns(rows: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """Return the contrast at the frequencies that stand highest on the average, or vary most, by channel.

    Parameters
    ----------
    rows : list of dict of str to (k,) float32
        By record and channel, as of `line_contrast`; records of another length are left undefined.
    """
    columns = {}
    for channel, first in rows[0].items():
        every = np.full((len(rows), first.size), np.nan, dtype=np.float32)
        for place, row in enumerate(rows):
            if row[channel].size == first.size:
                every[place] = row[channel]
        known = every[np.isfinite(every).all(axis=1)]
        chosen = [np.argsort(-rank, kind="stable")[:KEPT_LINES] for rank in (known.mean(axis=0), known.std(axis=0))]
        for k in dict.fromkeys(np.concatenate(chosen).tolist()):
            share = (k + 0.5) / first.size / 2.0
            columns[f"line of {channel} at {share:.4f} of the rate"] = every[:, k].astype(np.float64)
    return columns


LOW_HZ, HIGH_PARTS = 8.0, 32
SHARED_PARTS = (8, 16, 32)
"""Parts of the band at whose last ones channels are compared."""

BLOCK, FEWEST_BINS = 50, 4


def quiet_ends(channels: dict[str, np.ndarray], fs_hz: float) -> dict[str, float]:
    """Return levels [dB] and what channels share, -1 to 1, by name; undefined where a record is too short.

    Parameters
    ----------
    channels : dict of str to (n,) float64
    fs_hz : float
        Sampling frequency [Hz].
    """
    from scipy import fft

    spectra = {name: fft.rfft((x - x.mean()) * np.hanning(x.size))[1:-1] for name, x in channels.items()}
    numbers = {}
    for name, lines in spectra.items():
        low = lines[: int(LOW_HZ * channels[name].size / fs_hz)]
        numbers[f"level below {LOW_HZ:g} Hz of {name}"] = _mean_level(low)
        numbers[f"level of the highest bins of {name}"] = _mean_level(lines[-(lines.size // HIGH_PARTS) :])
    for first, second in combinations(spectra, 2):
        for parts in SHARED_PARTS if spectra[first].size == spectra[second].size else ():
            kept = slice(-(spectra[first].size // parts), None)
            name = f"last 1/{parts} of the band that {first} and {second} share"
            numbers[name] = _shared(spectra[first][kept], spectra[second][kept])
    return numbers


def _mean_level(lines: np.ndarray) -> float:
    """Return the mean level of lines in dB, by logarithms, so that no line rules it."""
    if lines.size < FEWEST_BINS:
        return math.nan
    return float(np.mean(10.0 * np.log10(np.square(np.abs(lines)) / lines.size + TINY)))


def _shared(first: np.ndarray, second: np.ndarray) -> float:
    blocks = first.size // BLOCK
    if not blocks:
        return math.nan
    of_first, of_second = (lines[-blocks * BLOCK :].reshape(blocks, BLOCK) for lines in (first, second))
    product = (of_first * of_second.conj()).real.mean(axis=1)
    size = np.sqrt(np.square(np.abs(of_first)).mean(axis=1) * np.square(np.abs(of_second)).mean(axis=1))
    return float(np.mean(product / (size + TINY)))


SEGMENTS, HARMONICS = 8, 3
FEWEST_PULSES = 2 * SEGMENTS


def clock_drift(signal: np.ndarray, fs_hz: float, pulses_s: np.ndarray, teeth: int) -> float:
    """Return by what share of its speed the mesh runs ahead of the pulses; NaN with too few of these.

    Parameters
    ----------
    signal : (n,) float64
    fs_hz : float
        Sampling frequency [Hz].
    pulses_s : (k,) float64
        One per turn [s].
    teeth : int
    """
    if pulses_s.size < FEWEST_PULSES:
        return math.nan
    first, last = (int(pulses_s[k] * fs_hz) + 1 for k in (0, -1))
    length = (min(last, signal.size) - first) // SEGMENTS
    if first < 0 or length < 1:
        return math.nan
    kept = slice(first, first + length * SEGMENTS)
    turns = np.interp(np.arange(kept.start, kept.stop) / fs_hz, pulses_s, np.arange(pulses_s.size))
    once, lines = np.exp(-2j * np.pi * teeth * turns), []
    for harmonic in range(1, HARMONICS + 1):
        lines.append((signal[kept] * once**harmonic).reshape(SEGMENTS, length).sum(axis=1))
    across = np.array([np.sum(line[1:] * line[:-1].conj()) for line in lines])
    ahead = np.angle(across) / (2.0 * np.pi * teeth * np.arange(1, HARMONICS + 1))
    weight = np.abs(across) * np.square(np.arange(1, HARMONICS + 1))
    return float((weight @ ahead) / (weight.sum() + TINY) / ((turns[-1] - turns[0]) / SEGMENTS))


def pulse_roughness(pulses_s: np.ndarray) -> float:
    """Return log10 of the scatter of third differences of pulse times (k,) [s]; a shaft's own speed leaves few."""
    third = np.diff(np.asarray(pulses_s, dtype=np.float64), 3)
    return float(np.log10(third.std() + 1e-12)) if third.size > 1 else math.nan


def pulse_places(pulses_s: np.ndarray, duration_s: float) -> dict[str, float]:
    """Return how pulses (k,) [s] lie in a record; nothing with fewer than four.

    Pulses run from end to end, one after the other: less than an interval is left at either end, no interval is twice
    as long as others, and no pulse stands in the middle of its neighbours to the last bit, as one that was filled in.
    """
    if pulses_s.size < 4:
        return {}
    intervals_s = np.diff(pulses_s)
    middle_s = float(np.median(intervals_s))
    return {
        "intervals ahead of the pulses": float(pulses_s[0]) / middle_s,
        "intervals behind the pulses": (duration_s - float(pulses_s[-1])) / middle_s,
        "longest interval in medians, whole": float(np.round(intervals_s.max() / middle_s)),
        "pulses in the middle of their neighbours": float(
            np.mean(pulses_s[1:-1] == 0.5 * (pulses_s[:-2] + pulses_s[2:]))
        ),
    }


GRIDS_S = (1e-3, 1e-4, 1e-5, 1e-6)


def pulse_grids(pulses_s: np.ndarray, fs_hz: float) -> dict[str, float]:
    """Return how far pulses (k,) [s] lie from grids of round times, and of the samples, over what chance gives."""
    grids = {f"{grid_s:g} s": grid_s for grid_s in GRIDS_S} | {"the samples": 1.0 / fs_hz}
    shares = {name: np.asarray(pulses_s, dtype=np.float64) / grid_s for name, grid_s in grids.items()}
    return {
        f"distance of the pulses from {name}": 4.0 * float(np.mean(np.abs(share - np.round(share))))
        for name, share in shares.items()
        if share.size
    }


MARKED_PARTS, MARK_REACH, FEWEST_VALUES = 32, 8, 12
"""Runs of 17 samples around the largest of every part; one of fewer values, such as a clipped one, marks nothing."""

NEIGHBOURS = 3
"""Steps up and down whose frequency the repeats are compared with."""

TOP = "largest sample"
"""Held by `stored_numbers` for `without_ends`, which takes it out."""


def stored_numbers(signal: np.ndarray) -> dict[str, float]:
    """Return the numbers of one channel (n,) float64 by name; none of fewer than three samples."""
    if signal.size < 3:
        return {}
    size, apart = np.abs(signal), np.abs(np.diff(signal))
    step = apart[apart > 0.0].min(initial=np.inf)
    near = 1.5 * step if np.isfinite(step) else 0.0
    return {
        "repeats": repeats_beyond_chance(apart),
        "samples as large as the largest": float(np.sum(size >= size.max() - near)),
        "first difference": rank_of_first(apart),
        "last difference": rank_of_first(apart[::-1]),
        TOP: float(size.max()),
    }


def repeats_beyond_chance(apart: np.ndarray) -> float:
    """Return by how many standard deviations equal neighbours exceed those a few steps apart.

    Parameters
    ----------
    apart : (n,) float64
        Differences of neighbours, without signs.
    """
    above = apart[apart > 0.0]
    if not above.size:
        return float(apart.size)
    steps = np.round(apart / above.min())
    few = float(np.sum((steps >= 1.0) & (steps <= NEIGHBOURS)))
    expected = few / (2.0 * NEIGHBOURS)
    return float((np.sum(apart == 0.0) - expected) / np.sqrt(expected + few / (2.0 * NEIGHBOURS) ** 2 + 1.0))


def without_ends(columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return columns of all records without the largest samples; where several records share one, it counts once.

    Parameters
    ----------
    columns : dict of str to (records,) float64
        As of `stored_numbers`, "... of channel".
    """
    kept = {name: values for name, values in columns.items() if not name.startswith(TOP)}
    for name, tops in columns.items():
        if name.startswith(TOP):
            _, place, counts = np.unique(tops, return_inverse=True, return_counts=True)
            largest = f"samples as large as the largest{name.removeprefix(TOP)}"
            kept[largest] = np.where(counts[place.ravel()] > 1, 1.0, kept[largest])
    return kept


def sample_marks(signal: np.ndarray) -> set[int]:
    """Return a number for the run of samples around the largest sample of every part of a record.

    Parameters
    ----------
    signal : (n,) float
        As it is stored; taken as float32.
    """
    stored = np.ascontiguousarray(signal, dtype="<f4")
    size, marks = stored.size // MARKED_PARTS, set[int]()
    if size <= 2 * MARK_REACH:
        return marks
    tops = stored[: size * MARKED_PARTS].reshape(MARKED_PARTS, size).argmax(axis=1) + size * np.arange(MARKED_PARTS)
    for top in tops.tolist():
        run = stored[max(top - MARK_REACH, 0) : top + MARK_REACH + 1]
        if run.size == 2 * MARK_REACH + 1 and np.unique(run).size >= FEWEST_VALUES:
            marks.add(int.from_bytes(hashlib.blake2b(run.tobytes(), digest_size=8).digest(), "little"))
    return marks


TEMPLATES = "templates"
TEMPLATE_SAMPLES, AROUND, TEMPLATE_TURNS = 16384, 32, 16
LARGEST_CODE, CODES = 4.0, 31.0
"""Times its floor up to which a line counts, and codes per floor: a byte holds them."""

COURSE_PARTS = 64
IN_PARTS, BANDS = "spectra", (0, 1 / 64, 1 / 16, 1 / 4, 1)
"""What has parts, and the edges of the parts of a spectrum, in shares of half the rate."""


def whitened_codes(signal: np.ndarray) -> np.ndarray:
    """Return the spectrum of the first samples (n,) over its floor, real and imaginary part, (2, k) int8."""
    from scipy import fft

    return _codes_of_lines(fft.rfft(_windowed(signal[:TEMPLATE_SAMPLES]))[1:])


def order_codes(signal: np.ndarray, fs_hz: float, pulses_s: np.ndarray) -> np.ndarray:
    """Return the same over 16 turns of the shaft from the first pulse on, without its whole orders, (2, k) int8.

    Parameters
    ----------
    signal : (n,) float64
    fs_hz : float
        Sampling frequency [Hz].
    pulses_s : (k,) float64
        One per turn [s]; with too few nothing is left.
    """
    from scipy import fft

    if pulses_s.size <= TEMPLATE_TURNS:
        return np.zeros((2, 0), np.int8)
    turns = np.arange(TEMPLATE_SAMPLES) * (TEMPLATE_TURNS / TEMPLATE_SAMPLES)
    times_s = np.interp(turns, np.arange(pulses_s.size), pulses_s)
    piece = np.interp(times_s * fs_hz, np.arange(signal.size), signal)
    lines = fft.rfft(_windowed(piece))[1:]
    place = np.arange(1, lines.size + 1) % TEMPLATE_TURNS
    return _codes_of_lines(lines, np.minimum(place, TEMPLATE_TURNS - place) > NEAR_ORDER_BINS)


def _windowed(piece: np.ndarray) -> np.ndarray:
    return np.asarray((piece - piece.mean()) * np.hanning(piece.size))


def _codes_of_lines(lines: np.ndarray, kept: np.ndarray | None = None) -> np.ndarray:
    """Return lines over the floor around them in codes; those that are not kept give zeros."""
    lines = lines[: lines.size // AROUND * AROUND].reshape(-1, AROUND)
    floor = np.sqrt(np.median(np.square(np.abs(lines)), axis=1, keepdims=True) / np.log(2.0)) + TINY
    over = lines / floor
    over /= np.maximum(np.abs(over) / LARGEST_CODE, 1.0)
    if kept is not None:
        over *= kept[: over.size].reshape(over.shape)
    return np.round(CODES * np.stack([over.real, over.imag])).astype(np.int8).reshape(2, -1)


def level_course(signal: np.ndarray) -> np.ndarray:
    """Return the level of equal parts of a record (n,) less its mean, (64,) float32 [dB]."""
    size = signal.size // COURSE_PARTS
    if not size:
        return np.zeros(COURSE_PARTS, np.float32)
    power = np.square(signal[: size * COURSE_PARTS] - signal.mean()).reshape(COURSE_PARTS, size).mean(axis=1)
    decibels = 10.0 * np.log10(power + TINY)
    return np.asarray(decibels - decibels.mean(), dtype=np.float32)


def template_products(codes: Mapping[str, list[np.ndarray]], courses: list[np.ndarray]) -> dict[str, np.ndarray]:
    """Return the products of all pairs of records, (records, records), by what they are of.

    Parameters
    ----------
    codes : mapping of str to (records) of (2 channels, k) int8
        By what they are of. Zero is put for records that are shorter than the longest.
    courses : (records) of (channels * 64,) float32
    """
    products = {}
    for what, records in codes.items():
        size = max(row.shape[1] for row in records)
        rows = np.flatnonzero([row.shape[1] == size for row in records])
        for low, high in pairwise(round(edge * size) for edge in (BANDS if what == IN_PARTS else (0, 1))):
            part = np.stack([records[row][:, low:high].ravel() for row in rows.tolist()]).astype(np.float32) / CODES
            product = np.zeros((len(records), len(records)))
            product[np.ix_(rows, rows)] = part @ part.T / max(part.shape[1], 1)
            products[f"{what}, lines {low} to {high}"] = product
    every = np.stack(courses).astype(np.float64)
    return {**products, "courses of the level": every @ every.T}


def phase_columns(orders: list[np.ndarray]) -> dict[str, np.ndarray]:
    """Return both parts of the lines that have most of an angle in common, (records,) float64 each, by name.

    Parameters
    ----------
    orders : (records) of (2 channels, k) int8
        As of `order_codes`; shorter ones are left undefined.
    """
    size = max(row.shape[1] for row in orders)
    every = np.full((len(orders), orders[0].shape[0], size), np.nan)
    for place, row in enumerate(orders):
        if row.shape[1] == size:
            every[place] = row
    columns, known = {}, every[np.isfinite(every).all(axis=(1, 2))]
    for channel in range(every.shape[1] // 2 if known.size else 0):
        parts = slice(2 * channel, 2 * channel + 2)
        common = np.square(known[:, parts].sum(axis=0)).sum(axis=0)
        common /= np.square(known[:, parts]).sum(axis=(0, 1)) + 1.0
        for line in np.argsort(-common, kind="stable")[:KEPT_LINES].tolist():
            order = (line + 1) / TEMPLATE_TURNS
            for name, part in zip(("real", "imaginary"), every[:, parts, line].T, strict=True):
                columns[f"{name} part at order {order:.7g} of channel {channel + 1}"] = part
    return columns


def template_detectors(products: dict[str, np.ndarray]) -> list[Entry]:
    """Return the detectors on products of all pairs of records, (records, records) each, by what they are of."""
    return [
        Entry(
            f"{TEMPLATES} of {what}",
            partial(GroupRidge, product),
            np.arange(len(product)),
            np.diagonal(product) > 0.0,
            len(product),
        )
        for what, product in products.items()
        if product.any()
    ]


EDGES, OFFSETS, LINES, STORED, ENDS, CLOCK = "edges", "offsets", "lines", "samples", "ends", "clock"
CODE_LAW, COURSE, BLOCKS, PHASES = "codes", "course", "blocks", "phases"
LOCKED, LOW_BITS, ECHOES = "locked", "low_bits", "echoes"
OF_NO_GEARBOX = frozenset({CODE_LAW, COURSE, BLOCKS, PHASES, LOCKED, LOW_BITS, ECHOES})
"""Layers that have one law for all gearboxes: beside a reference they only scatter more."""

EIGHTHS = 8


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
    floors : dict of str to (records, 64) float32
        Power of bands by channel, as of `diagnostics.audit.spectral_shape.floor_levels` [dB].
    """

    layers: dict[str, dict[str, np.ndarray]] = field(default_factory=dict)
    levels: dict[str, np.ndarray] = field(default_factory=dict)
    marks: list[frozenset[int]] = field(default_factory=list)
    fs_hz: float = math.nan
    templates: dict[str, np.ndarray] = field(default_factory=dict)
    floors: dict[str, np.ndarray] = field(default_factory=dict)

    def of(self, rows: np.ndarray) -> RawColumns:
        """Return the numbers of some records, by their rows (k,) int."""
        return replace(
            self,
            layers={layer: {n: v[rows] for n, v in columns.items()} for layer, columns in self.layers.items()},
            levels={name: values[rows] for name, values in self.levels.items()},
            marks=[self.marks[row] for row in rows.tolist()] if self.marks else [],
            templates={what: product[np.ix_(rows, rows)] for what, product in self.templates.items()},
            floors={name: levels[rows] for name, levels in self.floors.items()},
        )


@dataclass(frozen=True, slots=True)
class _RawRecord:
    """What one record gives: columns by layer, contrast by channel, levels, marks, and what stands at fixed times."""

    layers: dict[str, dict[str, float]]
    lines: dict[str, np.ndarray]
    levels: dict[str, float]
    marks: frozenset[int]
    codes: np.ndarray
    from_pulse: np.ndarray
    orders: np.ndarray
    course: np.ndarray
    floors: dict[str, np.ndarray]
    phases: dict[str, np.ndarray]
    low_bits: dict[str, np.ndarray]
    echoes: dict[str, np.ndarray]


def raw_columns(records: Iterable[Recording]) -> RawColumns:
    """Return the numbers of all records, in their order."""
    rows, fs_hz = [], math.nan
    for record in records:
        rows.append(_raw_record(record))
        fs_hz = record.fs_hz
    if not rows:
        return RawColumns()
    layers = {layer: _columns([row.layers[layer] for row in rows]) for layer in rows[0].layers}
    layers[STORED] = without_ends(layers[STORED])
    layers[LINES] = line_columns([row.lines for row in rows])
    layers[PHASES] = phase_columns([row.orders for row in rows])
    channels = tuple(rows[0].floors)
    phases = {f"phases of {name}": phase_product([row.phases[name] for row in rows]) for name in channels}
    layers[LOCKED] = locked_columns([row.phases for row in rows]) | component_columns(phases)
    layers[LOW_BITS] = component_columns(
        {f"low bits of {name}": parity_product([row.low_bits[name] for row in rows]) for name in channels}
    )
    layers[ECHOES] = echo_columns([row.echoes for row in rows], fs_hz)
    codes = {
        IN_PARTS: [row.codes for row in rows],
        "spectra from the first pulse": [row.from_pulse for row in rows],
    }
    templates = template_products(codes, [row.course for row in rows])
    floors = {name: np.stack([row.floors[name] for row in rows]) for name in rows[0].floors}
    levels, marks = _columns([row.levels for row in rows]), [row.marks for row in rows]
    return RawColumns(layers, levels, marks, fs_hz, templates, floors)


def _raw_record(record: Recording) -> _RawRecord:
    held = {name: np.asarray(signal, dtype=np.float64) for name, signal in record.channels.items()}
    rates, teeth = shaft_rates_hz(record), record.teeth[0]
    accelerations = {name: x for name, x in held.items() if _is_acceleration(record, name)}
    first = round(float(record.tacho_s[0]) * record.fs_hz) if record.tacho_s.size else 0
    layers = {
        EDGES: _by_channel(held, edge_ranks),
        OFFSETS: _by_channel(accelerations, offsets),
        STORED: _by_channel(held, stored_numbers),
        CODE_LAW: code_law(record.channels),
        COURSE: _by_channel(held, course_numbers),
        BLOCKS: _by_channel(held, block_edges),
        ENDS: quiet_ends(held, record.fs_hz),
        CLOCK: {
            "roughness of the pulses": pulse_roughness(record.tacho_s),
            **pulse_grids(record.tacho_s, record.fs_hz),
            **pulse_places(record.tacho_s, max(x.size for x in held.values()) / record.fs_hz),
            **{f"drift of {name}": clock_drift(x, record.fs_hz, record.tacho_s, teeth) for name, x in held.items()},
        },
    }
    return _RawRecord(
        layers,
        {name: line_contrast(x, record.fs_hz, rates) for name, x in held.items()},
        _by_channel(held, raw_levels),
        frozenset(mark for signal in record.channels.values() for mark in sample_marks(signal)),
        np.concatenate([whitened_codes(x) for x in held.values()]),
        np.concatenate([whitened_codes(x[first : first + TEMPLATE_SAMPLES // 2]) for x in held.values()]),
        np.concatenate([order_codes(x, record.fs_hz, record.tacho_s) for x in held.values()]),
        np.concatenate([level_course(x) for x in held.values()]),
        {name: floor_levels(x) for name, x in held.items()},
        {name: phase_codes(x) for name, x in held.items()},
        {name: parity_bits(signal) for name, signal in record.channels.items()},
        {name: echo_codes(x, record.fs_hz, rates) for name, x in held.items()},
    )


def _by_channel(held: Mapping[str, np.ndarray], numbers: Callable[[np.ndarray], dict[str, float]]) -> dict[str, float]:
    return {f"{what} of {name}": value for name, signal in held.items() for what, value in numbers(signal).items()}


def _is_acceleration(record: Recording, channel: str) -> bool:
    return record.quantities.get(channel, RECORDED.word) == RECORDED.word


def _columns(rows: list[dict[str, float]]) -> dict[str, np.ndarray]:
    names = dict.fromkeys(name for row in rows for name in row)
    return {name: np.array([row.get(name, np.nan) for row in rows]) for name in names}


def raw_levels(signal: np.ndarray) -> dict[str, float]:
    """Return rms, peak and power in equal bands up to half the rate, in dB, of samples (n,) float64."""
    from scipy import fft

    power = np.square(np.abs(fft.rfft(signal - signal.mean())))[1:-1]
    powers = {"rms": np.square(signal).mean(), "peak": np.square(signal).max()}
    powers |= {
        f"power in eighth {k + 1} of the band": part.sum() for k, part in enumerate(np.array_split(power, EIGHTHS))
    }
    return {name: float(10.0 * np.log10(value + TINY)) for name, value in powers.items()}
