"""Two stages in a rigid casing: on hard bolts it is the ground, and it feels all bearings together."""

from __future__ import annotations

from math import cos, pi, radians, sin
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh

from siggen.config import parse
from siggen.drivetrain.drivetrain import PLANE, Drivetrain
from siggen.drivetrain.makers import GROUND
from siggen.drivetrain.structure import Structure, matrices, static_solution
from siggen.gearbox.design import SetDesign
from siggen.motion.equations import mesh_springs
from siggen.motion.modes import natural_modes
from siggen.record.structure import axis_places_m, specimen_body, structure
from tests.config.staged import SLOW, staged

MESH = np.array([3e8, 5e8])
HARD = {"shear_stiffness_n_per_m": 1e16, "axial_stiffness_n_per_m": 1e16}


def built(model: str, **housing: Any) -> Structure:
    more = {"housing": {"kind": "rigid", **housing}} if model == "casing" else {}
    raw = staged(dynamics={"model": model}, stages=[{**SLOW, "direction_deg": 35.0}], **more)
    parsed = parse(raw)
    assert parsed.config is not None, parsed.problems
    return structure(SetDesign(parsed.config).gearbox(0))


def at_rest(found: Structure, torque_nm: float = 20.0) -> np.ndarray:
    loaded = found.stiffness + mesh_springs(found, MESH)
    return np.asarray(static_solution(found, loaded, found.torque_vector * torque_nm))


def test_a_casing_on_hard_bolts_is_the_ground_seen_in_a_mirror() -> None:
    """Horizontal runs from the first pinion to its gear on the ground, and back in a casing."""
    ground, casing = built("8dof"), built("casing", bolts=HARD)
    expected, found = (dict(zip(one.coordinates, at_rest(one), strict=True)) for one in (ground, casing))
    for name, value in expected.items():
        sign = -1.0 if name.startswith("x_") else 1.0
        assert found[name] == pytest.approx(sign * value, rel=1e-6, abs=1e-12), name
    for place, (pushing, _) in ground.bearing_forces.items():
        sign = -1.0 if place.endswith("horizontal") else 1.0
        force = casing.bearing_forces[place][0] @ at_rest(casing)
        assert force == pytest.approx(sign * (pushing @ at_rest(ground)), rel=1e-6)


def test_bolts_carry_what_all_shafts_press_with() -> None:
    """Meshes are forces inside the casing: bearings of all shafts press with the moment of motor and load alone.

    Moments count as the first pinion turns, from vertical to horizontal; the load's shaft turns as that does.
    """
    found, torque_nm = built("casing"), 20.0
    rest, places = at_rest(found), dict.fromkeys(name.split("/")[0] for name in found.bearing_forces)
    forces = {name: float(row @ rest) for name, (row, _) in found.bearing_forces.items()}
    largest = max(abs(force) for force in forces.values())
    for axis in ("horizontal", "vertical"):
        assert abs(sum(forces[f"{place}/{axis}"] for place in places)) < 1e-9 * largest
    parsed = parse(staged(stages=[{**SLOW, "direction_deg": 35.0}]))
    assert parsed.config is not None
    axes = axis_places_m(SetDesign(parsed.config).gearbox(0))
    moment = sum(
        axes[place][1] * forces[f"{place}/horizontal"] - axes[place][0] * forces[f"{place}/vertical"]
        for place in places
    )
    loaded = torque_nm * (47 / 18) * (52 / 17)
    assert moment == pytest.approx(torque_nm - loaded, rel=1e-9)


def test_the_modes_of_a_rigid_casing_make_the_same_machine() -> None:
    rigid = staged(dynamics={"model": "casing"}, housing={"kind": "rigid"}, stages=[{**SLOW, "direction_deg": 35.0}])
    parsed = parse(rigid)
    assert parsed.config is not None, parsed.problems
    specimen = SetDesign(parsed.config).gearbox(0)
    body = specimen_body(specimen)
    alone = Drivetrain((body.body, GROUND), body.bolts)
    mass, _, stiffness = matrices(alone)
    values, shapes = eigh(stiffness, mass)
    seats = {f"{name}/{along}": alone.row(seat, along) for name, seat in body.seats.items() for along in PLANE}
    columns = {
        "frequency_hz": np.sqrt(values) / (2.0 * pi),
        "damping_ratio": np.full(3, 0.04),
        **{f"{name.replace('/', '_')}_per_sqrt_kg": row @ shapes for name, row in seats.items()},
    }
    rows = zip(*columns.values(), strict=True)
    text = "\n".join([",".join(columns), *(",".join(repr(float(x)) for x in row) for row in rows), ""])
    modal = parse({**rigid, "housing": {"kind": "modal", "modes": text}})
    assert modal.config is not None, modal.problems
    first, second = (structure(SetDesign(config).gearbox(0)) for config in (parsed.config, modal.config))
    expected, found = (natural_modes(one, MESH).frequency_hz for one in (first, second))
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-6)
    assert "slow_shaft/vertical" in second.motions


def test_shafts_stand_at_their_centre_distances_in_their_directions() -> None:
    parsed = parse(staged(stages=[{**SLOW, "direction_deg": 35.0}]))
    assert parsed.config is not None
    places = axis_places_m(SetDesign(parsed.config).gearbox(0))
    first, second = 1e-3 * 2.0 * (18 + 47) / 2, 1e-3 * 3.0 * (17 + 52) / 2
    pinion, gear, last = (np.array(places[f"{name}_bearing"]) for name in ("pinion", "gear", "slow"))
    assert gear - pinion == pytest.approx([-first, 0.0])
    assert last - gear == pytest.approx([-second * cos(radians(35.0)), second * sin(radians(35.0))])
