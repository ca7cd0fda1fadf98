"""Made-up recordings of a pair of gears whose angle is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.signal.shaft_angle import ShaftAngle


@dataclass(frozen=True)
class MadeGears:
    """Channels (n,), their rate [Hz], times [s] and true turns of the pinion (n,)."""

    channels: dict[str, np.ndarray]
    fs_hz: float
    time_s: np.ndarray
    turns: np.ndarray

    def error_pitches(self, found: ShaftAngle) -> float:
        """Return the largest error of an angle about its median, in pitches of the pinion."""
        error = (np.interp(found.time_s, self.time_s, self.turns) - found.turns) * found.teeth[0]
        return float(np.abs(error - np.median(error))[10:-10].max())


def made_gears(
    teeth: tuple[int, int] = (27, 71),
    *,
    speed_hz: float = 24.0,
    seconds: float = 7.0,
    channels: int = 2,
    beside: float = 0.8,
    noise: float = 2.0,
    drift: float = 2e-3,
    step: float = 4e-3,
    harmonics: tuple[int, ...] = (1, 2, 3, 4),
    seed: int = 0,
) -> MadeGears:
    """Return mesh lines with two sidebands of both shafts, in noise, of a speed that drifts and steps up and down."""
    rng, fs_hz = np.random.default_rng(seed), 12_800.0
    time_s = np.arange(round(seconds * fs_hz)) / fs_hz
    share = time_s / seconds
    steps = np.tanh((share - 0.33) * seconds / 0.1) - np.tanh((share - 0.7) * seconds / 0.1)
    turns = np.cumsum(speed_hz * (1.0 + drift * (share - 0.5) - 0.5 * step * steps)) / fs_hz
    made = {}
    for channel in range(channels):
        signal = noise * rng.standard_normal(time_s.size)
        for h in harmonics:
            level = rng.uniform(0.3, 1.2)
            signal += level * np.cos(2.0 * np.pi * (h * teeth[0] * turns + rng.uniform()))
            for k in (-2, -1, 1, 2):
                for ratio in (1.0, teeth[0] / teeth[1]):
                    size = level * beside * rng.uniform(0.3, 1.0)
                    signal += size * np.cos(2.0 * np.pi * ((h * teeth[0] + k * ratio) * turns + rng.uniform()))
        made[f"c{channel}"] = signal
    return MadeGears(made, fs_hz, time_s, turns)
