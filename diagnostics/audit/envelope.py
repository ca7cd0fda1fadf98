"""Ranges of healthy gearboxes for thirteen quantities, and the share of a set's healthy channel-records inside them.

The ranges pool recordings of a few machines (90 % of their channels) and are wide by necessity; only ratios are used.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from diagnostics.audit.measured_set import MeasuredSet

BENCH, VARIABLE = "bench", "variable"


@dataclass(frozen=True, slots=True)
class Quantity:
    """Name in the measured set, title with unit, and the ranges (low, high) that count as inside."""

    name: str
    title: str
    ranges: tuple[tuple[float, float], ...]

    def inside(self, values: np.ndarray) -> np.ndarray:
        """Return which values lie in one of the ranges; undefined ones do not."""
        return np.asarray(np.any([(values >= low) & (values <= high) for low, high in self.ranges], axis=0))


HARMONIC_RANGE = ((-30.0, 12.0),)
QUANTITIES = (
    Quantity("sideband1_db", "1st sidebands / mesh 1 [dB]", ((-30.0, -8.0),)),
    Quantity("sideband2_db", "2nd sidebands / mesh 1 [dB]", ((-31.0, -14.0),)),
    Quantity("asymmetry_db", "upper / lower 1st sideband [dB]", ((-20.0, 6.0),)),
    *(Quantity(f"harmonic{h}_db", f"mesh {h} / mesh 1 [dB]", HARMONIC_RANGE) for h in (2, 3, 4, 5)),
    Quantity("noise_density_db", "noise density at mesh 1 [dB/Hz]", ((-36.0, -20.0),)),
    Quantity("synchronous_ratio_db", "synchronous SNR [dB]", ((-4.0, 9.0),)),
    Quantity("kurtosis", "kurtosis, raw (loaded or light load)", ((2.0, 3.2), (4.0, 6.5))),
    Quantity("fm4_pinion", "FM4", ((2.3, 4.3),)),
    Quantity("energy_ratio_pinion", "energy ratio", ((0.09, 1.8),)),
)
SPEED_RANGES = {BENCH: ((0.007, 0.05),), VARIABLE: ((0.3, 1.5),)}

SPREAD_RANGES = {
    "sideband1_db": (1.0, 5.0),
    **{f"harmonic{h}_db": (3.0, 10.0) for h in (2, 3, 4, 5)},
}
"""Standard deviation between sensors of one gearbox [dB]."""


@dataclass(frozen=True, slots=True)
class QuantityShare:
    """One quantity over all healthy channel-records: its 5 %, 50 % and 95 % points, share inside, share undefined."""

    quantity: Quantity
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
    """Shares of all quantities, their mean, the share of channel-records inside all of them, and sensor spreads."""

    shares: tuple[QuantityShare, ...]
    mean_inside: float
    all_inside: float
    spreads: tuple[SensorSpread, ...]
    channel_records: int


def quantities(speed: str = BENCH) -> tuple[Quantity, ...]:
    """Return the thirteen quantities, the last with the range of a bench or of a variable-speed machine."""
    return (*QUANTITIES, Quantity("speed_variation_percent", f"speed variation, {speed} [%]", SPEED_RANGES[speed]))


def realism(measured: MeasuredSet, speed: str = BENCH) -> Realism | None:
    """Return how the healthy records lie in the ranges; None without healthy records.

    Parameters
    ----------
    measured : MeasuredSet
        The set.
    speed : str
        `bench` or `variable`.
    """
    healthy = measured.healthy
    if not healthy.any():
        return None
    shares, inside = [], []
    for quantity in quantities(speed):
        values = measured.values[quantity.name][healthy].ravel()
        defined = values[np.isfinite(values)]
        points = np.quantile(defined, [0.05, 0.5, 0.95]).tolist() if defined.size else [math.nan] * 3
        within = quantity.inside(values)
        inside.append(within)
        undefined = 1.0 - defined.size / values.size
        shares.append(
            QuantityShare(quantity, values, (points[0], points[1], points[2]), float(within.mean()), undefined)
        )
    return Realism(
        shares=tuple(shares),
        mean_inside=float(np.mean([share.inside for share in shares])),
        all_inside=float(np.all(inside, axis=0).mean()),
        spreads=sensor_spreads(measured),
        channel_records=int(values.size),
    )


def sensor_spreads(measured: MeasuredSet) -> tuple[SensorSpread, ...]:
    """Return the spread between channels for each quantity; empty with fewer than three channels."""
    if len(measured.channels) < 3:
        return ()
    found = []
    for name, wanted in SPREAD_RANGES.items():
        values = measured.values[name][measured.healthy]
        spread = np.std(values, axis=1, ddof=1)
        found.append(SensorSpread(name, float(np.nanmedian(spread)), wanted))
    return tuple(found)
