"""Change of the noise of a record from its reference, less what the lines of the gears can have left in it.

What the averages of both shafts leave is noise and leftover of the lines, since no tacho of one pulse a turn follows a
shaft exactly. A damaged tooth makes lines stronger, so its leftover rises too, by no more decibels than the lines do:
with a noise N and a share j of lines of power S, N + j S rises by less than S. So a rise counts as far as it exceeds
that of the lines of its band; damage takes no noise away, so a fall counts whole. Noise that a leak adds, or takes,
stands in bands and states in which the lines stay as they are. Source: derived.
"""

from __future__ import annotations

import numpy as np

from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.audit.residual_lines import line_array
from diagnostics.indicators.background_levels import HIGHEST_NOISE_SHARE, LOWEST_NOISE_HZ, NOISE_BANDS, NOISE_LEVELS

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
    known, found = (reference >= 0)[:, None], {}
    lines = line_levels(measured)
    for name in names:
        rose = measured.values[name] - measured.values[name][reference]
        by_lines = np.max([own - own[reference] for own in lines[name]], axis=0, initial=0.0)
        found[name] = np.where(known, np.maximum(rose - by_lines, 0.0) + np.minimum(rose, 0.0), np.nan)
    return found


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
    found = {}
    for name, low, high in zip(NOISE_LEVELS, edges[:-1], edges[1:], strict=True):
        inside = (hz >= low) & (hz < high)
        found[name] = (_decibels(power, inside & is_mesh), _decibels(power, inside & ~is_mesh))
    return found


def _decibels(power: np.ndarray, kept: np.ndarray) -> np.ndarray:
    total = np.where(kept[:, None], power, 0.0).sum(axis=-1)
    return np.where(total > 0.0, 10.0 * np.log10(np.maximum(total, TINY)), 0.0)
