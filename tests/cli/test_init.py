"""`siggen init`: one command writes a configuration that can be simulated as it is."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from siggen.checks.loading import load_config
from siggen.checks.plausibility import implausible
from siggen.cli.app import app
from siggen.errors import UsageError

RIGS = {
    "25/56": ["--teeth", "25,56", "--module", "2", "--face-width", "20", "--speed", "15,25", "--torque", "20"],
    "fine": ["--teeth", "19,19", "--module", "0.8", "--face-width", "8", "--speed", "50", "--torque", "1"],
    "at the band": ["--teeth", "20,40", "--module", "0.8", "--face-width", "8", "--speed", "50", "--torque", "1"],
    "large": ["--teeth", "21,83", "--module", "8", "--face-width", "100", "--speed", "10,25", "--torque", "1000,3000"],
    "wide": ["--teeth", "17,80", "--module", "10", "--face-width", "100", "--speed", "10,20", "--torque", "5000"],
    "28/28": ["--teeth", "28,28", "--module", "3.175", "--face-width", "6.35", "--speed", "23", "--torque", "160"],
}


def run(*arguments: str) -> object:
    return CliRunner().invoke(app, ["init", *arguments], catch_exceptions=False)


@pytest.mark.parametrize("name", RIGS)
def test_a_machine_of_a_few_numbers_can_be_simulated_and_is_plausible(tmp_path: Path, name: str) -> None:
    file = tmp_path / "rig.yaml"
    assert run(*RIGS[name], "--sensors", "3", "--out", str(file)).exit_code == 0
    config = load_config(file)
    assert implausible(config) == ()
    assert len(config.channels) == 3
    assert [state.severity for state in config.states] == ["healthy", "healthy", "slight", "moderate", "severe"]


def test_a_load_that_is_light_for_the_errors_of_the_gears_is_told(tmp_path: Path) -> None:
    """The reach of a tilt grows with the load, errors of the teeth do not."""
    fine = ["--teeth", "18,47", "--module", "0.8", "--face-width", "8", "--speed", "20,30", "--torque"]
    found = [run(*fine, torque, "--out", str(tmp_path / f"{torque}.yaml")).output for torque in ("1", "4")]
    assert ["errors across the face" in text for text in found] == [True, False]


def test_shafts_that_tilt_far_for_a_wide_face_are_told_with_what_follows(tmp_path: Path) -> None:
    """2 of 8 through-face spalls of the wide one end as outside_model, none of the narrow one."""
    wide = ["--teeth", "19,60", "--module", "5", "--speed", "20", "--torque", "300", "--face-width"]
    found = [run(*wide, width, "--out", str(tmp_path / f"{width}.yaml")).output for width in ("50", "30")]
    assert ["flanks tilt at rest" in text for text in found] == [True, False]


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        (["--teeth", "25"], "two whole numbers"),
        (["--teeth", "25,x"], "--teeth: received '25,x'"),
        (["--module", "0.002"], "allowed: 0.3 to 50 mm"),
        (["--speed", "25,15"], "the lowest value first"),
        (["--speed", ""], "--speed: received nothing"),
        (["--sensors", "0"], "allowed: 1 to 8"),
        (["--extends", "nothing"], "allowed: a preset"),
    ],
)
def test_slips_are_named(tmp_path: Path, changed: list[str], said: str) -> None:
    from siggen.errors import SiggenError

    with pytest.raises(SiggenError, match=said):
        run(*RIGS["25/56"], "--out", str(tmp_path / "rig.yaml"), *changed)
    assert not (tmp_path / "rig.yaml").exists()


def test_a_file_that_exists_is_never_written(tmp_path: Path) -> None:
    (tmp_path / "rig.yaml").write_text("mine")
    with pytest.raises(UsageError, match="is there already"):
        run(*RIGS["25/56"], "--out", str(tmp_path / "rig.yaml"))
    assert (tmp_path / "rig.yaml").read_text() == "mine"


def test_what_is_implausible_is_said_at_once(tmp_path: Path) -> None:
    slip = ["--teeth", "25,56", "--module", "2", "--face-width", "20", "--speed", "15,25", "--torque", "2000"]
    result = CliRunner().invoke(app, ["init", *slip, "--out", str(tmp_path / "rig.yaml")])
    assert result.exit_code == 0, result.output
    assert "implausible: " in result.output
