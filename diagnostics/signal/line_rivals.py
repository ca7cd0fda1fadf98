"""What the lines of a recording say of an angle, and how far other speeds and other teeth lie behind it, in nats.

Over the right angle the lines of both shafts are sharp and stand at the orders of the teeth. A line says the logarithm
of its power over the noise, six at most, less what a line costs: without that cost dense combs would win. Source:
derived.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.signal.speed_paths import MESH_WEIGHT, SIDEBAND_WEIGHT, line_orders, noise_floor

FLOOR_CELLS = 101
OVERSAMPLED = 2.3
"""Samples per period of the highest order."""

MOST_SAID, MOST_SHARP, COST = 6.0, 12.0, 0.35
NOISE_SAYS, LEAST_SAID = 0.3, 15.0
"""Mean of a sharp level where there is no line; nats from which a shaft's sidebands are seen."""

LOW_ORDERS, LOW_WEIGHT = 4, 0.5
"""Shaft orders from one on that count too, and how much."""

OUTSIDE = (0.6, 1.7)
"""How far beyond its ends a range is looked at: one that misses the speed is refused."""

MULTIPLES = (1 / 3, 0.5, 2 / 3, 0.75, 4 / 3, 1.5, 2.0, 3.0)
"""Speeds over the true one at which many of its lines are lines too."""

PINION_NEAR, GEAR_NEAR = 8, 12
"""How many teeth more and fewer are tried."""

LEAST_SHARE_OF_TEETH = 0.7
APART_CELLS, TOGETHER_CELLS, KNOWN_SIDEBANDS, MIXED, JUDGED_SIDEBANDS = 2.5, 0.4, 12, (2, 5), 3
"""Cells within which two lines overlap, and within which their peaks are one; sidebands of the given teeth that are
known, so that they speak for no other teeth; sidebands of a shaft that tell its teeth."""

SPEEDS_AT_ONCE = 20_000


@dataclass(frozen=True, slots=True, eq=False)
class OrderLevels:
    """Levels over the noise [nats] by order of the first shaft, less their median, means over channels (cells,).

    `level`: limited, largest of three cells; `sharp`: of each cell, hardly limited. `revolutions`: cells per order.
    """

    level: np.ndarray
    sharp: np.ndarray
    revolutions: int

    def said(self, orders: np.ndarray, scales: np.ndarray) -> np.ndarray:
        """Return what lines at these orders say at multiples of the speed, less their cost, (scales, orders)."""
        cells = np.rint(np.outer(scales, orders) * self.revolutions).astype(np.intp)
        said = self.level[np.minimum(cells, self.level.size - 1)] - np.float32(COST)
        said[cells >= self.level.size] = 0.0
        return np.asarray(said)

    def sharpness(self, orders: np.ndarray) -> np.ndarray:
        """Return the sharp level at these orders, (orders,), by parabolas between cells; zero above the band.

        About its top the logarithm of a line behind a Hann window is a parabola to 0.1 nat.
        """
        places = orders * self.revolutions
        cells = np.clip(np.rint(places).astype(np.intp), 1, self.sharp.size - 2)
        before, level, behind = (self.sharp[cells + k] for k in (-1, 0, 1))
        away = places - cells
        between = level + 0.5 * away * (behind - before) + 0.5 * away**2 * (before - 2.0 * level + behind)
        return np.where(places < self.sharp.size - 2, np.maximum(between, 0.0), 0.0)

    def total(self, orders: np.ndarray, scale: float = 1.0) -> float:
        """Return what all lines at these orders say."""
        return float(self.said(orders, np.array([scale])).sum())


def order_levels(
    signals: np.ndarray, fs_hz: float, time_s: np.ndarray, turns: np.ndarray, highest_order: float
) -> OrderLevels:
    """Return the levels of a recording over an angle.

    Parameters
    ----------
    signals : (channels, n) float32
        The recording, without power above 0.4 `fs_hz` that counts.
    fs_hz : float
        Sampling frequency [Hz].
    time_s, turns : (k,) float64
        The angle.
    highest_order : float
        Up to which levels are needed.
    """
    from scipy import fft, ndimage

    revolutions = int(turns[-1] - turns[0])
    count = fft.next_fast_len(int(revolutions * OVERSAMPLED * highest_order), real=True)
    places = np.interp(turns[0] + np.arange(count) * (revolutions / count), turns, time_s) * fs_hz
    window = np.hanning(count).astype(np.float32)
    cells = min(int(highest_order * revolutions) + 2, count // 2)
    total, sharp = np.zeros(cells, np.float32), np.zeros(cells, np.float32)
    for signal in signals:
        over_angle = ndimage.map_coordinates(signal, [places], order=3, mode="nearest", output=np.float32)
        spectrum = fft.rfft(over_angle * window)[:cells]
        power = np.square(spectrum.real) + np.square(spectrum.imag)
        power /= noise_floor(power, FLOOR_CELLS) + np.float32(1e-12) * power.max() + np.float32(1e-30)
        level = np.log1p(power)
        sharp += np.minimum(level, np.float32(MOST_SHARP))
        total += np.minimum(ndimage.maximum_filter1d(level, 3), np.float32(MOST_SAID))
    total /= len(signals)
    sharp /= len(signals)
    return OrderLevels(
        np.maximum(total - np.median(total), 0.0), np.maximum(sharp - np.median(sharp), 0.0), revolutions
    )


def fit_nats(levels: OrderLevels, teeth: tuple[int, int], harmonics: int, scales: np.ndarray) -> np.ndarray:
    """Return what all lines of these teeth say at multiples of the speed (n,), (n,) nats."""
    mesh, beside = line_orders(teeth, harmonics)
    low = np.unique(np.round(np.outer(np.arange(1, LOW_ORDERS + 1), (1.0, teeth[0] / teeth[1])), 9))
    orders = np.concatenate([mesh, beside, low])
    weight = np.repeat([MESH_WEIGHT, SIDEBAND_WEIGHT, LOW_WEIGHT], [mesh.size, beside.size, low.size])
    parts = np.array_split(scales, max(1, scales.size // SPEEDS_AT_ONCE))
    return np.concatenate([levels.said(orders, part) @ weight for part in parts])


@dataclass(frozen=True, slots=True)
class Rival:
    """Another explanation of the lines: its name, and how far it lies behind [nats]; below zero it is ahead."""

    name: str
    behind: float


def rivals(
    levels: OrderLevels, teeth: tuple[int, int], harmonics: int, limits_hz: tuple[float, float], speed_hz: float
) -> dict[str, Rival]:
    """Return the best rival of every kind: `speed` in the range, `outside` of it, `mesh`, `pinion`, `gear`.

    Parameters
    ----------
    levels : OrderLevels
        Over the angle that is judged.
    teeth : (int, int)
        As given.
    harmonics : int
        Mesh harmonics within the band.
    limits_hz : (float, float)
        The range [Hz].
    speed_hz : float
        Mean speed by the angle [Hz].
    """
    return _of_speed(levels, teeth, harmonics, limits_hz, speed_hz) | _of_teeth(levels, teeth, harmonics)


def _of_speed(
    levels: OrderLevels, teeth: tuple[int, int], harmonics: int, limits_hz: tuple[float, float], speed_hz: float
) -> dict[str, Rival]:
    judged = float(fit_nats(levels, teeth, harmonics, np.ones(1))[0])
    step = 1.0 / (levels.revolutions * teeth[0] * harmonics)
    low, high = OUTSIDE[0] * limits_hz[0] / speed_hz, OUTSIDE[1] * limits_hz[1] / speed_hz
    scales = np.exp(np.arange(np.log(low), np.log(high) + step, step))
    # what shares lines with the judged speed is looked at by itself, below
    shared = np.abs(scales[:, None] / np.array([1.0, *MULTIPLES]) - 1.0).min(axis=1)
    scales = scales[shared > 3.0 / (levels.revolutions * teeth[0])]
    multiples = np.outer(MULTIPLES, np.exp(step * np.arange(-3, 4)))
    best: dict[str, Rival] = {}
    for part, is_multiple in ((scales, False), *((row, True) for row in multiples)):
        fits = fit_nats(levels, teeth, harmonics, part)
        within = (part * speed_hz >= 0.999 * limits_hz[0]) & (part * speed_hz <= 1.001 * limits_hz[1])
        for kind, chosen in (("speed", within), ("outside", ~within)):
            if not chosen.any():
                continue
            place = int(np.where(chosen, fits, -np.inf).argmax())
            behind = judged - float(fits[place])
            if is_multiple:  # it shares lines: its mesh lines have to stand as high as those that are judged
                less = _mesh_mean(levels, teeth[0], harmonics, 1.0)
                less -= _mesh_mean(levels, teeth[0], harmonics, float(part[place]))
                behind = max(behind, 2.0 * harmonics * less)
                if part[place] < 1.0:
                    behind = max(behind, -_unexplained(levels, teeth, harmonics, float(part[place])))
            if kind not in best or behind < best[kind].behind:
                best[kind] = Rival(f"{part[place] * speed_hz:.4g} Hz", behind)
    return best


def _unexplained(levels: OrderLevels, teeth: tuple[int, int], harmonics: int, scale: float) -> float:
    """Return what lines of a slower speed say that the judged one has not [nats].

    A blow per turn has lines at all orders of a shaft, mesh lines of half its speed among them. But at half the speed
    the sidebands would stand at half orders, too.
    """
    mesh, beside = line_orders(teeth, harmonics)
    explained = np.concatenate([mesh, beside])
    tried = beside * scale
    apart = APART_CELLS / levels.revolutions
    new = np.abs(tried - np.rint(tried)) > apart
    new &= np.abs(tried[:, None] - explained).min(axis=1) > apart
    return levels.total(tried[new])


def _mesh_mean(levels: OrderLevels, teeth: int, harmonics: int, scale: float) -> float:
    count = max(1, int(harmonics / scale))
    return levels.total(teeth * np.arange(1.0, count + 1.0), scale) / count


def _of_teeth(levels: OrderLevels, teeth: tuple[int, int], harmonics: int) -> dict[str, Rival]:
    first, second = teeth
    h = np.arange(1.0, harmonics + 1.0)

    def of_mesh(z: int) -> np.ndarray:
        beside = (h[:, None] * z + np.array([-2, -1, 1, 2])).ravel()
        mesh, sharp = 2.0 * levels.total(h * z), levels.sharpness(h * z).sum()
        above = 2.0 * float(sharp - 0.25 * levels.sharpness(beside).sum())
        return np.array([mesh, mesh + levels.total(beside), above])

    found: dict[str, Rival] = {}
    # ahead only with mesh lines alone, with the sidebands, and above these: a blow per turn has lines at all orders
    judged = of_mesh(first)
    meshes = [Rival(f"{z}/{second}", float((judged - of_mesh(z)).max())) for z in _near(first, PINION_NEAR)]
    found["mesh"] = min(meshes, key=_behind)
    for kind, own, other, reach, name in (
        ("pinion", first, second, PINION_NEAR, f"{{}}/{second}"),
        ("gear", second, first, GEAR_NEAR, f"{first}/{{}}"),
    ):
        tried = [
            Rival(name.format(z), behind)
            for z in _near(own, reach)
            if (behind := _behind_shaft(levels, first * h, first / own, first / other, first / z)) is not None
        ]
        if tried:
            found[kind] = min(tried, key=_behind)
    return found


def _near(teeth: int, reach: int) -> list[int]:
    return [z for z in range(teeth - reach, teeth + reach + 1) if z != teeth and z > LEAST_SHARE_OF_TEETH * teeth]


def _behind_shaft(
    levels: OrderLevels, mesh: np.ndarray, step: float, other_step: float, rival_step: float
) -> float | None:
    """Return how far the sidebands of a shaft with another step lie behind those with the given one [nats].

    A rival sideband speaks against the given teeth where it stands above the one in its place and above every line of
    the given teeth beside it: a peak at its very order is not theirs, though they may be only a cell away. What falls
    together with such a line counts only against a first shaft that says nothing: its angle would be another shaft's.
    None where nothing can be compared, or where both shafts turn alike.
    """
    apart = APART_CELLS / levels.revolutions
    if abs(step - other_step) < apart:
        return None
    own, other = (
        grid.ravel()
        for grid in np.mgrid[-KNOWN_SIDEBANDS : KNOWN_SIDEBANDS + 1, -KNOWN_SIDEBANDS : KNOWN_SIDEBANDS + 1]
    )
    # sidebands of one shaft, and those of both together where one of them modulates little
    inside = (np.minimum(abs(own), abs(other)) <= MIXED[0]) & (np.maximum(abs(own), abs(other)) <= MIXED[1])
    inside |= (own == 0) | (other == 0)
    known = np.unique(np.round(own[inside] * step + other[inside] * other_step, 9))
    total, said, shared, compared = 0.0, 0.0, 0.0, False
    for k in (*range(-JUDGED_SIDEBANDS, 0), *range(1, JUDGED_SIDEBANDS + 1)):
        place = k * rival_step
        mine, rival = levels.sharpness(mesh + k * step), levels.sharpness(mesh + place)
        beside = known[np.abs(known - place) < apart]
        if beside.size and np.abs(beside - place).min() < TOGETHER_CELLS / levels.revolutions:
            said += float((mine - NOISE_SAYS).sum())
            shared += float((rival - NOISE_SAYS).sum())
            continue
        compared = True
        best = np.max([mine, *(levels.sharpness(mesh + order) for order in beside)], axis=0)
        total += float(np.clip(best - rival, -MOST_SAID, MOST_SAID).sum())
    if step == 1.0 and said < LEAST_SAID < shared and total >= 0.0:
        return min(said - shared, total)
    return total if compared else None


def _behind(rival: Rival) -> float:
    return rival.behind
