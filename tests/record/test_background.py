"""Records of a machine with a background: what states share, what is new, and how much of it arrives."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.errors import ConfigError
from siggen.gearbox.background import BearingLevels, RubbingLevels, drawn_background
from siggen.gearbox.background_numbers import BaseNumbers
from siggen.gearbox.design import SetDesign
from siggen.gearbox.housing import Block
from siggen.gearbox.plan import planned_record
from siggen.gearbox.specimen import Specimen
from siggen.motion.response import Piece
from siggen.record.background import BackgroundBlocks, machine_noise
from siggen.record.background_course import BackgroundCourse, course_at
from siggen.record.bearing_noise import velocity_density
from siggen.record.channels import BlockInputs
from siggen.record.drive import record_rotation
from siggen.record.forced_ways import ChannelWay, SpecimenBackground, background_history_s, specimen_background
from siggen.record.instrument import Instrument, specimen_instrument
from siggen.record.rubbing import RubbingForce, force_spectrum
from siggen.sensing.filters import frequencies
from siggen.sensing.inputs import MOTION, Input
from siggen.sensing.responses import resonance_response
from siggen.sets.drawn import simulated
from tests.config.mill import mill
from tests.config.minimal import by_name, minimal
from tests.record.fixed_numbers import fix
from tests.simulated import label_names, simulate

ON_LID = {"name": "lid", "place": "lid", "axes": ["vertical"], "bits": None, "range_m_s2": 1e6}
LID = {**ON_LID, "place": "casing", "position_mm": [60.0, 50.0]}
RIGID = {"kind": "rigid"}
WASHER = {"kind": "bearing_force", "range_n": 1e6, "bits": None}
PLAIN = {"name": "bearing", "bits": None, "range_m_s2": 1e6}
ALL: dict[str, Any] = {
    "base": {},
    "rubbing": {"bursts": {}},
    "bearings": {},
    "machines": {},
    "shafts": {},
    "second_stage": {"order": 4.13},
    "auxiliary_drive": {"order": [12, 60], "shaft_order": 0.7},
}


@pytest.fixture(autouse=True)
def quick_mounts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Mounts that ring for a short time."""
    fix(monkeypatch, BaseNumbers, horizontal_hz=40.0, vertical_hz=40.0, rocking_hz=40.0)


def loaded(*sensors: dict[str, Any], **changes: Any) -> SetDesign:
    """Return a design whose flanks touch: in cold oil none would rub."""
    hot = {"dynamics__friction__oil_temperature_c": 60.0}
    changes = {"dynamics__model": "casing", "duration_s": 0.1, "specimens": 2, **hot, **changes}
    return load_config(minimal(sensors=by_name(sensors or (ON_LID, PLAIN)), **changes))


def record(config: SetDesign, record_id: int = 0) -> SimulatedRecord:
    result = simulate(config, [record_id])[0]
    assert isinstance(result, SimulatedRecord), result
    return result


def added(config: SetDesign, record_id: int = 0) -> tuple[dict[str, np.ndarray], dict[str, object]]:
    """Return what the background adds to every channel, and its labels."""
    planned = planned_record(config, record_id)
    specimen = config.gearbox(planned.specimen_id)
    instrument = specimen_instrument(specimen)
    inputs = BlockInputs(specimen, planned, record_rotation(specimen, planned), Standstill(instrument), instrument)
    blocks = list(inputs.seen())
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}, inputs.labels


def rubbed(changes: dict[str, float], duration_s: float) -> tuple[SetDesign, RubbingLevels]:
    """Return a configuration, and its drawn rubbing at a still level, some of it changed."""
    config = loaded(background={"rubbing": {}}, duration_s=duration_s)
    drawn = drawn_background(config.config, 0)
    assert drawn is not None
    assert drawn.rubbing is not None
    return config, replace(drawn.rubbing, **{"level_std": 0.0, **changes})


def whole_course(config: SetDesign) -> BackgroundCourse:
    """Return the course of the first record over its samples."""
    specimen, planned = config.gearbox(0), planned_record(config, 0)
    return course_at(specimen, planned, record_rotation(specimen, planned), 0, config.samples)


def background_ways(config: SetDesign, specimen: Specimen) -> tuple[SpecimenBackground, np.ndarray]:
    """Return a background with its responses, and their frequencies."""
    assert specimen.background is not None
    frequency = np.arange(0.0, 0.5 * config.fs_hz, 10.0)
    one = Input(MOTION, "casing_lid/vertical")
    ways = {"lid_vertical": ChannelWay({one: 1.0}, None, None)}
    return specimen_background(specimen, specimen.background, ways, frequency), frequency


def response_ways(config: SetDesign, specimen: Specimen) -> dict[str, complex]:
    """Return what a channel sees of a second mesh's force at the highest frequency, its own shafts left out."""
    assert specimen.background is not None
    frequency = np.array([0.0, 0.45 * config.fs_hz])
    ways = {
        one.name: ChannelWay({Input(MOTION, f"casing_{one.sensor}/vertical"): 1.0}, None, None)
        for one in specimen.channels
    }
    found = specimen_background(specimen, specimen.background, ways, frequency)
    assert found.inputs == ("second_stage",)
    stage = specimen.background.foreign["second_stage"]
    isolated = resonance_response(frequency, stage.support_hz, stage.support_damping)[-1]
    return {name: complex(rows[0, -1] / isolated) for name, rows in found.responses.items()}


class Standstill:
    """A response at rest: what is left is the background."""

    def __init__(self, instrument: Instrument) -> None:
        self.motions = tuple(motion for channel in instrument.channels for motion in channel.motions)

    places: tuple[str, ...] = ()
    readings: tuple[str, ...] = ()
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
        # the base makes filters longer: without it modes are cut after seven decay times, at 1e-3
        np.testing.assert_allclose(found.channels[name], expected, atol=1e-3 * np.abs(expected).max())
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
    alike = {"burst_count", "second_stage_order", "rubbing_asperity_share"}
    assert all(other[name] != healthy[1][name] for name in healthy[1] if name not in alike)


def test_levels_of_sensors_and_forces_belong_to_the_gearbox_with_a_background() -> None:
    drawn = [0.1, 0.2]
    noisy = {**ON_LID, "noise": {"floor_m_s2": drawn}, "mains": {"amplitude_m_s2": drawn}}
    noisy |= {"pink_noise": {"density_m_s2_per_sqrt_hz": drawn}}
    names = ["noise_floor_lid_vertical_m_s2", "pink_noise_lid_vertical_m_s2_per_sqrt_hz", "mains_lid_vertical_m_s2"]
    for background, shared in (({}, True), (None, False)):
        config = loaded(noisy, background=background)
        first, second = record(config, 0), record(config, 1)
        assert [first.labels[n] == second.labels[n] for n in names] == [shared] * 3
        assert not np.allclose(first.channels["lid_vertical"], second.channels["lid_vertical"])


def test_a_second_stage_turns_the_housing_and_pushes_it_nowhere() -> None:
    # a mesh inside presses on two seats with equal and opposite forces: far above all modes a = F arm x / I
    places = (0.0, 100.0, -200.0)
    lids = [{**LID, "name": f"lid{k}", "position_mm": [x, 0.0]} for k, x in enumerate(places)]
    config = loaded(*lids, housing=RIGID, background={"second_stage": {"order": 4.13}})
    specimen = config.gearbox(0)
    ways = response_ways(config, specimen)
    gears, casing = config.config.gears, specimen.housing
    assert isinstance(casing, Block)
    centre_mm = 0.5 * gears.module_mm * (gears.pinion.teeth + gears.gear.teeth)
    arm_m = 1e-3 * centre_mm * np.cos(np.radians(gears.pressure_angle_deg))
    for k, x in enumerate(places):
        expected = 1e-3 * x * arm_m / casing.inertia_kg_m2
        assert ways[f"lid{k}_vertical"].real == pytest.approx(expected, rel=0.05, abs=1e-4)


def test_records_do_not_depend_on_what_is_simulated_beside_them() -> None:
    config = loaded(background=ALL)
    for record_id, found in zip([0, 1], simulated(config, [0, 1]), strict=True):
        assert isinstance(found, SimulatedRecord)
        for name, signal in record(config, record_id).channels.items():
            assert signal.tobytes() == found.channels[name].tobytes()


def test_a_rotor_out_of_balance_shakes_gearbox_and_base_as_one_mass(monkeypatch: pytest.MonkeyPatch) -> None:
    shafts = {"coupling_stiffness_n_per_um": 0.0, "rotor_mass_kg": 10.0}
    base = {"mass_kg": 1000.0, "gyration_m": 10.0}
    fix(monkeypatch, BaseNumbers, horizontal_hz=3.0, vertical_hz=3.0, rocking_hz=3.0)
    centre = {**LID, "position_mm": [0.0, 0.0]}
    config = loaded(centre, housing=RIGID, background={"base": base, "shafts": shafts}, duration_s=1.0)
    signal = added(config)[0]["lid_vertical"]
    background = config.gearbox(0).background
    assert background is not None
    rotor = background.shafts["pinion"]
    angle = 2.0 * np.pi * 30.0 * np.arange(signal.size) / config.fs_hz
    # the machine on the gear's shaft has its line too
    lines = np.stack([f(order * angle) for order in (1.0, 18 / 47) for f in (np.cos, np.sin)], axis=1)
    found, *_ = np.linalg.lstsq(lines, signal, rcond=None)
    force_n = rotor.rotor_kg_m_s / rotor.rated_speed_hz * 2.0 * np.pi * 30.0**2
    total_kg = 1000.0 + 20.0 + 4.0
    # mounts at a tenth of the speed: 1 %; bolts carry 24 kg at 700 Hz: 0.2 %; gears weigh what their discs weigh
    assert np.hypot(*found[:2]) == pytest.approx(force_n / total_kg, rel=0.03)
    # nothing rings from the cut before the first sample
    assert (signal - lines @ found).std() < 2e-3 * signal.std()


def test_machines_stand_at_both_ends_of_three_shafts_and_turn_with_them() -> None:
    """Far below all modes a bearing carries what presses on its shaft: 41 N of a coupling once a turn of the output."""
    washers = {f"{at}_washer": {**WASHER, "place": f"{at}_bearing"} for at in ("input", "middle", "output")}
    sets = [
        load_config(mill(sensors=washers, background=background, duration_s=1.0))
        for background in ({"shafts": {"rotor_mass_kg": 0.0}}, None)
    ]
    found, clean = (record(one) for one in sets)
    levels = sets[0].gearbox(0).background
    assert levels is not None
    orders = {"input": 1.0, "middle": 18 / 47, "output": 18 / 47 * 17 / 52}
    angle = 2.0 * np.pi * 30.0 * np.arange(sets[0].samples) / sets[0].fs_hz
    waves = [f(k * order * angle) for order in orders.values() for k in (1, 2, 3, 4) for f in (np.cos, np.sin)]
    for at, levelled in {"input": levels.shafts["pinion"], "middle": None, "output": levels.shafts["slow"]}.items():
        name = f"{at}_washer_vertical"
        added_n = found.channels[name].astype(float) - clean.channels[name]
        fit, *_ = np.linalg.lstsq(np.stack(waves, axis=1), added_n, rcond=None)
        lines = dict(zip(orders, np.hypot(fit[::2], fit[1::2]).reshape(3, 4), strict=True))
        # resonances lie above 1 kHz: 1 % at 4 x 30 Hz; what rings longer than filters remember is 1 % of 41 N
        for shaft, amplitudes in lines.items():
            own = shaft == at and levelled is not None
            expected = levelled.coupling_n * 10.0 ** (np.array([0.0, *levelled.higher_db]) / 20.0) if own else 0.0
            np.testing.assert_allclose(amplitudes, expected, rtol=0.02, atol=0.8)
        assert (added_n - np.stack(waves, axis=1) @ fit).std() < 1e-3
    told = {name for name in found.labels if name.startswith("coupling_force")}
    assert told == {"coupling_force_input_n", "coupling_force_output_n"}


def test_rubbing_is_roughness_times_stiffness_over_the_averaging_face() -> None:
    """0.4 µm over 20 mm at 0.2 mm, 4e8 N/m: 16 N before the contact's width and the film take their part."""
    changes = {"correlation_m": 0.2e-3, "asperity_exponent": 1.0, "pinion_depth": 0.0}
    changes |= {"gear_depth": 0.0, "sliding_exponent": 0.0, "roll_off_m": 5e-3, "hurst_exponent": 1.0}
    config, rubbing = rubbed(changes, 1.0)
    course = replace(whole_course(config), roughness_m=0.4e-6)
    spectrum = force_spectrum(rubbing, course)
    assert spectrum.rough_n == pytest.approx(16.0 * course.asperity_share)
    # waves of 5 mm pass a contact of some 0.1 mm as they are: all the power is left
    assert spectrum.rms_n(0.5 * config.fs_hz) == pytest.approx(spectrum.rough_n, rel=0.06)
    force = RubbingForce(rubbing, course, course.length).take(course)
    # a roll-off of 350 Hz over 1 s: 350 independent values
    assert force.std() == pytest.approx(spectrum.rough_n, rel=0.12)


def test_the_spectrum_of_rough_flanks_moves_with_the_rolling_speed() -> None:
    """S_F(f; v) = S_F(f/a; v/a)/a at one film: waves of a surface pass in proportion to its speed (derived)."""
    config, rubbing = rubbed({}, 0.1)
    course = whole_course(config)
    twice = replace(course, point=replace(course.point, speed_hz=2.0 * course.point.speed_hz))
    slow, fast = (force_spectrum(rubbing, one) for one in (course, twice))
    frequency = np.geomspace(10.0, 10_000.0, 50)
    np.testing.assert_allclose(fast.density(2.0 * frequency), slow.density(frequency) / np.sqrt(2.0), rtol=1e-9)
    # in the end both corners cut: 20 (H + 1) dB per tenfold speed, plus half of what the film leaves
    high = np.array([2e5])
    steepness = np.log2(fast.density(high) / slow.density(high))[0]
    assert steepness == pytest.approx(rubbing.hurst_exponent + 1.0, rel=0.01)


def test_bearings_have_the_velocities_of_their_class_at_its_speed_and_their_waves_at_any() -> None:
    numbers = BearingLevels(60.0, 100.0, 150.0, 1e-7, 4.0, 0.1, 0.3, 2e-3)
    for (low, high), rms in (((50, 300), 60e-6), ((300, 1800), 100e-6), ((1800, 10_000), 150e-6)):
        frequency = np.linspace(low, high, 4001)
        power = np.trapezoid(velocity_density(numbers, 30.0, frequency) ** 2, frequency)
        # densities run straight between the middles of the bands, not in steps
        assert np.sqrt(power) == pytest.approx(rms, rel=0.2)
    frequency = np.geomspace(20.0, 20_000.0, 60)
    # one wave of the ring: displacement amplitude per band in proportion stays
    displacement = [velocity_density(numbers, n, n / 30.0 * frequency) / (n / 30.0 * frequency) for n in (5.0, 30.0)]
    np.testing.assert_allclose(displacement[0] * np.sqrt(5.0 / 30.0), displacement[1], rtol=1e-12)


def test_what_moves_slowly_between_shaft_and_seat_presses_on_nothing() -> None:
    """In series with its spring, far below all modes: the shaft gives way, the housing feels m ω² e of it."""
    config = loaded({**LID, "position_mm": [0.0, 0.0]}, housing=RIGID, background={"bearings": {}})
    specimen = config.gearbox(0)
    background, frequency = background_ways(config, specimen)
    k = background.inputs.index("pinion_bearing/vertical")
    place = int(np.argmin(np.abs(frequency - 40.0)))
    row = background.responses["lid_vertical"][k]
    stiff = float(np.abs(row[place])) * 2.0 * np.pi * frequency[place]
    twice = int(np.argmin(np.abs(frequency - 80.0)))
    # acceleration per displacement grows as ω⁴ while bolts hold the housing: as ω² the force, as ω² the housing
    ratio = float(np.abs(row[twice])) * 2.0 * np.pi * frequency[twice] / stiff
    assert ratio == pytest.approx((frequency[twice] / frequency[place]) ** 4, rel=0.1)


def test_the_replayed_share_of_the_rubbing_returns_every_turn() -> None:
    changes = {"replayed_share": 0.5, "gear_depth": 0.0, "pinion_depth": 0.0, "sliding_exponent": 0.0}
    config, rubbing = rubbed(changes, 4.0)
    course = whole_course(config)
    force = RubbingForce(rubbing, course, course.length).take(course)
    turns, per_turn = 94, config.fs_hz / 30.0
    # turns of the pinion do not fall on samples: read at equal angles
    at_angles = np.interp(np.arange(turns * 1024) * per_turn / 1024, np.arange(force.size), force).reshape(turns, 1024)
    share = at_angles.mean(axis=0).var() / at_angles.var()
    # the pinion's half of the share; of the rest 1/94 is left. The gear's turns 2.6 times slower and averages out too.
    assert share == pytest.approx(0.25, abs=0.04)


def test_the_noise_of_machines_swells_with_their_shafts_and_by_chance_and_keeps_its_power() -> None:
    """Kurtosis 3 exp(s²) (1 + Σ d²/(2 k)) in closed form, lines k = 1 to 3 of the shaft of depth d/√k."""
    config = loaded(background={"machines": {}}, duration_s=10.0)
    specimen, course = config.gearbox(0), whole_course(config)
    assert specimen.background is not None
    assert specimen.background.machines is not None
    levels = replace(specimen.background.machines, low_corner_hz=15.0, high_corner_hz=1000.0, level_time_s=2e-3)
    found = {}
    for depth, std in ((0.0, 0.0), (0.35, 0.0), (0.0, 0.6)):
        own = replace(levels, shaft_depth=depth, level_std=std)
        found[depth, std] = machine_noise(own, course, specimen.names)["load"].take(course)
    even = found.pop((0.0, 0.0))
    band = frequencies(even.size, config.fs_hz) > 500.0  # above what a level changes within
    even, *swelling = (np.fft.irfft(np.fft.rfft(x) * band, x.size) for x in (even, *found.values()))
    for (depth, std), noise in zip(found, swelling, strict=True):
        # 10 s hold 20,000 independent values: kurtosis to 3 %; its level to 4 %, of 2,500 independent levels
        assert np.mean(noise**2) / np.mean(even**2) == pytest.approx(1.0, rel=0.05)
        closed = np.exp(std**2) * (1.0 + 0.5 * depth**2 * (1.0 + 1.0 / 2.0 + 1.0 / 3.0))
        assert np.mean(noise**4) / np.mean(noise**2) ** 2 == pytest.approx(3.0 * closed, rel=0.08)
    turning = found[0.35, 0.0] ** 2
    gear_hz = course.point.speed_hz * float(specimen.shaft_turns[-1])
    line = np.abs(np.mean(turning * np.exp(-2j * np.pi * gear_hz * np.arange(turning.size) / config.fs_hz)))
    assert 2.0 * line / np.mean(turning) == pytest.approx(0.35, abs=0.05)  # of its own shaft; noise of 0.02


def test_forces_without_a_base_are_followed_as_long_as_the_shafts_ring() -> None:
    """What is left of an impulse after the history is e^-7 of the slowest mode; 20 ms would leave most of it."""
    specimen = loaded(background={"rubbing": {}}).gearbox(0)
    assert specimen.background is not None
    history_s = background_history_s(specimen, specimen.background)
    # the load is held by a spring of 1 Hz with 0.95 of the critical damping: 6 per second
    assert history_s == pytest.approx(7.0 / (2.0 * np.pi * 0.95), rel=0.02)


def test_a_base_needs_a_casing() -> None:
    plain = {"sensors": by_name([PLAIN])}
    with pytest.raises(ConfigError) as refused:
        load_config(minimal(**{**plain, "dynamics__model": "8dof", "background": {"base": {}}}))
    assert "background.base" in {problem.path for problem in refused.value.problems}


def test_a_random_level_gives_the_noise_of_bearings_its_tails_and_no_power() -> None:
    """Kurtosis 3 exp(s²) in closed form; both bearings of a shaft swell together, those of the other shaft do not."""
    found: dict[float, dict[str, np.ndarray]] = {}
    for std in (0.0, 0.7):
        config = loaded(background={"bearings": {}}, duration_s=20.0)
        specimen, planned = config.gearbox(0), planned_record(config, 0)
        drawn = specimen.background
        assert drawn is not None
        quick = {"level_time_s": 1e-3, "shaft_depth": 0.0, "level_std": std, "compliance_m": 0.0}
        own = {shaft: replace(levels, **quick) for shaft, levels in drawn.bearings.items()}
        noisy = replace(specimen, background=replace(drawn, bearings=own))
        acting, rotation = specimen_instrument(specimen).acting, record_rotation(specimen, planned)
        blocks = BackgroundBlocks(noisy, planned, rotation, acting, 0, config.samples)
        high = frequencies(config.samples, config.fs_hz) > 2000.0
        noises = {one.name: values for one, values in blocks.take(config.samples).items()}
        found[std] = {name: np.fft.irfft(np.fft.rfft(s) * high, s.size) for name, s in noises.items()}
    for name, signal in found[0.7].items():
        level = np.mean(signal**2) / np.mean(found[0.0][name] ** 2)
        kurtosis = np.mean(signal**4) / np.mean(signal**2) ** 2
        # 20 s hold 10,000 independent levels of variance exp(s²) - 1 = 0.63: 0.8 % of power, tails 4 times that
        assert level == pytest.approx(1.0, rel=0.04)
        assert kurtosis == pytest.approx(3.0 * np.exp(0.49), rel=0.10)
    power = {name: signal**2 - np.mean(signal**2) for name, signal in found[0.7].items()}
    together = np.corrcoef([power[f"{s}_bearing/{a}"] for s in ("pinion", "gear") for a in ("vertical", "horizontal")])
    # E[M²] - 1 = 0.63 of E[x⁴] - 1 = 3 * 1.63 - 1 = 3.9
    assert together[0, 1] == pytest.approx(0.16, abs=0.03)
    assert abs(together[0, 2]) < 0.03
