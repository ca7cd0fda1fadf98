"""Torques of 0 and below: a gearbox that is its own mirror image, idle flanks, and damage that nothing touches."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.arrays import FloatArray
from siggen.config import parse
from siggen.drivetrain.drivetrain import Modes
from siggen.gearbox.design import SetDesign
from siggen.gearbox.specimen import OperatingPoint
from siggen.record.motion import specimen_motion
from siggen.record.specimen_state import SpecimenState, specimen_state
from siggen.record.structure import specimen_body
from tests.config.minimal import minimal

EVEN = {"bearing": {"stiffness_n_per_m": {"each": [1.6e8, 2e8]}}, "mass_kg": 1.2}
STEP_S, STEPS = 1.0 / 51_200.0, 2_000


SHAFT = {"bearing_span_mm": 100.0, "gear_position": 0.45, "diameter_mm": 25.0}
HOUSED = {"model": "casing", "shafts": {"driver": SHAFT, "driven": SHAFT}}
"""In a box of plates, on shafts that tilt. Round equal gears and bearings the box is its own mirror image too."""


def own_mirror(friction: str = "off", *, housed: bool = False) -> SetDesign:
    """Return a gearbox of two equal gears on equal shafts: with the gear in front it is itself."""
    dynamics = {
        "model": "8dof",
        "pinion": EVEN,
        "gear": EVEN,
        "motor_inertia_kg_m2": 4e-3,
        "load_inertia_kg_m2": 4e-3,
        "input_coupling": {"stiffness_nm_per_rad": 6e3, "damping_nm_s_per_rad": 0.1},
        "output_coupling": {"stiffness_nm_per_rad": 6e3, "damping_nm_s_per_rad": 0.1},
        "backlash_um": 80.0,
        "mesh": {"law": "pairs", "damage": "geometry", "tip_relief_um": 8.0},
        "friction": {"model": friction},
    }
    parsed = parse(
        minimal(
            gears__pinion__teeth=25,
            gears__gear={"teeth": 25, "bore_radius_mm": 10.0},
            dynamics=dynamics | (HOUSED if housed else {}),
            housing={},
        )
    )
    assert parsed.config is not None, [str(problem) for problem in parsed.problems]
    return SetDesign(parsed.config)


def state_of(config: SetDesign, state_id: int = 0) -> SpecimenState:
    return specimen_state(config.gearbox(0), state_id)


def moved(config: SetDesign, state: SpecimenState, torque_nm: float, internals: bool = False) -> FloatArray:
    """Return states (k, 2n) from rest, or internals (k, names), with the mesh law at the same angles."""
    law = config.gearbox(0).law
    motion = specimen_motion(law, state.mesh, OperatingPoint(30.0, torque_nm), STEP_S)
    pitches = 0.4 + 25 * 30.0 * STEP_S * np.arange(STEPS + 1)
    states = np.empty((STEPS + 1, 2 * len(motion.structure.coordinates)))
    states[0] = motion.start(pitches[0])
    motion.advance(pitches, np.empty((pitches.size, 0)), states)
    return motion.internals(states, pitches) if internals else states


def mirror(config: SetDesign, state: SpecimenState) -> FloatArray:
    """Return (n, n): what both sides' exchange makes of displacements, by a mirror across the centre line."""
    stage = state.mesh.structure
    other = {"motor": "load", "load": "motor", "pinion": "gear", "gear": "pinion"}
    names, reflected = (
        list(stage.coordinates),
        np.diag([-1.0, 1.0]),  # gears stand beside each other
    )
    found = np.zeros((len(names), len(names)))
    for i, name in enumerate(names):
        kind, _, side = name.rpartition("_")
        if kind == "theta":
            found[names.index(f"theta_{other[side]}"), i] = 1.0
        elif not name.startswith("eta"):
            for j, axis in enumerate("xy"):
                to = names.index(f"{kind[:-1]}{axis}_{other[side]}")
                found[to, i] = reflected[j, "xy".index(kind[-1])]
    if "eta_1" in names:
        modes = specimen_body(config.gearbox(0)).body
        for name, sign in zip(modes.coordinates, signs_in_mirror(modes), strict=True):
            found[names.index(name), names.index(name)] = sign
    return found


def signs_in_mirror(modes: Modes) -> list[float]:
    """Return of each mode 1 if both seats rise together and part, -1 if neither; nothing else is left by the mirror."""
    signs = []
    for number in range(len(modes.frequency_hz)):
        shape = {
            axis: [float(modes.shapes[f"{g}_bearing/{axis}"][number]) for g in ("pinion", "gear")]
            for axis in ("vertical", "horizontal")
        }
        larger = max(abs(value) for pair in shape.values() for value in pair)
        sign = float(np.sign(np.prod(shape["vertical"]) - np.prod(shape["horizontal"])))
        assert shape["vertical"][1] == pytest.approx(sign * shape["vertical"][0], abs=1e-9 * larger)
        assert shape["horizontal"][1] == pytest.approx(-sign * shape["horizontal"][0], abs=1e-9 * larger)
        signs.append(sign)
    return signs


def in_the_mirror(states: FloatArray, image: FloatArray) -> FloatArray:
    """Return states with both sides exchanged."""
    n = len(image)
    return np.concatenate([states[:, :n] @ image.T, states[:, n:] @ image.T], axis=1)


def apart(one: FloatArray, other: FloatArray) -> float:
    """Return by how much velocities differ, over their size."""
    n = one.shape[1] // 2
    return float(np.sqrt(((one - other)[:, n:] ** 2).sum() / (other[:, n:] ** 2).sum()))


@pytest.mark.parametrize("housed", [False, True])
def test_a_gearbox_that_is_its_own_mirror_image_moves_in_it_under_the_opposite_torque(housed: bool):
    """Exact but for rounding: 5e-13 in a housing. A mode of it with the wrong sign gives 1.6e-7 to 1e-2, a tilt 0.1."""
    config = own_mirror(housed=housed)
    state = state_of(config)
    forth, back = moved(config, state, 40.0), moved(config, state, -40.0)
    assert apart(in_the_mirror(back, mirror(config, state)), forth) < 1e-9
    # not the same motion by chance: without the mirror they differ by their own size
    assert apart(back, forth) > 0.5


def test_friction_brakes_back_flanks_as_it_brakes_drive_flanks():
    """But for what holds the mean speed, the load in both cases, which the mirror makes a motor: friction's torque."""
    config, smooth = own_mirror("mixed_ehl"), own_mirror()
    state, without = state_of(config), state_of(smooth)
    forth, back = moved(config, state, 40.0), moved(config, state, -40.0)
    rubbed = apart(moved(smooth, without, 40.0), forth)
    assert apart(in_the_mirror(back, mirror(config, state)), forth) < 0.2 * rubbed


def test_both_torques_push_the_gears_apart_and_turn_them_against_each_other():
    config = own_mirror()
    state = state_of(config)
    law = config.gearbox(0).law
    for torque_nm in (40.0, -40.0):
        motion = specimen_motion(law, state.mesh, OperatingPoint(30.0, torque_nm), STEP_S)
        at = dict(zip(motion.structure.coordinates, motion.equations.static_deflection, strict=True))
        force_n = abs(torque_nm) / state.pair.pinion.base_radius_m
        apart = force_n * np.sin(state.pair.working_pressure_angle_rad) / 1.6e8
        up = np.sign(torque_nm) * force_n * np.cos(state.pair.working_pressure_angle_rad) / 2e8
        assert (at["x_pinion"], at["x_gear"]) == pytest.approx((-apart, apart), rel=1e-9)
        assert (at["y_pinion"], at["y_gear"]) == pytest.approx((-up, up), rel=1e-9)


@pytest.mark.parametrize("torque_nm", [0.0, -25.0])
def test_internals_of_any_torque_are_told_for_the_drive_flanks(torque_nm: float):
    config = own_mirror()
    state = state_of(config)
    law = config.gearbox(0).law
    motion = specimen_motion(law, state.mesh, OperatingPoint(30.0, torque_nm), STEP_S)
    found = dict(zip(motion.internal_names, moved(config, state, torque_nm, internals=True).T, strict=True))
    assert np.isfinite(found["mesh_force_n"]).all()
    if torque_nm < 0.0:
        mean_n = torque_nm / state.pair.pinion.base_radius_m
        assert found["mesh_force_n"][-1000:].mean() == pytest.approx(mean_n, rel=0.05)
        assert found["approach_m"].max() < -80e-6
    else:
        # at rest between the flanks, where nothing pushes
        assert np.abs(found["mesh_force_n"]).max() < 1e-9


def test_damage_of_drive_flanks_is_not_met_under_a_torque_below_0():
    config = own_mirror()
    healthy, damaged = state_of(config, 0), state_of(config, 1)
    assert damaged.static.largest_loss(40.0) > 1e-3
    assert damaged.static.largest_loss(-40.0) == 0.0
    assert np.array_equal(moved(config, healthy, -40.0), moved(config, damaged, -40.0))
