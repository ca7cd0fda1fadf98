"""Shares of records that the distance calls unlike training: `python docs/scripts/abstention.py TRAINED SET ...`.

Trains the distance on random draws of the gearboxes of TRAINED (n of them, a third of n as validation) and judges all
other gearboxes of it and every other set, channel by channel in the order of the sets. Rows: mean over the draws, and
the largest. Only the distance counts: teeth, rate and speed, which `predict` knows as well, would refuse more.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

import siggen
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.prediction.record_pieces import at_rate, record_pieces
from diagnostics.prediction.training_distance import TrainingDistance, calibrated_distance, distance_features
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import ShaftPulses
from diagnostics.records.recording import recordings
from diagnostics.training.referenced import log_values
from diagnostics.training.splits import SpecimenSplit

GEARBOXES = (12, 36, 96)
DRAWS = 8

Records = dict[str, Any]


def records(dataset: Any, channels: tuple[str, ...], fs_hz: float, duration_s: float) -> Records:
    """Return log features, speeds and gearboxes of the records of a set, as `predict` takes them with a tacho."""
    logs, speed_hz, specimen = [], [], []
    for record in recordings(dataset):
        signals = dict(zip(channels, record.channels.values(), strict=False))
        measured = at_rate(MeasuredRecording(Path(), signals, record.fs_hz, record.tacho_s), fs_hz)
        pulses = ShaftPulses(record.tacho_s, "tacho")
        teeth = (int(record.labels["teeth_pinion"]), int(record.labels["teeth_gear"]))
        pieces = record_pieces(measured, pulses, teeth, duration_s, IndicatorSettings())
        parts = distance_features(pieces.names)
        logs.append(np.nanmedian(log_values(pieces.columns(tuple(name for part in parts for name in part))), axis=0))
        speed_hz.append(pulses.speed_hz)
        specimen.append(record.labels["specimen_id"])
    return {"logs": np.array(logs), "speed_hz": np.array(speed_hz), "specimen": np.array(specimen), "parts": parts}


def drawn(trained: Records, count: int, rng: np.random.Generator) -> tuple[TrainingDistance, np.ndarray]:
    """Return the distance to random gearboxes, and which records belong to none of them."""
    order = rng.permutation(np.unique(trained["specimen"]))
    train = np.isin(trained["specimen"], order[:count])
    validation = np.isin(trained["specimen"], order[count : count + count // 3])
    split = SpecimenSplit(train, validation, ~(train | validation), ())
    found = calibrated_distance(trained["logs"], trained["speed_hz"], trained["parts"], split, trained["specimen"])
    return found, split.test


def outside(found: TrainingDistance, judged: Records, rows: np.ndarray | slice = slice(None)) -> float:
    """Return the share of records beyond the threshold."""
    return float(np.mean(found.distance(judged["logs"][rows], judged["speed_hz"][rows]) > found.threshold))


def say(line: str) -> None:
    """Write a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def main(trained_set: str, *others: str) -> None:
    """Print the table."""
    dataset = siggen.open(trained_set)
    channels = tuple(channel.name for channel in dataset.channels)

    def taken(folder: str) -> Records:
        return records(siggen.open(folder), channels, dataset.fs_hz, dataset.duration_s)

    trained, judged = taken(trained_set), {Path(folder).name: taken(folder) for folder in others}
    shares: dict[str, list[np.ndarray]] = {"its other gearboxes": [], **{name: [] for name in judged}}
    counts = [count for count in GEARBOXES if 4 * count // 3 < np.unique(trained["specimen"]).size]
    for count in counts:
        rng = np.random.default_rng(count)
        draws = [drawn(trained, count, rng) for _ in range(DRAWS)]
        shares["its other gearboxes"].append(np.array([outside(found, trained, rest) for found, rest in draws]))
        for name, other in judged.items():
            shares[name].append(np.array([outside(found, other) for found, _ in draws]))
    say(f"{'share called unlike, mean (largest of draws)':45}" + "".join(f"{count:>16}" for count in counts))
    for name, found in shares.items():
        say(f"{name:45}" + "".join(f"{100 * f.mean():9.1f} ({100 * f.max():.0f}) %" for f in found))


if __name__ == "__main__":
    main(*sys.argv[1:])
