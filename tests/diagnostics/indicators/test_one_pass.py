"""One pass over a record serves ranking, training and audit; what is kept beside a set is never out of date."""

from __future__ import annotations

import shutil
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from diagnostics.audit import bank, condition_leaks, signal_detectors
from diagnostics.cli.app import main
from diagnostics.indicators import channel_signals, table
from diagnostics.indicators.ranking_table import ranking_table
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.indicators.table import record_table
from diagnostics.signal import shaft_signals
from siggen.dataset import reading
from siggen.sets.verification import verify
from tests.dataset.fake_set import fake_config, write_fake_set
from tests.diagnostics.cli.test_bad_sets import samples, turning
from tests.rig_file import rig_file

OWN = "def peak_to_peak(signal, tacho, gears):\n    return float(signal.max() - signal.min())\n"


def made(folder: Path, specimens: int, splits: dict[str, int]) -> Path:
    """Write gearboxes in three states, one record of each."""
    points = [{"speed_hz": 30.0, "torque_nm": 60.0}]
    config = fake_config(
        specimens=specimens, fs_hz=12_800.0, duration_s=0.32, operating_points=points, splits=splits
    )  # fmt: skip
    write_fake_set(folder, config, simulation=turning)
    return folder


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return made(tmp_path / "set", 3, {"train": 7, "validation": 7, "test": 6})


def run(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr(sys, "argv", ["siggen-diagnostics", *arguments])
    try:
        main()
    except SystemExit as stop:
        return int(stop.code or 0)
    return 0


def counted(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """Count from now on how often a record is resampled and averaged anywhere in the commands' one pass."""
    calls: Counter[str] = Counter()
    monkeypatch.setattr(table, "_record_result", table._record_result.__wrapped__)  # type: ignore[attr-defined]

    def counting(module: Any, name: str) -> None:
        original: Callable[..., Any] = getattr(module, name)

        def call(*arguments: Any, **named: Any) -> Any:
            calls[name] += 1
            return original(*arguments, **named)

        monkeypatch.setattr(module, name, call)

    counting(channel_signals, "resample_to_angle")
    counting(channel_signals, "shaft_signals")
    counting(shaft_signals, "synchronous_average")
    return calls


@pytest.mark.slow  # trains and audits; that a kept table is read back is asked below
def test_ranking_training_audit_and_features_resample_and_average_once_per_record_and_channel(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, calls = made(tmp_path / "set", 8, {"train": 10, "validation": 5, "test": 5}), counted(monkeypatch)
    # What the audit's networks learn is not asked here: a few epochs read as many records as hundreds do.
    monkeypatch.setattr(signal_detectors, "SHOWN", 0)
    monkeypatch.setattr(signal_detectors, "DILATIONS", (1, 8))
    monkeypatch.setattr(condition_leaks, "PERMUTATIONS", 19)
    monkeypatch.setattr(bank, "PERMUTATIONS", 19)
    for command, *options in (
        ("indicators", "--out", "ranking"),
        ("report", "--no-cnn", "--out", "models"),
        ("audit", "--out", "audit"),
        ("indicators", "--out", "features.parquet"),
    ):
        out = str(tmp_path / options[-1])
        assert run(monkeypatch, command, str(folder), *options[:-1], out) == 0, capsys.readouterr().err
    dataset = reading.open(folder)
    channel_records = dataset.labels(columns=["record_id"]).num_rows * len(dataset.channels)
    # averages: pinion, gear, and the gear's Hann-weighted one that its sidebands are read from
    assert calls == {
        "resample_to_angle": channel_records,
        "shaft_signals": 2 * channel_records,
        "synchronous_average": 3 * channel_records,
    }
    assert verify(folder).mismatches == ()


def test_what_commands_show_under_one_name_is_one_number(folder: Path, tmp_path: Path) -> None:
    from diagnostics.audit.measured_set import measured_set
    from diagnostics.indicators.classifier_table import classifier_table

    dataset = reading.open(folder)
    first = record_table(dataset)
    ranked, classified, audited = ranking_table(first, dataset).matrix, classifier_table(first), measured_set(dataset)
    shared = [name for name in ranked.names if name in classified.column_names]
    assert len(shared) == len(first.names()) > 200
    for name in shared:
        indicator, channel = name.split("__")
        wanted = ranked.values[:, ranked.names.index(name)]
        np.testing.assert_array_equal(classified.column(name).to_numpy(), wanted)
        np.testing.assert_array_equal(audited.values[indicator][:, audited.channels.index(channel)], wanted)


def test_a_kept_table_is_read_back_until_set_or_settings_change(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = record_table(reading.open(folder))
    values = first.values(first.names())
    calls = counted(monkeypatch)
    again = record_table(reading.open(folder))
    assert not calls
    np.testing.assert_array_equal(again.values(again.names()), values)
    record_table(reading.open(folder), IndicatorSettings(sidebands=4))
    assert calls
    kept = list(folder.with_name("set_table").glob("*.parquet"))
    assert len(kept) == 2  # one per settings
    samples(lambda values, numbers: np.multiply(values, 2.0, out=values))(folder)
    doubled = record_table(reading.open(folder))
    rms = doubled.values(["rms__bearing_vertical"])[:, 0]
    np.testing.assert_allclose(rms, 2.0 * values[:, first.names().index("rms__bearing_vertical")], rtol=1e-6)
    assert len(list(folder.with_name("set_table").glob("*.parquet"))) == 1  # those of the other state are gone


def test_a_damaged_or_unwritable_table_is_computed_again(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    record_table(reading.open(folder))
    (kept,) = folder.with_name("set_table").glob("*.parquet")
    content = bytearray(kept.read_bytes())
    content[len(content) // 2] ^= 1
    kept.write_bytes(content)
    calls = counted(monkeypatch)
    record_table(reading.open(folder))
    assert calls["resample_to_angle"]
    assert pq.read_schema(kept).names
    shutil.rmtree(kept.parent)
    kept.parent.write_text("a file where the folder should be")
    found = record_table(reading.open(folder))
    assert "could not be kept" in found.note
    assert found.rows == 9


def test_a_chosen_channel_reads_the_table_of_all(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from diagnostics.records.usable_records import with_channels

    whole = record_table(reading.open(folder))
    calls = counted(monkeypatch)
    one = record_table(with_channels(reading.open(folder), whole.channels[:1]))
    assert not calls
    assert one.names() == tuple(name for name in whole.names() if name.endswith(f"__{whole.channels[0]}"))


@pytest.mark.slow  # trains, audits and reports; a walk takes an own indicator through a ranking and a table
def test_an_own_indicator_goes_through_features_training_audit_report_and_prediction(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = made(tmp_path / "set", 8, {"train": 10, "validation": 5, "test": 5})
    (tmp_path / "own_indicators_of_a_user.py").write_text(OWN)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])
    own = ("--indicator", "own_indicators_of_a_user:peak_to_peak")
    assert run(monkeypatch, "indicators", str(folder), "--out", "features.parquet", *own) == 0
    assert "peak_to_peak__bearing_vertical" in pq.read_schema("features.parquet").names
    assert run(monkeypatch, "audit", str(folder), "--out", "audit", *own) == 0
    assert run(monkeypatch, "report", str(folder), "--no-cnn", "--out", "report", *own) == 0
    metrics = Path("report/metrics.json").read_text()
    assert '"peak_to_peak__bearing_vertical"' in metrics
    assert "peak_to_peak (" in Path("report/models/model_card.md").read_text()
    capsys.readouterr()
    recording = str(min((folder / "data").glob("test*.parquet")))
    predict = (
        "predict",
        "report/models",
        f"{recording}:0",
        "--fs",
        "12800",
        "--teeth",
        "18,47",
        *rig_file(tmp_path, tacho="tacho_s"),
    )
    assert run(monkeypatch, *predict) == 2
    assert "your own indicators peak_to_peak, which are not part of a model; give" in capsys.readouterr().err
    assert run(monkeypatch, *predict, *own) == 0, capsys.readouterr().err
