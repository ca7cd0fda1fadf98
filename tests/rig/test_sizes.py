"""Sizes that follow from the rated torque where a file leaves them out: drawn for every gearbox."""

from __future__ import annotations

from math import atan, cos, degrees, pi, radians, sqrt, tan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.drivetrain.gear_stage import GearStage
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from siggen.gearbox.specimen import OperatingPoint, Specimen
from siggen.keys.number import bounds
from siggen.names import Side
from siggen.record.structure import structure, supported_stage
from siggen.rig import sizes
from siggen.rig.bearings import LEAST_LIFE_H, life_h
from siggen.rig.rating import rated_torque_nm
from siggen.rig.rig import Rig, RigDesign
from siggen.rig.rig_numbers import rig_numbers
from siggen.rig.shafts import shaft_end_mm
from siggen.rig.sizes import Sizing
from tests.config.minimal import minimal

STEEL_KG_M3 = 7850.0
FIXED = {"torque_factor": 1.5, "shear_n_per_mm2": 20.0, "length_factor": 1.3, "series": 62.0, "damping_time_s": 1e-5}


def sized(rated_nm: Any = 60.0, dynamics: dict[str, Any] | None = None, **changes: Any) -> SetDesign:
    shafts: dict[str, Any] = {"driver": {}, "driven": {}}
    own = {"model": "casing", "shafts": shafts, "rated_torque_nm": rated_nm, **(dynamics or {})}
    return load_config(minimal(**{"dynamics": own, **changes}))


def made(monkeypatch: pytest.MonkeyPatch, **choices: float) -> None:
    """Let every maker choose the same."""
    monkeypatch.setattr(sizes, "SIZING", Sizing.model_validate(choices))


def stage(gearbox: Specimen) -> GearStage:
    assert gearbox.train is not None
    return gearbox.train.first


def diameters_m(gearbox: Specimen) -> tuple[float, float]:
    assert gearbox.train is not None
    assert gearbox.train.bending is not None
    first, second = (shaft.diameter_m for shaft in gearbox.train.bending)
    return first, second


@pytest.mark.parametrize(
    ("teeth", "module_mm", "rated_nm", "expected"),
    [
        ((18, 47), 3.0, 60.0, [(40, "6207", 0.94, 2.6e8, 2650), (50, "6209", 3.4, 2.7e8, 1420)]),
        ((23, 55), 2.0, 20.0, [(35, "6206", 0.64, 1.8e8, 2680), (40, "6207", 1.8, 1.9e8, 1660)]),
    ],
)
def test_two_small_gearboxes_have_the_shafts_and_bearings_that_were_sized_by_hand(
    teeth: tuple[int, int], module_mm: float, rated_nm: float, expected: list[tuple[float, ...]]
) -> None:
    """Made for what their gears bear, at 20 N/mm²; numbers have two digits, so 5 %, modes half of it and 2 %."""
    width_mm = 20.0 if module_mm == 3.0 else 16.0
    factor = rated_torque_nm(teeth, module_mm, width_mm) / rated_nm
    rig = Rig(teeth, module_mm, width_mm, (5.0, 40.0), (rated_nm,) * 2, design=RigDesign(factor, 20.0, 1.0, 62))
    for rotor, (diameter_mm, bearing, mass_kg, stiffness, mode_hz) in zip(
        rig_numbers(rig).rotors, expected, strict=True
    ):
        assert (rotor.shaft.diameter_mm, rotor.shaft.bearing.designation) == (diameter_mm, bearing)
        assert rotor.mass_kg == pytest.approx(mass_kg, rel=0.05)
        assert rotor.bearing_n_per_m == pytest.approx(stiffness, rel=0.05)
        assert sqrt(rotor.bearing_n_per_m / rotor.mass_kg) / (2.0 * pi) == pytest.approx(mode_hz, rel=0.045)


def test_rotors_are_steel_discs_on_their_shafts_and_couplings_are_damped_by_a_twentieth(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """By hand: a disc of the pitch circle around the shaft, and the shaft, longer than the distance of its bearings."""
    made(monkeypatch, **FIXED)
    design = sized()
    config, gearbox = design.config, design.gearbox(0)
    assert gearbox.train is not None
    assert gearbox.train.bending is not None
    gears = config.gears
    for rotor, wheel, shaft in zip(
        (stage(gearbox).pinion, stage(gearbox).gear), (gears.pinion, gears.gear), gearbox.train.bending, strict=True
    ):
        outer, inner = 0.5e-3 * gears.module_mm * wheel.teeth, 0.5 * shaft.diameter_m  # type: ignore[operator]
        disc = STEEL_KG_M3 * pi * (outer**2 - inner**2) * 1e-3 * gears.face_width_mm  # type: ignore[operator]
        rod = STEEL_KG_M3 * pi * inner**2 * 1.3 * shaft.span_m
        assert rotor.mass_kg == pytest.approx(disc + rod, rel=1e-12)
        assert rotor.inertia_kg_m2 == pytest.approx(0.5 * disc * (outer**2 + inner**2) + 0.5 * rod * inner**2)
    coupling, motor = config.dynamics.input_coupling, config.dynamics.motor_inertia_kg_m2
    pinion = stage(gearbox).pinion.inertia_kg_m2
    critical = 2.0 * sqrt(coupling.stiffness_nm_per_rad * motor * pinion / (motor + pinion))  # type: ignore[operator]
    assert coupling.damping_nm_s_per_rad == pytest.approx(0.05 * critical, rel=0.05)  # of a typical shaft


def test_twice_the_torque_is_twice_the_stiffness_of_couplings_and_more_of_bearings_by_a_third_power(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The same balls without clearance, in gears so light beside the load that weight is left out."""
    made(monkeypatch, clearance_um=0.0)
    thick = {"shafts": {wheel: {"diameter_mm": 30.0} for wheel in ("driver", "driven")}}
    one, two = (
        sized(rated, thick, operating_points=[{"speed_hz": 30.0, "torque_nm": rated}]) for rated in (60.0, 120.0)
    )
    ratio = (
        two.config.dynamics.input_coupling.stiffness_nm_per_rad  # type: ignore[operator]
        / one.config.dynamics.input_coupling.stiffness_nm_per_rad
    )
    assert ratio == pytest.approx(2.0)
    stiff = [_principal(supported_stage(each.gearbox(0)).gear.bearing) for each in (one, two)]
    assert stiff[1] / stiff[0] == pytest.approx([2 ** (1 / 3)] * 2, rel=0.01)  # a weight of 3 % of the load turns it


def _principal(bearing: Any) -> np.ndarray:
    x, y, xy = bearing.stiffness_x_n_per_m, bearing.stiffness_y_n_per_m, bearing.stiffness_xy_n_per_m
    return np.linalg.eigvalsh([[x, xy], [xy, y]])


def test_a_lightly_loaded_bearing_with_clearance_is_much_softer_and_one_with_preload_is_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    softer = []
    for play in (15.0, -5.0):
        made(monkeypatch, **FIXED, clearance_um=play)
        one = sized().gearbox(0)
        light, heavy = (supported_stage(one.under(OperatingPoint(30.0, torque))).pinion for torque in (1.0, 60.0))
        softer.append(_principal(light.bearing) / _principal(heavy.bearing))
    assert max(softer[0]) < (1 / 60) ** (1 / 3)  # beyond the law of Hertz: the zone of load narrows too
    assert min(softer[1]) > 0.5


def test_damping_follows_the_stiffness_of_the_bearing_at_every_load(monkeypatch: pytest.MonkeyPatch) -> None:
    made(monkeypatch, **FIXED)
    gearbox = sized().gearbox(0)
    for torque_nm in (5.0, 60.0):
        bearing = supported_stage(gearbox.under(OperatingPoint(30.0, torque_nm))).gear.bearing
        assert bearing.damping_x_n_s_per_m == pytest.approx(1e-5 * bearing.stiffness_x_n_per_m)
        assert bearing.damping_y_n_s_per_m == pytest.approx(1e-5 * bearing.stiffness_y_n_per_m)


def test_thickness_goes_with_the_third_root_of_torque_over_shear() -> None:
    """Torsion, by hand: 16 T/(pi d³) is the shear that is allowed; a gear's root circle of 1 mm asks for nothing."""
    thin = shaft_end_mm(60.0, 1.0, RigDesign(1.5, 20.0))
    assert 16e3 * 1.5 * 60.0 / (pi * thin**3) == pytest.approx(20.0)
    assert shaft_end_mm(60.0, 1.0, RigDesign(1.5 * 8.0, 20.0)) == pytest.approx(2.0 * thin)
    assert shaft_end_mm(60.0, 1.0, RigDesign(1.5, 20.0 / 8.0)) == pytest.approx(2.0 * thin)


@pytest.mark.parametrize("series", [60, 62, 63])
def test_balls_of_the_catalogue_last_and_stand_side_by_side_or_give_way_to_rollers(series: int) -> None:
    for speed_hz in (5.0, 40.0, 300.0):
        rig = Rig((18, 47), 3.0, 20.0, (speed_hz,) * 2, (60.0,) * 2, design=RigDesign(series=series))
        first, second = (rotor.shaft.bearing for rotor in rig_numbers(rig).rotors)
        assert first.outer_mm + second.outer_mm < 195.0
        assert first.rollers or life_h(first, 1182.0, speed_hz) >= LEAST_LIFE_H
        assert first.rollers or (first.balls, first.series) in ((11, 60), (9, 62), (8, 63))
    (slow, _) = rig_numbers(Rig((18, 47), 3.0, 20.0, (5.0,) * 2, (60.0,) * 2, design=RigDesign(series=series))).rotors
    assert slow.shaft.bearing.series == series


def test_two_gearboxes_of_one_set_ring_at_other_places_and_each_is_the_same_alone_and_in_its_set() -> None:
    design = sized(specimens=8)
    modes = [structure(design.gearbox(number)) for number in range(4)]
    lowest = [np.sort(np.linalg.eigvals(np.linalg.solve(one.mass, one.stiffness)).real)[2:8] for one in modes]
    apart = [abs(np.log(a / b)).max() for k, a in enumerate(lowest) for b in lowest[:k]]
    assert min(apart) > 0.02  # of the squared frequencies
    alone = sized(specimens=3)
    assert [diameters_m(design.gearbox(n)) for n in range(3)] == [diameters_m(alone.gearbox(n)) for n in range(3)]
    assert stage(design.gearbox(2)) == stage(alone.gearbox(2))
    assert len({diameters_m(design.gearbox(n)) for n in range(8)}) > 1


def test_all_gearboxes_lie_within_what_checks_take_for_possible() -> None:
    design = sized(specimens=40)
    possible = design.possible.dynamics
    assert possible.shafts is not None
    for number in range(40):
        gearbox = design.gearbox(number)
        for side in Side:
            low, high = bounds(getattr(possible, side).mass_kg)
            assert low <= getattr(stage(gearbox), side).mass_kg <= high
        for diameter_m, shaft in zip(
            diameters_m(gearbox), (possible.shafts.driver, possible.shafts.driven), strict=True
        ):
            low, high = bounds(shaft.diameter_mm)
            assert low <= 1e3 * diameter_m <= high


def test_bearings_are_labels_of_a_gearbox_that_draws_them() -> None:
    labels = {column.name: value for column, value in sized(specimens=8).gearbox(1).labels.items()}
    assert labels["bearing_pinion"][:2] in ("60", "62", "63")  # type: ignore[index]
    assert -5.0 <= labels["bearing_clearance_gear_um"] <= 15.0  # type: ignore[operator]
    given = sized(dynamics={role: {"bearing": {"stiffness_n_per_m": 1e8}} for role in ("pinion", "gear")}).gearbox(1)
    assert not [column for column in given.labels if column.name.startswith("bearing")]


def test_what_a_file_gives_stays_and_nothing_bends_without_shafts(monkeypatch: pytest.MonkeyPatch) -> None:
    made(monkeypatch, **FIXED)
    given = {"mass_kg": 0.5, "bearing": {"stiffness_n_per_m": 3e8}}
    design = sized(dynamics={"pinion": given, "load_inertia_kg_m2": 7.0, "shafts": None})
    gearbox, free = design.gearbox(0), sized(dynamics={"shafts": None}).gearbox(0)
    assert gearbox.train is not None
    assert gearbox.train.bending is None
    assert (stage(gearbox).pinion.mass_kg, stage(gearbox).load_inertia_kg_m2) == (0.5, 7.0)
    assert stage(gearbox).pinion.bearing.stiffness_x_n_per_m == 3e8
    assert stage(gearbox).pinion.bearing.damping_x_n_s_per_m == pytest.approx(3e3)  # the time that is drawn
    assert stage(gearbox).pinion.inertia_kg_m2 == stage(free).pinion.inertia_kg_m2
    assert [side for side, _ in gearbox.train.balls] == [Side.DRIVEN]


def test_a_given_span_is_kept_and_its_shaft_weighs_as_much(monkeypatch: pytest.MonkeyPatch) -> None:
    made(monkeypatch, **FIXED)
    longer = {"driver": {"bearing_span_mm": [150, 160]}, "driven": {}}
    one, two = sized().gearbox(3), sized(dynamics={"shafts": longer}).gearbox(3)
    assert one.train is not None
    assert two.train is not None
    assert one.train.bending is not None
    assert two.train.bending is not None
    before, after = one.train.bending[0], two.train.bending[0]
    assert 0.150 <= after.span_m <= 0.160
    more_kg = STEEL_KG_M3 * 0.25 * pi * after.diameter_m**2 * 1.3 * (after.span_m - before.span_m)
    assert stage(two).pinion.mass_kg - stage(one).pinion.mass_kg == pytest.approx(more_kg)


def test_helical_gears_have_the_pitch_circles_of_their_transverse_section() -> None:
    across = cos(radians(20.0))
    angle_deg = degrees(atan(tan(radians(20.0)) / across))
    spurs = {"gears__module_mm": 3.0 / across, "gears__pressure_angle_deg": angle_deg}
    helical, spur = (sized(**keys, states={"healthy": {}}).gearbox(0) for keys in ({"gears__helix_deg": 20.0}, spurs))
    assert stage(helical).gear.mass_kg == pytest.approx(stage(spur).gear.mass_kg)
    assert diameters_m(helical) == diameters_m(spur)
    assert stage(helical).gear.mass_kg > stage(sized().gearbox(0)).gear.mass_kg


def test_a_stored_configuration_leaves_out_what_gearboxes_draw_and_reads_the_same() -> None:
    config = sized()
    stored = config.config.canonical()
    assert stored["dynamics"]["pinion"]["mass_kg"] is None
    assert load_config(stored) == config
    elsewhere = load_config({**stored, "operating_points": [{"speed_hz": 3.0, "torque_nm": 9.0}]})
    assert stage(elsewhere.gearbox(0)) == stage(config.gearbox(0))


@pytest.mark.parametrize("by_option", [False, True])
def test_it_takes_the_place_of_the_sizes_of_a_file_that_is_extended(tmp_path: Path, *, by_option: bool) -> None:
    file = tmp_path / "mine.yaml"
    own = "" if by_option else "dynamics: {rated_torque_nm: 60}\n"
    file.write_text(f"extends: paper_b\nname: mine\n{own}")
    dynamics = load_config(file, ["dynamics.rated_torque_nm=60"] if by_option else []).config.dynamics
    paper = load_config("paper_b").config.dynamics
    assert (dynamics.pinion.mass_kg, paper.pinion.mass_kg) == (None, 1.0)
    assert dynamics.shafts is not None
    assert paper.shafts is not None
    assert dynamics.shafts.driven.diameter_mm is None
    assert dynamics.shafts.driven.gear_position == paper.shafts.driven.gear_position
    assert dynamics.friction == paper.friction


@pytest.mark.parametrize(
    ("path", "rated", "changes", "received", "allowed"),
    [
        ("dynamics.rated_torque_nm", -5.0, {}, "-5.0", "above 0"),
        ("dynamics.rated_torque_nm", "much", {}, "the text 'much'", "number"),
        ("dynamics.rated_torque_nm", 60.0, {"planetary": {"ring_teeth": 77}}, "60.0, beside planetary", "gears alone"),
        ("dynamics.rated_speed_hz", None, {
            "planetary": {"ring_teeth": 77}, "dynamics": {"rated_speed_hz": 30.0}
        }, "30.0, beside planetary", "gears alone"),
        ("dynamics.gear.bearing.damping_time_s", None, {
            "dynamics": {"gear": {"bearing": {"damping_time_s": 1e-5, "damping_n_s_per_m": 900.0}}}
        }, "1e-05, beside damping_n_s_per_m 900.0", "one of both"),
        ("dynamics.shafts.driver.diameter_mm", None, {
            "dynamics": {"shafts": {"driver": {"diameter_mm": None}}}
        }, "null", "beside dynamics.rated_torque_nm"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_at_its_key(
    path: str, rated: Any, changes: dict[str, Any], received: str, allowed: str
) -> None:
    with pytest.raises(ConfigError) as refused:
        sized(rated, **changes)
    (problem,) = [one for one in refused.value.problems if one.path == path]
    assert problem.received == received
    assert allowed in problem.allowed


def test_a_damping_over_stiffness_takes_the_place_of_the_default_damping_and_reads_the_same() -> None:
    config = sized(None, dynamics={"gear": {"bearing": {"stiffness_n_per_m": 1e8, "damping_time_s": 2e-5}}})
    assert stage(config.gearbox(0)).gear.bearing.damping_x_n_s_per_m == pytest.approx(2e3)
    assert load_config(config.config.canonical()) == config


def test_a_size_that_nobody_wrote_stands_at_the_rated_torque() -> None:
    possible = sized(dynamics={"gear": {"mass_kg": 4.0}}).possible
    assert possible.given("dynamics.pinion.mass_kg") == "dynamics.rated_torque_nm"
    assert possible.given("dynamics.shafts.driver.diameter_mm") == "dynamics.rated_torque_nm"
    assert possible.given("dynamics.gear.mass_kg") == "dynamics.gear.mass_kg"
    assert possible.given("gears.module_mm") == "gears.module_mm"


def test_a_state_changes_the_bearing_that_was_drawn_but_not_how_the_gearbox_was_made() -> None:
    def states(path: str) -> dict[str, Any]:
        worn = {"fault": "clearance", "severity": "slight", "changes": {path: {"add": 20.0}}}
        return {"healthy": {}, "loose": worn}

    path = "dynamics.pinion.bearing.geometry.clearance_um"
    gearbox = sized(states=states(path)).gearbox(0)
    loose = gearbox.in_state(1)
    assert gearbox.train is not None
    assert loose.train is not None
    before, after = (one.train.balls[0][1].clearance_m for one in (gearbox, loose) if one.train)
    assert after - before == pytest.approx(20e-6)
    assert stage(loose).pinion.mass_kg == stage(gearbox).pinion.mass_kg
    assert loose.labels == gearbox.labels  # a label of the gearbox does not tell the state
    with pytest.raises(ConfigError, match=r"dynamics\.rated_torque_nm"):
        sized(states=states("dynamics.rated_torque_nm"))
