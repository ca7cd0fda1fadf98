"""Sizes that follow from the rated torque where a file leaves them out."""

from __future__ import annotations

from math import atan, cos, degrees, pi, radians, sqrt, tan
from pathlib import Path
from typing import Any

import pytest

from siggen.checks.loading import load_config
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from siggen.keys.number import bounds
from tests.config.minimal import minimal

STEEL_KG_M3 = 7850.0


def sized(rated_nm: Any = 60.0, dynamics: dict[str, Any] | None = None, **changes: Any) -> SetDesign:
    shafts = {"driver": {}, "driven": {}}
    own = {"model": "casing", "shafts": shafts, "rated_torque_nm": rated_nm, **(dynamics or {})}
    return load_config(minimal(**{"dynamics": own, **changes}))


def test_rotors_are_steel_discs_on_their_shafts_and_couplings_are_damped_by_a_twentieth() -> None:
    """By hand: a disc of the pitch circle around the shaft, and the shaft between its bearings."""
    config = sized()
    dynamics, gears, shafts = config.config.dynamics, config.config.gears, config.config.dynamics.shafts
    assert shafts is not None
    for rotor, wheel, shaft in (
        (dynamics.pinion, gears.pinion, shafts.driver),
        (dynamics.gear, gears.gear, shafts.driven),
    ):
        outer, inner = 0.5e-3 * gears.module_mm * wheel.teeth, 0.5e-3 * shaft.diameter_mm  # type: ignore[operator]
        disc = STEEL_KG_M3 * pi * (outer**2 - inner**2) * 1e-3 * gears.face_width_mm  # type: ignore[operator]
        rod = STEEL_KG_M3 * pi * inner**2 * 1e-3 * shaft.bearing_span_mm  # type: ignore[operator]
        assert rotor.mass_kg == pytest.approx(disc + rod, rel=6e-3)  # three digits
        inertia = 0.5 * disc * (outer**2 + inner**2) + 0.5 * rod * inner**2
        assert rotor.inertia_kg_m2 == pytest.approx(inertia, rel=6e-3)
        low, high = bounds(rotor.bearing.stiffness_n_per_m)
        assert high / low == pytest.approx(1.33 / 0.75, rel=0.01)
    coupling, motor, pinion = dynamics.input_coupling, dynamics.motor_inertia_kg_m2, dynamics.pinion.inertia_kg_m2
    critical = 2.0 * sqrt(coupling.stiffness_nm_per_rad * motor * pinion / (motor + pinion))  # type: ignore[operator]
    assert coupling.damping_nm_s_per_rad == pytest.approx(0.05 * critical, rel=0.02)


def test_twice_the_torque_is_twice_the_stiffness_of_couplings_and_more_of_bearings_by_a_third_power() -> None:
    thick = {"shafts": {wheel: {"diameter_mm": 30.0} for wheel in ("driver", "driven")}}
    one, two = (sized(rated, thick).config.dynamics for rated in (60.0, 120.0))
    ratio = two.input_coupling.stiffness_nm_per_rad / one.input_coupling.stiffness_nm_per_rad  # type: ignore[operator]
    assert ratio == pytest.approx(2.0)
    stiff = [bounds(each.gear.bearing.stiffness_n_per_m)[0] for each in (one, two)]
    assert stiff[1] / stiff[0] == pytest.approx(2 ** (1 / 3), rel=0.01)  # Hertz, of the same balls


def test_what_a_file_gives_stays_and_nothing_bends_without_shafts() -> None:
    given = {"mass_kg": 0.5, "bearing": {"stiffness_n_per_m": 3e8}}
    dynamics = sized(dynamics={"pinion": given, "load_inertia_kg_m2": 7.0, "shafts": None}).config.dynamics
    assert (dynamics.pinion.mass_kg, dynamics.load_inertia_kg_m2, dynamics.shafts) == (0.5, 7.0, None)
    assert dynamics.pinion.bearing.stiffness_n_per_m == 3e8
    assert dynamics.pinion.bearing.damping_n_s_per_m == sized().config.dynamics.pinion.bearing.damping_n_s_per_m
    assert dynamics.pinion.inertia_kg_m2 == sized().config.dynamics.pinion.inertia_kg_m2


def test_helical_gears_have_the_pitch_circles_of_their_transverse_section() -> None:
    across = cos(radians(20.0))
    angle_deg = degrees(atan(tan(radians(20.0)) / across))
    helical = sized(gears__helix_deg=20.0, states={"healthy": {}}).config.dynamics
    spur = sized(
        gears__module_mm=3.0 / across, gears__pressure_angle_deg=angle_deg, states={"healthy": {}}
    ).config.dynamics
    assert (helical.gear, helical.shafts) == (spur.gear, spur.shafts)
    assert helical.gear.mass_kg > sized().config.dynamics.gear.mass_kg  # type: ignore[operator]


def test_a_stored_configuration_holds_the_numbers_and_reads_the_same() -> None:
    config = sized()
    assert load_config(config.canonical()) == config
    assert load_config(
        {**config.canonical(), "operating_points": [{"speed_hz": 5.0, "torque_nm": 9.0}]}
    ).config.dynamics == (config.config.dynamics)


@pytest.mark.parametrize("by_option", [False, True])
def test_it_takes_the_place_of_the_sizes_of_a_file_that_is_extended(tmp_path: Path, *, by_option: bool) -> None:
    file = tmp_path / "mine.yaml"
    own = "" if by_option else "dynamics: {rated_torque_nm: 60}\n"
    file.write_text(f"extends: bench\nname: mine\n{own}")
    dynamics = load_config(file, ["dynamics.rated_torque_nm=60"] if by_option else []).config.dynamics
    bench = load_config("bench").config.dynamics
    assert dynamics.pinion.mass_kg == pytest.approx(0.94, abs=0.1)
    assert bench.pinion.mass_kg == 1.0
    assert dynamics.shafts is not None
    assert bench.shafts is not None
    assert bounds(dynamics.shafts.driven.diameter_mm)[0] == bounds(dynamics.shafts.driven.diameter_mm)[1]
    assert dynamics.shafts.driven.gear_position == bench.shafts.driven.gear_position
    assert dynamics.friction == bench.friction


@pytest.mark.parametrize(
    ("rated", "changes", "received", "allowed"),
    [
        (-5.0, {}, "-5.0", "above 0"),
        ("much", {}, "the text 'much'", "number"),
        (60.0, {"planetary": {"ring_teeth": 77}}, "60.0, beside planetary", "allowed with gears alone"),
    ],
)
def test_what_cannot_be_is_refused_at_its_key(rated: Any, changes: dict[str, Any], received: str, allowed: str) -> None:
    with pytest.raises(ConfigError) as refused:
        sized(rated, **changes)
    (problem,) = [one for one in refused.value.problems if one.path == "dynamics.rated_torque_nm"]
    assert problem.received == received
    assert allowed in problem.allowed
