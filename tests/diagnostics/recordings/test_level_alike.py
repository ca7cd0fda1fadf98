"""Recordings of one machine have levels of one unit; a file whose columns cannot be told apart is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diagnostics.recordings.level_alike import check_levels_alike, level_note
from diagnostics.recordings.measured_recording import read_recording
from diagnostics.recordings.taken import RecordingFacts
from diagnostics.recordings.text_files import read_text
from siggen.errors import UsageError

CHANNELS = ("a", "b")


def recordings(folder: Path, *factors: tuple[float, float]) -> list[object]:
    rng = np.random.default_rng(0)
    found = []
    for k, scale in enumerate(factors):
        file = folder / f"run{k}.npz"
        np.savez(file, **{name: f * rng.standard_normal(2000) for name, f in zip(CHANNELS, scale, strict=True)})
        found.append(read_recording(file, CHANNELS, RecordingFacts(fs_hz=25_600.0, unit="m/s2")))
    return found


@pytest.mark.parametrize("others", [1, 2, 4])
def test_the_recording_of_another_unit_is_named(tmp_path: Path, others: int) -> None:
    read = recordings(tmp_path, *[(1.0, 3.0)] * others, (100.0, 300.0))
    with pytest.raises(UsageError, match=r"dB off the other recordings.*unit"):
        check_levels_alike(read)
    if others > 1:
        with pytest.raises(UsageError, match=rf"run{others}\.npz: .*\+40 dB"):
            check_levels_alike(read)


def test_another_load_and_one_loud_channel_are_no_other_unit(tmp_path: Path) -> None:
    check_levels_alike(recordings(tmp_path, (1.0, 3.0), (5.0, 16.0), (1.0, 3.0)))
    check_levels_alike(recordings(tmp_path, (1.0, 3.0), (1.0, 300.0), (1.0, 3.0)))


def test_a_level_that_no_machine_has_is_noted(tmp_path: Path) -> None:
    usual, volts = recordings(tmp_path, (1.0, 3.0), (1e-6, 3e5))
    assert level_note(usual) == ""
    assert "rms of a is 9.9e-07" in level_note(volts)
    assert "rms of b is 3.07e+05" in level_note(volts)


def test_a_name_that_stands_for_two_columns_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "run.csv"
    file.write_text("x,x,tacho\n1,2,3\n4,5,6\n7,8,9\n")
    with pytest.raises(UsageError, match="2 columns are called x"):
        read_text(file)
