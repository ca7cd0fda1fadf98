"""Record: what the sensors of a gearbox gave in one run, and its order spectrum."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from siggen.arrays import FloatArray
from siggen.library.arguments import finite, named, one_of
from siggen.library.axes import drawing, legend_above, new_axes
from siggen.views.pictures import PALETTE

__all__ = ["LineOrders", "Record", "Spectrum"]

SIDEBANDS = 5
"""Lines of each shaft that are marked on either side of a mesh line."""
LEAST_PULSES = 4
"""Of the tacho, to follow the angle between them; with fewer the speed counts as steady."""


@dataclass(frozen=True)
class LineOrders:
    """Order of a mesh, and of its shafts, per turn of the first shaft."""

    name: str
    order: float
    shafts: Mapping[str, float]


@dataclass(frozen=True, repr=False)
class Spectrum:
    """Amplitudes over orders of the first shaft, which stay sharp where the speed varies.

    Attributes
    ----------
    order : (k,)
        Per turn of the first shaft.
    amplitude : (k,)
        In `unit`; a tone shows its amplitude (Hann window).
    unit, channel : str
    speed_hz : float
        Mean speed of the first shaft: `order * speed_hz` are frequencies.
    lines : tuple of LineOrders
        Orders of meshes and of the shafts whose sidebands stand beside them.
    """

    order: FloatArray
    amplitude: FloatArray
    unit: str
    channel: str
    speed_hz: float
    lines: tuple[LineOrders, ...] = ()

    def __repr__(self) -> str:
        """One line."""
        return f"Spectrum({self.channel} [{self.unit}], {self.order.size} orders up to {self.order[-1]:.4g})"

    def plot(self, ax: Any = None, *, around: int | None = None, label: str = "") -> Any:
        """Draw it with mesh lines and sidebands marked, and return the axes.

        Parameters
        ----------
        ax : axes of matplotlib; None: those of a new figure
        around : harmonic of the first mesh to draw alone, with its sidebands; None: all up to six harmonics
        label : for a legend; the channel, where it is empty

        Raises
        ------
        UsageError
            If the harmonic is beyond the spectrum, or matplotlib is missing.
        """
        harmonics = [h for h in range(1, 7) if self.lines and h * self.lines[0].order < self.order[-1]]
        if around is not None:
            finite("around", around, f"1 to {len(harmonics)}", 1, len(harmonics))
        with drawing() as plt:
            fresh = ax is None
            ax = new_axes(plt) if fresh else ax
            low, high = self._range(harmonics, around)
            shown = (self.order >= low) & (self.order <= high)
            floor = np.finfo(float).tiny
            drawn = np.maximum(self.amplitude[shown], floor)
            ax.semilogy(self.order[shown], drawn, lw=0.8, label=label or self.channel)
            if fresh:
                self._mark(ax, harmonics if around is None else [around], low, high)
                ax.set(xlabel="order of the first shaft", ylabel=f"amplitude [{self.unit}]", xlim=(low, high))
                least = np.quantile(self.amplitude[shown], 0.05)
                ax.set_ylim(max(0.3 * least, floor), 3.0 * float(drawn.max()))
            legend_above(ax)
        return ax

    def _range(self, harmonics: list[int], around: int | None) -> tuple[float, float]:
        if not self.lines or (not harmonics and around is None):
            return 0.0, float(self.order[-1])
        first = self.lines[0]
        if around is None:
            return 0.0, min((len(harmonics) + 0.5) * first.order, float(self.order[-1]))
        beside = (SIDEBANDS + 0.5) * max(first.shafts.values(), default=1.0)
        return around * first.order - beside, around * first.order + beside

    def _mark(self, ax: Any, harmonics: list[int], low: float, high: float) -> None:
        for number, mesh in enumerate(self.lines):
            name = f"mesh {mesh.name}".strip()
            at = [h * mesh.order for h in harmonics if low <= h * mesh.order <= high]
            ax.vlines(at, 0, 1, transform=ax.get_xaxis_transform(), color="0.6", lw=0.8, zorder=1,
                      ls=("-", "--", ":", "-.")[number % 4], label=name)  # fmt: skip
            for marker, colour, (shaft, order) in zip(
                "vo", (PALETTE[3], PALETTE[2]), mesh.shafts.items(), strict=False
            ):
                beside = [a + k * order for a in at for k in range(-SIDEBANDS, SIDEBANDS + 1) if k]
                near = [place for place in beside if low <= place <= high]
                heights = [self._height(place) for place in near]
                label = f"sidebands of {shaft}" if len(self.lines) == 1 else f"{name} ± {shaft}"
                ax.plot(near, heights, marker, ms=3, color=colour, mfc="none", mew=0.8, label=label)

    def _height(self, order: float) -> float:
        """Return the largest amplitude within two bins of an order, a little above the line."""
        step = self.order[1] - self.order[0]
        place = round(order / step)
        return 1.4 * float(self.amplitude[max(place - 2, 0) : place + 3].max(initial=0.0))


@dataclass(frozen=True, repr=False)
class Record:
    """What the sensors of one gearbox gave in one run.

    Attributes
    ----------
    state : str
    speed_hz, torque_nm : float
        Commanded, of the first shaft.
    fs_hz : float
        Sampling rate.
    channels : mapping
        Name -> signal (n,), in its unit.
    units : mapping
        Channel -> unit.
    labels : mapping
        What the tables of a set say of a record: damage, errors of the gears, noise (docs/reference/columns.md).
    tacho_s : (k,)
        Times at which the first shaft has made whole turns, from the first sample.
    truth : mapping
        Name -> (n,) of what no sensor sees, as far as `run` was asked for it.
    lines : tuple of LineOrders
        Orders of meshes and shafts.
    """

    state: str
    speed_hz: float
    torque_nm: float
    fs_hz: float
    channels: Mapping[str, FloatArray]
    units: Mapping[str, str]
    labels: Mapping[str, object]
    tacho_s: FloatArray
    truth: Mapping[str, FloatArray] = field(default_factory=dict)
    lines: tuple[LineOrders, ...] = ()

    def __repr__(self) -> str:
        """One line."""
        return (
            f"Record({self.state}, {self.speed_hz:.4g} Hz, {self.torque_nm:.4g} N m: {', '.join(self.channels)}; "
            f"{self._samples} samples at {self.fs_hz:g} Hz)"
        )

    @property
    def time_s(self) -> FloatArray:
        """Times of the samples (n,), from 0."""
        return np.arange(self._samples) / self.fs_hz

    @property
    def _samples(self) -> int:
        return len(next(iter(self.channels.values())))

    def plot(self, *channels: str, ax: Any = None) -> Any:
        """Draw channels over time, all without names, and return the axes: one for each channel of a new figure.

        Given the axes of another record, such as that of another state, it is drawn over that.

        Raises
        ------
        UsageError
            If there is no such channel, or matplotlib is missing.
        """
        shown = named("channels", channels, tuple(self.channels)) or tuple(self.channels)
        with drawing() as plt:
            axes = new_axes(plt, (8.0, 2.6), len(shown)) if ax is None else ax
            each = axes if isinstance(axes, np.ndarray) else [axes] * len(shown)
            for name, one in zip(shown, each, strict=True):
                one.plot(self.time_s, self.channels[name], lw=0.5, label=f"{name}, {self.state}")
                one.set_ylabel(
                    f"{name}\n[{self.units[name]}]" if len(shown) > 1 and ax is None else f"[{self.units[name]}]"
                )
                one.margins(x=0)
                one.legend(loc="upper right", fontsize=8)
            each[-1].set_xlabel("time [s]")
        return axes

    def spectrum(self, channel: str = "") -> Spectrum:
        """Return the order spectrum of a channel; of the first one where no name is given.

        The signal is read at even angles of the first shaft, between the pulses of the tacho.

        Raises
        ------
        UsageError
            If there is no such channel.
        """
        channel = one_of("channel", channel or next(iter(self.channels)), tuple(self.channels))
        signal, samples = self.channels[channel], self._samples
        turns = _turns(self.tacho_s, self.time_s, self.speed_hz)
        even = np.linspace(turns[0], turns[-1], samples)
        if self.tacho_s.size >= LEAST_PULSES:
            from scipy.interpolate import CubicSpline

            signal = CubicSpline(turns, signal)(even)
        window = np.hanning(samples + 1)[:-1]
        amplitude = np.abs(np.fft.rfft((signal - signal.mean()) * window)) * 2.0 / window.sum()
        order = np.fft.rfftfreq(samples, float(even[1] - even[0]))
        speed_hz = float((turns[-1] - turns[0]) / (self.time_s[-1] - self.time_s[0]))
        return Spectrum(
            np.asarray(order, dtype=np.float64), amplitude, self.units[channel], channel, speed_hz, self.lines
        )


def _turns(tacho_s: FloatArray, time_s: FloatArray, speed_hz: float) -> FloatArray:
    """Return the turns of the first shaft at times (n,), from any whole one; steady with too few pulses."""
    if tacho_s.size < LEAST_PULSES:
        return np.asarray(time_s * speed_hz)
    from scipy.interpolate import make_interp_spline

    found = np.asarray(make_interp_spline(tacho_s, np.arange(float(tacho_s.size)), k=3)(time_s))
    for beyond, end, beside in ((time_s < tacho_s[0], 0, 1), (time_s > tacho_s[-1], -1, -2)):
        # behind the last pulse no cubic holds: the mean speed of the last turn
        slope = 1.0 / abs(tacho_s[beside] - tacho_s[end])
        number = 0.0 if end == 0 else tacho_s.size - 1.0
        found[beyond] = number + (time_s[beyond] - tacho_s[end]) * slope
    return found
