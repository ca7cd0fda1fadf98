"""Shafts that cannot be: refused with key, value and what is allowed."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import yaml

from siggen.checks.loading import load_config
from siggen.checks.notes import shaft_notes
from siggen.checks.tilt_problems import flank_tilts, static_tilt_rad
from siggen.columns.record import RecordFailure, SimulatedRecord
from siggen.errors import ConfigError
from siggen.gearbox.specimen import Specimen
from siggen.names import Side
from siggen.record.motion import specimen_motion
from siggen.record.specimen_state import specimen_state
from tests.config.minimal import minimal
from tests.simulated import simulate

ROOT = Path(__file__).resolve().parents[2]


def with_shafts(model: str = "casing", **pinion: float) -> dict[str, object]:
    return minimal(dynamics={"model": model, "shafts": {"driver": pinion}})


@pytest.mark.parametrize(
    ("pinion", "key", "words"),
    [
        ({"bearing_span_mm": 0.0}, "bearing_span_mm", "above 0"),
        ({"bearing_span_mm": 1e6}, "bearing_span_mm", "2000"),
        ({"diameter_mm": 3.0}, "diameter_mm", "at least 5"),
        ({"bearing_span_mm": 15.0}, "bearing_span_mm", "bearings beside the gear"),
        ({"gear_position": 1.0}, "gear_position", "below 1"),
        ({"gear_position": 0.01}, "bearing_span_mm", "bearings beside the gear"),
        ({"diameter_mm": 200.0}, "diameter_mm", "root diameter of its gear"),
    ],
)
def test_impossible_shafts_are_refused_by_key(pinion: dict[str, float], key: str, words: str) -> None:
    with pytest.raises(ConfigError) as refused:
        load_config(with_shafts(**pinion))
    assert f"dynamics.shafts.driver.{key}" in str(refused.value)
    assert words in str(refused.value)


def test_models_without_a_casing_have_no_shafts_that_bend() -> None:
    with pytest.raises(ConfigError, match=r"dynamics\.shafts"):
        load_config(with_shafts(model="8dof"))


def test_no_section_and_the_default_have_the_same_identity() -> None:
    assert load_config(minimal()).identity == load_config(minimal(dynamics={"shafts": None})).identity
    assert load_config(with_shafts()).identity != load_config(minimal()).identity


def test_a_law_that_feels_no_tilt_is_refused() -> None:
    with pytest.raises(ConfigError, match=r"dynamics\.mesh\.law: pairs, whose contact feels a tilt"):
        load_config(minimal(dynamics={"model": "casing", "shafts": {}, "mesh": {"law": "linear"}}))


def test_plan_says_what_limits_shafts() -> None:
    assert not any("outside_model" in note for note in shaft_notes(load_config(minimal()).possible))
    assert any("outside_model" in note for note in shaft_notes(load_config(with_shafts()).possible))


@pytest.mark.parametrize("helix_deg", [0.0, 12.0, -12.0])
def test_the_tilt_of_plan_is_that_of_the_motion(helix_deg: float) -> None:
    # The closed form of the check against the static state of the assembled gearbox. Without friction, which takes some
    # 0.3 % of the torque off the load and which the check leaves out.
    uneven = with_shafts(gear_position=0.42, bearing_span_mm=120.0)
    smooth = {**uneven["dynamics"], "friction": {"model": "off"}}
    gears = {**uneven["gears"], "helix_deg": helix_deg}
    healthy = {"gears": gears, "dynamics": smooth, "states": {"healthy": {}}}
    config = load_config(uneven | healthy)
    config = load_config(config.canonical() | {"operating_points": [{"speed_hz": 20.0, "torque_nm": 45.0}]})
    specimen = config.gearbox(0)
    state = specimen_state(specimen, 0)
    motion = specimen_motion(specimen.law, state.mesh, config.drawn_points(0)[0], 1e-5)
    found = drawn_tilt_rad(specimen, 45.0)
    assert abs(found) > 1e-6
    assert found == pytest.approx(motion.pair_equations.static[0, 2], rel=1e-9)


@pytest.mark.parametrize(
    "pinion",
    [
        {"diameter_mm": 8.0, "bearing_span_mm": 200.0, "gear_position": 0.2},
        {"diameter_mm": 5.0, "gear_position": 0.3},
    ],
)
def test_shafts_that_tilt_beyond_the_model_under_the_steady_torque_are_refused_with_what_would_do(
    pinion: dict[str, float], tmp_path: Path
) -> None:
    file = tmp_path / "soft.yaml"
    file.write_text(yaml.safe_dump(with_shafts(**pinion), sort_keys=False))
    line = next(n for n, text in enumerate(file.read_text().splitlines(), 1) if "diameter_mm" in text)
    with pytest.raises(ConfigError, match=r"allowed: a tilt of at most \d+ urad") as refused:
        load_config(file)
    told = str(refused.value)
    assert f"dynamics.shafts.driver.diameter_mm: received {pinion['diameter_mm']}" in told
    assert f"(line {line})" in told
    thick = float(re.search(r"from ([\d.]+) mm on", told).group(1))
    load_config(with_shafts(**pinion | {"diameter_mm": thick}))
    with pytest.raises(ConfigError, match=rf"driver\.diameter_mm: received {thick - 0.2:.4g}.* from {thick:g} mm on"):
        load_config(with_shafts(**pinion | {"diameter_mm": round(thick - 0.2, 6)}))


def test_soft_shafts_are_refused_though_some_gearboxes_have_their_gear_in_the_middle() -> None:
    around = [0.4, 0.6]
    with pytest.raises(ConfigError, match=r"driver.diameter_mm: received 5.0.* from [\d.]+ mm on"):
        load_config(with_shafts(diameter_mm=5.0, bearing_span_mm=140.0, gear_position=around))


def drawn_tilt_rad(specimen: Specimen, torque_nm: float) -> float:
    train, rotors = specimen.train, (specimen.train.first.pinion, specimen.train.first.gear)
    each = zip(train.bending, rotors, Side, strict=True)
    return sum(static_tilt_rad(shaft, rotor.bearing, specimen.pair, role, torque_nm) for shaft, rotor, role in each)


@pytest.mark.parametrize("which", ["bench", "industrial", "quickstart", "paper_b"])
def test_presets_stay_within_the_tilt_of_the_model(which: str) -> None:
    # By the drawn gearboxes, where the check takes places at equal shares: half of them at least have room.
    config = load_config(ROOT / "configs" / f"{which}.yaml")
    gearbox, rooms = config.possible, []
    for number in range(9):
        specimen = config.gearbox(number)
        tilt_rad = drawn_tilt_rad(specimen, gearbox.largest_torque_nm)
        rooms.append(abs(tilt_rad) / flank_tilts(gearbox, specimen.pair).limit_rad)
    assert 0.0 < np.median(rooms) < 1.0


def in_motion(**pinion: float) -> SimulatedRecord | RecordFailure:
    askew = {"accuracy_class": 6, "lead_misalignment_um": 30.0}
    config = load_config(with_shafts(**pinion) | {"fs_hz": 25600.0, "duration_s": 0.05, "manufacture": askew})
    return simulate(config, [0])[0]


def test_shafts_that_are_too_soft_end_a_record_with_a_reason() -> None:
    failure = in_motion(diameter_mm=5.0, bearing_span_mm=400.0)
    assert isinstance(failure, RecordFailure)
    assert failure.status == "outside_model"
    assert "a gear moves by" in failure.reason
    assert "dynamics.shafts" in failure.reason


def test_a_face_pushed_askew_until_it_rests_on_one_end_is_no_reason_to_lose_a_record() -> None:
    assert isinstance(in_motion(diameter_mm=14.0), SimulatedRecord)


def test_a_tilt_in_motion_at_which_an_end_of_the_face_meets_the_other_flank_is_refused() -> None:
    config = load_config(with_shafts())
    specimen = config.gearbox(0)
    state = specimen_state(specimen, 0)
    motion = specimen_motion(specimen.law, state.mesh, config.drawn_points(0)[0], 1e-5)
    turn = motion.structure.mesh.tilt
    room_m = motion.law.backlash_m + motion.pair_equations.static[0, 1]
    for share, refused in ((0.99, False), (1.01, True)):
        states = np.zeros((2, 2 * turn.size))
        states[1, : turn.size] = share * room_m / motion.law.half_face_m * turn / (turn @ turn)
        approach = states[1, : turn.size] @ motion.equations.mesh_vector[0]
        assert abs(approach) < 1e-9 * room_m
        if not refused:
            motion.refuse_outside(states)
            continue
        with pytest.raises(ValueError, match="where an end of the face meets the other flank"):
            motion.refuse_outside(states)
