"""A record depends on its own operating point alone: its bytes beside a heavier, faster point of the same file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from tests.simulated import simulate

OWN = "{speed_hz: 32, torque_nm: [50, 60]}"
HEAVIER = "{speed_hz: 64, torque_nm: 180}"
SHORT = ["specimens=1", "duration_s=0.1", "background=null", "mesh_harmonics=5"]


def records_of_the_first_point(folder: Path, points: str, states: tuple[int, ...]) -> dict[int, SimulatedRecord]:
    """Return a record of some states at the first operating point, of a file that a user could have written."""
    file = folder / f"{len(points)}.yaml"
    file.write_text(f"extends: quickstart\nname: same\noperating_points: [{points}]\n", encoding="utf-8")
    config = load_config(file, SHORT)
    per_state = len(config.config.operating_points) * config.repeats
    found = simulate(config, [state * per_state for state in states])
    assert all(isinstance(record, SimulatedRecord) for record in found), found
    return {record.planned.state_id: record for record in found if isinstance(record, SimulatedRecord)}


@pytest.mark.parametrize("state", [0, 3], ids=["healthy", "severe"])
def test_a_heavier_and_faster_point_moves_no_byte_of_another_ones_record(tmp_path: Path, state: int) -> None:
    alone = records_of_the_first_point(tmp_path, OWN, (state,))[state]
    beside = records_of_the_first_point(tmp_path, f"{OWN}, {HEAVIER}", (state,))[state]
    assert alone.labels == beside.labels
    for name, signal in alone.channels.items():
        assert np.asarray(signal).tobytes() == np.asarray(beside.channels[name]).tobytes(), name
    assert alone.tacho_s.tobytes() == beside.tacho_s.tobytes()
