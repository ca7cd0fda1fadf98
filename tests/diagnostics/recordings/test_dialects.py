"""Files of every dialect are read rightly, or refused with the option that helps; none is read wrongly in silence."""

from __future__ import annotations

import gc
import logging
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from diagnostics.recordings import columns, taken
from diagnostics.recordings.file_columns import file_columns
from diagnostics.recordings.measured_recording import read_recording
from diagnostics.recordings.taken import RecordingFacts, take
from siggen.errors import UsageError
from tests.diagnostics.recordings import dialects
from tests.diagnostics.recordings.dialects import FS_HZ, LEFT, RIGHT, SAMPLES, TIME_S, Dialect

pytestmark = pytest.mark.filterwarnings(
    "ignore:unclosed file:ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning"
)
KINDS = [*dialects.texts(), *dialects.arrays()]
CUTS = 10


@pytest.fixture(autouse=True, scope="module")
def readers_that_fail_to_close() -> Iterator[None]:
    """Collect what libraries leave of damaged files at the end of the last test here, which ignores its complaints."""
    yield
    gc.collect()


def written(dialect: Dialect, folder: Path) -> Path:
    """Write a file, unless what writes it is not installed."""
    if dialect.name.endswith(".mf4"):
        pytest.importorskip("asammdf")
    path = folder / dialect.name
    dialect.write(path)
    return path


@pytest.mark.parametrize("dialect", KINDS, ids=[kind.name for kind in KINDS])
def test_each_dialect_is_read_rightly_or_refused_in_words(
    dialect: Dialect, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    path = written(dialect, tmp_path)
    if dialect.refused:
        with pytest.raises(UsageError, match=dialect.refused) as refusal:
            read_recording(path, None, dialect.said())
        assert str(refusal.value).startswith(str(path))
        return
    with caplog.at_level(logging.WARNING):
        found = read_recording(path, None, dialect.said())
    assert found.fs_hz == pytest.approx(FS_HZ, rel=1e-4)
    assert len(found.channels) == dialect.channels
    for signal, expected in zip(found.channels.values(), (LEFT, RIGHT), strict=False):
        shift = SAMPLES - signal.size if "shifted" in dialect.name else 0
        np.testing.assert_allclose(
            signal, dialect.factor * expected[shift : shift + signal.size], atol=4e-4 * dialect.factor
        )
        assert signal.size >= SAMPLES - 100
    assert dialect.says in caplog.text


@pytest.mark.parametrize("dialect", [k for k in KINDS if not k.refused], ids=[k.name for k in KINDS if not k.refused])
def test_a_file_cut_anywhere_is_read_rightly_as_far_as_it_goes_or_refused(
    dialect: Dialect, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(columns, "columns_read_apart", file_columns)  # in this process, for its speed
    path = written(dialect, tmp_path)
    content = path.read_bytes()
    facts, refused = dialect.said(), []
    for size in np.linspace(0, len(content) - 1, CUTS).round().astype(int).tolist():
        path.write_bytes(content[:size])
        try:
            found = read_recording(path, None, facts)
        except UsageError as error:
            refused.append(str(error))
            continue
        assert found.fs_hz == pytest.approx(FS_HZ, rel=3e-3)
        for signal, expected in zip(found.channels.values(), (LEFT, RIGHT), strict=False):
            shift = 100 if "shifted" in dialect.name else 0
            np.testing.assert_allclose(
                signal, dialect.factor * expected[shift : shift + signal.size], atol=4e-4 * dialect.factor
            )
    assert [text for text in refused if not text.startswith(str(path))] == []


def test_samples_at_uneven_times_are_laid_on_even_ones(tmp_path: Path) -> None:
    times = TIME_S + dialects.JITTER
    signal = np.sin(2 * np.pi * 640.0 * times)
    rows = [f"{t:.7f},{x:.6f}" for t, x in zip(times, signal, strict=True)]
    (tmp_path / "run.csv").write_text("\n".join(["time,left [m/s2]", *rows]) + "\n")
    found = read_recording(tmp_path / "run.csv", None, RecordingFacts(resample_hz=FS_HZ)).channels["left"]
    even = np.sin(2 * np.pi * 640.0 * (times[0] + np.arange(found.size) / FS_HZ))
    assert np.abs(found - even)[100:-100].max() < 5e-3  # taken as even the error is 0.13
    with pytest.raises(UsageError, match="received `resample_hz: 20000`"):
        read_recording(tmp_path / "run.csv", None, RecordingFacts(resample_hz=20_000.0))


@pytest.mark.parametrize(
    ("column", "values", "facts", "turn_s"),
    [
        ("tacho", (TIME_S * 100.0) % 1.0 < 0.3, {"tacho_pulses": 4}, 0.04),
        ("angle [deg]", (TIME_S * 25.0 * 360.0) % 360.0, {}, 0.04),
        ("shaft_angle_rad", TIME_S * 25.0 * 2 * np.pi, {}, 0.04),
        ("ticks", np.floor(TIME_S * 25.0 * 2048) % 65536, {"tacho": "ticks", "tacho_pulses": 2048}, 0.04),
        ("encoder", np.floor(TIME_S * 25.0 * 2048) % 4096, {"tacho": "encoder", "tacho_pulses": 2048}, 0.04),
        ("pulse", np.where((TIME_S * 25.0) % 1.0 < 0.3, 5.0, 0.2), {"tacho_pulses": 1, "tacho_level": 1.0}, 0.04),
    ],
)
def test_angle_counts_and_pulses_give_the_turns_of_the_shaft(
    column: str, values: np.ndarray, facts: dict[str, float], turn_s: float, tmp_path: Path
) -> None:
    np.savez(tmp_path / "run.npz", **{"left [g]": LEFT, column: values.astype(float)}, fs=FS_HZ)
    said = RecordingFacts(tacho_by_name=True, **facts)  # type: ignore[arg-type]
    found = read_recording(tmp_path / "run.npz", None, said)
    assert list(found.channels) == ["left"]
    assert found.tacho_s is not None
    np.testing.assert_allclose(np.diff(found.tacho_s), turn_s, atol=1.1 / FS_HZ)
    assert found.tacho_s.size >= 5
    if "angle" not in column:
        with pytest.raises(UsageError, match="tacho_pulses: 1"):
            read_recording(tmp_path / "run.npz", None, RecordingFacts(tacho=column))


def test_pulse_times_of_any_name_are_those_of_the_tacho(tmp_path: Path) -> None:
    np.savez(tmp_path / "run.npz", left_mg=LEFT, edges=0.01 + np.arange(24) / 100.0, fs=FS_HZ)
    found = read_recording(tmp_path / "run.npz", ("left_mg",), RecordingFacts(tacho="edges", tacho_pulses=4))
    assert found.tacho_s is not None
    np.testing.assert_allclose(found.tacho_s, 0.01 + np.arange(6) / 25.0)


@pytest.mark.parametrize(("column", "scale"), [("speed [rpm]", 60.0), ("rpm", 60.0), ("drehzahl_hz", 1.0)])
def test_a_column_of_speed_is_the_range_that_is_searched(column: str, scale: float, tmp_path: Path) -> None:
    speed = scale * np.linspace(24.0, 24.5, SAMPLES)
    np.savez(tmp_path / "run.npz", **{"left [g]": LEFT, column: speed}, fs=FS_HZ)
    found = read_recording(tmp_path / "run.npz", None, RecordingFacts())
    assert found.speed_span_hz == pytest.approx((0.99 * 24.0, 1.01 * 24.5), rel=1e-3)


def test_what_was_taken_is_said_as_a_table_once_for_files_alike(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(taken, "_said", {})
    dialect = next(kind for kind in KINDS if kind.name == "row.csv")
    for name in ("may_of_table.csv", "june_of_table.csv"):
        dialect.write(tmp_path / name)
        with caplog.at_level(logging.WARNING):
            take(tmp_path / name, RecordingFacts())
    said = [record.getMessage() for record in caplog.records]
    assert "separator comma, decimal mark point; 1600 rows; 6400 Hz (times of time in s)" in said[-2]
    assert [line.split() for line in said[-2].splitlines()[1:4]] == [
        ["column", "role", "unit", "factor", "from"],
        ["time", "time", "s", "unit", "of", "the", "file"],
        ["left", "vibration", "g", "9.80665", "unit", "of", "the", "file"],
    ]
    assert said[-1].endswith("; 1600 rows")
    assert len(said[-1].splitlines()) == 1
