"""Averages of the members of a planetary set at sensors that stand still, over turns against the carrier.

A sensor at rest hears each planet through a path that changes with the carrier's angle t: y = sum_i a(t + psi_i)
x(u - psi_i) for the sun, whose angle against the carrier is u. Lines are e^(i(k t + j u)): k by the path, j by the
teeth. A plain average over turns of u keeps k = 0 alone, what the path passes in the mean. A ring that moves as a whole
passes nothing there: its forces turn with the planets, and k is 1 or -1. So the record is weighted by a window over t
before it is averaged, as McFadden (1991) does. His condition, that the windows of all N planets add up to a constant,
holds for the shortest one, 1 + 2 cos t + ... up to order N/2 (halved there): of N orders k in a row, equal planets
leave the sun exactly one for every j, since k - j is a multiple of N. The window of all planets together, turned back
by the places psi_i, then keeps all lines of the sun and none of other orders.

* sun: every tooth of it meets all planets; averages of all windows are added, turned back by the planets' places.
* planet: one window. It stands where one planet leaves the most.
* ring: at rest before the sensor, its teeth show in lines that healthy planets have as well: whole orders of the
  carrier that are multiples of N. Mesh harmonic h stands at the multiple that is nearest to h z.

What healthy planets leave is locked to the passing of planets and stronger than all else. It is taken off first; mesh
harmonics are then put back. A Hann window over the record keeps lines of other members off from two bins on. Where the
windows begin is not known from pulses of the sun. They are turned to where the fourth power of the residual is largest,
so that the average of a record does not depend on its start. Source: derived; windows after McFadden.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.signal.shaft_signals import ShaftSignals, SignalShaft, parted, separated_average
from diagnostics.signal.spectrum import HANN_HALF_WIDTH_BINS, line_amplitudes, resolved_lines
from diagnostics.signal.synchronous_average import hann_weights, synchronous_average

PLACES_PER_ORDER = 8
"""Where windows are tried, per turn of their fastest term: 22.5 degrees of it at most beside the best."""


@dataclass(frozen=True, slots=True)
class Carrier:
    """What passes a sensor.

    Attributes
    ----------
    ring : int
        Teeth of the ring: mesh periods per turn of the carrier.
    places : tuple of float
        Where the planets stand, in turns.
    passing : int
        Orders of the carrier that healthy planets leave are multiples of it.
    samples_per_tooth : int
        Angle steps per mesh period.
    """

    ring: int
    places: tuple[float, ...]
    passing: int
    samples_per_tooth: int


def passing_lines(steps: np.ndarray, carrier: Carrier) -> np.ndarray:
    """Return what is locked to the passing of planets: complex lines at orders 0, 1 ... of the carrier.

    Lines are those of an average over whole turns of the carrier, zero beside multiples of its planets. All are zero
    where the record holds no whole turn.
    """
    from scipy import fft

    size = carrier.ring * carrier.samples_per_tooth
    if steps.size < size:
        return np.zeros(size // 2 + 1, dtype=np.complex128)
    lines = np.asarray(fft.rfft(synchronous_average(steps, carrier.ring, carrier.samples_per_tooth).signal) / size)
    lines[np.arange(lines.size) % carrier.passing != 0] = 0.0
    return lines


def member_signals(
    steps: np.ndarray, shaft: SignalShaft, carrier: Carrier, locked: np.ndarray, shaft_orders: int, sidebands: int
) -> ShaftSignals:
    """Return the signals of a member of a planetary set.

    Parameters
    ----------
    steps : (n,) float64
        Record in equal steps of mesh periods, at least one turn of the member.
    shaft : Shaft
        The member; `meets` says what it meets.
    carrier : Carrier
    locked : (orders,) complex128
        As of `passing_lines`.
    shaft_orders, sidebands : int
        As of `separated_average`.
    """
    if shaft.meets == RING:
        return _ring_signals(steps, shaft, carrier, shaft_orders, sidebands)
    rest = _without(steps, locked, carrier)[: shaft.revolutions * shaft.teeth * carrier.samples_per_tooth]
    orders = _window_orders(carrier)
    terms = _terms(rest, shaft, carrier, orders)
    mesh = _mesh_terms(locked, terms.shape[1], shaft, carrier, orders)
    angle = _window_angle(terms, shaft, carrier, shaft_orders)
    average = _waves(terms + mesh, np.array([angle]))[0]
    lines = line_amplitudes(average)
    parts = separated_average(average, shaft.teeth, shaft_orders, sidebands)
    return ShaftSignals(shaft, average, lines, average, resolved_lines(lines, shaft.resolved, shaft.teeth), parts)


def carrier_turns_needed(sidebands: int, teeth: int, other_teeth: int, carrier: Carrier) -> np.ndarray:
    """Return the turns of the carrier from which sidebands 1 ... of sun or planet stand clear of those of the other.

    Parameters
    ----------
    sidebands : int
        How many.
    teeth, other_teeth : int
        Of the member, and of the other one.
    carrier : Carrier

    Returns
    -------
    (sidebands,) float64
        Two bins of distance, as of `revolutions_needed`; infinite where lines of both coincide.
    """
    own = np.arange(1, sidebands + 1)[:, None, None] * (carrier.ring / teeth)
    others = np.arange(-2 * sidebands, 2 * sidebands + 1)[:, None]
    reach = 2 * int(_window_orders(carrier)[-1])
    by_path = np.arange(-reach, reach + 1)
    distance = np.abs(own - others[others[:, 0] != 0] * (carrier.ring / other_teeth) - by_path).min(axis=(1, 2))
    return np.where(distance > 1e-9, HANN_HALF_WIDTH_BINS / np.maximum(distance, 1e-9), np.inf)


SUN, PLANET, RING = "all planets", "one planet", "the sensor"
"""What a tooth of a member meets in turn, or stands still before."""


def _without(steps: np.ndarray, locked: np.ndarray, carrier: Carrier) -> np.ndarray:
    """Return a record less what is locked to the planets' passing."""
    from scipy import fft

    size = carrier.ring * carrier.samples_per_tooth
    periodic = fft.irfft(locked * size, n=size)
    return np.asarray(steps - np.resize(periodic, steps.size))


def _window_orders(carrier: Carrier) -> np.ndarray:
    """Return the orders 0, 1 ... of the window over a turn of the carrier."""
    return np.arange(len(carrier.places) // 2 + 1)


def _weight(carrier: Carrier, orders: np.ndarray) -> np.ndarray:
    """Return the window's share at each order; the last one is shared by two where planets are even in number."""
    count = len(carrier.places)
    return np.asarray(np.where(2 * orders == count, 0.5, 1.0)[:, None])


def _terms(rest: np.ndarray, shaft: SignalShaft, carrier: Carrier, orders: np.ndarray) -> np.ndarray:
    """Return the complex lines of averages by order of the window, (orders, lines): line j at FFT place j."""
    from scipy import fft

    size = shaft.teeth * carrier.samples_per_tooth
    weights = hann_weights(rest.size)
    weighted = rest * (weights / weights.mean())
    turn = np.arange(rest.size) / (carrier.ring * carrier.samples_per_tooth)
    folded = [
        (weighted * np.exp(-2j * np.pi * order * turn) if order else weighted).reshape(-1, size).mean(axis=0)
        for order in orders.tolist()
    ]
    lines = np.asarray(fft.fft(np.stack(folded).astype(np.complex128), axis=1) / size)
    return np.asarray(lines * _weight(carrier, orders) * _together(size, shaft, carrier, orders))


def _mesh_terms(locked: np.ndarray, size: int, shaft: SignalShaft, carrier: Carrier, orders: np.ndarray) -> np.ndarray:
    """Return the mesh harmonics of a member that passing planets leave, as lines by order of the window.

    Mesh harmonic h with order k of the window is order h z_ring + k of the carrier.
    """
    found = np.zeros((orders.size, size), dtype=np.complex128)
    harmonic = np.arange(-(size // 2 // shaft.teeth), size // 2 // shaft.teeth + 1)
    for place, order in enumerate(orders.tolist()):
        at = harmonic * carrier.ring + order
        inside = (np.abs(at) < locked.size) & (2 * np.abs(harmonic) * shaft.teeth < size) & (harmonic != 0)
        line = locked[np.abs(at[inside])]
        found[place, harmonic[inside] * shaft.teeth] = np.where(at[inside] < 0, np.conj(line), line)
    return np.asarray(found * _weight(carrier, orders) * _together(size, shaft, carrier, orders))


def _together(size: int, shaft: SignalShaft, carrier: Carrier, orders: np.ndarray) -> np.ndarray:
    """Return what windows of all planets make of a line, turned back by the planets' places; one planet: 1."""
    if shaft.meets != SUN:
        return np.ones((1, 1))
    line = np.fft.fftfreq(size, 1.0 / size)
    places = np.asarray(carrier.places)
    turned = np.exp(-2j * np.pi * (orders[:, None, None] - line[None, :, None]) * places)
    return np.asarray(turned.mean(axis=2))


def _waves(terms: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """Return averaged turns with the window at several angles, (angles, n): orders -k are the conjugate of k."""
    from scipy import fft

    waves = fft.ifft(terms, axis=1) * terms.shape[1]
    turning = np.exp(1j * angles[:, None] * np.arange(terms.shape[0]))
    turning[:, 1:] *= 2.0
    return np.asarray((turning @ waves).real, dtype=np.float64)


def _window_angle(terms: np.ndarray, shaft: SignalShaft, carrier: Carrier, shaft_orders: int) -> float:
    """Return where the window leaves the largest fourth power of the residual [rad]."""
    line = np.abs(np.fft.fftfreq(terms.shape[1], 1.0 / terms.shape[1])).astype(np.int64)
    residual = np.where((line % shaft.teeth == 0) | (line <= shaft_orders), 0.0, terms)
    count = PLACES_PER_ORDER * max(2, len(carrier.places))
    angles = 2.0 * np.pi * np.arange(count) / count
    return float(angles[np.argmax(np.sum(_waves(residual, angles) ** 4, axis=1))])


def _ring_signals(
    steps: np.ndarray, shaft: SignalShaft, carrier: Carrier, shaft_orders: int, sidebands: int
) -> ShaftSignals:
    """Return the signals of the ring: one turn of the carrier, of it the orders that equal planets leave."""
    from scipy import fft

    size = carrier.ring * carrier.samples_per_tooth
    spectrum = fft.rfft(synchronous_average(steps, carrier.ring, carrier.samples_per_tooth, hann=True).signal)
    order, step = np.arange(spectrum.size), carrier.passing
    spectrum[order % step != 0] = 0.0
    last = spectrum.size // carrier.ring + 1
    harmonics = np.round(np.arange(1, last + 1) * carrier.ring / step).astype(np.int64) * step
    distance = np.abs(order[:, None] - harmonics).min(axis=1) / step
    average = np.asarray(fft.irfft(spectrum, n=size))
    parts = parted(average, order <= shaft_orders * step, distance, sidebands)
    around = _beside_harmonics(spectrum, harmonics, carrier)
    sideband_average = np.asarray(fft.irfft(np.nan_to_num(around), n=size))
    lines = line_amplitudes(sideband_average)
    return ShaftSignals(shaft, average, lines, sideband_average, np.where(np.isnan(around), np.nan, lines), parts)


def _beside_harmonics(spectrum: np.ndarray, harmonics: np.ndarray, carrier: Carrier) -> np.ndarray:
    """Return lines of which sideband m of harmonic h, m passings of planets away, stands at order h z + m."""
    reach = (carrier.ring // carrier.passing - 1) // 2
    found = np.full(spectrum.size, np.nan + 0j)
    for number, centre in enumerate(harmonics.tolist(), start=1):
        beside = np.arange(-reach, reach + 1)
        to, source = number * carrier.ring + beside, centre + beside * carrier.passing
        inside = (to < spectrum.size) & (source < spectrum.size) & (source >= 0)
        found[to[inside]] = spectrum[source[inside]]
    return found
