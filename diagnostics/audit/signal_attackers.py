"""Attackers that look at averaged waveforms: each alone, and as differences from the gearbox's own healthy record.

All of them start from the lines of the pinion's averaged revolution in the one table of the set, without shaft and mesh
orders. Nothing of a record's level is used alone, but by the network, which is that of `report`; with a reference the
change is measured against the reference's size.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from diagnostics.audit.audit import REFERENCED
from diagnostics.audit.band_columns import Bank, band_bank, kurtogram_maximum
from diagnostics.audit.column_attackers import all_columns, best_column
from diagnostics.audit.convolution_features import convolution_features, revolution
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.audit.network_attacker import network_attacker
from diagnostics.audit.reference_pairs import reference_records
from diagnostics.audit.residual_lines import line_array, residual_lines, whitened
from diagnostics.audit.trial import Attacker

NETWORK = "circular network"
PREPARED = 4
"""Steps of preparing them, where records have references."""


def signal_attackers(measured: MeasuredSet, seed: int, advance: Callable[[], None]) -> list[Attacker]:
    """Return the attackers; those with a reference only where records have one, the network only with PyTorch.

    Parameters
    ----------
    measured : MeasuredSet
        The set.
    seed : int
        Of the network.
    advance : callable
        Called after every attacker that is prepared.
    """
    residual = residual_lines(line_array(measured.waveforms), measured.labels["teeth_pinion"])
    found = attackers_on(measured, residual, None, seed, advance)
    reference = reference_records(measured)
    if (reference >= 0).any():
        known = np.where((reference >= 0)[:, None, None], residual[reference], np.nan)
        found += attackers_on(measured, residual - known, known, seed, advance)
    return found


def attackers_on(
    measured: MeasuredSet, residual: np.ndarray, reference: np.ndarray | None, seed: int, advance: Callable[[], None]
) -> list[Attacker]:
    """Return the attackers on residual lines, which are differences where a reference is given.

    Parameters
    ----------
    measured : MeasuredSet
    residual : (records, channels, orders) complex128
    reference : (records, channels, orders) complex128, optional
        What the residual is a difference from, NaN where there is none.
    seed, advance
        As of `signal_attackers`.
    """
    suffix = REFERENCED if reference is not None else ""
    bank, highest = band_bank(residual, reference), kurtogram_maximum(residual)
    values, names = over_channels(bank)
    advance()
    waves = level_waves(residual, reference)
    features = convolution_features(waves)
    advance()
    places = reference_records(measured) if reference is not None else None
    network = network_attacker(NETWORK + suffix, measured, places, seed)
    return [
        best_column(f"best band{suffix}", values, names),
        all_columns(f"all bands{suffix}", values),
        best_column(f"kurtogram{suffix}", _mean(highest)[:, None], ("",)),
        all_columns(f"random convolutions{suffix}", features),
        *([network] if network else []),
    ]


def over_channels(bank: Bank) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return mean and largest value over the channels, (records, 2 columns), with their names."""
    with np.errstate(invalid="ignore"):
        largest = np.nanmax(np.where(np.isfinite(bank.values), bank.values, -np.inf), axis=1, initial=-np.inf)
    values = np.concatenate([_mean(bank.values), np.where(np.isfinite(largest), largest, np.nan)], axis=1)
    names = [f"{name} ({how} channels)" for how in ("mean of the", "largest of the") for name in bank.names]
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


def _mean(values: np.ndarray) -> np.ndarray:
    """Return the mean over channels that are defined; NaN without any."""
    defined = np.isfinite(values)
    with np.errstate(invalid="ignore"):
        return np.asarray(
            np.where(defined, values, 0.0).sum(axis=1) / np.where(defined.any(axis=1), defined.sum(axis=1), np.nan)
        )
