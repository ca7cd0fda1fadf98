"""Rows of a set of recordings with injected damage: ids, labels, origin, signals."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.calibration.healthy_blocks import Block, HealthyBlocks
from diagnostics.calibration.injection import SPARE_TURNS, Difference, injected, simulated_differences

TRAIN, VALIDATION, TEST = "train", "validation", "test"
RECORDED, INJECTED = "recorded", "injected"
NO_GEARBOX = -1
OF_DAMAGE = ("damaged_area_mm2", "damaged_area_share", "damage_profile_length_mm", "mesh_stiffness_loss")
"""Labels of the simulated damage; 0 for a recording as it is."""


def splits_of(recordings: int) -> tuple[str, ...]:
    """Return the split of each recording: the last fifth is tested, the fifth before validates; two train at least."""
    test = max(1, recordings // 5) if recordings > 1 else 0
    validation = recordings // 5
    return (TRAIN,) * (recordings - test - validation) + (VALIDATION,) * validation + (TEST,) * test


def injected_rows(
    blocks: HealthyBlocks, mine: Path, gearboxes: int, seed: int, advance: Callable[[], None]
) -> Iterator[dict[str, Any]]:
    """Yield the rows of all recordings, each as it is and then with every damage of its own simulated gearboxes.

    Parameters
    ----------
    blocks : HealthyBlocks
    mine : Path
        The calibrated configuration.
    gearboxes : int
        Different ones for each recording.
    seed : int
    advance : callable
        Told of every gearbox.
    """
    record_id = 0
    for number, (block, split) in enumerate(zip(blocks.blocks, splits_of(len(blocks.blocks)), strict=True)):
        own = {"specimen_id": number, "split": split, "operating_point_id": 0, "speed_hz": block.speed_hz}
        yield {"record_id": record_id, **own, **_recorded(block)}
        record_id += 1
        for k in range(gearboxes):
            gearbox = number * gearboxes + k
            start = int(generator(seed, Purpose.PATHS, 0, 1 + gearbox).integers(SPARE_TURNS))
            for difference in simulated_differences(mine, block, gearbox):
                yield {"record_id": record_id, **own, **_injected(block, difference, start, gearbox, k)}
                record_id += 1
            advance()


def _recorded(block: Block) -> dict[str, Any]:
    labels = {"state": "healthy", "fault": "healthy", "severity": "healthy", "faulty_gear": "none", "repeat": 0}
    nothing = {"simulated_gearbox": NO_GEARBOX, "path_number": NO_GEARBOX, "identity": ""}
    unknown = {"difference_db": -np.inf, "difference_torque_nm": np.nan}
    return {
        **_origin(block, RECORDED),
        **labels,
        **dict.fromkeys(OF_DAMAGE, 0.0),
        **nothing,
        **unknown,
        **_signals(block, block.channels),
    }


def _injected(block: Block, difference: Difference, start: int, gearbox: int, repeat: int) -> dict[str, Any]:
    added = sum(float(np.mean(signal**2)) for signal in difference.channels.values())
    own = sum(float(np.var(signal)) for signal in block.channels.values())
    numbers = [value for name, value in difference.labels.items() if name.startswith("path_number_")]
    labels = ("state", "fault", "severity", "faulty_gear", *OF_DAMAGE)
    return {
        **_origin(block, INJECTED),
        **{name: difference.labels[name] for name in labels},
        "repeat": repeat,
        "simulated_gearbox": gearbox,
        "path_number": int(numbers[0]) if numbers else NO_GEARBOX,
        "identity": difference.identity,
        "difference_db": 10.0 * float(np.log10(max(added, 1e-30) / own)),
        "difference_torque_nm": float(difference.labels["torque_nm"]),
        **_signals(block, injected(block, difference, start)),
    }


def _origin(block: Block, origin: str) -> dict[str, Any]:
    return {"recording": block.name, "origin": origin}


def _signals(block: Block, channels: Mapping[str, np.ndarray]) -> dict[str, Any]:
    return {"signals": tuple(channels.values()), "tacho_s": block.pulses_s}
