"""A recording cut into pieces as long as the training records, at their rate, with the features of each.

Averages over more revolutions suppress more noise, and a wider band holds more of it, so indicators of records of other
length or rate are other numbers. Pieces of the trained length keep them comparable. Source: derived.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from diagnostics.indicators.own_indicator import OwnIndicator, own_values
from diagnostics.indicators.record import record_values
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.prediction.noise_floor import floor_features
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import ShaftPulses
from diagnostics.records.recording import Recording
from siggen.columns.drivetrain import GearTrain
from siggen.errors import UsageError

LARGEST_DENOMINATOR = 1000


@dataclass(frozen=True, slots=True)
class RecordPieces:
    """Features of the pieces of a recording.

    Attributes
    ----------
    values : (pieces, features) float64
        NaN where undefined.
    names : tuple of str
        Feature names.
    revolutions : int
        Pinion revolutions of the shortest piece.
    notes : tuple of str
        What is undefined and why.
    waveforms : tuple of dict of str to (orders,) complex64
        Lines of the first driver's average of every piece by channel, see `diagnostics.indicators.record.RecordValues`.
    """

    values: np.ndarray
    names: tuple[str, ...]
    revolutions: int
    notes: tuple[str, ...]
    waveforms: tuple[dict[str, np.ndarray], ...] = ()

    def columns(self, names: tuple[str, ...]) -> np.ndarray:
        """Return the named features, (pieces, len(names)); those that were not taken are NaN."""
        position = {name: k for k, name in enumerate(self.names)}
        found = np.full((len(self.values), len(names)), np.nan)
        for k, name in enumerate(names):
            if name in position:
                found[:, k] = self.values[:, position[name]]
        return found

    def medians(self, names: tuple[str, ...]) -> np.ndarray:
        """Return the median over pieces of the named features, (len(names),); NaN where no piece defines one."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # no piece defines it: NaN it is
            return np.asarray(np.nanmedian(self.columns(names), axis=0))


def at_rate(recording: MeasuredRecording, fs_hz: float) -> MeasuredRecording:
    """Return the recording at the given rate if it was sampled faster, else as it is."""
    if recording.fs_hz <= fs_hz * (1.0 + 1e-9):
        return recording
    from scipy.signal import resample_poly

    ratio = Fraction(fs_hz / recording.fs_hz).limit_denominator(LARGEST_DENOMINATOR)
    channels = {
        name: np.asarray(resample_poly(signal, ratio.numerator, ratio.denominator))
        for name, signal in recording.channels.items()
    }
    return replace(recording, channels=channels, fs_hz=recording.fs_hz * float(ratio))


def cut(
    recording: MeasuredRecording, pulses: ShaftPulses, duration_s: float
) -> Iterator[tuple[dict[str, np.ndarray], np.ndarray]]:
    """Yield channels and pulse times of consecutive pieces; a rest shorter than a piece counts if there is no more."""
    samples = next(iter(recording.channels.values())).size
    length = min(round(duration_s * recording.fs_hz), samples)
    for start in range(0, samples - length + 1, length):
        begin_s, end_s = start / recording.fs_hz, (start + length - 1) / recording.fs_hz
        times_s = pulses.times_s[(pulses.times_s >= begin_s) & (pulses.times_s <= end_s)] - begin_s
        yield {name: signal[start : start + length] for name, signal in recording.channels.items()}, times_s


def record_pieces(
    recording: MeasuredRecording,
    pulses: ShaftPulses,
    train: GearTrain,
    duration_s: float,
    settings: IndicatorSettings,
    own: Sequence[OwnIndicator] = (),
) -> RecordPieces:
    """Return features of consecutive pieces, between lines too; a rest shorter than a piece counts if there is no more.

    Parameters
    ----------
    recording : MeasuredRecording
        At the rate of the model.
    pulses : ShaftPulses
        Of the first shaft.
    train : GearTrain
        The gearbox, with teeth.
    duration_s : float
        Length of a piece.
    settings : IndicatorSettings
        How features are taken.
    own : sequence of OwnIndicator
        The user's indicators.

    Raises
    ------
    UsageError
        If one of these fails.
    """
    labels: dict[str, float] = {"record_id": 0, "speed_hz": pulses.speed_hz, "torque_nm": math.nan}
    found, values = [], []
    for piece, times_s in cut(recording, pulses, duration_s):
        found.append(record_values(piece, times_s, recording.fs_hz, train, settings))
        mine = _own_values(own, Recording(labels, piece, times_s, recording.fs_hz, train))
        values.append(found[-1].values | mine | floor_features(piece, recording.fs_hz))
    names = tuple(values[0])
    table = np.array([[piece[name] for name in names] for piece in values])
    notes = tuple(dict.fromkeys(piece.notes for piece in found if piece.notes))
    waveforms = tuple(piece.waveforms for piece in found)
    return RecordPieces(table, names, min(piece.revolutions[0] for piece in found), notes, waveforms)


def _own_values(own: Sequence[OwnIndicator], piece: Recording) -> dict[str, float]:
    """Return the user's indicators of a piece; a recording says nothing about its torque, which is then undefined."""
    values, failed = own_values(own, piece)
    if failed:
        raise UsageError(f"channel {failed[0].channel}: {failed[0].text}")
    return values
