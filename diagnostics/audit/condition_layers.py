"""Numbers by which records that do not look at the gears can be told: a table of every layer, one row per record.

Labels of the conditions, texts and digits among them, order of the files, bytes of samples, noise over and between
channels, lags, and the layers of raw records.

* Texts: length, beginning, characters at every place from both ends, residues of the last number, and parts of the
  date. A text that is another one in every record tells no state as a whole; a character or its day may.
* Digits: how numbers are written, residues and check sums of whole ones: a column that went through another program in
  one state keeps its values and loses digits, or has a number twice in one gearbox.
* Pairs of columns with few values: each may be the same in all states, and both together not.
* Noise beside a reference: what the averages of both shafts leave is noise and leftover of the lines, since no tacho of
  one pulse a turn follows a shaft exactly. A damaged tooth makes lines stronger, so its leftover rises too, by no more
  decibels than the lines do: with a noise N and a share j of lines of power S, N + j S rises by less than S. So a rise
  counts as far as it exceeds that of the lines of its band; damage takes no noise away, so a fall counts whole.
* Lags beside a reference, against the tacho and the other channels: a path and a converter delay all mesh lines of a
  channel alike. Damage of a few teeth changes their size, and their phase only a little: the lag of the averaged
  waveform moves by up to a quarter of a sample in severe states. So lags count in whole samples between channels, and
  in steps of two against the tacho. Estimated by the largest sum of the mesh lines' cross spectrum over trial lags. How
  near that sum comes to one of lines that are only delayed is the likeness: a record that runs backwards has no such
  lag. Large damage lowers it too, so it is asked with the levels, of the smallest damage.
  Source: generalised cross-correlation, standard literature; the steps measured.

Source of all else: derived.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from datetime import datetime
from itertools import combinations

import numpy as np

from diagnostics.audit.averaged_lines import line_array
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.audit.raw_records import OF_NO_GEARBOX
from diagnostics.indicators.background_levels import HIGHEST_NOISE_SHARE, LOWEST_NOISE_HZ, NOISE_BANDS, NOISE_LEVELS
from diagnostics.records.sample_bytes import BYTES
from diagnostics.statistics.evaluation import mean_of_defined
from siggen.keys.column import Role

FEW_DIGITS, TEXT_DIGITS = 12, 15
"""A number that was computed has 15 to 17; many programs write 15."""

MODULI = (2, 3, 4, 5, 7, 8, 9, 10, 11, 13)
MOST_VALUES, MOST_PAIRED = 6, 12
"""Values that a column of few may have, and columns that are paired."""


def digit_columns(name: str, values: np.ndarray) -> dict[str, np.ndarray]:
    """Return the numbers of a column (records,) float, (records,) float64 each; those that do not vary are left out.

    Numbers that are zero or undefined have no digits.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        is_single = values.astype(np.float32).astype(np.float64) == values
    few = np.array([_digits(value) < FEW_DIGITS for value in values.tolist()])
    kept = np.array([float(f"{value:.{TEXT_DIGITS}g}") == value for value in values.tolist()])
    written = np.isfinite(values) & (values != 0.0)
    flags = {
        f"few digits of {name}": few & written,
        f"single precision of {name}": is_single & written,
        f"{TEXT_DIGITS} digits hold {name}": kept & written,
    }
    return _varied(flags) | zero_signs(name, values)


def repeated_values(name: str, values: np.ndarray, specimen: np.ndarray) -> dict[str, np.ndarray]:
    """Return which numbers (records,) another record of the gearbox has too; what does not vary is left out."""
    pairs = list(zip(specimen.tolist(), values.tolist(), strict=True))
    count = Counter(pairs)
    return _varied({f"{name} that its gearbox has twice": np.array([count[pair] > 1 for pair in pairs])})


def pair_columns(columns: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return which records have each pair of values of two columns (records,) that have few; flags that vary.

    Constant columns are left out. The first MOST_PAIRED of the others are paired, since pairs grow with their square.
    """
    few = {name: values for name, values in columns.items() if 1 < len(set(values.tolist())) <= MOST_VALUES}
    flags = {}
    for (first, ones), (second, others) in combinations(list(few.items())[:MOST_PAIRED], 2):
        both = list(zip(ones.tolist(), others.tolist(), strict=True))
        for pair in sorted(set(both), key=str):
            name = f"{first} is {pair[0]!r} and {second} is {pair[1]!r}"
            flags[name] = np.array([values == pair for values in both])
    return _varied(flags)


def residue_columns(name: str, values: np.ndarray) -> dict[str, np.ndarray]:
    """Return which whole numbers (records,) leave each residue, (records,) float64 each; what does not vary is left."""
    return _varied(
        {
            f"{name} is {residue} modulo {modulus}": values % modulus == residue
            for modulus in MODULI
            for residue in range(modulus)
        }
    )


def zero_signs(name: str, values: np.ndarray) -> dict[str, np.ndarray]:
    """Return which zeros of a column (records,) float have a minus sign; nothing where none or all have."""
    return _varied({f"sign of zero of {name}": (values == 0.0) & np.signbit(values)})


def _varied(columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    return {name: flags.astype(np.float64) for name, flags in columns.items() if flags.any() and not flags.all()}


def _digits(value: float) -> int:
    return len("".join(filter(str.isdigit, repr(value).split("e")[0])).strip("0"))


MOST_BEGINNINGS, LONGEST_BEGINNING = 8, 4
"""Beginnings that are columns, the most frequent first, and characters that a beginning may have."""

LONGEST_TEXT, MOST_CHARACTERS, DIGITS_KEPT = 40, 16, 18
"""Characters that are read from each end, columns of a place, and digits of the last number of a text."""

DATE_PARTS = ("year", "month", "day", "hour", "minute", "second")
DATE = re.compile(r"\d{4}-\d{2}-\d{2}([T ]\d{2}:\d{2}(:\d{2})?)?")


def text_columns(name: str, values: np.ndarray) -> dict[str, np.ndarray]:
    """Return the numbers of a column of texts, (records,) float64 each; none where all texts are one.

    Parameters
    ----------
    name : str
        What the column is called.
    values : (records,) array
        Texts, dates or times.
    """
    texts = [str(value) for value in values.tolist()]
    if len(set(texts)) < 2:
        return {}
    columns = {f"length of {name}": np.array([len(text) for text in texts], dtype=np.float64)}
    for length in range(1, LONGEST_BEGINNING + 1):
        starts = [text[:length] for text in texts]
        for start, _ in Counter(starts).most_common(MOST_BEGINNINGS):
            columns[f"{name} begins with {start!r}"] = np.array(
                [beginning == start for beginning in starts], dtype=np.float64
            )
    columns |= _date_columns(name, texts)
    if values.dtype.kind == "U":
        columns |= _character_columns(name, texts)
    return {column: numbers for column, numbers in columns.items() if np.ptp(numbers[np.isfinite(numbers)]) > 0.0}


def _character_columns(name: str, texts: list[str]) -> dict[str, np.ndarray]:
    """Return which characters stand at each place, from both ends, how many are of a kind, and residues of numbers."""
    columns = {}
    for end, turned in (("", texts), (" from the end", [text[::-1] for text in texts])):
        for place in range(min(max(map(len, texts)), LONGEST_TEXT)):
            characters = [text[place : place + 1] for text in turned]
            for character, _ in Counter(characters).most_common(MOST_CHARACTERS):
                column = f"character {place + 1}{end} of {name} is {character!r}"
                columns[column] = np.array([part == character for part in characters], dtype=np.float64)
    kinds = {"digits": str.isdigit, "capitals": str.isupper, "small letters": str.islower, "spaces": str.isspace}
    for kind, is_kind in kinds.items():
        columns[f"{kind} in {name}"] = np.array([sum(map(is_kind, text)) for text in texts], dtype=np.float64)
    last = [re.findall(r"\d+", text)[-1:] for text in texts]
    if all(last):
        numbers = np.array([int(part[0][-DIGITS_KEPT:]) for part in last])
        columns |= residue_columns(f"the last number of {name}", numbers)
        right = np.array([_luhn(part[0]) == 0 for part in last])
        columns |= _varied({f"check digit of the last number of {name}": right})
    return columns


def _luhn(digits: str) -> int:
    """Return the sum of Luhn modulo 10, 0 where the last digit checks the others (ISO/IEC 7812-1)."""
    doubled = [int(digit) * (1 + place % 2) for place, digit in enumerate(reversed(digits))]
    return sum(value - 9 * (value > 9) for value in doubled) % 10


def _date_columns(name: str, texts: list[str]) -> dict[str, np.ndarray]:
    """Return the parts of dates that stand in the texts, NaN where there is none; nothing without any date."""
    dates = [_date(text) for text in texts]
    if not any(dates):
        return {}
    start = datetime(1970, 1, 1)
    parts = {
        f"{part} of {name}": _as_numbers([getattr(date, part) if date else None for date in dates])
        for part in DATE_PARTS
    }
    return parts | {
        f"day of the week of {name}": _as_numbers([date.weekday() if date else None for date in dates]),
        f"time of {name}": _as_numbers([(date - start).total_seconds() if date else None for date in dates]),
    }


def _date(text: str) -> datetime | None:
    seen = DATE.search(text)
    try:
        return datetime.fromisoformat(seen.group()) if seen else None
    except ValueError:
        return None


def _as_numbers(values: list[float | None]) -> np.ndarray:
    return np.array([np.nan if value is None else value for value in values], dtype=np.float64)


TINY = 1e-30


def noise_excess(measured: MeasuredSet, reference: np.ndarray, names: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Return by how much noise rose or fell beyond what lines explain, (records, channels) [dB] by band.

    Parameters
    ----------
    measured : MeasuredSet
    reference : (records,) int
        Row of the record that each stands beside, -1 without one: undefined there.
    names : tuple of str
        Bands, of `NOISE_LEVELS`.
    """
    known, excess = (reference >= 0)[:, None], {}
    lines = line_levels(measured)
    for name in names:
        rose = measured.values[name] - measured.values[name][reference]
        by_lines = np.max([levels - levels[reference] for levels in lines[name]], axis=0, initial=0.0)
        excess[name] = np.where(known, np.maximum(rose - by_lines, 0.0) + np.minimum(rose, 0.0), np.nan)
    return excess


def line_levels(measured: MeasuredSet) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Return the power of mesh lines and of all other lines of the pinion by band of noise, (records, channels) [dB].

    0 dB where a record has no such line, or no pulses.
    """
    power, speed = np.square(np.abs(line_array(measured.waveforms))), measured.values["pulses_per_s"][:, 0]
    order = np.arange(power.shape[-1])
    is_mesh = order % measured.teeth[:, None] == 0
    hz = order * speed[:, None]
    highest = HIGHEST_NOISE_SHARE * measured.raw.fs_hz
    edges = np.geomspace(LOWEST_NOISE_HZ, highest, NOISE_BANDS + 1)
    levels = {}
    for name, low, high in zip(NOISE_LEVELS, edges[:-1], edges[1:], strict=True):
        inside = (hz >= low) & (hz < high)
        levels[name] = (_decibels(power, inside & is_mesh), _decibels(power, inside & ~is_mesh))
    return levels


def _decibels(power: np.ndarray, kept: np.ndarray) -> np.ndarray:
    total = np.where(kept[:, None], power, 0.0).sum(axis=-1)
    return np.where(total > 0.0, 10.0 * np.log10(np.maximum(total, TINY)), 0.0)


LAGS = "lags"
HARMONICS, LARGEST_LAG, TRIALS_PER_SAMPLE = 20, 16, 8
TACHO_STEP = 2.0
"""Step of the lag to the tacho that counts, in samples; between channels it is one sample."""

FINE = 0.1
"""Samples around the largest sum at which a parabola is laid through it."""


def sample_lags(
    lines: np.ndarray, reference: np.ndarray, teeth: int, samples_per_turn: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return by how many samples a record lies behind its reference, and how like it is then, (channels,) each.

    Parameters
    ----------
    lines, reference : (channels, orders) complex
        Averaged revolution of the pinion, from the tacho's pulse on.
    teeth : int
        Of the pinion.
    samples_per_turn : float

    Returns
    -------
    (channels,) float64
        In samples; NaN without mesh lines.
    (channels,) float64
        0 to 1; 1 where all lines are delayed alike.
    """
    orders = np.arange(1, HARMONICS + 1) * teeth
    orders = orders[orders < lines.shape[-1]]
    across = lines[:, orders] * np.conj(reference[:, orders])
    weighed = across / np.sqrt(np.abs(across) + 1e-30)
    trial = np.arange(-LARGEST_LAG * TRIALS_PER_SAMPLE, LARGEST_LAG * TRIALS_PER_SAMPLE + 1) / TRIALS_PER_SAMPLE
    turned = np.exp(2j * np.pi * orders[:, None] * trial / samples_per_turn)
    total = (weighed @ turned).real
    best = trial[np.argmax(total, axis=1)]
    whole = np.abs(weighed).sum(axis=1)
    defined = np.isfinite(across).all(axis=1) & (whole > 0.0)
    around = best[:, None] + FINE * np.arange(-1.0, 2.0)
    peak = np.einsum(
        "co,cot->ct", weighed, np.exp(2j * np.pi * orders[:, None] * around[:, None] / samples_per_turn)
    ).real
    bend = peak[:, 0] - 2.0 * peak[:, 1] + peak[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        shift = np.where(bend < 0.0, 0.5 * FINE * (peak[:, 0] - peak[:, 2]) / bend, 0.0)
        likeness = total.max(axis=1) / whole
    fine = best + np.clip(shift, -1.0 / TRIALS_PER_SAMPLE, 1.0 / TRIALS_PER_SAMPLE)
    return np.where(defined, fine, np.nan), np.where(defined, likeness, np.nan)


def channel_lags(measured: MeasuredSet, reference: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return lag and likeness of every channel beside the record's reference, (records, channels) each."""
    lines, teeth = line_array(measured.waveforms), measured.teeth
    per_turn = measured.raw.fs_hz / measured.values["pulses_per_s"][:, 0]
    lags = np.full((2, *lines.shape[:2]), np.nan)
    for row in np.flatnonzero((reference >= 0) & np.isfinite(per_turn)).tolist():
        lags[:, row] = sample_lags(lines[row], lines[reference[row]], int(teeth[row]), float(per_turn[row]))
    return lags[0], lags[1]


def lag_columns(measured: MeasuredSet, reference: np.ndarray) -> dict[str, np.ndarray]:
    """Return lags in steps that count, by name, (records,) each."""
    lags, _ = channel_lags(measured, reference)
    channels = measured.channels
    columns = {"lag to the tacho": TACHO_STEP * np.round(np.median(lags, axis=1) / TACHO_STEP)}
    for first in range(len(channels)):
        for second in range(first + 1, len(channels)):
            apart = np.round(lags[:, first] - lags[:, second])
            columns[f"lag of {channels[first]} to {channels[second]}"] = apart
    return columns


def fine_lags(measured: MeasuredSet, reference: np.ndarray) -> dict[str, np.ndarray]:
    """Return likeness and lags without steps [samples], to tacho and first channel, by name, (records,) each."""
    lags, likeness = channel_lags(measured, reference)
    columns = {"lag to the tacho": np.median(lags, axis=1)}
    for k, channel in enumerate(measured.channels):
        columns[f"likeness of {channel} to its own healthy record"] = likeness[:, k]
        if k:
            columns[f"lag of {channel} to {measured.channels[0]}"] = lags[:, k] - lags[:, 0]
    return columns


METADATA, TEXTS, BYTE, ORDER, NOISE, CHANNELS = "metadata", "texts", "bytes", "order", "noise", "channels"
STEADY_NOISE = NOISE_LEVELS[4:]
"""Bands in which a stroke has rung off within half a turn: from 637 Hz on at 25.6 kHz.

With a damping ratio of 2 to 3 % an amplitude falls to a tenth in 19 to 29 ms at 637 Hz; half a turn at 25 Hz takes 20.
Below, the quietest half turn still holds the strokes of severe damage. Measured: docs/understand/audit.md.
"""

PULSES = ("pulses_per_s", "speed_variation_percent", "start_turn")


def condition_layers(measured: MeasuredSet) -> dict[str, tuple[np.ndarray, tuple[str, ...]]]:
    """Return the values (records, columns) of every layer with the names of its columns.

    The order is that of the records in the files of the set, as a share of all. Labels are those that do not say what
    the damage is or follows from it. Bytes and noise are means over the channels; `channels` holds the noise of each,
    less the mean over all.
    """
    noise = {name: measured.values[name] for name in steady_noise(measured)}
    return {
        METADATA: _stacked(_metadata(measured)),
        ORDER: _stacked(_order(measured)),
        BYTE: _stacked(_bytes(measured)),
        NOISE: _stacked({name: _mean(values) for name, values in noise.items()}),
        CHANNELS: _stacked(_between_channels(noise, measured.channels)),
        TEXTS: _stacked(_texts(measured)),
        **{layer: _stacked(columns) for layer, columns in measured.raw.layers.items()},
    }


def condition_changes(measured: MeasuredSet, reference: np.ndarray) -> dict[str, tuple[np.ndarray, tuple[str, ...]]]:
    """Return the layers as changes from the reference (records,), undefined without one (-1).

    Of noise what exceeds the lines. Layers with one law for all gearboxes are not compared, nor is the order in the
    files: within a gearbox the records of a set stand in the order of its states by design.
    """
    known, changes = (reference >= 0)[:, None], {}
    for layer, (values, names) in condition_layers(measured).items():
        if layer not in {ORDER, *OF_NO_GEARBOX} and values.shape[1]:
            filled = filled_columns(values)
            changes[layer] = np.where(known, filled - filled[reference], np.nan), names
    excess = noise_excess(measured, reference, steady_noise(measured))
    for layer, columns in (
        (NOISE, {name: _mean(values) for name, values in excess.items()}),
        (CHANNELS, _between_channels(excess, measured.channels)),
    ):
        if layer in changes:
            values, names = _stacked(columns)
            changes[layer] = np.where(known, filled_columns(values), np.nan), names
    return changes


def steady_noise(measured: MeasuredSet) -> tuple[str, ...]:
    """Return the bands of noise that a set has and in which strokes ring off."""
    return tuple(name for name in STEADY_NOISE if name in measured.values)


def _order(measured: MeasuredSet) -> dict[str, np.ndarray]:
    """Return the place of every record among all, and among those of its split, as shares."""
    every = np.arange(len(measured.healthy))
    places = {"place in the files": every / max(every.size, 1)}
    if "split" in measured.labels:
        of_split = np.zeros(every.size)
        for split in dict.fromkeys(measured.labels["split"].tolist()):
            rows = np.flatnonzero(measured.labels["split"] == split)
            of_split[rows] = np.arange(rows.size) / rows.size
        places["place in the files of its split"] = of_split
    return places


def _bytes(measured: MeasuredSet) -> dict[str, np.ndarray]:
    """Return means over the channels; the step of each channel besides, which no clipping moves."""
    held = {name: measured.values[name] for name in BYTES if name in measured.values}
    means = {name: _mean(values) for name, values in held.items()}
    if (step := held.get(BYTES[0])) is not None and len(measured.channels) > 1:
        means |= {f"{BYTES[0]} of {channel}": step[:, k] for k, channel in enumerate(measured.channels)}
    return means


def _between_channels(noise: dict[str, np.ndarray], channels: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Return the noise of every channel less the mean over those that are defined."""
    differences: dict[str, np.ndarray] = {}
    for name, values in noise.items():
        mean = mean_of_defined(values, axis=1)
        differences |= {f"{name} of {channel}": values[:, k] - mean for k, channel in enumerate(channels)}
    return differences if len(channels) > 1 else {}


def _texts(measured: MeasuredSet) -> dict[str, np.ndarray]:
    columns: dict[str, np.ndarray] = {}
    conditions, specimen = measured.steady_conditions, measured.labels["specimen_id"]
    for name, values in conditions.items():
        if values.dtype.kind not in "biuf":
            columns |= text_columns(name, values)
        if values.dtype.kind in "iu":
            columns |= residue_columns(name, values)
        if values.dtype.kind == "f":
            columns |= digit_columns(name, values) | repeated_values(name, values, specimen)
    for name, values in measured.labels.items():
        if values.ndim == 1 and values.dtype.kind == "f" and measured.roles.get(name) == Role.MEASURED:
            columns |= zero_signs(name, values)  # damage moves a measured number, but not how zero is written
    return columns | pair_columns({name: values for name, values in conditions.items() if values.dtype.kind in "biuU"})


def _metadata(measured: MeasuredSet) -> dict[str, np.ndarray]:
    numbers = {
        name: values.astype(np.float64)
        for name, values in measured.steady_conditions.items()
        if values.dtype.kind in "biuf"
    }
    pulses = {name: measured.values[name][:, 0] for name in (*PULSES, "samples") if name in measured.values}
    return numbers | pulses | _beside_labels(measured, pulses)


def _beside_labels(measured: MeasuredSet, pulses: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return what the pulses give less what labels say, where a set has both."""
    labels, distances = measured.labels, {}
    if "speed_hz" in labels and "pulses_per_s" in pulses:
        distances["speed of the pulses over its label"] = pulses["pulses_per_s"] / labels["speed_hz"] - 1.0
    if (shaft_hz := measured.pulsed_shaft_hz) is not None and "pulses_per_s" in pulses:
        off = np.abs(pulses["pulses_per_s"] / shaft_hz - 1.0)
        distances["distance of the pulses from the shaft's frequency"] = off
    if "start_angle_rad" in labels and "start_turn" in pulses:
        apart = pulses["start_turn"] - labels["start_angle_rad"] / (2.0 * np.pi)
        distances["distance of the start by the pulses from its label"] = np.abs((apart + 0.5) % 1.0 - 0.5)
    return distances


def filled_columns(values: np.ndarray) -> np.ndarray:
    """Return columns with undefined values far below all others, so that being undefined tells something too."""
    finite = np.isfinite(values)
    kept = np.where(finite, values, np.nan)
    with np.errstate(invalid="ignore"):
        low = np.nanmin(np.where(finite.any(axis=0), kept, 0.0), axis=0)
        span = np.nanmax(np.where(finite.any(axis=0), kept, 0.0), axis=0) - low
    return np.asarray(np.where(finite, values, low - span - 1.0))


def _mean(values: np.ndarray) -> np.ndarray:
    """Return the mean over channels; NaN where one of them is undefined."""
    return np.asarray(values.mean(axis=1))


def _stacked(columns: dict[str, np.ndarray]) -> tuple[np.ndarray, tuple[str, ...]]:
    return np.stack(list(columns.values()), axis=1) if columns else np.empty((0, 0)), tuple(columns)
