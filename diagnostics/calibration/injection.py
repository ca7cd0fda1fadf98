"""Healthy recordings plus what simulated damage changes: damaged less healthy, of one gearbox at one course of speed.

Both simulations are one state each of the same gearbox: start angle, speed and every draw but the damage are the same.
Noise and own lines are off, so that nothing but the damage is left. Angle by angle the difference is laid under the
recording's own course; where the recording is longer, it begins again after whole turns. The path of the gearbox stays
in frequency, which is exact where the speed is that of the simulation. Source: derived.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import siggen
from diagnostics.calibration.healthy_blocks import Block
from diagnostics.signal.order_domain import AngleGrid, resample_to_angle

LONGEST_S = 10.0
SPARE_TURNS = 2
FADE_TURNS = 0.5
PHYSICS, SHUFFLED, WHITE = "physics", "shuffled phases", "white noise"
CONTROLS = (SHUFFLED, WHITE)


@dataclass(frozen=True, slots=True)
class Difference:
    """What one damage does to one gearbox.

    Attributes
    ----------
    channels : mapping of str to (n,) float64
        Damaged less healthy acceleration [m/s²], by the recordings' channels.
    fs_hz : float
    pulses_s : (k,) float64
        Turns of the pinion in the simulation.
    labels : mapping
        Of the damaged record.
    identity : str
        Of the configuration of the damaged record.
    """

    channels: Mapping[str, np.ndarray]
    fs_hz: float
    pulses_s: np.ndarray
    labels: Mapping[str, Any]
    identity: str


def damage_states(mine: Path) -> tuple[dict[str, Any], ...]:
    """Return the damaged states of a calibrated configuration, as it gives them."""
    return tuple(state for state in siggen.load_config(mine).canonical()["states"] if state.get("damage"))


def simulated_differences(mine: Path, block: Block, gearbox: int) -> Iterator[Difference]:
    """Yield the difference of every damaged state of a gearbox, at the speed of a recording."""
    wanted = min((block.pulses_s.size - 1 + SPARE_TURNS) / block.speed_hz, LONGEST_S)
    duration = np.ceil(wanted * block.fs_hz) / block.fs_hz
    changes = _quiet(mine, block, duration, gearbox)
    healthy: Any = siggen.simulate(siggen.load_config({**changes, "states": [{"name": "healthy"}]}), [gearbox])[0]
    for state in damage_states(mine):
        alone = {**state, "grows_from": "none"} if "grows_from" in state else state
        config = siggen.load_config({**changes, "states": [alone]})
        damaged: Any = siggen.simulate(config, [gearbox])[0]
        if not (hasattr(healthy, "channels") and hasattr(damaged, "channels")):
            continue
        pairs = zip(block.channels, healthy.channels.values(), damaged.channels.values(), strict=True)
        found = {name: b.astype(np.float64) - a.astype(np.float64) for name, a, b in pairs}
        yield Difference(found, config.fs_hz, np.asarray(damaged.tacho_s), damaged.labels, config.identity)


def _quiet(mine: Path, block: Block, duration_s: float, gearbox: int) -> dict[str, Any]:
    """Return a configuration at the recording's speed, without noise, converter and variation of the speed."""
    config = siggen.load_config(mine).canonical()
    off = {"noise_spectrum": None, "lines": None, "bits": None, "range_m_s2": 1e6}
    return {
        **config,
        "name": "difference",
        "specimens": gearbox + 1,
        "repeats": 1,
        "duration_s": float(duration_s),
        "variation": {},
        "sensors": [{**sensor, **off} for sensor in config["sensors"]],
        "operating_points": [{**config["operating_points"][0], "speed_hz": block.speed_hz}],
    }


def injected(block: Block, difference: Difference, start_turn: int) -> dict[str, np.ndarray]:
    """Return the recording's channels with the difference at its own course of angle.

    Parameters
    ----------
    block : Block
    difference : Difference
    start_turn : int
        Turn of the simulation that lies under the first pulse of the recording.
    """
    grid = _times(block, difference, start_turn)
    return {
        name: signal + resample_to_angle(difference.channels[name], difference.fs_hz, grid)
        for name, signal in block.channels.items()
    }


def _times(block: Block, difference: Difference, start_turn: int) -> AngleGrid:
    """Return where in the simulation every sample of the recording lies, by the angle of the pinion."""
    time_s = np.arange(next(iter(block.channels.values())).size) / block.fs_hz
    turn = _continued(time_s, block.pulses_s)
    whole = difference.pulses_s.size - 1
    inside = np.mod(turn + start_turn, whole)
    return AngleGrid(np.interp(inside, np.arange(whole + 1), difference.pulses_s), 1, 1, np.inf)


def _continued(time_s: np.ndarray, pulses_s: np.ndarray) -> np.ndarray:
    """Return turns since the first pulse at times (n,); before the first and after the last at the speed there."""
    turns = np.arange(pulses_s.size, dtype=np.float64)
    found = np.interp(time_s, pulses_s, turns)
    first, last = pulses_s[1] - pulses_s[0], pulses_s[-1] - pulses_s[-2]
    found = np.where(time_s < pulses_s[0], (time_s - pulses_s[0]) / first, found)
    return np.asarray(np.where(time_s > pulses_s[-1], turns[-1] + (time_s - pulses_s[-1]) / last, found))


def control_difference(difference: Difference, kind: str, rng: np.random.Generator) -> Difference:
    """Return a difference of the same energy without the physics: with shuffled phases, or white.

    Parameters
    ----------
    difference : Difference
    kind : str
        PHYSICS leaves it as it is; SHUFFLED keeps every line's energy and gives it a random phase; WHITE keeps the
        energy of every channel alone.
    rng : numpy Generator
    """
    if kind == PHYSICS:
        return difference
    channels = {name: _control(signal, kind, rng) for name, signal in difference.channels.items()}
    return Difference(channels, difference.fs_hz, difference.pulses_s, difference.labels, difference.identity)


def _control(signal: np.ndarray, kind: str, rng: np.random.Generator) -> np.ndarray:
    if kind == WHITE:
        return np.asarray(rng.standard_normal(signal.size) * float(np.sqrt(np.mean(signal**2))))
    spectrum = np.fft.rfft(signal)
    spectrum[1:-1] *= np.exp(2j * np.pi * rng.random(spectrum.size - 2))
    return np.asarray(np.fft.irfft(spectrum, signal.size))
