"""Two stages in a row: motor, 18/47, a shaft, 18/47 again, load; every gear on a bearing of its own on the ground."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from siggen.dynamics.friction.friction import constant_friction
from siggen.dynamics.mesh.mesh_force import mean_mesh_stiffness
from siggen.dynamics.mesh.pair_columns import FRICTION, NORMAL, POSITION
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.dynamics.structure.load_lock import locked_load
from siggen.dynamics.structure.mesh_vectors import MeshVectors
from siggen.dynamics.structure.shaft_lines import rigid_rotation
from siggen.dynamics.structure.structure import Element, Structure, assemble, eight_dof, vector
from siggen.dynamics.time.equations import no_inputs
from siggen.dynamics.time.exponential_motion import ExponentialMotion
from siggen.dynamics.time.pair_motion import MeanState, PairMesh, PairMotion
from tests.dynamics.casing_stage import BASE_RADIUS_1, BASE_RADIUS_2, PRESSURE_ANGLE, make_stage
from tests.dynamics.pair_runs import TORQUE, contact_law, gear_pair, law, tables

SINE, COSINE = np.sin(PRESSURE_ANGLE), np.cos(PRESSURE_ANGLE)
RATIO = 47 / 18
SHAFT_NM_PER_RAD = 2.0e4
LATER = 0.37
"""Base pitches that the second mesh has turned where the first has turned none."""
STEP = 1.0 / (51200 * 4)


def masses(heavy: float) -> dict[str, float]:
    """Return the inertias of two stages, those of the shaft in between times `heavy`."""
    stage = make_stage()
    found = {"theta_m": stage.motor_inertia_kg_m2}
    for number, rotor, factor in zip("1234", (stage.pinion, stage.gear) * 2, (1.0, heavy, heavy, 1.0), strict=True):
        mass = {f"{axis}_{number}": factor * rotor.mass_kg for axis in "xy"}
        found |= {**mass, f"theta_{number}": factor * rotor.inertia_kg_m2}
    return found | {"theta_l": stage.load_inertia_kg_m2}


def springs() -> list[Element]:
    stage, found = make_stage(), []
    for number, rotor in zip("1234", (stage.pinion, stage.gear) * 2, strict=True):
        bearing = rotor.bearing
        found += [
            Element({f"x_{number}": 1.0}, bearing.stiffness_x_n_per_m, bearing.damping_x_n_s_per_m),
            Element({f"y_{number}": 1.0}, bearing.stiffness_y_n_per_m, bearing.damping_y_n_s_per_m),
        ]
    first, last = stage.input_coupling, stage.output_coupling
    return [
        *found,
        Element({"theta_m": 1.0, "theta_1": -1.0}, first.stiffness_nm_per_rad, first.damping_nm_s_per_rad),
        Element({"theta_2": 1.0, "theta_3": -1.0}, SHAFT_NM_PER_RAD, 1.0),
        Element({"theta_4": 1.0, "theta_l": -1.0}, last.stiffness_nm_per_rad, last.damping_nm_s_per_rad),
    ]


def mesh_of(coordinates: tuple[str, ...], a: str, b: str, sense: float, name: str) -> MeshVectors:
    """Return a mesh of gear a, which turns counter-clockwise (sense 1) or back, with gear b on its right."""
    along = {f"x_{a}": SINE, f"y_{a}": sense * COSINE, f"x_{b}": -SINE, f"y_{b}": -sense * COSINE}
    across = {f"x_{a}": -COSINE, f"y_{a}": sense * SINE, f"x_{b}": COSINE, f"y_{b}": -sense * SINE}
    rolling = {f"theta_{a}": BASE_RADIUS_1, f"theta_{b}": -BASE_RADIUS_2}
    still = {**across, f"theta_{b}": -gear_pair().line_of_action_m}
    turning = {f"theta_{a}": 1.0, f"theta_{b}": 1.0}
    sliding = np.array([vector(coordinates, still), vector(coordinates, turning)])
    mass = make_stage().equivalent_mesh_mass_kg
    whole = vector(coordinates, {**along, **rolling})
    return MeshVectors(whole, sliding, mass, (f"theta_{a}", f"theta_{b}"), name=name)


def two_stages(heavy: float = 1.0) -> Structure:
    inertias = masses(heavy)
    coordinates = tuple(inertias)
    stiffness, damping = assemble(coordinates, springs())
    bearings = {f"gear_{n}/{axis}": vector(coordinates, {f"{axis}_{n}": 1.0}) for n in "1234" for axis in "xy"}
    return Structure(
        coordinates=coordinates,
        mass=np.diag(list(inertias.values())),
        damping=damping,
        stiffness=stiffness,
        meshes=(mesh_of(coordinates, "1", "2", 1.0, "first"), mesh_of(coordinates, "3", "4", -1.0, "second")),
        shaft_lines=(("theta_m", "theta_1"), ("theta_2", "theta_3"), ("theta_4", "theta_l")),
        torque_vector=vector(coordinates, {"theta_m": 1.0, "theta_l": -(RATIO**2)}),
        motions=bearings,
        bearing_forces={},
        bearing_directions={},
    )


def motion(kind: type[PairMotion], structure: Structure, *laws: PairLaw, step_s: float = STEP) -> PairMotion:
    mean = mean_mesh_stiffness(tables())
    meshes = [PairMesh(chosen, mean, begins_pitches=begins) for chosen, begins in zip(laws, (0.0, LATER), strict=False)]
    return kind(structure, meshes, mean=MeanState(TORQUE, 30.0), step_s=step_s)


def run(found: PairMotion, steps: int, step_s: float = STEP) -> tuple[np.ndarray, np.ndarray]:
    pitches = 18 * 30.0 * step_s * np.arange(steps + 1) + 0.3
    states = np.empty((steps + 1, 2 * len(found.structure.coordinates)))
    states[0] = found.start(pitches[0])
    found.advance(pitches, no_inputs(pitches), states)
    return pitches, states


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def test_rigid_shafts_turn_in_the_ratio_of_the_teeth_and_torques_balance_on_them() -> None:
    structure = two_stages()
    turning = dict(zip(structure.coordinates, rigid_rotation(structure), strict=True))
    assert turning["theta_3"] == pytest.approx(18 / 47)
    assert turning["theta_l"] == pytest.approx((18 / 47) ** 2)
    assert structure.torque_vector @ rigid_rotation(structure) == pytest.approx(0.0, abs=1e-12)
    for mesh in structure.meshes:
        assert mesh.vector @ rigid_rotation(structure) == pytest.approx(0.0, abs=1e-15)


def test_each_mesh_carries_the_torque_of_its_shaft() -> None:
    """At rest the force is torque over base radius: of the second mesh the ratio times that of the first."""
    found = motion(PairMotion, two_stages(), law(), law())
    expected = TORQUE / BASE_RADIUS_1 * np.array([1.0, RATIO])
    assert found.equations.static_force == pytest.approx(expected, rel=1e-9)
    at_rest = found.internals(found.start(0.3)[None], np.array([0.3]))[0]
    values = dict(zip(found.internal_names, at_rest, strict=True))
    assert [values["first_mesh_force_n"], values["second_mesh_force_n"]] == pytest.approx(expected, rel=1e-6)


def test_a_shaft_too_heavy_to_move_parts_both_stages() -> None:
    """Then the first stage is one whose gear stands still: no mesh sees the other."""
    _, states = run(motion(ExponentialMotion, two_stages(heavy=1e6), contact_law(), contact_law()), 4000)
    stage = make_stage()
    gear = replace(stage.gear, mass_kg=1e6 * stage.gear.mass_kg, inertia_kg_m2=1e6 * stage.gear.inertia_kg_m2)
    alone = eight_dof(replace(stage, gear=gear))
    _, expected = run(motion(ExponentialMotion, alone, contact_law()), 4000)
    both, one = two_stages().coordinates, alone.coordinates
    for name in ("x_1", "y_1", "theta_1"):
        rate, wanted = states[:, len(both) + both.index(name)], expected[:, len(one) + one.index(name)]
        # what is left is the shaft's motion: one over how much heavier it is, times a stiffness ratio of about ten
        assert rms(rate - wanted) < 1e-5 * rms(wanted)


@pytest.mark.parametrize("kind", [ExponentialMotion, PairMotion])
def test_a_whole_second_stage_shakes_the_first_one(kind: type[PairMotion]) -> None:
    """The same with a shaft of steel: the second mesh's line stands in the first one's bearing."""
    _, states = run(motion(kind, two_stages(), contact_law(), contact_law()), 16384)
    structure = two_stages()
    vibration = states[:-1, len(structure.coordinates) + structure.coordinates.index("y_1")]
    spectrum = np.abs(np.fft.rfft((vibration - vibration.mean()) * np.hanning(vibration.size)))
    hz = np.fft.rfftfreq(vibration.size, STEP)
    line = 540.0 * 18 / 47
    floor = np.median(spectrum[(hz > 0.5 * line) & (hz < 1.5 * line)])
    assert spectrum[np.abs(hz - line).argmin()] > 10.0 * floor


def test_both_integrators_agree_with_friction_in_both_meshes() -> None:
    """Runge-Kutta steps of a quarter serve as reference; the exponential steps follow it as with one mesh."""
    rubbing = contact_law(friction=constant_friction(0.05))
    structure = locked_load(two_stages())
    fine = motion(PairMotion, structure, rubbing, rubbing, step_s=STEP / 4)
    _, wanted = run(fine, 16000, STEP / 4)
    _, found = run(motion(ExponentialMotion, structure, rubbing, rubbing), 4000)
    n = len(structure.coordinates)
    for mesh in structure.meshes:
        expected = wanted[::4, n:] @ mesh.vector
        assert rms(found[:, n:] @ mesh.vector - expected) < 1e-3 * rms(expected)


def test_the_rate_is_that_of_all_forces_by_hand() -> None:
    """M ẅ = -K w - C w' - sum over the meshes of p (N - F_s) + (r_0 + s r_1) F, with numpy from tables of pairs."""
    structure, rubbing = two_stages(), law(friction=constant_friction(0.05))
    found = motion(PairMotion, structure, rubbing, law(friction=constant_friction(0.03)))
    n, rng = len(structure.coordinates), np.random.default_rng(3)
    state = found.start(0.3) + rng.normal(0.0, 1.0, 2 * n) * np.repeat([1e-7, 1e-3], n)
    forces = -structure.stiffness @ state[:n] - structure.damping @ state[n:]
    for m, (mesh, pairs) in enumerate(zip(structure.meshes, found.pairs(state[None], np.array([0.3])), strict=True)):
        friction, position = pairs[0, :, FRICTION], pairs[0, :, POSITION]
        forces -= mesh.vector * (pairs[0, :, NORMAL].sum() - found.equations.static_force[m])
        forces -= mesh.sliding[0] * friction.sum() + mesh.sliding[1] * (position * friction).sum()
    assert found.rate(state, 0.3)[n:] == pytest.approx(np.linalg.solve(structure.mass, forces), rel=1e-8)
