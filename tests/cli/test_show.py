"""`siggen show`: labels in a table, or the record in a picture."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from siggen.cli.app import app
from siggen.dataset.reading import open as open_set
from siggen.errors import UsageError, how_to_install
from siggen.views.record import SIDEBANDS, amplitude_spectrum, record_figure
from tests.dataset.fake_set import write_fake_set


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sets") / "fake"
    write_fake_set(path)
    return path


def test_labels_and_damage_are_listed_with_units_within_80_columns(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    result = CliRunner().invoke(app, ["show", str(folder), "--record", "3"])
    assert result.exit_code == 0
    assert max(map(len, result.stdout.splitlines())) <= 80
    for text in ("Record 3", "slight", "torque_nm", "N m", "512 samples", "Damage", "ellipse", "1 of"):
        assert text in result.stdout
    dataset = open_set(folder)
    words = set(result.stdout.split())
    assert words > {*dataset.labels(columns=None).schema.names, *(channel.column for channel in dataset.channels)}


def test_json_has_the_labels_and_the_damage_in_full(folder: Path) -> None:
    found = json.loads(CliRunner().invoke(app, ["show", str(folder), "--record", "3", "--json"]).stdout)
    record = open_set(folder).record(3)
    assert found["labels"]["torque_nm"] == record["torque_nm"]
    assert len(found["damage"]) == record["damage_count"] > 0
    for column, told in found["channels"].items():
        assert told["rms"] == pytest.approx(np.sqrt(np.mean(record[column].astype(float) ** 2)))


def test_a_healthy_record_has_no_damage_table(folder: Path) -> None:
    assert "Damage" not in CliRunner().invoke(app, ["show", str(folder), "--record", "0"]).stdout


def test_a_tone_on_a_bin_shows_its_amplitude() -> None:
    t_s = np.arange(1000) / 1000.0
    frequency_hz, amplitude = amplitude_spectrum(3.0 * np.sin(2 * np.pi * 100.0 * t_s) + 5.0, 1000.0)
    # a Hann window passes a tone on a bin at its amplitude exactly, up to rounding
    assert amplitude[np.argmin(np.abs(frequency_hz - 100.0))] == pytest.approx(3.0, rel=1e-9)
    assert amplitude[0] < 1e-9


def test_the_figure_has_units_labels_and_sidebands_at_the_shafts_distances(folder: Path) -> None:
    dataset = open_set(folder)
    record = dataset.record(5)
    figure = record_figure(record, dataset.channels[1], dataset.fs_hz)
    assert "moderate" in figure.get_suptitle()
    assert "bearing_horizontal" in figure.get_suptitle()
    waveform, first, *_ = [axes for part in figure.subfigs for axes in part.get_axes()]
    assert waveform.get_xlabel() == "time [s]"
    assert waveform.get_ylabel() == "acceleration [m/s²]"
    assert first.get_xlabel() == "frequency [Hz]"
    assert first.get_ylabel() == "amplitude [m/s²]"
    marks_hz = sorted(line.get_xdata()[0] for line in first.lines if len(line.get_xdata()) == 2)
    pinion = [540.0 + 30.0 * k for k in range(-SIDEBANDS, SIDEBANDS + 1)]
    gear = [540.0 + 30.0 * 18 / 47 * k for k in range(-SIDEBANDS, SIDEBANDS + 1) if k]
    assert marks_hz == pytest.approx(sorted([*pinion, *gear]))


def test_the_picture_is_written_and_its_path_alone_is_on_stdout(folder: Path, tmp_path: Path) -> None:
    png = tmp_path / "figures/record.png"
    result = CliRunner().invoke(app, ["show", str(folder), "--record", "3", "--png", str(png)])
    assert result.exit_code == 0
    assert result.stdout == f"{png}\n"
    assert png.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--record", "99"], "no record 99"),
        (["--record", "3", "--png", "x.docx"], r"\.docx"),
        (["--record", "3", "--set", "duration_s=0.1"], "add --out"),
        (["--record", "3", "--internals", "--out", "x.npz"], "equations of motion"),
        (["--record", "3", "--png", "x.png", "--channel", "casing"], "bearing_vertical"),
        (["--record", "3", "--channel", "casing"], "bearing_vertical"),
        (["--record", "3", "--channel", "bearing_vertical"], "add --png FILE or --open"),
    ],
)
def test_wrong_wishes_are_answered_with_what_there_is(folder: Path, arguments: list[str], message: str) -> None:
    result = CliRunner().invoke(app, ["show", str(folder), *arguments])
    assert isinstance(result.exception, UsageError)
    assert message.replace("\\", "") in str(result.exception)


def test_without_matplotlib_the_message_says_how_to_install_it(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    result = CliRunner().invoke(app, ["show", str(folder), "--record", "3", "--png", str(tmp_path / "x.png")])
    assert isinstance(result.exception, UsageError)
    assert how_to_install("diagnostics") in str(result.exception)
