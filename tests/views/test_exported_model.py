"""A model that leaves siggen has to give the same motion elsewhere."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from siggen.checks.loading import load_config
from siggen.cli.app import app
from siggen.errors import UsageError
from siggen.views.exported_model import FORMAT_VERSION, exported_model

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "docs" / "scripts" / "exported_model.py"
PAGE = (ROOT / "docs" / "reference" / "exported_model.md").read_text()
runner = CliRunner()


def script():
    spec = importlib.util.spec_from_file_location("exported_model_script", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


# Shafts damped ten times as much: a transient of some 30 ms, which scipy can follow within seconds.
QUICK = ["dynamics.input_coupling.damping_nm_s_per_rad=2.3", "dynamics.output_coupling.damping_nm_s_per_rad=2.3"]


def differences(config: str, *overrides: str, record: int = 0, samples: int = 300) -> list[float]:
    """Return the largest differences of approach and mesh force over their swing."""
    times, own, other = script().compare(config, [*QUICK, *overrides], samples=samples, record=record)
    assert len(times) == samples
    return [float(np.abs(a - b).max() / np.ptp(a)) for a, b in zip(own, other, strict=True)]


def test_scipy_integrates_the_exported_linear_model_to_the_same_motion() -> None:
    # Product integration at 16 steps per sample errs by 1e-8, scipy by its tolerance of 1e-7.
    assert max(differences("configs/paper_a.yaml", "dynamics.steps_per_sample=16")) < 2e-6


STIFF = ("dynamics.friction.model=off", "dynamics.mesh.damping=constant", "dynamics.model=8dof")
PINION = ("sensors.0.place=pinion_bearing", "sensors.0.position_mm=null")


def test_scipy_integrates_the_exported_tooth_pairs_to_the_same_motion() -> None:
    # Runge-Kutta steps of first order at contact events; sampled forces differ most at their steps.
    coarse, fine = (
        differences("tests/configs/casing.yaml", *STIFF, *PINION, f"dynamics.steps_per_sample={steps}")
        for steps in (4, 16)
    )
    assert max(fine) < 2e-3
    assert max(coarse) > 2.0 * max(fine)


def test_scipy_integrates_the_exported_contact_across_the_face_to_the_same_motion() -> None:
    # Contacts begin without a step of the stiffness, so that Runge-Kutta errs less than with springs.
    face = ("dynamics.mesh.contact=face", "dynamics.steps_per_sample=16")
    assert max(differences("tests/configs/casing.yaml", *STIFF, *PINION, *face, samples=100)) < 2e-3


SHAFTS = "dynamics.shafts={pinion: {gear_position: 0.4}, gear: {gear_position: 0.4}}"


@pytest.mark.slow
def test_scipy_integrates_the_exported_tilt_of_a_damaged_gearbox_to_the_same_motion() -> None:
    frictionless = ("dynamics.friction.model=off", "dynamics.mesh.damping=constant", "dynamics.steps_per_sample=16")
    tilting = ("dynamics.mesh.contact=face", SHAFTS, "stiffness.coupling=none")
    assert max(differences("tests/configs/casing.yaml", *frictionless, *tilting, record=16, samples=300)) < 2e-3


@pytest.mark.slow
def test_scipy_integrates_the_exported_slices_of_a_spall_to_the_same_motion() -> None:
    # Record 16: spalled through the face, 25 Hz; 2200 samples hold a whole revolution, hence the spalled tooth. Its
    # impacts are events of first order as above, of a force that falls to a fraction of the mean.
    steps = "dynamics.steps_per_sample=16"
    assert max(differences("tests/configs/casing.yaml", *STIFF, *PINION, steps, record=16, samples=2200)) < 5e-3


@pytest.mark.parametrize("varying", ["variation.speed.end_ratio=1.1", "dynamics.unbalance.grade_mm_s=6.3"])
def test_a_record_that_the_format_cannot_hold_is_refused(varying: str) -> None:
    with pytest.raises(UsageError, match="allowed are constant speed and torque, without other forces"):
        exported_model(load_config(ROOT / "tests" / "configs" / "casing.yaml", ["duration_s=0.01", varying]), 0)


def test_what_the_script_does_not_know_is_refused_by_name() -> None:
    model = exported_model(load_config(ROOT / "tests" / "configs" / "casing.yaml", ["duration_s=0.01"]), 16)
    with pytest.raises(ValueError, match=r"law\.damping_film_root_kg"):
        script().integrate(model, np.arange(2) / 51200.0)


@pytest.mark.parametrize(
    ("file", "record", "overrides"),
    [
        ("configs/paper_a.yaml", 0, []),
        ("configs/linear_pits.yaml", 0, []),
        ("configs/paper_b.yaml", 0, []),
        ("tests/configs/casing.yaml", 16, ["dynamics.mesh.damping=constant", "stiffness.coupling=body"]),
        ("tests/configs/casing.yaml", 16, ["dynamics.mesh.contact=face"]),
    ],
)
def test_every_key_is_described(file: str, record: int, overrides: list[str]) -> None:
    model = exported_model(load_config(ROOT / file, ["duration_s=0.01", *overrides]), record)
    missing = [key for key in model if f"`{key}`" not in PAGE]
    assert not missing, f"docs/reference/exported_model.md does not describe {missing}"
    assert model["format_version"] == FORMAT_VERSION


def test_the_archive_is_the_same_whenever_it_is_written_and_needs_no_pickle(tmp_path: Path) -> None:
    files = [tmp_path / "a.npz", tmp_path / "b.npz"]
    for file in files:
        arguments = ["configs/linear_pits.yaml", "--record", "5", "--out", str(file), "--set", "duration_s=0.1"]
        result = runner.invoke(app, ["export-model", *arguments], catch_exceptions=False)
        assert result.output.strip() == str(file)
    assert files[0].read_bytes() == files[1].read_bytes()
    with np.load(files[0], allow_pickle=False) as model:
        assert model["mass"].shape == (8, 8)
        assert set(model["motion_names"]) == {
            f"{gear}_bearing/{axis}" for gear in ("pinion", "gear") for axis in ("vertical", "horizontal")
        }
        # Static equilibrium: K q_s + p F_s is the torque and its balance.
        residual = model["stiffness"] @ model["static_deflection"] + model["mesh_vector"] * model["static_force_n"]
        np.testing.assert_allclose(residual, model["torque_vector"] * model["torque_nm"], atol=1e-8)


def test_another_ending_is_refused_before_any_work(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"allowed is \.npz"):
        runner.invoke(
            app, ["export-model", "nowhere.yaml", "--record", "0", "--out", "model.mat"], catch_exceptions=False
        )
