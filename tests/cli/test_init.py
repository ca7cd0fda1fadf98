"""`siggen init`: one command writes a configuration that can be simulated as it is."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest
from typer.testing import CliRunner

from siggen.checks.loading import load_config
from siggen.checks.plausibility import _hertz_pa, implausible
from siggen.cli.app import app
from siggen.config import read_yaml
from siggen.errors import UsageError
from siggen.gearbox.teeth import gear_pair
from tests.command import command

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
    assert implausible(config.possible) == ()
    assert len(config.channels) == 3
    assert [state.severity for state in config.config.states] == [
        "healthy",
        "healthy",
        "slight",
        "moderate",
        "severe",
        "healthy",
    ]
    assert [state.name for state in config.config.states if state.sham] == ["sham"]


def test_an_editor_completes_and_checks_a_rig_by_the_schema_beside_it(tmp_path: Path) -> None:
    file = tmp_path / "machines" / "rig.yaml"
    assert run(*RIGS["25/56"], "--out", str(file)).exit_code == 0
    first, *_ = file.read_text(encoding="utf-8").splitlines()
    assert first == "# yaml-language-server: $schema=siggen.schema.json"
    schema = json.loads((file.parent / first.partition("$schema=")[2]).read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    editor, rig = jsonschema.Draft202012Validator(schema), read_yaml(file)
    editor.validate(rig)
    with pytest.raises(jsonschema.ValidationError, match="modul_mm"):
        editor.validate({**rig, "gears": {**rig["gears"], "modul_mm": 2.0}})
    with pytest.raises(jsonschema.ValidationError, match="'seed' is a required property"):
        editor.validate({key: value for key, value in rig.items() if key != "extends"})


def test_all_digits_that_a_user_gives_are_written(tmp_path: Path) -> None:
    file = tmp_path / "rig.yaml"
    given = ["--teeth", "32,80", "--module", "1.5125", "--face-width", "20.1255"]
    made = command("siggen", "init", *given, "--speed", "24.1667", "--torque", "60.55,61.123456", "--out", str(file))
    assert made.returncode == 0, made.stderr
    config = load_config(file)
    point = config.config.operating_points[0]
    assert (point.speed_hz, point.torque_nm.low, point.torque_nm.high) == (24.1667, 60.55, 61.123456)
    assert (config.config.gears.module_mm, config.config.gears.face_width_mm) == (1.5125, 20.1255)


def test_a_speed_in_rpm_is_that_in_hz_and_face_width_and_torque_are_proposed(tmp_path: Path) -> None:
    file = tmp_path / "rig.yaml"
    made = command(
        "siggen", "init", "--teeth", "32/80", "--module", "1.5", "--speed", "1200rpm,1450/60", "--out", str(file)
    )
    assert made.returncode == 0, made.stderr
    config = load_config(file)
    speed = config.config.operating_points[0].speed_hz
    assert (speed.low, speed.high) == (20.0, pytest.approx(1450 / 60, rel=1e-14))
    assert config.config.gears.face_width_mm == 12.0
    assert "--face-width was not given; proposed: 12 mm, 8 modules" in made.stderr
    pair, torque_nm = gear_pair(config.config.gears), config.config.operating_points[0].torque_nm
    pressure_mpa = 1e-6 * _hertz_pa(pair, torque_nm / pair.pinion.base_radius_m)
    root_mpa = 4.3 * 1e3 * torque_nm / (16.0 * 1.5) / (12.0 * 1.5)
    stressed = pressure_mpa / (1500 / 1.2 / 2**0.5), root_mpa / (860 / 1.5 / 2)
    assert max(stressed) == pytest.approx(1.0, rel=5e-3)  # three digits
    assert f"--torque was not given; proposed: {torque_nm:g} N m, what the gears are rated for" in made.stderr
    assert "proposed: 12 mm" in file.read_text()


def test_the_rate_of_recordings_is_taken_with_the_mesh_harmonics_that_it_carries(tmp_path: Path) -> None:
    # 12,800 Hz carry 200 orders of 25 Hz: seven of 25 teeth, the speed's variation and 8 sidebands beside them
    for rate, harmonics in {"12800": 7, "48828.125": 10}.items():
        file = tmp_path / f"{rate}.yaml"
        assert run(*RIGS["25/56"], "--fs", rate, "--out", str(file)).exit_code == 0
        config = load_config(file)
        assert (config.fs_hz, config.config.mesh_harmonics) == (float(rate), harmonics)
    with pytest.raises(UsageError, match="--fs: received 1000; allowed: at least 2154 Hz, for the first mesh line"):
        run(*RIGS["25/56"], "--fs", "1000", "--out", str(tmp_path / "slow.yaml"))


def test_json_tells_the_file_and_what_was_proposed(tmp_path: Path) -> None:
    file = tmp_path / "rig.yaml"
    said = json.loads(run("--teeth", "32,80", "--module", "1.5", "--speed", "20", "--json", "--out", str(file)).stdout)
    assert (said["path"], set(said["proposed"])) == (str(file), {"face-width", "torque"})
    assert said["implausible"] == []


def test_all_missing_options_are_said_at_once(tmp_path: Path) -> None:
    made = command("siggen", "init", "--module", "2", "--out", str(tmp_path / "rig.yaml"))
    assert made.returncode == 2
    assert "--teeth: received nothing; give the teeth of pinion and gear" in made.stderr
    assert "--speed: received nothing; give the speed of the pinion" in made.stderr
    assert "--torque" not in made.stderr


@pytest.mark.parametrize("damage", ["spalls", "pits"])
@pytest.mark.parametrize("count", [1, 4])
def test_any_number_of_sizes_of_pits_or_spalls_on_shifted_teeth(tmp_path: Path, damage: str, count: int) -> None:
    file = tmp_path / "rig.yaml"
    asked = ["--damage", damage, "--severities", str(count), "--shift", "0.3,-0.1"]
    assert run(*RIGS["25/56"], *asked, "--out", str(file)).exit_code == 0
    config = load_config(file)
    assert (config.config.gears.pinion.profile_shift, config.config.gears.gear.profile_shift) == (0.3, -0.1)
    sizes = [state for state in config.config.states if state.damaged]
    assert [state.name for state in sizes] == (["severe"] if count == 1 else [f"size_{k}" for k in range(1, 5)])
    assert [state.severity for state in sizes] == [state.name for state in sizes]
    grown = [getattr(state.damages[0], {"spalls": "face_share", "pits": "count"}[damage]) for state in sizes]
    assert grown == sorted(set(grown))
    assert damage == "pits" or grown[-1] == 1.0


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        (["--teeth", "25"], "two whole numbers"),
        (["--teeth", "18,1000"], "gears.gear.teeth: received 1000 against 18, a ratio of 55.6"),
        (["--teeth", "25,x"], "--teeth: received '25,x'"),
        (["--module", "0.002"], "allowed: 0.3 to 50 mm"),
        (["--speed", "25,15"], "the lowest value first"),
        (["--speed", ""], "--speed: received nothing"),
        (["--speed", "fast"], "--speed: received 'fast'; allowed: one speed in Hz"),
        (["--speed", "20/0"], "--speed: received '20/0'"),
        (["--sensors", "0"], "allowed: 1 to 8"),
        (["--damage", "holes"], "--damage: received 'holes'; allowed: spalls or pits"),
        (["--severities", "13"], "--severities: received 13; allowed: 1 to 12"),
        (["--shift", "x"], "--shift: received 'x'; allowed: one number, or two"),
        (["--shift", "3"], "--shift: received 3,0; allowed: -1 to 1.5 modules"),
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
