"""`--json`: standard output holds one JSON object and nothing else, with the numbers that the text rounds."""

from __future__ import annotations

from contextlib import chdir
from pathlib import Path

import numpy as np
import pytest
from scipy.io import wavfile

from tests.command import command
from tests.walks.walking import FS_HZ, printed, recorded

DESCRIBED = "--rig reading.yaml"
MONTHS = ("april", "may", "june", "july", "august")


@pytest.fixture(scope="module")
def machine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with six recordings: four healthy ones, one more, and one with a weak tooth."""
    folder = tmp_path_factory.mktemp("machine")
    for seed, (name, depth) in enumerate([*((month, 0.0) for month in MONTHS), ("worn", 0.7)]):
        wavfile.write(folder / f"{name}.wav", round(FS_HZ), recorded(seed, depth).astype(np.float32))
    (folder / "reading.yaml").write_text("{unit: g, teeth: [18, 47], speed: [28, 32]}\n")
    with chdir(folder):
        done = command(
            "diagnostics", *f"baseline april.wav may.wav june.wav july.wav {DESCRIBED} --out machine".split()
        )
    assert done.returncode == 0, done.stderr
    return folder


def test_modes_rise_and_the_teeth_hold_no_more_than_all_of_the_strain_energy(tmp_path: Path) -> None:
    modes = printed(tmp_path, "siggen inspect modes quickstart")["modes"]
    frequencies = [mode["frequency_hz"] for mode in modes]
    assert frequencies == sorted(frequencies)
    assert frequencies[0] < 0.1 < frequencies[1]
    assert all(-1e-9 <= mode["mesh_share"] <= 1.0 for mode in modes)


def test_paths_of_every_channel_are_no_lower_at_their_peak_than_their_rms(tmp_path: Path) -> None:
    channels = printed(tmp_path, "siggen inspect path quickstart")["channels"]
    assert channels
    assert all(channel["largest_m_s2_per_n"] >= channel["rms_m_s2_per_n"] for channel in channels)


def test_a_changed_machine_is_said_with_its_score_and_exit_code(machine: Path) -> None:
    checks = printed(machine, "siggen-diagnostics check machine august.wav worn.wav", code=4)["checks"]
    assert [check["verdict"] for check in checks] == ["unchanged", "changed"]
    assert checks[1]["score"]["score"] > checks[1]["score"]["limit"]
    assert checks[1]["moved"]


def test_indicators_of_recordings_have_a_row_for_each_channel(machine: Path) -> None:
    rows = printed(machine, f"siggen-diagnostics indicators may.wav worn.wav {DESCRIBED}")["recordings"]
    assert [row["recording"] for row in rows] == ["may.wav", "worn.wav"]
    assert all(row["speed_hz"] == pytest.approx(30.0, abs=0.2) and row["rms"] > 0 for row in rows)
