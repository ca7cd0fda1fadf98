"""How a set's healthy records lie against measured healthy recordings: what gives the set away, and what lies inside.

One feature alone: AUC over windows, every recording and every gearbox counting alike. All together: ridge regression,
judged on recordings and gearboxes that it was not shown. Whether a recording lies within the spread of the gearboxes:
the rms of its features' distances from the gearboxes' median, over their spread, against the same of every channel of
every gearbox.
Source: derived.

A user's own healthy recordings as features of windows, each window with its recording.

A file directly in the folder is a recording. Files of one subfolder belong together, such as channels of one machine
that ran once: they are one recording. Windows of one recording are not independent of each other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from diagnostics.audit.bank import DESIGN
from diagnostics.judging.evaluation import Entry, held_out_values
from diagnostics.judging.learners import GroupRidge, products
from diagnostics.recordings.file_columns import READERS
from diagnostics.recordings.taken import RecordingFacts, channel_columns, say_taken, take
from diagnostics.records.state_classes import HEALTHY
from diagnostics.signal.window_features import FEATURES, signal_windows, window_features
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

LOWEST_RATE_HZ = 9600.0
MOST_WINDOWS = 20
"""Windows taken of a channel, evenly spread."""

FEWEST_RECORDINGS, FEWEST_GEARBOXES = 4, 8
"""Fewer recordings do not tell what all measured machines share from what one of them is."""

TELLING_AUC = 0.9
INSIDE = (0.025, 0.975)
NORMAL_IQR = 1.349


@dataclass(frozen=True, slots=True)
class WindowSet:
    """Windows of recordings or of gearboxes.

    Attributes
    ----------
    values : (windows, 64) float64
        Features.
    owner : (windows,) str
        Recording or gearbox.
    channel : (windows,) str
        Channel within it.
    """

    values: np.ndarray
    owner: np.ndarray
    channel: np.ndarray

    def medians(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the median features of every channel of every owner, (channels, 64), and the owners, (channels,)."""
        pairs = list(dict.fromkeys(zip(self.owner.tolist(), self.channel.tolist(), strict=True)))
        found = [self.values[(self.owner == owner) & (self.channel == channel)] for owner, channel in pairs]
        return np.stack([np.median(rows, axis=0) for rows in found]), np.array([owner for owner, _ in pairs])


def window_set(channels: Iterable[tuple[np.ndarray, float, str, str]]) -> WindowSet | None:
    """Return the windows of channels: signal (n,), rate [Hz], owner and name; None where none holds a whole second."""
    found = [(row, *named) for signal, fs_hz, *named in channels for row in _channel_features(signal, fs_hz)]
    if not found:
        return None
    values, owner, channel = zip(*found, strict=True)
    return WindowSet(np.stack(values), np.array(owner), np.array(channel))


def reference_windows(folder: Path) -> WindowSet:
    """Return the windows of all recordings of a folder.

    Parameters
    ----------
    folder : Path
        With files, or with a subfolder for every recording.

    Raises
    ------
    UsageError
        Without readable files, a rate, or a whole window.
    """
    if not folder.is_dir():
        raise UsageError(f"{folder}: no such folder; give the folder of healthy recordings to --reference")
    files = sorted(path for path in folder.rglob("*") if path.suffix.lower() in READERS)
    if not files:
        raise UsageError(f"{folder}: no recordings; allowed are files that end in {', '.join(READERS)}")
    windows = window_set(channel for path in files for channel in _recorded(path, path.relative_to(folder)))
    if windows is None:
        raise UsageError(f"{folder}: no recording holds a whole second; windows of one second are needed")
    return windows


def _recorded(path: Path, inside: Path) -> Iterator[tuple[np.ndarray, float, str, str]]:
    """Yield the channels of a file, which lies `inside` of the folder."""
    try:
        taken = take(path, RecordingFacts(), say=False)
        columns = channel_columns(taken)
    except UsageError as error:
        raise UsageError(
            f"{str(error).rstrip('.')}. `audit` takes no option of `siggen-diagnostics indicators`: correct the "
            "file, or leave it out"
        ) from error
    say_taken(taken)
    rate = taken.fs_hz
    if not rate or rate < LOWEST_RATE_HZ:
        raise UsageError(
            f"{path}: sampling rate: received {rate}; {LOWEST_RATE_HZ:g} Hz or more are needed. Give the file "
            "a column of times with its unit, time [s], or write it as WAV"
        )
    for column in columns.values():
        yield taken.found.values[column], rate, inside.parts[0], f"{inside}:{column}"


def _channel_features(signal: np.ndarray, fs_hz: float) -> list[np.ndarray]:
    if not np.isfinite(signal).all():
        return []
    windows = signal_windows(signal, fs_hz)
    chosen = np.unique(np.linspace(0, len(windows) - 1, min(len(windows), MOST_WINDOWS)).round().astype(int))
    found = [window_features(windows[k]) for k in chosen.tolist()]
    return [row for row in found if np.isfinite(row).all()]


def synthetic_windows(dataset: Dataset, advance: Callable[[], None]) -> WindowSet:
    """Return the windows of the healthy records of a set; a source is a gearbox.

    Parameters
    ----------
    dataset : siggen Dataset
    advance : callable
        Called after every record.

    Raises
    ------
    UsageError
        If no healthy record holds a whole second.
    """
    windows = window_set(_healthy(dataset, advance))
    if windows is None:
        raise UsageError(f"{dataset.path}: no healthy record holds a whole second; --reference needs one")
    return windows


def _healthy(dataset: Dataset, advance: Callable[[], None]) -> Iterator[tuple[np.ndarray, float, str, str]]:
    columns = {channel.name: channel.column for channel in dataset.channels}
    for batch in dataset.records(columns=["specimen_id", "fault", *columns.values()]):
        for row in range(batch.num_rows):
            advance()
            if batch.column("fault")[row].as_py() == HEALTHY:
                owner = str(batch.column("specimen_id")[row].as_py())
                for name, column in columns.items():
                    signal = np.asarray(batch.column(column)[row].values, dtype=np.float64)
                    yield signal, dataset.fs_hz, owner, name


@dataclass(frozen=True, slots=True)
class FeatureGap:
    """One feature: AUC of measured against synthetic windows, medians of both, and share of synthetic inside the real.

    `synthetic_spread` is the standard deviation between channels of gearboxes that the quartiles of their medians give.
    """

    name: str
    auc: float
    measured: float
    synthetic: float
    synthetic_spread: float
    inside: float


@dataclass(frozen=True, slots=True)
class RecordingPlace:
    """One recording: its distance from the gearboxes over their spread, the share of these that lie farther, windows.

    Median over its channels; the gearboxes' channels stand each for themselves.
    """

    name: str
    distance: float
    farther: float
    windows: int


@dataclass(frozen=True, slots=True)
class ReferenceComparison:
    """The whole comparison.

    Attributes
    ----------
    gaps : tuple of FeatureGap
        The most telling first.
    places : tuple of RecordingPlace
    discriminator_auc : float
        On recordings and gearboxes that were not shown; NaN with fewer than four recordings or eight gearboxes.
    inside : float
        Share of synthetic values inside 95 % of the measured ones, mean over the features.
    gearbox_distance : float
        Median of the distances of the gearboxes' own channels.
    recordings, gearboxes : int
    """

    gaps: tuple[FeatureGap, ...]
    places: tuple[RecordingPlace, ...]
    discriminator_auc: float
    inside: float
    gearbox_distance: float
    recordings: int
    gearboxes: int

    @property
    def telling(self) -> int:
        """How many features alone reach an AUC of 0.9."""
        return sum(gap.auc >= TELLING_AUC for gap in self.gaps)


def reference_comparison(measured: WindowSet, synthetic: WindowSet, seed: int) -> ReferenceComparison:
    """Return the comparison; the seed deals folds."""
    (real, owner), (own, gearbox) = measured.medians(), synthetic.medians()
    names = tuple(dict.fromkeys(owner.tolist()))
    middle = np.median(own, axis=0)
    spread = np.subtract(*np.quantile(own, [0.75, 0.25], axis=0)) / NORMAL_IQR
    spread = np.where(spread > 0.0, spread, np.abs(middle) * 1e-6 + 1e-12)
    each, others = _rms((real - middle) / spread), _rms((own - middle) / spread)
    distance = [float(np.median(each[owner == name])) for name in names]
    gaps = _gaps(measured, synthetic, middle, spread)
    return ReferenceComparison(
        gaps=tuple(sorted(gaps, key=lambda gap: -gap.auc)),
        places=tuple(
            RecordingPlace(name, far, float(np.mean(others >= far)), int(np.sum(measured.owner == name)))
            for name, far in zip(names, distance, strict=True)
        ),
        discriminator_auc=discriminator_auc(measured, synthetic, seed),
        inside=float(np.mean([gap.inside for gap in gaps])),
        gearbox_distance=float(np.median(others)),
        recordings=len(names),
        gearboxes=int(np.unique(gearbox).size),
    )


def _rms(values: np.ndarray) -> np.ndarray:
    """Return the rms over features, one wild feature limited to ten spreads."""
    return np.asarray(np.sqrt(np.mean(np.square(np.clip(values, -10.0, 10.0)), axis=1)))


def _weights(owner: np.ndarray) -> np.ndarray:
    """Return weights with which every source counts alike, sum one."""
    _, index, count = np.unique(owner, return_inverse=True, return_counts=True)
    return np.asarray(1.0 / count[index.ravel()] / count.size)


def _gaps(measured: WindowSet, synthetic: WindowSet, middle: np.ndarray, spread: np.ndarray) -> list[FeatureGap]:
    real_weight, own_weight = _weights(measured.owner), _weights(synthetic.owner)
    found = []
    for k, name in enumerate(FEATURES):
        real, own = measured.values[:, k], synthetic.values[:, k]
        area = float(real_weight @ (0.5 + 0.5 * np.sign(real[:, None] - own)) @ own_weight)
        low, high = np.quantile(real, INSIDE)
        inside = float(own_weight @ ((own >= low) & (own <= high)))
        found.append(
            FeatureGap(name, max(area, 1.0 - area), float(np.median(real)), float(middle[k]), float(spread[k]), inside)
        )
    return found


def discriminator_auc(measured: WindowSet, synthetic: WindowSet, seed: int) -> float:
    """Return the AUC of all features together on sources that were not shown; NaN with too few of them.

    Channels stand for their windows: one row of medians each.
    """
    (real, owner), (own, gearbox) = measured.medians(), synthetic.medians()
    if np.unique(owner).size < FEWEST_RECORDINGS or np.unique(gearbox).size < FEWEST_GEARBOXES:
        return float("nan")
    values = np.concatenate([real, own])
    is_real = np.arange(len(values)) < len(real)
    source = np.unique(np.concatenate([np.char.add("r", owner), np.char.add("g", gearbox)]), return_inverse=True)[1]
    # recordings and gearboxes are dealt apart, so that every fold holds both
    folds = np.concatenate([DESIGN.dealt(source[side], seed) for side in (is_real, ~is_real)], axis=1)
    places = np.arange(len(values))
    entry = Entry("all features", partial(GroupRidge, products(values)), places, np.ones(len(values), dtype=bool))
    return float(held_out_values(entry, places, is_real[None], source, folds)[0])
