"""A model that leaves siggen has to give the same motion elsewhere."""

from __future__ import annotations

import importlib.util
import io
import re
import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from siggen.checks.loading import load_config
from siggen.cli.app import app
from siggen.config import by_reference
from siggen.errors import UsageError
from siggen.gearbox.configured import state_config
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import planned_record
from siggen.motion.equations import no_inputs
from siggen.record.drive import record_drive
from siggen.record.motion import specimen_motion
from siggen.record.specimen_state import specimen_state
from siggen.views.exported_model import FORMAT_VERSION, exported_model
from tests.config.minimal import by_name
from tests.config.planets import SPALL as PLANET_SPALL
from tests.config.planets import planets
from tests.record.test_two_stages import two_stages
from tests.simulated import drawn_record, internals_table

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "docs" / "scripts" / "exported_model.py"
PAGE = (ROOT / "docs" / "reference" / "exported_model.md").read_text()
runner = CliRunner()


def script():
    sys.path.insert(0, str(SCRIPT.parent))  # the script imports its law from beside it
    spec = importlib.util.spec_from_file_location("exported_model_script", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


# Shafts damped ten times as much: a transient of some 30 ms, which scipy can follow within seconds.
QUICK = ["dynamics.input_coupling.damping_nm_s_per_rad=2.3", "dynamics.output_coupling.damping_nm_s_per_rad=2.3"]


def differences(config: str, *overrides: str, record: int = 0, samples: int = 300, rtol: float = 1e-6) -> list[float]:
    """Return the largest differences of approach and mesh force over their swing."""
    times, own, other = script().compare(config, [*QUICK, *overrides], samples=samples, record=record, rtol=rtol)
    assert len(times) == samples
    return [float(np.abs(a - b).max() / np.ptp(a)) for a, b in zip(own, other, strict=True)]


def test_scipy_integrates_the_exported_linear_model_to_the_same_motion() -> None:
    # Product integration at 16 steps per sample errs by 1e-8, scipy by its tolerance of 1e-7.
    assert max(differences("configs/paper_a.yaml", "dynamics.steps_per_sample=16", samples=120, rtol=1e-7)) < 2e-6


PINION = ("sensors.lid.place=pinion_bearing", "sensors.lid.position_mm=null")


@pytest.mark.slow
def test_scipy_gives_the_motion_of_helical_teeth_whose_slices_rub_both_ways() -> None:
    changed = ("gears.helix_deg=15", "dynamics.mesh.damping=constant", "dynamics.model=8dof", "housing={}")
    geometry = "dynamics.mesh.damage=geometry"
    rubbed = (
        geometry,
        "dynamics.friction={model: constant, coefficient: 0.08}",
        *PINION,
        "dynamics.steps_per_sample=16",
    )
    assert max(differences("tests/configs/casing.yaml", *changed, *rubbed, samples=150, rtol=1e-7)) < 2e-3


MATRICES = ("mass", "damping", "stiffness")
VECTORS = ("mesh.0.vector", "mesh.0.sliding_vectors", "mesh.0.friction_vectors")
Change = Callable[[np.ndarray], np.ndarray]


def beginning(
    config: str | dict,
    record: int,
    samples: int,
    steps: int,
    *overrides: str,
    change: Change = np.array,
    runge_kutta: bool = True,
) -> tuple[dict, list]:
    """Return the model as a file gives it; approach, mesh force and tilt of all meshes of the loop from its start on.

    The beginning, not the record behind it: before that the housing settles for 0.6 s, which scipy needs minutes for.
    Both have the matrices as `change` leaves them. Steps are those of Runge-Kutta, or as shipped.
    """
    loaded = load_config(
        ROOT / config if isinstance(config, str) else config,
        ["duration_s=0.01", f"dynamics.steps_per_sample={steps}", *overrides],
    )
    if runge_kutta:
        loaded = loaded.with_sections(dynamics=by_reference(loaded.config.dynamics))
    planned = planned_record(loaded, record)
    specimen = loaded.gearbox(planned.specimen_id)
    state = specimen_state(specimen, planned.state_id)
    point, driven = specimen.points[planned.operating_point_id], record_drive(specimen, state.mesh.structure, planned)
    built = state.mesh.structure
    matrices = {name: change(getattr(built, name)) for name in MATRICES}
    vectors = tuple(replace(one, vector=change(one.vector), sliding=change(one.sliding)) for one in built.meshes)
    mesh = replace(state.mesh, structure=replace(built, meshes=vectors, **matrices))
    motion = specimen_motion(specimen.law, mesh, point, 1.0 / (loaded.fs_hz * steps), driven)
    buffer = io.BytesIO()
    np.savez(
        buffer, **{name: np.asarray(value) for name, value in exported_model(*drawn_record(loaded, record)).items()}
    )
    buffer.seek(0)
    model = {name: value[()] for name, value in np.load(buffer, allow_pickle=False).items()}
    times = model["start_s"] + np.arange(samples * steps + 1) / (loaded.fs_hz * steps)
    pitches = driven.rotation.angle_rad(times) * model["mesh.0.pitches_per_rad"]
    inputs = no_inputs(pitches) if driven.excitation is None else driven.excitation.inputs(times, driven.rotation)
    states = np.empty((times.size, model["start_state"].size))
    states[0] = model["start_state"]
    motion.advance(pitches, inputs, states)
    inner = motion.internals(states[::steps], pitches[::steps], inputs[::steps])
    before = [f"{one.name}_" if one.name else "" for one in built.meshes]
    seen = [first + name for first in before for name in ("approach_m", "mesh_force_n", "mesh_tilt_rad")]
    names = [name for name in seen if name in motion.internal_names]
    own = [inner[:, motion.internal_names.index(name)] for name in names]
    return model | {name: change(model[name]) for name in (*MATRICES, *VECTORS)}, own


def by_scipy(model: dict, own: list, rtol: float) -> list:
    """Return the quantities of `own` at the same times from an exported model."""
    times = model["start_s"] + np.arange(len(own[0])) / model["fs_hz"]
    return list(script().integrate(model, times, rtol))[: len(own)]


def largest(own: list, other: list) -> float:
    """Return the largest difference of any quantity over its swing."""
    return max(float(np.abs(a - b).max() / np.ptp(a)) for a, b in zip(own, other, strict=True))


@pytest.mark.slow  # below one of a casing; the law itself: tests/dynamics/mesh/test_law_independently.py
def test_scipy_gives_the_motion_of_a_damaged_misaligned_record_of_bench_from_its_file_alone() -> None:
    # As shipped, with varying speed and torque, unbalance, tones, coupling, friction and tilt; record 6 is spalled over
    # 95 % of the face, and its tooth 16 comes after 7 ms. Eight steps per sample leave 6e-4 of the mesh force.
    model, own = beginning("configs/bench.yaml", 6, 260, 8, "manufacture.lead_misalignment_um=5")
    assert len(own) == 3
    assert largest(own, by_scipy(model, own, 1e-5)) < 1e-3
    sound = model | {"mesh.0.law.table_of_pair": np.zeros_like(model["mesh.0.law.table_of_pair"])}
    assert largest(own, by_scipy(sound, own, 1e-3)) > 0.05


FINE = 1e-6
"""Tolerance of scipy where springs begin with a step. It starts at rest, where rounding alone is the error
that chooses its steps: the last bits decide where its steps pass those of the force. With 1e-5 they moved one sample,
under an impact of 250 N, by up to 5e-3 of the mesh force, with 1e-6 by 2e-4."""

SLOW_SPALL = (
    "states.sham.damage={kind: spall, gear: slow_pinion, teeth: 17, centre_height_mm: pitch, face_length_mm: 30.0, "
    "depth_mm: 0.2, profile_length_mm: 1.0}"
)


@pytest.mark.slow
def test_scipy_gives_the_motion_of_two_stages_from_their_file_alone() -> None:
    """Every tooth of the second pinion is spalled through the face; friction and errors in both meshes."""
    model, own = beginning(two_stages(), 14, 350, 8, SLOW_SPALL, "manufacture={accuracy_class: 6}")
    assert model["meshes"] == 2
    assert len(own) == 4
    assert largest(own, by_scipy(model, own, FINE)) < 1e-3  # 2e-4 of the first mesh's force
    sound = model | {"mesh.1.law.table_of_pair": np.zeros_like(model["mesh.1.law.table_of_pair"])}
    assert largest(own[2:], by_scipy(sound, own, 1e-4)[2:]) > 0.05


def planetary(**changes: object) -> dict:
    """Return a set with friction, errors and pins out of place; of one state every tooth of the sun is spalled."""
    damage = {**PLANET_SPALL, "gear": "sun", "teeth": 25, "centre_height_mm": "pitch"}
    states = [{"name": "healthy"}, {"name": "severe", "damage": damage}]
    friction = {**planets()["dynamics"], "friction": {"model": "mixed_ehl"}}
    section = {"ring_teeth": 77, "pin_error_um": 10}
    made = {"manufacture": {"accuracy_class": 6}, "states": by_name(states), "dynamics": friction, "planetary": section}
    return planets(**{**made, **changes})


@pytest.mark.slow
def test_scipy_gives_the_motion_of_a_planetary_set_from_its_file_alone() -> None:
    """Six meshes in a frame that turns, by the steps that records take."""
    model, own = beginning(planetary(), 1, 80, 16, runge_kutta=False)
    assert model["meshes"] == 6
    assert len(own) == 12
    assert largest(own, by_scipy(model, own, FINE)) < 1e-3
    sound = model | {f"mesh.{m}.law.table_of_pair": 0 * model[f"mesh.{m}.law.table_of_pair"] for m in range(3)}
    assert largest(own, by_scipy(sound, own, 1e-4)) > 0.05


def test_the_model_starts_where_its_record_does() -> None:
    """From its start on, by its own steps, a motion comes to the record's values; one that starts later does not."""
    whole = load_config(planetary(), ["duration_s=0.005"])
    model, loaded = exported_model(*drawn_record(whole, 0)), state_config(whole.config, 0, 0)
    design, steps = SetDesign(loaded), int(model["steps_per_sample"])
    specimen, point = design.gearbox(0), design.drawn_points(0)[0]
    motion = specimen_motion(
        specimen.law, specimen_state(specimen, 0).mesh, point, float(model["step_s"])
    )  # fmt: skip
    first = round(-model["start_s"] / model["step_s"])
    assert first % steps == 0
    times = np.arange(-first, steps * int(model["samples"])) * model["step_s"]
    turned = model["start_angle_rad"] + 2.0 * np.pi * model["speed_hz"] * times
    pitches = turned * model["mesh.0.pitches_per_rad"]
    states = np.empty((times.size, model["start_state"].size))
    states[0] = model["start_state"]
    motion.advance(pitches, no_inputs(pitches), states)
    inner, record = motion.internals(states[first::steps], pitches[first::steps]), internals_table(whole, 0)
    for number, name in enumerate(motion.internal_names):
        if name.endswith("_mesh_force_n"):
            own, found = record[name].to_numpy(), inner[:, number]
            assert np.abs(own - found).max() < 1e-6 * np.ptp(own)


@pytest.mark.parametrize("beam", [pytest.param("rack_trochoid", marks=pytest.mark.slow), "calibrated"])
def test_scipy_gives_the_motion_with_damping_by_asperity_share(beam: str) -> None:
    model, own = beginning("tests/configs/casing.yaml", 12, 300, 32, f"stiffness.beam={beam}")
    assert {"mesh.0.law.contact.touch_m", "mesh.0.law.damping_film_root_kg"} <= set(model)
    assert largest(own, by_scipy(model, own, FINE)) < 1e-3


@pytest.mark.parametrize(
    ("file", "record", "overrides"),
    [
        ("configs/paper_a.yaml", 0, []),
        ("tests/configs/linear_pits.yaml", 0, []),
        ("configs/paper_b.yaml", 0, []),
        ("tests/configs/casing.yaml", 16, ["dynamics.mesh.damping=constant", "stiffness.beam=calibrated"]),
        ("configs/bench.yaml", 5, []),
    ],
)
def test_every_key_is_described(file: str, record: int, overrides: list[str]) -> None:
    described(exported_model(*drawn_record(load_config(ROOT / file, ["duration_s=0.01", *overrides]), record)), 1)


def test_every_key_of_two_stages_is_described() -> None:
    described(exported_model(*drawn_record(load_config(two_stages(), ["duration_s=0.01"]), 0)), 2)


def test_every_key_of_a_planetary_set_is_described() -> None:
    described(exported_model(*drawn_record(load_config(planetary(), ["duration_s=0.01"]), 0)), 6)


def described(model: Mapping, meshes: int) -> None:
    missing = [key for key in model if f"`{re.sub(r'^mesh[.][0-9][.]', 'mesh.M.', key)}`" not in PAGE]
    assert not missing, f"docs/reference/exported_model.md does not describe {missing}"
    assert model["format_version"] == FORMAT_VERSION
    assert model["meshes"] == meshes
    assert {key.split(".")[1] for key in model if key.startswith("mesh.")} == {str(m) for m in range(meshes)}


def test_the_archive_is_the_same_whenever_it_is_written_and_needs_no_pickle(tmp_path: Path) -> None:
    files = [tmp_path / "a.npz", tmp_path / "b.npz"]
    for file in files:
        arguments = ["tests/configs/linear_pits.yaml", "--record", "5", "--out", str(file), "--set", "duration_s=0.1"]
        result = runner.invoke(app, ["show", *arguments], catch_exceptions=False)
        assert result.output.strip() == str(file)
    assert files[0].read_bytes() == files[1].read_bytes()
    with np.load(files[0], allow_pickle=False) as model:
        assert model["mass"].shape == (8, 8)
        assert set(model["motion_names"]) == {
            f"{gear}_bearing/{axis}" for gear in ("pinion", "gear") for axis in ("vertical", "horizontal")
        }
        # Static equilibrium: K q_s + p F_s is the torque and its balance.
        residual = (
            model["stiffness"] @ model["static_deflection"] + model["mesh.0.vector"] * model["mesh.0.static_force_n"]
        )
        np.testing.assert_allclose(residual, model["torque_vector"] * model["torque_nm"], atol=1e-8)


def test_another_ending_is_refused_before_any_work(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"allowed are \.csv, \.parquet, \.npz"):
        runner.invoke(app, ["show", "nowhere.yaml", "--record", "0", "--out", "model.mat"], catch_exceptions=False)
