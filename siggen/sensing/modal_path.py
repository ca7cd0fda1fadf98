"""Modal path: accelerance from bearing forces to places on a housing, as a sum over lightly damped modes.

H(f) = Σ_r R_r (i2πf)² / (ω_r² - (2πf)² + i 2 ζ_r ω_r 2πf), R_r = φ_r(sensor) φ_r(bearing) / m_r (reference: standard
literature, modal analysis). Modal masses m_r = m_1 (f_r / f_1)^p make residues fall as 1/f^p (derived; p = 2 by
default: higher modes move smaller parts of the wall by less).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import ComplexArray, FloatArray


@dataclass(frozen=True, slots=True)
class HousingModes:
    """Modes of one housing, in ascending order of their frequencies; arrays are (modes,).

    Attributes
    ----------
    frequency_hz, damping_ratio : natural frequencies and damping ratios
    modal_mass_kg : for shapes with mean square 1
    """

    frequency_hz: FloatArray
    damping_ratio: FloatArray
    modal_mass_kg: FloatArray


def housing_modes(
    frequency_hz: FloatArray, damping_ratio: FloatArray, *, lowest_mass_kg: float, exponent: float
) -> HousingModes:
    """Return modes whose modal masses grow as frequency to the power `exponent` from that of the lowest mode.

    Raises
    ------
    ValueError
        If frequencies are not positive and ascending, damping ratios outside (0, 1), or the mass not positive.
    """
    if not (frequency_hz.size and frequency_hz[0] > 0.0 and (np.diff(frequency_hz) >= 0.0).all()):
        raise ValueError(f"frequency_hz: received {frequency_hz}; allowed are positive frequencies in ascending order")
    if not ((damping_ratio > 0.0) & (damping_ratio < 1.0)).all() or damping_ratio.shape != frequency_hz.shape:
        raise ValueError(f"damping_ratio: received {damping_ratio}; allowed is one between 0 and 1 per mode")
    if not lowest_mass_kg > 0.0:
        raise ValueError(f"lowest_mass_kg: received {lowest_mass_kg}; allowed are masses above 0")
    masses = lowest_mass_kg * (frequency_hz / frequency_hz[0]) ** exponent
    return HousingModes(frequency_hz, damping_ratio, masses)


def mode_shape(modes: int, rng: np.random.Generator) -> FloatArray:
    """Return the values (modes,) of all mode shapes at a random place and direction: random sign, mean square 1.

    Sizes lie between 0.5 and 1.5 of their mean: the bearings' walls and where one would put a sensor are no nodes.
    """
    size = rng.uniform(0.5, 1.5, modes) / SHAPE_RMS
    return np.where(rng.random(modes) < 0.5, -size, size)


SHAPE_RMS = float(np.sqrt(13.0 / 12.0))
"""Root mean square of a uniform number between 0.5 and 1.5."""


def modal_accelerance(
    modes: HousingModes,
    at_input: FloatArray,
    at_output: FloatArray,
    frequency_hz: FloatArray,
    shares: ComplexArray | None = None,
) -> ComplexArray:
    """Return the accelerance (inputs, k) in m/s² per N at frequencies (k,).

    Parameters
    ----------
    modes : HousingModes
    at_input : (inputs, modes) mode shapes where the forces act
    at_output : (modes,) mode shapes at the sensor, along its axis
    frequency_hz : (k,)
    shares : those of `modal_shares` at these frequencies, if they are at hand
    """
    total = np.zeros((len(at_input), frequency_hz.size), dtype=np.complex128)
    residues = at_input * (at_output / modes.modal_mass_kg)
    for residue, share in zip(residues.T, modal_shares(modes, frequency_hz) if shares is None else shares, strict=True):
        total += residue[:, None] * share
    return total


def modal_shares(modes: HousingModes, frequency_hz: FloatArray) -> ComplexArray:
    """Return what every mode does at frequencies (k,) with a residue of 1 (modes, k), the same for all places."""
    shares = np.empty((modes.frequency_hz.size, frequency_hz.size), dtype=np.complex128)
    for share, natural_hz, ratio in zip(shares, modes.frequency_hz, modes.damping_ratio, strict=True):
        x = frequency_hz / natural_hz
        share[:] = -(x**2) / (1.0 - x**2 + 2j * ratio * x)
    return shares
