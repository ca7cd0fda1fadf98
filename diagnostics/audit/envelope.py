"""Ranges of healthy gearboxes for thirteen quantities, and the share of a set's healthy channel-records inside them.

The ranges pool recordings of a few machines (90 % of their channels) and are wide by necessity; only ratios are used.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from diagnostics.audit.measured_set import MeasuredSet


@dataclass(frozen=True, slots=True)
class MeasuredQuantity:
    """Name in the measured set, title with unit, and the ranges (low, high) that count as inside."""

    name: str
    title: str
    ranges: tuple[tuple[float, float], ...]

    def inside(self, values: np.ndarray) -> np.ndarray:
        """Return which values lie in one of the ranges; undefined ones do not."""
        return np.asarray(np.any([(values >= low) & (values <= high) for low, high in self.ranges], axis=0))


HARMONIC_RANGE = ((-30.0, 12.0),)
QUANTITIES = (
    MeasuredQuantity("sideband1_db", "1st sidebands / mesh 1 [dB]", ((-30.0, -8.0),)),
    MeasuredQuantity("sideband2_db", "2nd sidebands / mesh 1 [dB]", ((-31.0, -14.0),)),
    MeasuredQuantity("asymmetry_db", "upper / lower 1st sideband [dB]", ((-20.0, 6.0),)),
    *(MeasuredQuantity(f"harmonic{h}_db", f"mesh {h} / mesh 1 [dB]", HARMONIC_RANGE) for h in (2, 3, 4, 5)),
    MeasuredQuantity("noise_density_db", "noise density at mesh 1 [dB/Hz]", ((-36.0, -20.0),)),
    MeasuredQuantity("synchronous_ratio_db", "synchronous SNR [dB]", ((-4.0, 9.0),)),
    MeasuredQuantity("kurtosis", "kurtosis, raw (loaded or light load)", ((2.0, 3.2), (4.0, 6.5))),
    MeasuredQuantity("fm4", "FM4", ((2.3, 4.3),)),
    MeasuredQuantity("energy_ratio", "energy ratio", ((0.09, 1.8),)),
)
BACKGROUND_QUANTITIES = (
    MeasuredQuantity("shaft_1x_db", "shaft 1x / strongest mesh line [dB]", ((-47.0, -5.0),)),
    *(
        MeasuredQuantity(f"shaft_{k}x_db", f"shaft {k}x / strongest mesh line [dB]", ((-50.0, -5.0),))
        for k in (2, 3, 4)
    ),
    MeasuredQuantity("floor_10_20hz_db", "floor 10-20 Hz [dB/Hz]", ((-80.0, -35.0),)),
    MeasuredQuantity("floor_40_160hz_db", "floor 40-160 Hz [dB/Hz]", ((-58.0, -40.0),)),
    MeasuredQuantity("floor_5_10khz_db", "floor 5-10 kHz [dB/Hz]", ((-65.0, -45.0),)),
    MeasuredQuantity("floor_slope_db", "floor 5-10 kHz / 40-160 Hz [dB]", ((-22.0, 10.0),)),
    MeasuredQuantity("tonality_3500_5000hz_db", "mean / median 3.5-5 kHz [dB]", ((2.5, 18.0),)),
    MeasuredQuantity("tonality_5_8khz_db", "mean / median 5-8 kHz [dB]", ((2.5, 14.0),)),
    MeasuredQuantity("lines_above_mesh5_per_khz", "lines above mesh 5 [1/kHz]", ((1.5, 8.7),)),
    MeasuredQuantity("noise_kurtosis_1_2khz", "kurtosis of the noise, 1-2 kHz", ((2.9, 3.6),)),
    MeasuredQuantity("noise_kurtosis_2_4khz", "kurtosis of the noise, 2-4 kHz", ((2.95, 4.5),)),
    MeasuredQuantity("noise_kurtosis_4_8khz", "kurtosis of the noise, 4-8 kHz", ((3.1, 6.3),)),
    MeasuredQuantity("noise_envelope_cv_1_2khz", "variation of its envelope, 1-2 kHz", ((0.51, 0.6),)),
    MeasuredQuantity("noise_envelope_cv_2_4khz", "variation of its envelope, 2-4 kHz", ((0.52, 0.7),)),
    MeasuredQuantity("noise_envelope_cv_4_8khz", "variation of its envelope, 4-8 kHz", ((0.53, 0.94),)),
    MeasuredQuantity("shaft_depth", "depth of the envelope at a shaft, 2-8 kHz", ((0.08, 0.75),)),
    MeasuredQuantity("repeated_coherence", "coherence of half averages, orders 100-300", ((0.0, 0.96),)),
    MeasuredQuantity("repeated_kurtosis", "kurtosis of the average, orders 100-300", ((2.3, 3.2),)),
)
"""What stands beside the mesh lines. Ranges pool channels of two or three machines and what is expected of others.

Where one machine was measured, the other end is judgement (docs/understand/methods.md).
"""

SPEED_RANGES = ((0.007, 0.05), (0.3, 1.5))
"""Of test benches, and of machines whose speed varies."""

SPREAD_RANGES = {
    "sideband1_db": (1.0, 5.0),
    **{f"harmonic{h}_db": (3.0, 10.0) for h in (2, 3, 4, 5)},
}
"""Standard deviation between sensors of one gearbox [dB]."""


@dataclass(frozen=True, slots=True)
class QuantityShare:
    """One quantity over all healthy channel-records: its 5 %, 50 % and 95 % points, share inside, share undefined."""

    quantity: MeasuredQuantity
    values: np.ndarray
    quantiles: tuple[float, float, float]
    inside: float
    undefined: float


@dataclass(frozen=True, slots=True)
class SensorSpread:
    """Median over gearboxes of the standard deviation between their channels [dB], and the range it should be in."""

    name: str
    spread_db: float
    wanted_db: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Realism:
    """Shares of the thirteen quantities and of those of the background, and sensor spreads.

    `mean_inside` is the mean over the thirteen, `all_inside` the share of channel-records inside all of them,
    `background_inside` the mean over the background's, `left_out` the quantity of every channel without acceleration.
    """

    shares: tuple[QuantityShare, ...]
    mean_inside: float
    all_inside: float
    spreads: tuple[SensorSpread, ...]
    channel_records: int
    background: tuple[QuantityShare, ...] = ()
    left_out: Mapping[str, str] = field(default_factory=dict)

    @property
    def background_inside(self) -> float:
        """Mean share inside over the quantities of the background; NaN without any."""
        return float(np.mean([share.inside for share in self.background])) if self.background else math.nan


def quantities() -> tuple[MeasuredQuantity, ...]:
    """Return the thirteen quantities, the last with the ranges of benches and of machines of variable speed."""
    return (*QUANTITIES, MeasuredQuantity("speed_variation_percent", "speed variation [%]", SPEED_RANGES))


def realism(measured: MeasuredSet) -> Realism | None:
    """Return how the healthy records lie in the ranges; None without healthy records or without accelerations.

    Ranges were measured with accelerometers: channels of another quantity are left out and named.

    Parameters
    ----------
    measured : MeasuredSet
        The set.
    """
    judged = np.ix_(measured.healthy, measured.accelerations)
    if not all(one.size for one in judged):
        return None
    shares = [quantity_share(q, measured.values[measured.column(q.name)][judged]) for q in quantities()]
    inside = [share.quantity.inside(share.values) for share in shares]
    background = [q for q in BACKGROUND_QUANTITIES if np.isfinite(measured.values[q.name][judged]).any()]
    return Realism(
        shares=tuple(shares),
        mean_inside=float(np.mean([share.inside for share in shares])),
        all_inside=float(np.all(inside, axis=0).mean()),
        spreads=sensor_spreads(measured),
        channel_records=int(shares[0].values.size),
        background=tuple(quantity_share(q, measured.values[q.name][judged]) for q in background),
        left_out=measured.other_quantities,
    )


def quantity_share(quantity: MeasuredQuantity, values: np.ndarray) -> QuantityShare:
    """Return how the values of healthy channel-records lie in the ranges of a quantity."""
    flat = values.ravel()
    defined = flat[np.isfinite(flat)]
    low, middle, high = np.quantile(defined, [0.05, 0.5, 0.95]).tolist() if defined.size else [math.nan] * 3
    inside = float(quantity.inside(flat).mean())
    return QuantityShare(quantity, flat, (low, middle, high), inside, 1.0 - defined.size / flat.size)


def sensor_spreads(measured: MeasuredSet) -> tuple[SensorSpread, ...]:
    """Return the spread between channels for each quantity; empty with fewer than three accelerometers."""
    if measured.accelerations.size < 3:
        return ()
    found = []
    for name, wanted in SPREAD_RANGES.items():
        values = measured.values[name][np.ix_(measured.healthy, measured.accelerations)]
        spread = np.std(values, axis=1, ddof=1)
        found.append(SensorSpread(name, float(np.nanmedian(spread)), wanted))
    return tuple(found)
