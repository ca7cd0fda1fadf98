"""`calibrate` on recordings of a hidden machine: the set it leads to resembles the machine more than the rig does."""

from __future__ import annotations

import itertools
import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import decimate
from typer.testing import CliRunner

import siggen
from diagnostics.cli.app import app
from siggen.cli.app import app as siggen_app
from siggen.errors import UsageError
from tests.diagnostics.calibration.hidden_machine import FS_HZ, channel_data, hidden_recordings
from tests.rig_file import rig_file

GEARBOXES = 2


def band_levels_db(signal: np.ndarray) -> np.ndarray:
    """Return mean densities of twelfths of an octave from 300 Hz to 8 kHz."""
    density = np.square(np.abs(np.fft.rfft((signal - signal.mean()) * np.hanning(signal.size))))
    hz = np.fft.rfftfreq(signal.size, 1.0 / FS_HZ)
    edges = 300.0 * 2.0 ** (np.arange(57) / 12.0)
    return np.array([10.0 * np.log10(density[(hz >= a) & (hz < b)].mean()) for a, b in itertools.pairwise(edges)])


def distance_db(source: Path, held_out: list[Path]) -> np.ndarray:
    """Return the rms difference in band level between the median of some gearboxes and held-out recordings, (2,)."""
    config = siggen.load_config(source, ["states={healthy: {}}", "specimens=8"])
    records = [siggen.run(siggen.draw(config, k)) for k in range(GEARBOXES)]
    simulated = [[band_levels_db(x) for x in record.channels.values()] for record in records]
    real = [[band_levels_db(column) for column in channel_data(file).T] for file in held_out]
    return np.sqrt(np.square(np.median(simulated, axis=0) - np.mean(real, axis=0)).mean(axis=-1))


@pytest.fixture(scope="module")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    # its second stage has 27 teeth on the gear's shaft
    return hidden_recordings(tmp_path_factory.mktemp("hidden"))


@pytest.fixture(scope="module")
def calibrated(recordings: list[Path]) -> tuple[Path, Path, str]:
    """Return rig, calibrated configuration, and what the command said."""
    folder = recordings[0].parent
    rig, mine = folder / "rig.yaml", folder / "mine.yaml"
    drawing = ["--teeth", "18,47", "--module", "3", "--face-width", "20", "--speed", "33,36", "--torque", "20,50"]
    made = CliRunner().invoke(siggen_app, ["init", *drawing, "--out", str(rig)], catch_exceptions=False)
    assert made.exit_code == 0, made.output
    rig.write_text(rig.read_text().replace("duration_s: 1.5 ", "duration_s: 0.75 "))  # half as long to simulate
    said = ["calibrate", str(rig), *map(str, recordings[:3]), "--fs", "25600", *rig_file(folder, tacho_pulses=1)]
    judged = ["--held-out", str(recordings[3])]
    options = ["--gearboxes", "4", *judged, "--out", str(mine)]
    result = CliRunner().invoke(app, [*said, *options], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return rig, mine, result.output


def test_the_calibrated_set_lies_nearer_to_held_out_recordings_than_the_rig(
    recordings: list[Path], calibrated: tuple[Path, Path, str]
) -> None:
    rig, mine, _ = calibrated
    before, after = distance_db(rig, recordings[3:]), distance_db(mine, recordings[3:])
    # of this machine 8.8 and 8.4 dB before, 3.2 and 4.1 dB after; 7.2 and 6.4 dB without lines at whole orders
    assert (after < 0.6 * before).all(), (before, after)


def test_what_was_fitted_and_what_was_not_is_written_down(calibrated: tuple[Path, Path, str]) -> None:
    _, mine, said = calibrated
    facts = json.loads((mine.parent / "mine_data" / "calibration.json").read_text())
    assert facts["speed_hz"] == pytest.approx([34.0] * 3, rel=2e-3)
    lines = facts["channels"]["sensor_1_vertical"]["line_level_db"]
    assert all(low <= value <= high for value, low, high in lines.values() if low is not None)
    assert "mesh 1" in lines
    assert facts["second_stage"] == {"shaft": "gear", "teeth": 27, "order": pytest.approx(27 * 18 / 47)}
    stage = facts["channels"]["sensor_1_vertical"]["second_stage_level_db"]
    assert all(low <= value <= high for value, low, high in stage.values())
    assert "27 teeth on the gear shaft" in said
    assert any("path and source" in text for text in facts["not_identified"])
    assert "path and source" in said
    assert "intervals of 90\xa0% hold their mean" in said
    assert "background: null" in mine.read_text()


def test_recordings_at_half_the_rate_of_the_rig_take_one_call(
    recordings: list[Path], calibrated: tuple[Path, Path, str], tmp_path: Path
) -> None:
    slow = []
    for file in recordings[:3]:
        columns = np.loadtxt(file, delimiter=",", skiprows=1)
        slow.append(tmp_path / f"{file.stem}.npz")
        halved = np.stack([*decimate(columns[:, :2], 2, axis=0).T, columns[::2, 2]])
        np.savez(slow[-1], **dict(zip(("ch1_m_s2", "ch2_m_s2", "tacho"), halved, strict=True)))
    said = ["calibrate", str(calibrated[0]), *map(str, slow), "--fs", "12800", *rig_file(tmp_path, tacho_pulses=1)]
    few = ["--gearboxes", "2", "--out", str(tmp_path / "slow.yaml")]
    result = CliRunner().invoke(app, [*said, *few], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    config = siggen.load_config(tmp_path / "slow.yaml")
    # 12,800 Hz over 2.56 carry 5,000 Hz: seven harmonics of 18 teeth at 35 Hz
    assert (config.fs_hz, config.config.mesh_harmonics) == (12_800.0, 7)


def test_every_gearbox_of_the_set_draws_its_own_path(calibrated: tuple[Path, Path, str]) -> None:
    config = siggen.load_config(calibrated[1], ["states={healthy: {}}", "specimens=8", "duration_s=0.1"])
    records = [siggen.run(siggen.draw(config, k)) for k in range(3)]
    numbers = {record.labels["path_number_sensor_1_vertical"] for record in records}
    assert len(numbers) > 1


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"channels": {"lid": "ch1"}}, "the rig has the channels"),
        ({"unit": "mV"}, "states the unit m/s2"),
    ],
)
def test_a_call_that_cannot_work_says_why(
    recordings: list[Path], calibrated: tuple[Path, Path, str], wrong: dict[str, object], said: str, tmp_path: Path
) -> None:
    arguments = [
        "calibrate",
        str(calibrated[0]),
        str(recordings[0]),
        "--fs",
        "25600",
        *rig_file(tmp_path, tacho_pulses=1, **wrong),
        "--out",
        "x.yaml",
    ]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code != 0
    text = result.output + str(result.exception)
    assert said in text


def test_a_recording_that_is_fitted_is_not_held_out_even_under_another_name(
    recordings: list[Path], calibrated: tuple[Path, Path, str], tmp_path: Path
) -> None:
    again = shutil.copy(recordings[1], tmp_path / f"again{recordings[1].suffix}")
    fitted, out = map(str, recordings[:3]), tmp_path / "x.yaml"
    options = [
        "--fs",
        "25600",
        *rig_file(tmp_path, tacho_pulses=1),
        "--held-out",
        str(recordings[3]),
        "--held-out",
        str(again),
    ]
    result = CliRunner().invoke(app, ["calibrate", str(calibrated[0]), *fitted, *options, "--out", str(out)])
    assert isinstance(result.exception, UsageError)
    assert f"has the same samples as {recordings[1].name}, which is fitted" in str(result.exception)
    assert not out.exists()


@pytest.mark.parametrize("taken", ["x.yaml", "x_data", "set"])
def test_what_is_there_already_is_refused_before_anything_is_read(tmp_path: Path, taken: str) -> None:
    (tmp_path / taken).mkdir()
    # neither rig nor recording exist: whoever read first would speak of them
    options = ["--fs", "25600", "--out", str(tmp_path / "x.yaml"), "--inject", str(tmp_path / "set")]
    result = CliRunner().invoke(app, ["calibrate", "no_rig.yaml", "none.csv", *options])
    assert isinstance(result.exception, UsageError)
    assert f"{taken}: is there already" in str(result.exception)


def test_noise_without_mesh_lines_and_a_wrong_unit_are_refused(
    tmp_path: Path, recordings: list[Path], calibrated: tuple[Path, Path, str]
) -> None:
    rows = np.loadtxt(recordings[0], delimiter=",", skiprows=1)
    noise = rows.copy()
    noise[:, :2] = np.random.default_rng(0).standard_normal((len(rows), 2))
    for name, values in (("noise.csv", noise), ("loud.csv", rows * [1e6, 1e6, 1.0])):
        np.savetxt(tmp_path / name, values, delimiter=",", header="ch1 [m/s2],ch2 [m/s2],tacho", comments="")
    common = [
        str(calibrated[0]),
        "--fs",
        "25600",
        *rig_file(tmp_path, tacho_pulses=1),
        "--gearboxes",
        "2",
        "--out",
        str(tmp_path / "x.yaml"),
    ]
    for name, said in (("noise.csv", "mesh lines above its floor"), ("loud.csv", "`unit` of the rig file")):
        result = CliRunner().invoke(app, ["calibrate", *common[:1], str(tmp_path / name), *common[1:]])
        assert isinstance(result.exception, UsageError)
        assert said in str(result.exception)
        assert not (tmp_path / "x.yaml").exists()
