"""Shafts and gears of further meshes that do not fit beside each other, names that are taken, and coaxial gearboxes."""

from __future__ import annotations

from typing import Any

import pytest

from siggen.checks.loading import load_config
from siggen.drivetrain.structure import static_solution
from siggen.errors import ConfigError, Problem
from siggen.motion.equations import mesh_springs
from siggen.record.structure import axis_places_m, structure
from tests.config.minimal import by_name
from tests.config.staged import SLOW, staged

HEALTHY = [{"name": "healthy"}]
THIN = {"pinion": {"teeth": 17, "bore_radius_mm": 10.0}, "gear": {"teeth": 35, "bore_radius_mm": 20.0}}
EQUAL = {**SLOW["gears"], **THIN, "module_mm": 2.5}
"""2.5 mm (17 + 35)/2 = 2 mm (18 + 47)/2."""


def one_more(**changes: Any) -> dict[str, Any]:
    return staged(stages=[{**SLOW, **changes}], states=by_name(HEALTHY))


def told(raw: dict[str, Any]) -> Problem:
    with pytest.raises(ConfigError) as refused:
        load_config(raw)
    (problem,) = refused.value.problems
    return problem


def test_gears_of_one_shaft_need_one_and_a_half_times_their_faces_between_its_bearings() -> None:
    """20 and 30 mm wide, at a third and at two thirds: they touch at (20 + 30)/2 = span/3."""
    problem = told(one_more(span_mm=[74.9, 160]))
    assert problem.path == "machine.shafts.gear.span_mm"
    assert problem.received == "74.9 mm for faces of 50 mm together"
    assert "at least 75 mm" in problem.allowed
    assert load_config(one_more(span_mm=75.0)).config.stages


@pytest.mark.parametrize(
    "gears", [{**EQUAL, "module_mm": 2.4}, {**EQUAL, "gear": {"teeth": 36, "bore_radius_mm": 20.0}}]
)
def test_axes_a_little_apart_are_refused(gears: dict[str, Any]) -> None:
    problem = told(one_more(direction_deg=180.0, gears=gears))
    assert problem.path == "machine.meshes.slow.direction_deg"
    apart_mm = abs(65.0 - 0.5 * gears["module_mm"] * (17 + gears["gear"]["teeth"]))
    assert f"the axis of slow_shaft stands {apart_mm:.4g} mm from that of pinion_shaft" in problem.received
    assert "at least 32 mm, the radii of both shafts" in problem.allowed
    assert load_config(one_more(direction_deg=120.0, gears=gears)).config.stages


def test_a_direction_that_is_drawn_is_refused_where_one_gearbox_could_not_be() -> None:
    problem = told(one_more(direction_deg=[150, 180], gears=EQUAL))
    assert "stands 0 mm" in problem.received or "e-" in problem.received


@pytest.mark.parametrize("direction_deg", [180.0, -180.0])
def test_a_coaxial_gearbox_stands_and_its_layshaft_alone_holds_the_casing_against_turning(direction_deg: float) -> None:
    """Both shafts of one axis have no arm about it: a force times the centre distance is the torque, in and out."""
    config = load_config({**one_more(direction_deg=direction_deg, gears=EQUAL), "dynamics": {"model": "8dof"}})
    specimen = config.gearbox(0)
    places = axis_places_m(specimen)
    assert places["slow_bearing"] == pytest.approx(places["pinion_bearing"], abs=1e-15)
    found, torque_nm = structure(specimen), 20.0
    loaded = found.stiffness + mesh_springs(found, [3e8, 5e8])
    rest = static_solution(found, loaded, torque_nm * found.torque_vector)
    forces = {name: float(row @ rest) for name, (row, _) in found.bearing_forces.items()}
    for axis in ("horizontal", "vertical"):
        assert sum(force for name, force in forces.items() if name.endswith(axis)) == pytest.approx(0.0, abs=1e-6)
    # The motor turns the shafts from x to y and the load back, as its shaft turns that way too.
    ratio = 47 * 35 / (18 * 17)
    assert 0.065 * forces["gear_bearing/vertical"] == pytest.approx(torque_nm * (1 - ratio), rel=1e-9)
