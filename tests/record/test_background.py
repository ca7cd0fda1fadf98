"""Records of a machine with a background: what states share, what is new, and how much of it arrives."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import Record, label_names
from siggen.config import Config
from siggen.dynamics.time.response_stream import Piece
from siggen.errors import ConfigError
from siggen.keys.number import constant
from siggen.planning.plan import planned_record
from siggen.planning.specimen import draw_specimen
from siggen.record.background import BackgroundBlocks
from siggen.record.background_course import course_at
from siggen.record.block_inputs import BlockInputs
from siggen.record.rubbing import RubbingForce, force_size_n
from siggen.record.simulation import simulate, simulate_specimen
from siggen.sensing.inputs import FLOOR
from siggen.sensing.spectral_filter import frequencies
from siggen.specimen.background import drawn_background
from siggen.specimen.background_numbers import RubbingNumbers
from siggen.specimen.instrument import Instrument, specimen_instrument
from tests.config.minimal import minimal

LID = {"name": "lid", "place": "casing", "axes": ["vertical"], "bits": None, "range_m_s2": 1e6}
MODAL = {**LID, "path": {"kind": "modal"}, "position_mm": [60.0, 50.0]}
PLAIN = {"name": "bearing", "bits": None, "range_m_s2": 1e6}
ALL: dict[str, Any] = {
    "base": {"mount_hz": 40.0},
    "rubbing": {"bursts": {}},
    "floor": {},
    "shafts": {},
    "second_stage": {"order": 4.13},
    "auxiliary_drive": {"order": {"kind": "uniform", "low": 12, "high": 60}, "shaft_order": 0.7},
}


def loaded(*sensors: dict[str, Any], **changes: Any) -> Config:
    changes = {"dynamics__model": "casing", "duration_s": 0.1, "specimens": 2, "housing": {}, **changes}
    return load_config(minimal(sensors=list(sensors or (MODAL, PLAIN)), **changes))


def record(config: Config, record_id: int = 0) -> Record:
    result = simulate(config, [record_id])[0]
    assert isinstance(result, Record), result
    return result


def added(config: Config, record_id: int = 0) -> tuple[dict[str, np.ndarray], dict[str, object]]:
    """Return what the background adds to every channel, and its labels."""
    planned = planned_record(config, record_id)
    specimen = draw_specimen(config, planned.specimen_id)
    instrument = specimen_instrument(config, specimen)
    inputs = BlockInputs(config, specimen, planned, Standstill(instrument), instrument)
    blocks = list(inputs.seen())
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}, inputs.labels


def rubbed(keys: dict[str, float], changes: dict[str, float], duration_s: float) -> tuple[Config, RubbingNumbers]:
    """Return a configuration with these keys, and what is drawn for its rubbing with some numbers changed."""
    config = loaded(background={"rubbing": keys}, duration_s=duration_s)
    drawn = drawn_background(config, 0)
    assert drawn is not None
    assert drawn.rubbing is not None
    return config, drawn.rubbing.model_copy(update=changes)


class Standstill:
    """A response at rest: what is left is the background."""

    def __init__(self, instrument: Instrument) -> None:
        self.motions = tuple(motion for channel in instrument.channels for motion in channel.motions)

    places: tuple[str, ...] = ()
    before = 0

    def pieces(self) -> Iterator[Piece]:
        return iter(())


def test_a_record_holds_the_gears_and_the_background_and_its_labels() -> None:
    config, without = loaded(background=ALL), loaded()
    found, clean = record(config), record(without)
    assert set(found.labels) == set(label_names(config))
    signals, labels = added(config)
    for name, signal in signals.items():
        expected = clean.channels[name].astype(float) + signal
        np.testing.assert_allclose(found.channels[name], expected, atol=1e-5 * np.abs(expected).max())
        assert signal.std() > 0.01
    assert {name: found.labels[name] for name in labels} == labels
    assert config.identity != without.identity


def test_states_share_levels_and_lines_but_not_the_course_of_the_noise() -> None:
    config = loaded(background=ALL)
    healthy, damaged = added(config, 0), added(config, 1)
    assert {k: v for k, v in healthy[1].items() if k != "burst_count"} == {
        k: v for k, v in damaged[1].items() if k != "burst_count"
    }
    assert not np.allclose(healthy[0]["lid_vertical"], damaged[0]["lid_vertical"])
    assert healthy[1]["coupling_force_pinion_n"] != healthy[1]["coupling_force_gear_n"]
    other = added(config, 2)[1]
    assert all(
        other[name] != healthy[1][name] for name in healthy[1] if name not in {"burst_count", "second_stage_order"}
    )


def test_levels_of_sensors_and_bearing_forces_belong_to_the_gearbox_unless_redrawn() -> None:
    drawn = {"kind": "uniform", "low": 0.1, "high": 0.2}
    noisy = {**MODAL, "noise": {"floor_m_s2": drawn}, "mains": {"amplitude_m_s2": drawn}}
    noisy |= {"pink_noise": {"density_m_s2_per_sqrt_hz": drawn}}
    housing = {
        "force_noise": {"density_n_per_sqrt_hz": drawn, "corner_hz": {"kind": "uniform", "low": 900, "high": 999}}
    }
    names = ["noise_floor_lid_vertical_m_s2", "pink_noise_lid_vertical_m_s2_per_sqrt_hz", "mains_lid_vertical_m_s2"]
    names.append("force_noise_n_per_sqrt_hz")
    for background, shared in (({}, True), ({"redraw": "record"}, False), (None, False)):
        config = loaded(noisy, housing=housing, background=background)
        first, second = record(config, 0), record(config, 1)
        assert [first.labels[n] == second.labels[n] for n in names] == [shared] * 4
        assert not np.allclose(first.channels["lid_vertical"], second.channels["lid_vertical"])
    levels = [added(loaded(background={**ALL, "redraw": "record"}), i)[1]["rubbing_force_n"] for i in (0, 1)]
    assert levels[0] != levels[1]


def test_redrawing_for_every_record_keeps_the_records_of_before() -> None:
    drawn = {"kind": "uniform", "low": 0.1, "high": 0.2}
    noisy = {**MODAL, "noise": {"floor_m_s2": drawn}, "pink_noise": {"density_m_s2_per_sqrt_hz": drawn}}
    before, after = loaded(noisy), loaded(noisy, background={"redraw": "record"})
    assert record(before).channels["lid_vertical"].tobytes() == record(after).channels["lid_vertical"].tobytes()


def test_adding_a_sensor_leaves_the_bytes_of_the_others() -> None:
    alone = record(loaded(MODAL, background=ALL)).channels["lid_vertical"]
    both = record(loaded(PLAIN, {**MODAL, "name": "other"}, MODAL, background=ALL)).channels["lid_vertical"]
    assert alone.tobytes() == both.tobytes()


def test_a_second_stage_turns_the_housing_and_pushes_it_nowhere() -> None:
    # a mesh inside presses on two seats with equal and opposite forces: far above all modes a = F arm x / I
    places = (0.0, 100.0, -200.0)
    lids = [{**LID, "name": f"lid{k}", "position_mm": [x, 0.0]} for k, x in enumerate(places)]
    config = loaded(*lids, background={"second_stage": {"order": 4.13}, "redraw": "record"})
    specimen = draw_specimen(config, 0)
    background = specimen_instrument(config, specimen).background
    assert background is not None
    assert background.inputs == ("second_stage",)
    gears, casing = config.gears, config.dynamics.casing
    centre_mm = 0.5 * gears.module_mm * (gears.pinion.teeth + gears.gear.teeth)
    arm_m = 1e-3 * centre_mm * np.cos(np.radians(gears.pressure_angle_deg))
    for k, x in enumerate(places):
        expected = 1e-3 * x * arm_m / float(casing.inertia_kg_m2)
        assert background.responses[f"lid{k}_vertical"][0, -1].real == pytest.approx(expected, rel=0.05, abs=1e-4)


def test_records_do_not_depend_on_what_is_simulated_beside_them() -> None:
    config = loaded(background=ALL)
    for record_id, found in zip([0, 1], simulate_specimen(config, [0, 1]), strict=True):
        assert isinstance(found, Record)
        for name, signal in record(config, record_id).channels.items():
            assert signal.tobytes() == found.channels[name].tobytes()


def test_a_rotor_out_of_balance_shakes_gearbox_and_base_as_one_mass() -> None:
    shafts = {"coupling_stiffness_n_per_um": 0.0, "rotor_mass_kg": 10.0}
    base = {"mass_kg": 1000.0, "gyration_m": 10.0, "mount_hz": 3.0}
    centre = {**LID, "position_mm": [0.0, 0.0]}
    config = loaded(centre, background={"base": base, "shafts": shafts}, duration_s=1.0)
    signal = added(config)[0]["lid_vertical"]
    background = specimen_instrument(config, draw_specimen(config, 0)).background
    assert background is not None
    rotor = background.shafts["pinion"]
    angle = 2.0 * np.pi * 30.0 * np.arange(signal.size) / config.fs_hz
    # the machine on the gear's shaft has its line too
    lines = np.stack([f(order * angle) for order in (1.0, 18 / 47) for f in (np.cos, np.sin)], axis=1)
    found, *_ = np.linalg.lstsq(lines, signal, rcond=None)
    force_n = 10.0 * 1e-3 * constant(rotor.rotor_grade_mm_s) / constant(rotor.rated_speed_hz) * 2.0 * np.pi * 30.0**2
    total_kg = 1000.0 + 20.0 + 4.0
    # mounts at a tenth of the speed: 1 %; bolts carry 24 kg at 700 Hz: 0.2 %; gears weigh what their discs weigh
    assert np.hypot(*found[:2]) == pytest.approx(force_n / total_kg, rel=0.03)
    # nothing rings from the cut before the first sample
    assert (signal - lines @ found).std() < 2e-3 * signal.std()


def test_rubbing_is_roughness_times_stiffness_over_the_averaging_face() -> None:
    """0.4 µm over 20 mm at 0.2 mm, 4e8 N/m: 16 N, where neither speed nor load counts."""
    changes = {"correlation_mm": 0.2, "speed_exponent": 0.0, "load_exponent": 0.0, "pinion_depth": 0.0}
    changes |= {"gear_depth": 0.0, "sliding_exponent": 0.0, "corner_hz": 1500.0, "steepness": 2.0}
    config, rubbing = rubbed({"roughness_um": 0.4, "level_std": 0.0}, changes, 1.0)
    course = course_at(config, draw_specimen(config, 0), planned_record(config, 0), 0, config.samples)
    assert force_size_n(rubbing, course) == pytest.approx(16.0)
    force = RubbingForce(rubbing, course, course.length).take(course)
    # 1,500 Hz over 1 s: 1,500 independent values; the band holds all but (f_c/f)^3/4 of the power
    assert force.std() == pytest.approx(16.0, rel=0.06)
    load = {"load_exponent": 0.5, "speed_exponent": 1.0}
    again = rubbing.model_copy(update=load)
    pinion = course.pair.pinion
    factor = (course.mesh_force_n / 0.02 / 5e4) ** 0.5
    factor *= 2.0 * np.pi * 30.0 * pinion.base_radius_m * np.tan(course.pair.working_pressure_angle_rad) / 3.0
    assert force_size_n(again, course) == pytest.approx(16.0 * factor)


def test_the_replayed_share_of_the_rubbing_returns_every_turn() -> None:
    changes = {"replayed_share": 0.5, "gear_depth": 0.0, "pinion_depth": 0.0, "sliding_exponent": 0.0}
    config, rubbing = rubbed({"level_std": 0.0}, changes, 4.0)
    course = course_at(config, draw_specimen(config, 0), planned_record(config, 0), 0, config.samples)
    force = RubbingForce(rubbing, course, course.length).take(course)
    turns, per_turn = 94, config.fs_hz / 30.0
    # turns of the pinion do not fall on samples: read at equal angles
    at_angles = np.interp(np.arange(turns * 1024) * per_turn / 1024, np.arange(force.size), force).reshape(turns, 1024)
    share = at_angles.mean(axis=0).var() / at_angles.var()
    # the pinion's half of the share; of the rest 1/94 is left. The gear's turns 2.6 times slower and averages out too.
    assert share == pytest.approx(0.25, abs=0.04)


def test_a_background_needs_bearings_and_a_base_needs_a_casing() -> None:
    plain = {"sensors": [PLAIN], "housing": None}
    for model, part, path in (("torsional", {"rubbing": {}}, "rubbing"), ("8dof", {"base": {}}, "base")):
        with pytest.raises(ConfigError) as refused:
            load_config(minimal(**{**plain, "dynamics__model": model, "background": part}))
        assert f"background.{path}" in {problem.path for problem in refused.value.problems}


def test_a_gearbox_without_casing_or_path_has_its_background_too() -> None:
    parts = {name: part for name, part in ALL.items() if name != "base"}
    config = loaded(PLAIN, dynamics__model="8dof", housing=None, background=parts)
    assert added(config)[0]["bearing_vertical"].std() > 1e-3


def test_a_random_level_gives_the_noise_of_bearings_its_tails_and_no_power() -> None:
    """Kurtosis 3 exp(s²) in closed form; both bearings of a shaft swell together, those of the other shaft do not."""
    found: dict[float, dict[str, np.ndarray]] = {}
    for std in (0.0, 0.7):
        config = loaded(background={"floor": {"level_std": std}}, duration_s=20.0)
        specimen, planned = draw_specimen(config, 0), planned_record(config, 0)
        background = specimen_instrument(config, specimen).background
        assert background is not None
        assert background.section.floor is not None
        floor = background.section.floor.model_copy(update={"level_time_ms": 1.0, "shaft_depth": 0.0})
        background = replace(background, section=background.section.model_copy(update={"floor": floor}))
        blocks = BackgroundBlocks(config, specimen, planned, background, 0, config.samples)
        high = frequencies(config.samples, config.fs_hz) > 2000.0
        whites = {one.name: values for one, values in blocks.take(config.samples).items() if one.kind == FLOOR}
        found[std] = {name: np.fft.irfft(np.fft.rfft(s) * high, s.size) for name, s in whites.items()}
    for name, signal in found[0.7].items():
        level = np.mean(signal**2) / np.mean(found[0.0][name] ** 2)
        kurtosis = np.mean(signal**4) / np.mean(signal**2) ** 2
        bearing = name.partition("/")[0] in {"pinion_bearing", "gear_bearing"}
        # 20 s hold 10,000 independent levels of variance exp(s²) - 1 = 0.63: 0.8 % of power, tails 4 times that
        assert level == pytest.approx(1.0, rel=0.04 if bearing else 1e-12)
        assert kurtosis == pytest.approx(3.0 * np.exp(0.49) if bearing else 3.0, rel=0.10 if bearing else 0.02)
    power = {name: signal**2 - np.mean(signal**2) for name, signal in found[0.7].items()}
    together = np.corrcoef([power[f"{s}_bearing/{a}"] for s in ("pinion", "gear") for a in ("vertical", "horizontal")])
    # E[M²] - 1 = 0.63 of E[x⁴] - 1 = 3 * 1.63 - 1 = 3.9
    assert together[0, 1] == pytest.approx(0.16, abs=0.03)
    assert abs(together[0, 2]) < 0.03


def test_without_a_random_level_the_floor_keeps_its_bytes() -> None:
    first, second = (added(loaded(background={"floor": floor}))[0] for floor in ({}, {"level_std": 0.0}))
    assert first["lid_vertical"].tobytes() == second["lid_vertical"].tobytes()
