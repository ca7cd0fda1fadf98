"""A machine beside its simulation: recordings and records of a set in one table, each over the other side's nearest."""

from __future__ import annotations

import base64
import math
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from diagnostics.explore.beside_page import write_beside_page
from diagnostics.explore.measured_page import ShownRecording
from diagnostics.machine.recording_indicators import RecordingIndicators, recording_indicators
from diagnostics.recordings.taken import RecordingFacts
from siggen.errors import UsageError
from tests.diagnostics.conftest import CHANNELS, FS_HZ, TEETH, MemoryDataset, memory_dataset, shaft_record
from tests.diagnostics.explore.test_explorer import Read
from tests.diagnostics.explore.unpacked import held, listed, rows, steps


def recorded(
    folder: Path, name: str, speed_hz: float, channels: tuple[str, ...] = ("ch1", "ch2")
) -> RecordingIndicators:
    rng = np.random.default_rng(7)
    signal, pulses = shaft_record(rng, 0.0, speed_hz=speed_hz)
    signals = {channel: (k + 1.0) * signal for k, channel in enumerate(channels)}
    np.savez(folder / name, **signals, tacho_s=pulses)
    return recording_indicators(folder / name, TEETH, RecordingFacts(fs_hz=FS_HZ, unit="m/s2", tacho="tacho_s"))


def with_speeds(dataset: MemoryDataset, speeds: list[float]) -> MemoryDataset:
    place = dataset.table.schema.get_field_index("speed_hz")
    dataset.table = dataset.table.set_column(place, "speed_hz", pa.array(speeds))
    return dataset


def test_each_side_is_laid_over_the_healthy_record_of_the_other_that_is_nearest_in_speed(tmp_path: Path) -> None:
    dataset = with_speeds(memory_dataset(("train", "test")), [25.0, 26.0, 27.0, 35.0, 34.0, 33.0])
    shown = [
        ShownRecording(recorded(tmp_path, "<b>slow.npz", 24.0), "healthy reference", math.nan),
        ShownRecording(recorded(tmp_path, "fast.npz", 36.0), "changed", 12.0),
    ]
    page = write_beside_page("rig", shown, dataset, tmp_path / "page.html").read_text(encoding="utf-8")
    found = Read(page)
    data = held(page)["look-data"]
    records = listed(data)
    assert [record["kind"] for record in records] == ["recording"] * 2 + ["simulated"] * 6
    assert [record["record_id"] for record in records] == [6, 7, 0, 1, 2, 3, 4, 5]
    assert rows(data["beside"]) == [2, 5, *[0] * 6]  # the healthy simulated ones, the one healthy recording
    assert rows(data["overlay"]) == [None, 0, None, 2, 2, None, 5, 5]  # as on a page of either
    assert "b" not in found.tags
    assert records[0]["name"] == "<b>slow.npz"
    assert records[1]["torque_nm"] == 12.0
    assert records[0]["specimen_id"] is None


def test_channels_are_taken_in_their_order_and_values_stay_those_of_the_recording(tmp_path: Path) -> None:
    one = recorded(tmp_path, "one.npz", 30.0)
    dataset = memory_dataset(("train",))
    page = write_beside_page(
        "rig", [ShownRecording(one, "unchanged", math.nan)], dataset, tmp_path / "page.html"
    ).read_text(encoding="utf-8")
    data = held(page)
    assert "channel ch1 is shown as bearing_vertical of the set" in page
    (rms,) = (entry for entry in data["look-data"]["indicators"] if entry["name"] == f"rms__{CHANNELS[1]}")
    values = np.frombuffer(base64.b64decode(rms["data"]), "<f4")
    assert values[0] == np.float32(one.values["rms__ch2"])
    signal = one.recording.channels["ch2"]
    assert np.abs(steps(data["look-record-0"]["channels"][CHANNELS[1]]["wave"])).max() == pytest.approx(
        np.abs(signal).max(), rel=1e-4
    )


def test_what_cannot_be_laid_over_is_refused_with_what_is_allowed(tmp_path: Path) -> None:
    dataset = memory_dataset(("train",))
    single = ShownRecording(recorded(tmp_path, "single.npz", 30.0, ("lid",)), "unchanged", math.nan)
    with pytest.raises(UsageError, match=r"have the channels lid, the set .*; allowed: as many on both sides"):
        write_beside_page("rig", [single], dataset, tmp_path / "page.html")
    both = ShownRecording(recorded(tmp_path, "both.npz", 30.0), "unchanged", math.nan)
    dataset.fs_hz = 2.0 * FS_HZ
    with pytest.raises(UsageError, match=r"have 12800 Hz, the set 25600 Hz; allowed: one rate"):
        write_beside_page("rig", [both], dataset, tmp_path / "page.html")
