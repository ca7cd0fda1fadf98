"""How much a recording speaks for a speed: lines at the orders of both shafts against what lies around them.

The spectrum is taken over the angle of some shaft of the machine, so that its lines are sharp while the speed drifts;
the orders of every other speed lie at other multiples of that angle. Power over the median around it is distributed
exponentially where there is no line. What speaks for a speed is the logarithm of a likelihood ratio: lines whose power
has a mean of m, against noise. It is largest at the true speed: at half of it every second order is empty, at twice of
it half of the lines are left out. Source: derived.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import gcd

import numpy as np

from diagnostics.signal.spectrum import order_spectrum

AROUND_CELLS = 101
"""Cells of the spectrum whose median is the level of the noise; three or more of the gear's orders."""

BESIDE_CELLS = 11
"""The same beside a strong line, whose skirts (of drift and phase that were not followed exactly) are no lines of
another speed: a line stands above its neighbours."""

STRONGEST = 10.0
"""Power over noise that one line may count at most: twenty lines decide, never one."""

SIDEBANDS = 2.5
"""Orders of its own shaft that a sideband lies from the mesh line at most; sidebands are a group of their own, since
where nothing else is modulated they are the only lines of a shaft."""

LEAST_SHARE = 0.1
"""Of what the lines of one shaft stand out by, those of the other do so at least; else half of the speed of a pair
2 : 1, whose pinion has all lines and whose gear has none, would be as likely."""

MESH_MOST = 20.0
"""What lines of another stage may say: they fit as mesh lines at some speed, while those of its shafts do not."""

FEWEST_CELLS = 6.0
"""Of the spectrum between lines of the pair's common period; where they are nearer, they are not looked at."""

SPEEDS_AT_ONCE = 400


@dataclass(frozen=True)
class LineEvidence:
    """Power over noise (cells,), over the angle of a shaft that turns at `speed_hz`, mean over channels.

    Attributes
    ----------
    power : (cells,) float64
        By order of that shaft in steps of 1 / revolutions.
    revolutions : int
    speed_hz : float
    teeth : (int, int)
        Of the pinion and of the gear that are looked for.
    highest_hz : float
        Lines above it are not looked at.
    """

    power: np.ndarray
    revolutions: int
    speed_hz: float
    teeth: tuple[int, int]
    highest_hz: float

    @property
    def step(self) -> float:
        """Relative step of speed at which the highest line moves by half a cell."""
        return 0.5 / (self.revolutions * self.highest_hz / self.speed_hz)

    def at(self, speeds_hz: np.ndarray, mesh_most: float = np.inf) -> np.ndarray:
        """Return what speaks for each pinion speed (n,) [Hz], as logarithms of likelihood ratios (n,).

        Mesh lines say `mesh_most` at most: with `MESH_MOST`, no more than those of another stage could.
        """
        parts = np.array_split(speeds_hz, max(1, speeds_hz.size // SPEEDS_AT_ONCE))
        return np.concatenate([self._at(part, mesh_most) for part in parts])

    def sharpness(self, speed_hz: float) -> float:
        """Return how high mesh lines and sidebands of a speed stand, as a sum of logarithms."""
        orders = np.concatenate(self._groups[:2])
        place = orders[orders * speed_hz <= self.highest_hz] * speed_hz / self.speed_hz
        return float(np.sum(np.log1p(self.power[np.rint(place * self.revolutions).astype(np.int64)])))

    def _at(self, speeds_hz: np.ndarray, mesh_most: float) -> np.ndarray:
        mesh, pinion_beside, gear_beside, pinion_rest, gear_rest, hunting = (
            self._lines(speeds_hz, orders) for orders in self._groups
        )
        total = np.asarray(np.minimum(mesh.evidence(), mesh_most) + hunting.evidence())
        for one, other in ((pinion_beside, gear_beside), (pinion_rest, gear_rest)):
            total += one.evidence(other) + other.evidence(one)
        return total

    def _lines(self, speeds_hz: np.ndarray, orders: np.ndarray) -> _Lines:
        count = np.searchsorted(orders, self.highest_hz / speeds_hz, side="right")  # orders rise
        cells = np.outer(speeds_hz * (self.revolutions / self.speed_hz), orders[: count.max(initial=0)])
        np.rint(cells, out=cells)
        np.minimum(cells, self.power.size - 1, out=cells)
        found = self._limited[cells.astype(np.intp)]
        all_have = count.min(initial=orders.size)
        found[:, all_have:] *= np.arange(all_have, found.shape[1]) < count[:, None]
        return _Lines(count, found.sum(axis=1) / np.maximum(count, 1))

    @cached_property
    def _limited(self) -> np.ndarray:
        return np.asarray(np.minimum(self.power, STRONGEST))

    @cached_property
    def _groups(self) -> tuple[np.ndarray, ...]:
        finest = FEWEST_CELLS / self.revolutions
        return tuple(_groups(self.teeth, int(2.0 * self.power.size / self.revolutions), finest))


@dataclass(frozen=True, slots=True)
class _Lines:
    """Number of lines of a group and the mean of their power over noise (n,), for n speeds."""

    count: np.ndarray
    mean: np.ndarray

    def evidence(self, other: _Lines | None = None) -> np.ndarray:
        """Return the logarithm of the likelihood ratio of the likeliest mean against noise.

        With lines of the other shaft, a mean that `LEAST_SHARE` of theirs reaches: two gears in mesh show both.
        """
        least = 1.0 + (LEAST_SHARE * np.maximum(other.mean - 1.0, 0.0) if other is not None else 0.0)
        likely = np.maximum(self.mean, least)
        return np.asarray(self.count * (self.mean * (1.0 - 1.0 / likely) - np.log(likely)))


def line_evidence(
    signals: Sequence[np.ndarray], pulses_s: np.ndarray, fs_hz: float, teeth: tuple[int, int], highest_hz: float
) -> LineEvidence:
    """Return the evidence of a recording over the angle that pulse times give.

    Parameters
    ----------
    signals : sequence of (n,) float
        The channels.
    pulses_s : (k,) float64
        One time per turn of a shaft whose lines are sharp over that angle [s].
    fs_hz : float
        Sampling frequency [Hz].
    teeth : (int, int)
        Of pinion and gear.
    highest_hz : float
        Up to where lines are looked for.
    """
    spectra = [order_spectrum(signal, pulses_s, fs_hz, teeth[0]) for signal in signals]
    power = np.mean([power_over_noise(spectrum.amplitude_m_s2) for spectrum in spectra], axis=0)
    speed_hz = float((pulses_s.size - 1) / (pulses_s[-1] - pulses_s[0]))
    highest = min(highest_hz, 0.95 * float(spectra[0].order[-1]) * speed_hz)
    return LineEvidence(power, spectra[0].revolutions, speed_hz, teeth, highest)


def power_over_noise(amplitude: np.ndarray) -> np.ndarray:
    """Return power over that of the noise around it; of mean one or little less where there is no line."""
    from scipy.ndimage import median_filter

    power = np.square(amplitude)
    medians = (median_filter(power, cells, mode="reflect") for cells in (AROUND_CELLS, BESIDE_CELLS))
    noise = np.maximum(*medians) / np.log(2.0)
    return np.asarray(power / (noise + 1e-300))


def _groups(teeth: tuple[int, int], highest: int, finest: float) -> Iterator[np.ndarray]:
    """Yield orders: mesh lines; sidebands of pinion, of gear; other lines of both; of the pair's common period."""
    pinion, gear = teeth
    own = np.arange(1, highest + 1)
    turns = np.arange(1, int(highest * gear / pinion) + 1)
    of_pinion = own[own % pinion != 0].astype(np.float64)
    of_gear = turns[turns * pinion % gear != 0] * pinion / gear
    beside_pinion, beside_gear = _beside(of_pinion, pinion, 1.0), _beside(of_gear, pinion, pinion / gear)
    yield own[own % pinion == 0].astype(np.float64)
    yield from (of_pinion[beside_pinion], of_gear[beside_gear], of_pinion[~beside_pinion], of_gear[~beside_gear])
    common = gcd(pinion, gear)
    periods = np.arange(1, highest * gear // common + 1 if common >= finest * gear else 1)
    yield periods[(periods * common % gear != 0) & (periods * common % pinion != 0)] * common / gear


def _beside(orders: np.ndarray, teeth: int, width: float) -> np.ndarray:
    """Return which orders are sidebands of a mesh line."""
    apart = np.minimum(orders % teeth, teeth - orders % teeth)
    return np.asarray((apart <= SIDEBANDS * width) & (orders > 0.5 * teeth))
