"""Injection: at the simulation's own course the difference is added as it is; rows say where they come from."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import siggen
from diagnostics.calibration.healthy_blocks import HealthyBlock, HealthyBlocks
from diagnostics.calibration.injection import (
    DamageEffect,
    injected,
    simulated_differences,
    splits_of,
    write_injected,
)
from diagnostics.page.provenance import origin_sentence
from siggen.errors import UsageError
from siggen.publication.publish import publication
from siggen.sets.verification import verify
from tests.config.minimal import by_name

SPEED_HZ, FS_HZ = 34.0, 25_600.0
SPALL = {"kind": "irregular", "gear": "pinion", "teeth": 1, "profile_length_mm": 1.5, "face_share": 1.0}
CONFIGURATION: dict[str, Any] = {
    "extends": "quickstart",
    "name": "injected",
    "specimens": 2,
    "duration_s": 0.6,
    "background": None,
    "operating_points": [{"speed_hz": SPEED_HZ, "torque_nm": 40.0}],
    "states": {"others": None, "healthy": {}, "severe": {"damage": SPALL}},
}
QUIET = {"variation": {}}


@pytest.fixture(scope="module")
def mine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("injection") / "mine.yaml"
    file.write_text(json.dumps(CONFIGURATION))
    return file


@pytest.fixture(scope="module")
def simulated(mine: Path) -> tuple[HealthyBlock, DamageEffect]:
    """Return a noise-free healthy record as a recording, and the difference of its own gearbox."""
    pulses = np.arange(0.0, 0.6, 1.0 / SPEED_HZ)
    rng = np.random.default_rng(0)
    channels = {name: rng.standard_normal(round(0.6 * FS_HZ)) for name in ("lid_vertical", "side_horizontal")}
    block = HealthyBlock("run", channels, FS_HZ, pulses)
    return block, next(simulated_differences(mine, block, 0))


def test_a_sensor_of_another_kind_is_refused_before_anything_is_simulated(monkeypatch: pytest.MonkeyPatch) -> None:
    washer = {"kind": "force_washer", "name": "washer", "bits": 16}
    config = SimpleNamespace(canonical=lambda: {"sensors": by_name([washer])})
    monkeypatch.setattr(siggen, "load_config", lambda _: config)
    block: Any = SimpleNamespace(pulses_s=np.arange(3.0), speed_hz=1.0, fs_hz=100.0)
    with pytest.raises(UsageError, match=r"sensor washer: received kind force_washer, which has no noise_spectrum"):
        next(simulated_differences(Path("mine.yaml"), block, 0))


def test_the_difference_is_that_of_one_gearbox_at_one_course(simulated: tuple[HealthyBlock, DamageEffect]) -> None:
    """It lies under the damaged tooth alone: once per turn, and nothing before the damage is in mesh."""
    _, difference = simulated
    signal = difference.channels["lid_vertical"]
    turns = difference.pulses_s.size - 1
    samples = np.interp(np.arange(turns * 64) / 64, np.arange(turns + 1), difference.pulses_s) * FS_HZ
    power = np.add.reduceat(np.square(signal), samples.astype(int))[: turns * 64].reshape(turns, 64)
    # with start angle, speed and errors in common, half of the turn holds nearly all; without, all of it would
    share = np.sort(power.mean(axis=0))[::-1].cumsum() / power.mean(axis=0).sum()
    assert share[31] > 0.8
    assert difference.labels["state"] == "severe"


def test_at_the_simulations_own_course_the_recording_plus_difference_is_exact(
    simulated: tuple[HealthyBlock, DamageEffect],
) -> None:
    block, difference = simulated
    own = HealthyBlock(
        "own", {k: v[: block.channels[k].size] for k, v in difference.channels.items()}, FS_HZ, difference.pulses_s
    )
    twice = injected(own, difference, 0)
    # half a turn at either end is extrapolated; between, the resampling errs by 1e-3 of the highest band at most
    inside = slice(int(difference.pulses_s[0] * FS_HZ) + 40, int(difference.pulses_s[-1] * FS_HZ) - 1200)
    for name, signal in own.channels.items():
        error = (twice[name][: signal.size] - 2.0 * signal)[inside]
        assert np.sqrt(np.mean(error**2)) < 0.02 * signal.std()


def test_a_faster_recording_gets_the_difference_at_its_own_angle(simulated: tuple[HealthyBlock, DamageEffect]) -> None:
    block, difference = simulated
    silent = {name: np.zeros(signal.size) for name, signal in block.channels.items()}
    faster = HealthyBlock("fast", silent, FS_HZ, np.arange(0.0, 0.5, 1.0 / (1.05 * SPEED_HZ)))
    found = injected(faster, difference, 0)["lid_vertical"]
    turns = [np.sqrt(np.mean(found[int(a * FS_HZ) : int(b * FS_HZ)] ** 2)) for a, b in pairwise(faster.pulses_s[:9])]
    own = difference.pulses_s
    expected = [
        np.sqrt(np.mean(difference.channels["lid_vertical"][int(a * FS_HZ) : int(b * FS_HZ)] ** 2))
        for a, b in pairwise(own[:9])
    ]
    assert turns == pytest.approx(expected, rel=0.03)


def test_every_row_says_what_it_was_made_of_and_a_recording_is_on_one_side(
    mine: Path, simulated: tuple[HealthyBlock, DamageEffect], tmp_path: Path
) -> None:
    block, _ = simulated
    rng = np.random.default_rng(1)
    longer = {name: np.append(rng.permutation(signal), signal[:100]) for name, signal in block.channels.items()}
    blocks = HealthyBlocks((block, HealthyBlock("other", longer, FS_HZ, block.pulses_s)), tuple(block.channels), FS_HZ)
    found = siggen.open(write_injected(blocks, mine, 1, tmp_path / "set", 0, lambda: None))
    rows = found.labels(columns=["recording", "origin", "state", "split", "specimen_id", "difference_db"]).to_pylist()
    assert [row["origin"] for row in rows] == ["recorded", "injected"] * 2
    assert [(row["recording"], row["split"], row["specimen_id"]) for row in rows[::2]] == [
        ("run", "train", 0),
        ("other", "test", 1),
    ]
    assert rows[1]["state"] == "severe"
    assert np.isfinite(rows[1]["difference_db"])
    for number, own in ((0, block.channels), (2, longer)):
        recorded = found.record(number)
        np.testing.assert_allclose(recorded["accel_lid_vertical_m_s2"], own["lid_vertical"][:15_360], rtol=1e-6)
    assert json.loads((tmp_path / "set" / "injected.json").read_text())["recordings"] == ["run", "other"]
    assert verify(tmp_path / "set", sample=1).mismatches == ()
    assert "healthy recordings, and the same with the vibration of simulated damage" in origin_sentence(found)


@pytest.mark.parametrize("recordings", range(1, 12))
def test_two_recordings_train_and_the_last_is_the_test(recordings: int) -> None:
    splits = splits_of(recordings)
    assert len(splits) == recordings
    assert list(splits) == sorted(splits, key=("train", "validation", "test").index)
    assert recordings == 1 or splits[-1] == "test"
    assert recordings < 3 or splits.count("train") >= 2


def test_publishing_injected_recordings_is_refused(
    mine: Path, simulated: tuple[HealthyBlock, DamageEffect], tmp_path: Path
) -> None:
    block, _ = simulated
    blocks = HealthyBlocks((block,), tuple(block.channels), FS_HZ)
    folder = write_injected(blocks, mine, 1, tmp_path / "set", 0, lambda: None)
    with pytest.raises(UsageError, match="your recordings"):
        publication(folder, None)
