"""One signal through every kind of file, units, tacho, and what is refused."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from scipy.io import savemat, wavfile

from diagnostics.recordings.measured_recording import read_recording
from diagnostics.recordings.taken import RecordingFacts, channel_names, take
from siggen.errors import UsageError

FS_HZ = 8000
NAMES = ("vertical", "horizontal")


def signals() -> np.ndarray:
    return 5.0 * np.random.default_rng(3).standard_normal((2, 4000))


def write(path: Path, kind: str) -> Path:
    first, second = signals()
    file = path / f"run.{kind}"
    if kind == "csv":
        np.savetxt(file, np.stack([first, second], axis=1), delimiter=",", header="vertical,horizontal", comments="")
    elif kind == "npy":
        np.save(file, np.stack([first, second]))
    elif kind == "npz":
        np.savez(file, vertical=first, horizontal=second, fs=FS_HZ)
    elif kind == "mat":
        savemat(file, {"vertical": first, "horizontal": second, "note": "text"})
    elif kind == "wav":
        wavfile.write(file, FS_HZ, np.stack([first, second], axis=1).astype(np.float32))
    else:
        pq.write_table(pa.table({"vertical": first, "horizontal": second}), file)
    return file


@pytest.mark.parametrize("kind", ["csv", "npy", "npz", "mat", "wav", "parquet"])
def test_every_kind_of_file_gives_the_same_signals(kind: str, tmp_path: Path) -> None:
    columns = {"vertical": "1", "horizontal": "2"} if kind in ("npy", "wav") else {}
    found = read_recording(write(tmp_path, kind), NAMES, RecordingFacts(fs_hz=FS_HZ, columns=columns, unit="g"))
    for name, expected in zip(NAMES, signals(), strict=True):  # WAV holds float32
        np.testing.assert_allclose(found.channels[name], 9.80665 * expected, rtol=1e-6)
    assert found.fs_hz == FS_HZ
    assert found.duration_s == pytest.approx(0.5)


def test_integer_wav_needs_its_full_scale(tmp_path: Path) -> None:
    samples = np.array([[-16384, 8192], [16384, 0], [0, -8192]] * 50, dtype=np.int16)
    wavfile.write(tmp_path / "run.wav", FS_HZ, samples)
    columns = {"vertical": "1", "horizontal": "2"}
    with pytest.raises(UsageError, match=r"run.wav: holds shares of full scale.*full_scale: 50"):
        read_recording(tmp_path / "run.wav", NAMES, RecordingFacts(unit="m/s2", columns=columns))
    found = read_recording(tmp_path / "run.wav", NAMES, RecordingFacts(unit="m/s2", columns=columns, full_scale=50.0))
    np.testing.assert_array_equal(found.channels["vertical"][:3], [-25.0, 25.0, 0.0])


def test_millivolts_take_the_sensitivity(tmp_path: Path) -> None:
    file = write(tmp_path, "npz")
    with pytest.raises(UsageError, match="sensitivity"):
        read_recording(file, NAMES, RecordingFacts(fs_hz=FS_HZ, unit="mV"))
    found = read_recording(file, NAMES, RecordingFacts(fs_hz=FS_HZ, unit="mV", sensitivity_mv_per_g=100.0))
    np.testing.assert_allclose(found.channels["vertical"], signals()[0] / 100.0 * 9.80665)


def test_semicolons_with_decimal_commas(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text("vertical;horizontal\n" + "1,5;-2,25\n0,5;3,0\n-1,0;1,0\n")
    found = read_recording(tmp_path / "run.csv", NAMES, RecordingFacts(fs_hz=FS_HZ, unit="m/s2"))
    np.testing.assert_array_equal(found.channels["horizontal"], [-2.25, 3.0, 1.0])


@pytest.mark.parametrize(
    "above",
    [
        "# recorder 7, 12 bit\n# 8000 Hz\nvertical,horizontal\n",
        "% recorder 7\n\nvertical,horizontal\n",
        "vertical,horizontal\n[m/s2],[m/s2]\n",
        "# recorder 7\nvertical,horizontal\nm/s²,m/s2\n",
    ],
)
def test_comments_and_units_above_the_samples_are_skipped(above: str, tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text(above + "1.5,-2.25\n0.5,3.0\n-1.0,1.0\n", encoding="utf-8")
    found = read_recording(tmp_path / "run.csv", NAMES, RecordingFacts(fs_hz=FS_HZ, unit="m/s2"))
    np.testing.assert_array_equal(found.channels["vertical"], [1.5, 0.5, -1.0])


@pytest.mark.parametrize("second", ["start,here", "g,3.0", "g", "g,rotor"])
def test_a_second_row_that_is_not_plainly_units_is_no_sample_and_refused(second: str, tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text(f"vertical,horizontal\n{second}\n1.5,2.5\n0.5,3.0\n")
    with pytest.raises(UsageError, match="cannot be read as a table of numbers"):
        read_recording(tmp_path / "run.csv", NAMES, RecordingFacts(fs_hz=FS_HZ, unit="m/s2"))


@pytest.mark.parametrize("text", ["vertical,horizontal\n", "vertical,horizontal\ng,g\n", "# only this\n", ""])
def test_a_text_file_without_samples_says_so(text: str, tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text(text)
    with pytest.raises(UsageError, match=r"run.csv: holds no samples"):
        read_recording(tmp_path / "run.csv", NAMES, RecordingFacts(fs_hz=FS_HZ, unit="m/s2"))


def test_a_record_of_this_package_is_read_by_row_with_its_pulses(tmp_path: Path) -> None:
    first, second = signals().astype(np.float32)
    rows = {"accel_vertical_m_s2": [first, second], "accel_horizontal_m_s2": [second, first]}
    pq.write_table(pa.table({**rows, "tacho_s": [[0.1, 0.2], [0.1, 0.3]], "record_id": [0, 1]}), tmp_path / "a.parquet")
    with pytest.raises(UsageError, match=r"holds 2 records.*a.parquet:ROW, from 0 to 1"):
        read_recording(tmp_path / "a.parquet", NAMES, RecordingFacts(fs_hz=FS_HZ, unit="m/s2"))
    found = read_recording(tmp_path / "a.parquet", NAMES, RecordingFacts(FS_HZ, unit="m/s2", row=1, tacho="tacho_s"))
    np.testing.assert_array_equal(found.channels["vertical"], second)
    assert found.tacho_s is not None
    np.testing.assert_array_equal(found.tacho_s, [0.1, 0.3])


def test_pulses_of_a_sampled_tacho_lie_between_samples(tmp_path: Path) -> None:
    time_s = np.arange(4000) / FS_HZ
    noise = 0.02 * np.random.default_rng(1).standard_normal(4000)
    tacho = np.clip(40.0 * np.sin(2 * np.pi * 25.3 * time_s - 1.0), -1.0, 1.0) + noise
    first, second = signals()
    np.savez(tmp_path / "run.npz", vertical=first, horizontal=second, t=tacho)
    found = read_recording(tmp_path / "run.npz", NAMES, RecordingFacts(FS_HZ, unit="m/s2", tacho="t", tacho_pulses=1))
    assert found.tacho_s is not None
    expected = (np.arange(found.tacho_s.size) + 1.0 / (2 * np.pi)) / 25.3
    np.testing.assert_allclose(found.tacho_s, expected, atol=0.2 / FS_HZ)  # a fifth of a sample


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (
            lambda x: np.where(np.arange(x.size) == 7, np.nan, x),
            "1 of 4000 samples are not finite, first row 8 of the data",
        ),
        (np.zeros_like, "constant over all 4000 samples"),
        (lambda x: np.clip(x, -4.0, 4.0), "stand clipped"),
        (lambda x: (np.arange(x.size) % 80 < 8) * 5.0, r"100.00% of the samples stand at 0 or 5.*tacho: vertical"),
        (lambda x: x[:-5], "differ in their number of samples"),
    ],
)
def test_unusable_signals_name_file_and_way_out(spoil: object, message: str, tmp_path: Path) -> None:
    first, second = signals()
    np.savez(tmp_path / "run.npz", vertical=spoil(first), horizontal=second)  # type: ignore[operator]
    with pytest.raises(UsageError, match=message) as error:
        read_recording(tmp_path / "run.npz", NAMES, RecordingFacts(fs_hz=FS_HZ, unit="m/s2"))
    assert "run.npz" in str(error.value)


def test_a_signal_of_gaps_is_told_before_the_rate_that_is_missing_too(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text("vertical\n" + "1.5\nnan\n" * 100)
    with pytest.raises(UsageError, match=r"of \d+ samples are not finite"):
        read_recording(tmp_path / "run.csv", ("vertical",), RecordingFacts())


def test_rate_channels_and_pickled_arrays_are_refused(tmp_path: Path) -> None:
    file = write(tmp_path, "mat")
    with pytest.raises(UsageError, match=r"run.mat: sampling rate: received None.*--fs"):
        read_recording(file, NAMES, RecordingFacts(unit="m/s2"))
    with pytest.raises(UsageError, match=r"no column axial.*channels: .*axial: COLUMN"):
        read_recording(file, ("axial",), RecordingFacts(fs_hz=FS_HZ, unit="m/s2"))
    np.save(tmp_path / "objects.npy", np.array([{"a": 1}], dtype=object), allow_pickle=True)
    (tmp_path / "pickled.npy").write_bytes(pickle.dumps([1.0, 2.0]))
    for name in ("objects.npy", "pickled.npy"):
        with pytest.raises(UsageError, match="cannot be read as arrays of numbers"):
            read_recording(tmp_path / name, NAMES, RecordingFacts(fs_hz=FS_HZ, unit="m/s2"))


@pytest.mark.parametrize(
    ("above", "factor"),
    [
        ("vertical,horizontal\ng,g\n", 9.80665),
        ("vertical,horizontal\n[mg],[mg]\n", 9.80665e-3),
        ("vertical [g],horizontal [g]\n", 9.80665),
        ("vertical_mg,horizontal_mg\n", 9.80665e-3),
        ("vertical (m/s^2),horizontal (m/s²)\n", 1.0),
    ],
)
def test_a_unit_in_a_name_or_in_a_row_is_that_of_the_values(above: str, factor: float, tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text(above + "1.5,-2.25\n0.5,3.0\n-1.0,1.0\n", encoding="utf-8")
    names = dict(zip(NAMES, ("1", "2"), strict=True))
    found = read_recording(tmp_path / "run.csv", NAMES, RecordingFacts(fs_hz=FS_HZ, columns=names))
    np.testing.assert_allclose(found.channels["vertical"], factor * np.array([1.5, 0.5, -1.0]))


@pytest.mark.parametrize(
    "other", ["time", "rpm", "speed", "ticks", "motor_speed", "angle", "index", "label", "n [rpm]"]
)
def test_columns_of_other_quantities_are_never_vibration(other: str, tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text(f"lid,{other}\n" + "1.5,0.0\n0.5,0.0001\n-1.0,0.0002\n2.0,0.0003\n")
    assert channel_names(take(tmp_path / "run.csv", RecordingFacts(), say=False)) == ("lid",)
    with pytest.raises(UsageError, match=r"is a .*allowed are columns of vibration"):
        read_recording(tmp_path / "run.csv", ("a",), RecordingFacts(fs_hz=10_000.0, unit="g", columns={"a": other}))
