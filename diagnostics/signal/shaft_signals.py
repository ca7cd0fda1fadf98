"""What the indicators of one shaft are made of: its average, the parts of it, and its lines; computed once per channel.

Lines of the driver's sidebands come from the plain average; those of the driven gear from a Hann-weighted one, since
over the few revolutions of a record the driver's lines do not cancel. Source: derived; see `revolutions_needed`.

Regular, residual and difference signal of a synchronous average, by zeroing of whole orders.

residual = average minus shaft orders and ALL mesh harmonics (sidebands kept); difference = residual minus the first-
order sidebands; regular = average minus difference. Orders are whole bins of one revolution, so nothing rings and
nothing depends on speed, unlike notch filters in Hz. Source: Lebold et al. 2000 for the separation of residual and
difference; all mesh harmonics below the band edge are removed. MATLAB's `tsaresidual`, `tsadifference` and `tsaregular`
separate alike (help page on filtered averages): the first shaft order always counts, and so do so many harmonics of it
and of the mesh, two in their worked example. With harmonics 3 to 5 strong, as in most measured gearboxes, two are too
few.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.signal.order_domain import AngleGrid
from diagnostics.signal.spectrum import line_amplitudes, resolved_lines, revolutions_needed
from diagnostics.signal.synchronous_average import synchronous_average

SHAFT_ORDERS = 2
SIDEBANDS = 1


@dataclass(frozen=True, slots=True)
class SeparatedAverage:
    """One averaged revolution (n,), separated; `regular + difference` is the average."""

    regular: np.ndarray
    residual: np.ndarray
    difference: np.ndarray


def separated_average(
    average: np.ndarray,
    teeth: int,
    shaft_orders: int = SHAFT_ORDERS,
    sidebands: int = SIDEBANDS,
    beside: int = 0,
) -> SeparatedAverage:
    """Separate one averaged revolution.

    Parameters
    ----------
    average : (n,) float64
        One revolution at equal angle steps.
    teeth : int
        Teeth on the shaft.
    shaft_orders : int
        Shaft orders 0 ... `shaft_orders` count as regular.
    sidebands : int
        Sidebands on each side of every mesh harmonic that count as regular.
    beside : int
        Teeth of another gear on the shaft, whose mesh harmonics count as regular too; 0: there is none.
    """
    order = np.arange(average.size // 2 + 1)
    harmonic = np.round(order / teeth)
    distance = np.where(harmonic > 0, np.abs(order - harmonic * teeth), np.inf)
    if beside:
        distance = np.minimum(distance, _distance(order, beside))
    return parted(average, order <= shaft_orders, distance, sidebands)


def parted(average: np.ndarray, of_shaft: np.ndarray, distance: np.ndarray, sidebands: int) -> SeparatedAverage:
    """Separate one averaged revolution (n,).

    Parameters
    ----------
    average : (n,) float64
    of_shaft : (n // 2 + 1,) bool
        Orders that count as regular.
    distance : (n // 2 + 1,) float64
        How far orders lie from the next mesh harmonic, in sidebands: 0 is the harmonic itself.
    sidebands : int
        As of `separated_average`.
    """
    from scipy import fft

    spectrum = fft.rfft(average)
    residual = fft.irfft(np.where(of_shaft | (distance == 0), 0.0, spectrum), n=average.size)
    difference = fft.irfft(np.where(of_shaft | (distance <= sidebands), 0.0, spectrum), n=average.size)
    return SeparatedAverage(average - difference, residual, difference)


def _distance(order: np.ndarray, teeth: int) -> np.ndarray:
    """Return how far orders of a shaft lie from the next mesh line of a gear on it."""
    harmonic = np.maximum(np.round(order / teeth), 1)
    return np.asarray(np.abs(order - harmonic * teeth))


@dataclass(frozen=True, slots=True)
class SignalShaft:
    """One shaft of a record: its name, teeth, whole revolutions, which sidebands are resolved, and what is not.

    `beside` are the teeth of another gear on it, which takes part in another mesh; 0: there is none. `meets` says what
    a tooth of a planetary set's member meets, see `member_average`; `period` are the mesh periods after which an event
    comes back to a sensor at rest, where those are not its teeth. `weighted` says whether sidebands come from a
    Hann-weighted average.
    """

    name: str
    teeth: int
    revolutions: int
    resolved: np.ndarray
    note: str
    beside: int = 0
    meets: str = ""
    period: float = 0.0
    weighted: bool = False


@dataclass(frozen=True, slots=True)
class ShaftSignals:
    """Signals of one shaft in one channel.

    Attributes
    ----------
    shaft : Shaft
    average : (n,) float64
        Synchronous average, one revolution.
    lines : (n // 2 + 1,) float64
        Its line amplitudes at whole shaft orders.
    sideband_average : (n,) float64
        The average that sidebands are read from: the same for the driver, Hann-weighted for the driven gear.
    sideband_lines : (n // 2 + 1,) float64
        Its line amplitudes, NaN where a sideband is not resolved.
    parts : SeparatedAverage
        Regular, residual and difference signal of the average.
    """

    shaft: SignalShaft
    average: np.ndarray
    lines: np.ndarray
    sideband_average: np.ndarray
    sideband_lines: np.ndarray
    parts: SeparatedAverage


def record_shafts(
    grid: AngleGrid | None, teeth: tuple[int, int], samples_per_tooth: int, sidebands: int, named: tuple[str, ...]
) -> tuple[SignalShaft, SignalShaft]:
    """Return the shafts of driver and driven gear of a record.

    Parameters
    ----------
    grid : AngleGrid, optional
        Steps of the driver's angle; without them both shafts have no revolution.
    teeth : (int, int)
        Teeth of both gears.
    samples_per_tooth : int
        Angle steps per mesh period.
    sidebands : int
        Sidebands 1 ... of which it is told whether they are resolved.
    named : tuple of str
        What both gears are called.
    """
    steps = grid.time_s.size if grid else 0
    turns = tuple(steps // (z * samples_per_tooth) for z in teeth)
    needed = np.array([revolutions_needed(k, teeth[1], teeth[0]) for k in range(1, sidebands + 1)])
    resolved = needed <= turns[1]
    note = "" if turns[0] else "no whole turn of the first shaft between two pulses"
    driver = SignalShaft(named[0], teeth[0], turns[0], np.ones(sidebands, dtype=bool), note)
    limits = _resolution_note(named[1], resolved, needed, turns[1])
    return driver, SignalShaft(named[1], teeth[1], turns[1], resolved, limits, weighted=True)


def _resolution_note(gear: str, resolved: np.ndarray, needed: np.ndarray, turns: int) -> str:
    if turns < 1:
        return f"no whole {gear} revolution: all {gear} averages undefined"
    missing = [f"{k + 1} (needs {needed[k]:.0f})" for k in np.flatnonzero(~resolved)]
    return f"{gear} sidebands not resolved by {turns} {gear} revolutions: {', '.join(missing)}" if missing else ""


def shaft_signals(
    steps: np.ndarray, shaft: SignalShaft, samples_per_tooth: int, shaft_orders: int, difference_sidebands: int
) -> ShaftSignals:
    """Return the signals of one shaft from a record in equal steps of angle.

    Parameters
    ----------
    steps : (n,) float64
        Angle signal, at least one revolution of the shaft.
    shaft : Shaft
        Whose revolutions are averaged.
    samples_per_tooth, shaft_orders, difference_sidebands : int
        As of `FeatureSettings`.
    """
    average = synchronous_average(steps, shaft.teeth, samples_per_tooth).signal
    lines = line_amplitudes(average)
    parts = separated_average(average, shaft.teeth, shaft_orders, difference_sidebands, beside=shaft.beside)
    if not shaft.weighted:
        return ShaftSignals(shaft, average, lines, own_band(average, shaft), own_lines(lines, shaft), parts)
    weighted = synchronous_average(steps, shaft.teeth, samples_per_tooth, hann=True).signal
    resolved = resolved_lines(line_amplitudes(weighted), shaft.resolved, shaft.teeth)
    return ShaftSignals(shaft, average, lines, own_band(weighted, shaft), own_lines(resolved, shaft), parts)


def own_lines(lines: np.ndarray, shaft: SignalShaft) -> np.ndarray:
    """Return lines at whole orders of a shaft, NaN where another gear on it has its mesh lines and this one has not."""
    return np.where(_is_foreign(lines.size, shaft), np.nan, lines) if shaft.beside else lines


def own_band(average: np.ndarray, shaft: SignalShaft) -> np.ndarray:
    """Return an average without the mesh lines that only another gear on the shaft has."""
    from scipy import fft

    if not shaft.beside:
        return average
    spectrum = fft.rfft(average)
    return np.asarray(fft.irfft(np.where(_is_foreign(spectrum.size, shaft), 0.0, spectrum), n=average.size))


def without_mesh_lines(average: np.ndarray, teeth: int) -> np.ndarray:
    """Return an average without its mean and the mesh lines of a gear on the shaft."""
    from scipy import fft

    spectrum = fft.rfft(average)
    spectrum[::teeth] = 0.0
    return np.asarray(fft.irfft(spectrum, n=average.size))


def _is_foreign(orders: int, shaft: SignalShaft) -> np.ndarray:
    order = np.arange(orders)
    return np.asarray((order > 0) & (order % shaft.beside == 0) & (order % shaft.teeth != 0))
