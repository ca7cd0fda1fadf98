"""Detectors that look at averaged waveforms: each alone, and as differences from the gearbox's own healthy record.

All of them start from the lines of the pinion's averaged revolution in the one table of the set, without shaft and mesh
orders; alone behind the inverse of their path (`innovations`). Nothing of a record's level is used alone, but by the
network, which is that of `report`; with a reference the change is measured against the reference's size.

* Random convolutions: kernels of nine weights -1 and 2, all 84 choices of three twos, dilated; the answer's share above
  a level ("proportion of positive values") is the feature. Source: Dempster et al. 2021 (MiniRocket). Here convolutions
  are circular, so that nothing depends on where the revolution starts, levels are quantiles of the answers of all
  records of the set, or of those to learn from (no state is looked at), and the largest answer counts too. aeon and
  sktime hold MiniRocket, but bring some 20 packages and no circular convolution.
* Network: one per fold learns from all damaged states of the gearboxes to learn from, and is asked about each state of
  the others. It is shown a fixed number of records in all, so that its cost does not grow with the set.
* Teeth: the energy of a tooth's `innovations`, in slices of a pitch and three bands, is compared with that of the other
  teeth at the same place. Logistic regression learns from the teeth that the labels name against all teeth of healthy
  records; a record has the score of its loudest tooth. Derived.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import combinations, pairwise

import numpy as np

from diagnostics.audit.audit import REFERENCED
from diagnostics.audit.averaged_lines import (
    band_bank,
    kurtogram_maximum,
    line_array,
    whitened,
)
from diagnostics.audit.measured_set import MeasuredSet, reference_records
from diagnostics.base.extras import missing_packages
from diagnostics.judging.evaluation import Entry
from diagnostics.judging.learners import all_columns, best_column
from diagnostics.signal.innovations import innovations, measured_channels, residual_lines
from diagnostics.statistics.evaluation import mean_of_defined
from diagnostics.training.average_rows import AveragedRecords, padded_lines
from diagnostics.training.splits import SpecimenSplit

PITCH_STEPS = 48
"""Angle steps of a pitch."""
WINDOW = 64
"""Steps from where a tooth enters that belong to it; the next one is in them."""
SLICE, APART = 4, 3
"""Steps of a slice, and from one to the next."""
MESHES = (0.5, 3.0, 9.0, 1e9)
"""Edges of the three bands, in mesh orders: what a small spall changes lies in one of them."""
FLOOR = 0.15
"""Added to ratios of energies, whose logarithm a quiet slice would else decide."""
STRENGTH = 1e-3
"""C of the regression: columns are many, teeth to learn from few."""
TINY = 1e-30


def tooth_energies(lines: np.ndarray, teeth: int) -> np.ndarray:
    """Return logarithms of each tooth's energy over that of the others, (teeth, bands * channels * slices).

    Parameters
    ----------
    lines : (channels, orders) complex128
        Innovations of one record.
    teeth : int
    """
    from scipy import fft

    steps, order = teeth * PITCH_STEPS, np.arange(lines.shape[-1])
    start = np.arange(teeth)[:, None] * PITCH_STEPS + np.arange(0, WINDOW - SLICE + 1, APART)
    found = []
    for low, high in pairwise(MESHES):
        kept = np.where((order >= low * teeth) & (order < high * teeth), lines, 0.0)[:, : steps // 2]
        power = np.square(fft.irfft(kept, steps, axis=-1))
        energy = np.sum([np.roll(power, -step, axis=-1) for step in range(SLICE)], axis=0)
        own = energy[:, start % steps]
        others = (own.sum(axis=1, keepdims=True) - own) / (teeth - 1)
        found += list(np.log(own / (others + TINY) + FLOOR))
    return np.concatenate(found, axis=-1)


class _LoudestTooth:
    """Logistic regression on energies of teeth (teeth, columns) by record; X are places of records."""

    def __init__(self, energies: Mapping[int, np.ndarray], faulty: np.ndarray) -> None:
        self.energies, self.faulty = energies, faulty

    def fit(self, X: np.ndarray, y: np.ndarray, groups: np.ndarray) -> _LoudestTooth:  # noqa: ARG002
        """Fit to all teeth of healthy records and to those that labels name; y (1, n)."""
        from sklearn.linear_model import LogisticRegression
        from sklearn.pipeline import make_pipeline
        from sklearn.preprocessing import StandardScaler

        damaged = y[0].tolist()
        rows = [self._known(row, ill) for row, ill in zip(X.tolist(), damaged, strict=True)]
        target = np.repeat(damaged, [len(one) for one in rows])
        self.model = None
        if 0 < target.sum() < target.size:
            model = LogisticRegression(C=STRENGTH, class_weight="balanced", max_iter=300)
            self.model = make_pipeline(StandardScaler(), model).fit(np.concatenate(rows), target)
        return self

    def _known(self, row: int, ill: bool) -> np.ndarray:
        """Return the teeth to learn from: all of a healthy record, else those named; strangers may count from 1."""
        own = self.energies[row]
        return own[[tooth for tooth in self.faulty[row] if 0 <= tooth < len(own)]] if ill else own

    def score(self, X: np.ndarray) -> np.ndarray:
        """Return the score of the loudest tooth of every record, (1, m); all alike where no label names a tooth."""
        if self.model is None:
            return np.zeros((1, X.size))
        asked = [self.energies[row] for row in X.tolist()]
        first = np.cumsum([0, *map(len, asked[:-1])])
        return np.maximum.reduceat(self.model.decision_function(np.concatenate(asked)), first)[None]


def tooth_detector(name: str, measured: MeasuredSet, lines: np.ndarray) -> Entry | None:
    """Return the detector, or None where no label names a tooth of the first driver.

    Parameters
    ----------
    name : str
    measured : MeasuredSet
    lines : (records, channels, orders) complex128
        Innovations, of records or of their differences from the reference; NaN where there is none.
    """
    faulty = measured.first("faulty_teeth")
    if faulty is None:
        return None
    usable = np.asarray(measured_channels(lines).all(axis=1))
    teeth, places = measured.teeth, np.arange(len(lines))
    energies = {row: tooth_energies(lines[row], int(teeth[row])) for row in places[usable].tolist()}
    columns = next(iter(energies.values())).shape[1] if energies else 0
    return Entry(name, partial(_LoudestTooth, energies, faulty), places, usable, columns, deals=1, many=False)


SHOWN, FEWEST_EPOCHS = 4500, 4
"""Records that a network is shown in all, and passes at least: some 5 s of CPU."""

LENGTH, TWOS = 9, 3
KERNELS = tuple(combinations(range(LENGTH), TWOS))
DILATIONS = (1, 2, 3, 5, 8, 13, 21, 34)
LEVELS = (0.5, 0.75, 0.9, 0.97, 0.995)
STEPS = 1024
CALIBRATING = 64
"""Records, evenly spread over the set, whose answers set the levels."""

NETWORK = "1-D network"
PREPARED = 4
"""Steps of preparing them, where records have references."""


class _FoldNetwork:
    """The network of the gearboxes to learn from, one for all damaged states; X are places of records."""

    def __init__(self, records: AveragedRecords, usable: np.ndarray, measured: MeasuredSet, seed: int) -> None:
        self.records, self.usable, self.seed = records, usable, seed
        self.specimen, self.damaged = measured.labels["specimen_id"], ~measured.healthy
        self.kept: dict[bytes, np.ndarray] = {}

    def fit(self, X: np.ndarray, y: np.ndarray, groups: np.ndarray) -> _FoldNetwork:  # noqa: ARG002
        """Learn from all records of these gearboxes; which state is asked about does not matter."""
        learnt = np.unique(groups)
        if (key := learnt.tobytes()) not in self.kept:
            self.kept[key] = self._scores(self.usable & np.isin(self.specimen, learnt))
        self.said = self.kept[key]
        return self

    def _scores(self, train: np.ndarray) -> np.ndarray:
        """Return the probability of damage of every record from a network that learnt from some."""
        from diagnostics.training.cnn import NetworkSettings, network_probability, train_network

        nobody = np.zeros_like(train)
        split = SpecimenSplit(train, nobody, nobody, ("healthy", "damaged"))
        settings = NetworkSettings(most_epochs=max(FEWEST_EPOCHS, round(SHOWN / max(int(train.sum()), 1))))
        trained = train_network(self.records, self.damaged.astype(np.int64), split, self.seed, settings)
        return np.asarray(network_probability(trained.network, self.records)[:, 1])

    def score(self, X: np.ndarray) -> np.ndarray:
        """Return the probability of damage, (1, m)."""
        return np.asarray(self.said[X][None])


def network_detector(name: str, measured: MeasuredSet, reference: np.ndarray | None, seed: int) -> Entry | None:
    """Return the detector, or None without PyTorch.

    Parameters
    ----------
    name : str
    measured : MeasuredSet
    reference : (records,) int, optional
        Healthy record of the same gearbox that each stands beside, -1 without one; None: every record stands alone.
    seed : int
        Of first weights, order and changed paths.
    """
    if missing_packages("torch", "safetensors"):
        return None
    usable = np.array([all(lines.size for lines in row) for row in measured.waveforms], dtype=bool)
    lines = padded_lines(measured.waveforms)
    beside = None
    if reference is not None:
        usable &= (reference >= 0) & usable[reference]
        beside = lines[reference]
    records = AveragedRecords(lines, measured.teeth, measured.channels, beside)
    network, places = _FoldNetwork(records, usable, measured, seed), np.arange(len(lines))
    return Entry(name, lambda: network, places, usable, records.rows * 2 * lines.shape[2], deals=1, many=False)


def revolution(lines: np.ndarray) -> np.ndarray:
    """Return one revolution of lines at equal angle steps, (..., 1024) float32; higher orders are left out."""
    from scipy import fft

    return np.asarray(fft.irfft(lines[..., : STEPS // 2], n=STEPS, axis=-1) * (0.5 * STEPS), dtype=np.float32)


def convolution_features(waves: np.ndarray, first: int | None = None) -> np.ndarray:
    """Return the features of every record, mean over its channels.

    Parameters
    ----------
    waves : (records, channels, steps) float32
        One revolution each, of comparable level; channels with NaN do not count.
    first : int, optional
        The first so many records set the levels; default all.

    Returns
    -------
    (records, features) float64
        84 kernels, eight dilations, five shares and the largest answer; NaN without any channel.
    """
    records, channels, steps = waves.shape
    flat = waves.reshape(-1, steps)
    defined = np.isfinite(flat).all(axis=1)
    used = np.ascontiguousarray(flat[defined])
    found = np.full((records * channels, len(KERNELS) * len(DILATIONS) * (len(LEVELS) + 1)), np.nan, dtype=np.float32)
    if used.size:
        found[defined] = _of_waves(used, int(defined[: channels * first].sum()) if first else len(used))
    split = found.reshape(records, channels, -1)
    counted = defined.reshape(records, channels).sum(axis=1)[:, None]
    with np.errstate(invalid="ignore"):
        return np.asarray(np.nansum(split, axis=1, dtype=np.float64) / np.where(counted > 0, counted, np.nan))


def _of_waves(waves: np.ndarray, first: int) -> np.ndarray:
    chosen = np.unique(np.linspace(0, first - 1, CALIBRATING).round().astype(int))
    found = []
    for dilation in DILATIONS:
        shifted = [np.roll(waves, (LENGTH // 2 - place) * dilation, axis=1) for place in range(LENGTH)]
        ones = -np.sum(shifted, axis=0, dtype=np.float32)
        for kernel in KERNELS:
            answer = ones + np.float32(3.0) * (shifted[kernel[0]] + shifted[kernel[1]] + shifted[kernel[2]])
            levels = np.quantile(answer[chosen], LEVELS).astype(np.float32)
            found += [np.count_nonzero(answer > level, axis=1) / np.float32(waves.shape[1]) for level in levels]
            found.append(answer.max(axis=1))
    return np.stack(found, axis=1).astype(np.float32)


def signal_detectors(measured: MeasuredSet, seed: int, advance: Callable[[], None]) -> list[Entry]:
    """Return the detectors; those with a reference only where records have one, the network only with PyTorch.

    Parameters
    ----------
    measured : MeasuredSet
        The set.
    seed : int
        Of the network.
    advance : callable
        Called after every detector that is prepared.
    """
    residual = residual_lines(line_array(measured.waveforms), measured.teeth)
    found = detectors_on(measured, residual, None, seed, advance)
    reference = reference_records(measured)
    if (reference >= 0).any():
        known = np.where((reference >= 0)[:, None, None], residual[reference], np.nan)
        found += detectors_on(measured, residual - known, known, seed, advance)
    return found


def detectors_on(
    measured: MeasuredSet, residual: np.ndarray, reference: np.ndarray | None, seed: int, advance: Callable[[], None]
) -> list[Entry]:
    """Return the detectors on residual lines, which are differences where a reference is given.

    Parameters
    ----------
    measured : MeasuredSet
    residual : (records, channels, orders) complex128
    reference : (records, channels, orders) complex128, optional
        What the residual is a difference from, NaN where there is none.
    seed, advance
        As of `signal_detectors`.
    """
    suffix = REFERENCED if reference is not None else ""
    flat = innovations(residual, measured.teeth)
    residual = flat if reference is None else residual  # a change is measured against the size of the reference
    values, names = over_channels(*band_bank(residual, reference))
    highest = kurtogram_maximum(residual)
    advance()
    waves = level_waves(residual, reference)
    features = convolution_features(waves)
    advance()
    places = reference_records(measured) if reference is not None else None
    network = network_detector(NETWORK + suffix, measured, places, seed)
    teeth = tooth_detector(f"teeth{suffix}", measured, flat)
    return [
        best_column(f"best band{suffix}", values, names),
        all_columns(f"all bands{suffix}", values),
        best_column(f"kurtogram{suffix}", mean_of_defined(highest, axis=1)[:, None], ("",)),
        all_columns(f"random convolutions{suffix}", features),
        *(detector for detector in (teeth, network) if detector),
    ]


def over_channels(bank: np.ndarray, named: Sequence[str]) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return mean and largest value over the channels of a bank, (records, 2 columns), with their names."""
    with np.errstate(invalid="ignore"):
        largest = np.nanmax(np.where(np.isfinite(bank), bank, -np.inf), axis=1, initial=-np.inf)
    values = np.concatenate([mean_of_defined(bank, axis=1), np.where(np.isfinite(largest), largest, np.nan)], axis=1)
    names = [f"{name} ({how} channels)" for how in ("mean of the", "largest of the") for name in named]
    return values, tuple(names)


def level_waves(residual: np.ndarray, reference: np.ndarray | None) -> np.ndarray:
    """Return one revolution of every record and channel at a comparable level, (records, channels, steps) float32.

    Alone: whitened, of unit rms. With a reference: over the reference's rms.
    """
    wave = revolution(whitened(residual) if reference is None else residual)
    level = wave if reference is None else revolution(reference)
    size = np.sqrt(np.square(level, dtype=np.float64).mean(axis=-1, keepdims=True))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(wave / np.where(size > 0.0, size, np.nan), dtype=np.float32)
