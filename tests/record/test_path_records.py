"""Records behind transfer paths and instruments, from the configuration on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import Record, label_names
from siggen.config import Config
from siggen.errors import ConfigError
from siggen.planning.plan import planned_record
from siggen.planning.specimen import draw_specimen
from siggen.record.simulation import record_response, simulate, simulate_specimen, specimen_state
from siggen.sensing.modal_path import modal_accelerance
from siggen.specimen.housing import specimen_housing
from siggen.specimen.instrument import specimen_instrument
from siggen.specimen.measured_path import INPUTS
from tests.config.minimal import minimal

LID = {"name": "lid", "place": "casing", "axes": ["vertical", "axial"], "bits": None, "range_m_s2": 1e6}
MODAL = {**LID, "path": {"kind": "modal"}, "position_mm": [60.0, 50.0]}
FLEXIBLE = {**LID, "path": {"kind": "modal", "rigid": False}}
RIGID = {**LID, "axes": ["vertical"], "position_mm": [60.0, 50.0]}


def raw(*sensors: dict[str, Any], **changes: Any) -> dict[str, Any]:
    changes = {"dynamics__model": "casing", "duration_s": 0.1, "specimens": 2, "housing": {}, **changes}
    return minimal(sensors=list(sensors), **changes)


def loaded(*sensors: dict[str, Any], **changes: Any) -> Config:
    return load_config(raw(*sensors, **changes))


def record(config: Config, record_id: int = 0) -> Record:
    result = simulate(config, [record_id])[0]
    assert isinstance(result, Record), result
    return result


def problems(*sensors: dict[str, Any], **changes: Any) -> dict[str, str]:
    with pytest.raises(ConfigError) as refused:
        loaded(*sensors, **changes)
    return {p.path: f"{p.received}; {p.allowed}" for p in refused.value.problems}


def test_a_path_adds_flexible_modes_to_the_rigid_motion() -> None:
    config = loaded(MODAL, {**FLEXIBLE, "name": "flexible"}, {**RIGID, "name": "rigid"})
    channels = record(config).channels
    specimen = draw_specimen(config, 0)
    response, _ = record_response(config, specimen, specimen_state(config, specimen, 0), planned_record(config, 0))
    housing = specimen_housing(config, 0)
    assert housing is not None
    # the rigid channel is the model's own motion, the axial one has no rigid part
    np.testing.assert_array_equal(
        channels["rigid_vertical"], response.acceleration_m_s2["casing_rigid/vertical"].astype(np.float32)
    )
    whole = {
        name: np.concatenate([response.history.bearing_force_n[name], response.bearing_force_n[name]])
        for name in INPUTS
    }
    length = 2 * whole[INPUTS[0]].size  # one transform, in which nothing wraps round
    grid = np.arange(length // 2 + 1) * config.fs_hz / length
    total = np.zeros(grid.size, dtype=complex)
    for name in INPUTS:
        shapes = housing.at_bearings((name,))
        path = modal_accelerance(housing.modes, shapes, housing.shape_at("sensors.lid/vertical"), grid)[0]
        values = whole[name] - response.bearing_force_n[name].mean()
        total += path * np.fft.rfft(np.concatenate([np.zeros(length - values.size), values]))
    expected = np.fft.irfft(total, length)[-config.samples :]
    expected += response.acceleration_m_s2["casing_lid/vertical"]
    # stored as float32; the mean acceleration of the rigid part (1e-3 of its rms) is not passed on
    assert np.abs(channels["lid_vertical"] - expected).max() < 1e-2 * expected.std()
    assert channels["lid_axial"].std() > 0.1 * channels["lid_vertical"].std()


def test_a_gearbox_without_a_casing_shakes_one_through_its_path() -> None:
    channels = record(loaded(FLEXIBLE, dynamics__model="8dof")).channels
    assert all(signal.std() > 0.1 for signal in channels.values())


def test_adding_or_moving_a_sensor_leaves_the_bytes_of_the_others() -> None:
    noisy = {**MODAL, "noise": {"floor_m_s2": 0.1}, "pink_noise": {"density_m_s2_per_sqrt_hz": 0.01}}
    housing = {"force_noise": {"share_per_sqrt_hz": 1e-5}}
    alone = record(loaded(noisy, housing=housing), 1).channels
    other = {**FLEXIBLE, "name": "other", "high_pass_hz": 1.0, "mains": {"amplitude_m_s2": 0.1}}
    for sensors in ((noisy, other), (other, noisy)):
        both = record(loaded(*sensors, housing=housing), 1).channels
        for name, signal in alone.items():
            assert both[name].tobytes() == signal.tobytes()


def test_an_instrument_without_a_path_leaves_plain_channels_as_they_were() -> None:
    filtered = {**RIGID, "name": "filtered", "mounting": {"frequency_hz": 9000.0}, "high_pass_hz": 1.0}
    alone = record(loaded(RIGID, housing=None)).channels["lid_vertical"]
    both = record(loaded(RIGID, filtered, housing=None)).channels
    assert both["lid_vertical"].tobytes() == alone.tobytes()
    assert both["filtered_vertical"].tobytes() != alone.tobytes()


def test_records_do_not_depend_on_what_is_simulated_beside_them() -> None:
    config = loaded(MODAL, housing={"force_noise": {"share_per_sqrt_hz": 1e-5}})
    together = list(simulate_specimen(config, [2, 3]))
    for record_id, found in zip([2, 3], together, strict=True):
        assert isinstance(found, Record)
        for name, signal in record(config, record_id).channels.items():
            assert signal.tobytes() == found.channels[name].tobytes()


DISTURBED = {
    **MODAL,
    "gain": {"kind": "uniform", "low": 0.9, "high": 1.1},
    "noise": {"floor_m_s2": {"kind": "uniform", "low": 0.1, "high": 0.2}},
    "pink_noise": {"density_m_s2_per_sqrt_hz": {"kind": "uniform", "low": 0.01, "high": 0.02}},
    "mains": {"amplitude_m_s2": {"kind": "uniform", "low": 0.1, "high": 0.2}},
    "tones": {"frequency_hz": {"kind": "uniform", "low": 100, "high": 1000}, "amplitude_m_s2": 0.2, "count": 2},
    "inverter": {"carrier_hz": {"kind": "uniform", "low": 2000, "high": 8000}, "amplitude_m_s2": 0.1},
    "mounting": {"frequency_hz": {"kind": "uniform", "low": 5000, "high": 15000}},
    "resonance": {"frequency_hz": {"kind": "uniform", "low": 20000, "high": 50000}},
    "high_pass_hz": {"kind": "uniform", "low": 0.5, "high": 2.0},
    "cross_axis": {"kind": "uniform", "low": 0.03, "high": 0.05},
}
PARTS = ("noise_floor_", "pink_noise_", "mains_", "tones_", "inverter_", "force_noise_")


def test_what_is_added_does_not_depend_on_the_state() -> None:
    """The same gearbox and levels, only the damage differs: disturbances of a record are drawn by its index alone."""
    housing = {"force_noise": {"density_n_per_sqrt_hz": {"kind": "uniform", "low": 0.01, "high": 0.02}}}
    damaged = loaded(DISTURBED, housing=housing)
    milder = raw(DISTURBED, housing=housing)
    milder["states"][1]["damage"]["depth_mm"] = 0.1
    first, second = record(damaged, 1), record(load_config(milder), 1)
    drawn = [name for name in label_names(damaged) if name.startswith(PARTS)]
    assert len(drawn) == 11
    assert {name: first.labels[name] for name in drawn} == {name: second.labels[name] for name in drawn}
    assert first.channels["lid_vertical"].tobytes() != second.channels["lid_vertical"].tobytes()
    paths = {name: first.labels[name] for name in label_names(damaged) if name.startswith("path_")}
    assert paths == {name: record(damaged, 0).labels[name] for name in paths}
    assert 6 <= int(paths["path_modes_lid_vertical"]) <= 15  # type: ignore[call-overload]


def test_sensors_of_a_gearbox_differ_as_measured_ones_do() -> None:
    """Standard deviations over 12 sensors, median over gearboxes, against 1-5 dB and 3-10 dB of measured machines."""
    config = loaded(FLEXIBLE)
    mesh_hz, shaft_hz = 540.0, 30.0
    spread = []
    force = np.random.default_rng(1).standard_normal((3, 4))
    for specimen_id in range(60):
        housing = specimen_housing(config, specimen_id)
        assert housing is not None
        lines = np.array([mesh_hz - shaft_hz, mesh_hz, mesh_hz + shaft_hz, *(mesh_hz * np.arange(2, 6))])
        bearings = housing.at_bearings(INPUTS)
        shapes = [housing.shape_at(f"sensor {i}") for i in range(12)]
        # a mesh force acts on all four bearings with fixed shares
        level = np.array([np.abs(force[0] @ modal_accelerance(housing.modes, bearings, s, lines)) for s in shapes])
        ratios = [0.5 * (level[:, 0] + level[:, 2]) / level[:, 1], *(level[:, 3:] / level[:, 1:2]).T]
        spread.append([np.std(20.0 * np.log10(ratio), ddof=1) for ratio in ratios])
    median = np.median(spread, axis=0)
    assert 1.0 < median[0] < 5.0
    assert ((median[1:] > 3.0) & (median[1:] < 10.0)).all(), median


def test_sensors_of_a_gearbox_share_its_modes_and_gearboxes_do_not() -> None:
    config = loaded(MODAL)
    first, second = specimen_housing(config, 0), specimen_housing(config, 1)
    assert first is not None
    assert second is not None
    assert first.modes.frequency_hz[0] != second.modes.frequency_hz[0]
    for housing in (first, second):
        assert (np.diff(housing.modes.frequency_hz) > 0.0).all()
        assert housing.modes.frequency_hz[0] >= 300.0
        assert housing.modes.frequency_hz[-1] <= 8000.0
        assert ((housing.modes.damping_ratio >= 0.01) & (housing.modes.damping_ratio <= 0.04)).all()


@pytest.mark.parametrize(
    ("sensor", "changes", "path", "said"),
    [
        (MODAL, {"housing": None}, "sensors.0.path", "a section housing"),
        (MODAL, {"dynamics__model": "8dof"}, "sensors.0.path.rigid", "no casing that moves"),
        ({**MODAL, "position_mm": None}, {}, "sensors.0.position_mm", "a path without rigid motion"),
        ({**RIGID, "axes": ["axial"]}, {}, "sensors.0.axes", "axial with a path"),
        ({**FLEXIBLE, "place": "pinion_bearing", "axes": ["vertical"]}, {}, "sensors.0.path", "place: casing"),
        (FLEXIBLE, {"dynamics__model": "torsional"}, "sensors.0.place", "pinion_rim"),
        (MODAL, {"housing": {"settle_s": 0.1}}, "housing.settle_s", "at least 0.371 s"),
        (MODAL, {"housing": {"modes": 0.0}}, "housing.modes", "from 1 to 60"),
        ({**MODAL, "path": {"kind": "modes"}}, {}, "sensors.0.path.kind", "modal, measured"),
        ({**MODAL, "path": {"kind": "modal", "delay_us": -1.0}}, {}, "sensors.0.path.delay_us", "from 0 to 5000"),
        ({**MODAL, "mounting": {"frequency_hz": 0.0}}, {}, "sensors.0.mounting.frequency_hz", "above 0"),
        ({**MODAL, "mains": {}}, {}, "sensors.0.mains.amplitude_m_s2", "needed"),
    ],
)  # fmt: skip
def test_contradictions_are_named(sensor: dict, changes: dict, path: str, said: str) -> None:
    found = problems(sensor, **changes)
    assert list(found) == [path]
    assert said in found[path]


def test_a_rim_has_no_axis_across() -> None:
    rim = {"name": "rim", "place": "pinion_rim", "axes": ["tangential"], "cross_axis": 0.04}
    assert "sensors.0.cross_axis" in problems(rim, dynamics__model="torsional", housing=None)


def test_the_bytes_do_not_depend_on_workers(tmp_path: Path) -> None:
    from siggen.sets.generation import generate

    config = loaded(DISTURBED, housing={"force_noise": {"share_per_sqrt_hz": 1e-5}}, fs_hz=25600.0)
    for workers in (1, 2):
        generate(config, tmp_path / str(workers), workers)
    files = sorted(p.relative_to(tmp_path / "1") for p in (tmp_path / "1" / "data").rglob("*.parquet"))
    assert files
    for file in files:
        assert (tmp_path / "1" / file).read_bytes() == (tmp_path / "2" / file).read_bytes()


def line_ratio(first: np.ndarray, second: np.ndarray, cycles: int) -> complex:
    """Return the ratio of two signals at a line with whole cycles in the record."""
    turn = np.exp(-2j * np.pi * cycles * np.arange(first.size) / first.size)
    return complex((first.astype(float) @ turn) / (second.astype(float) @ turn))


def test_mounting_sensor_and_coupling_act_on_the_lines_of_the_gears() -> None:
    filtered = {
        **RIGID,
        "name": "filtered",
        "mounting": {"frequency_hz": 2000.0, "damping_ratio": 0.1},
        "high_pass_hz": 200.0,
    }
    channels = record(loaded(RIGID, filtered, housing=None)).channels
    # 0.1 s hold 54 periods of the mesh at 18 teeth and 30 Hz: its harmonics are lines of the record
    for harmonic in (1, 2, 4):
        f = 540.0 * harmonic
        x, y = f / 2000.0, 1j * f / 200.0
        expected = 1.0 / (1.0 - x**2 + 0.2j * x) * y / (1.0 + y)
        found = line_ratio(channels["filtered_vertical"], channels["lid_vertical"], round(f / 10.0))
        # float32 channels
        assert found == pytest.approx(expected, rel=1e-4)


def test_a_sensor_leaks_a_share_of_the_motion_across_its_axis() -> None:
    both = {**RIGID, "axes": ["vertical", "horizontal"]}
    channels = record(loaded(both, {**both, "name": "leaky", "cross_axis": 0.05}, housing=None)).channels
    leak = channels["leaky_vertical"].astype(float) - channels["lid_vertical"] + channels["lid_vertical"].mean()
    across = channels["lid_horizontal"].astype(float)
    share = (leak @ across) / (across @ across)
    assert 0.0 < abs(share) <= 0.05
    # what is left is rounding to float32, and the mean, which is not passed on
    assert (leak - share * across).std() < 1e-5 * across.std()


def test_force_noise_reaches_the_sensor_through_its_path() -> None:
    density = 0.05
    quiet, loud = loaded(FLEXIBLE), loaded(FLEXIBLE, housing={"force_noise": {"density_n_per_sqrt_hz": density}})
    added = record(loud).channels["lid_vertical"].astype(float) - record(quiet).channels["lid_vertical"]
    instrument = specimen_instrument(loud, draw_specimen(loud, 0))
    path = instrument.channels[0].accelerance
    assert path is not None
    variance = (density**2 * np.abs(path) ** 2).sum() * loud.fs_hz / instrument.length
    # the lowest mode is 15 Hz wide, so 0.1 s hold few independent values of it: 3 standard errors are about 80 %
    assert 0.2 < added.var() / variance < 2.5
    assert record(loud).labels["force_noise_n_per_sqrt_hz"] == density


def test_force_noise_falls_above_its_corner() -> None:
    level = {"density_n_per_sqrt_hz": 1.0}
    quiet = record(loaded(FLEXIBLE))
    soft, white = (
        record(loaded(FLEXIBLE, housing={"force_noise": {**level, "corner_hz": corner}})) for corner in (1500.0, 1e6)
    )
    spectra = [
        np.abs(
            np.fft.rfft((r.channels["lid_vertical"].astype(float) - quiet.channels["lid_vertical"]) * np.hanning(5120))
        )
        for r in (soft, white)
    ]
    for low, high in ((400, 450), (1400, 1600), (9000, 11000)):
        # the same noise, so that the ratio is the response; windowed, since the record is a cut-out
        bins = slice(low // 10, high // 10)
        middle = 0.5 * (low + high)
        found = spectra[0][bins].sum() / spectra[1][bins].sum()
        assert found == pytest.approx(1.0 / np.hypot(1.0, middle / 1500.0), rel=0.05)


def test_force_noise_follows_the_torque_and_not_the_record() -> None:
    config = loaded(FLEXIBLE, housing={"force_noise": {"share_per_sqrt_hz": 1e-4}})
    base_radius_m = 0.5 * 3e-3 * 18 * np.cos(np.radians(20.0))
    for record_id in (0, 1):
        density = record(config, record_id).labels["force_noise_n_per_sqrt_hz"]
        assert density == pytest.approx(1e-4 * 60.0 / base_radius_m, rel=1e-12)


def test_other_machines_and_hum_are_where_the_labels_say() -> None:
    sensor = {
        **RIGID,
        "mains": {"amplitude_m_s2": 5.0, "frequency_hz": 50.0, "harmonics": 1},
        "inverter": {"carrier_hz": 4000.0, "amplitude_m_s2": 2.0},
    }
    channels, labels = record(loaded(sensor, housing=None)).channels, record(loaded(sensor, housing=None)).labels
    added = channels["lid_vertical"].astype(float) - record(loaded(RIGID, housing=None)).channels["lid_vertical"]
    spectrum = np.abs(np.fft.rfft(added)) * 2.0 / added.size
    assert spectrum[5] == pytest.approx(5.0, rel=1e-5)
    assert spectrum[400] == pytest.approx(2.0, rel=1e-5)
    assert labels["mains_lid_vertical_m_s2"] == pytest.approx(5.0 / np.sqrt(2.0))
    assert added.var() == pytest.approx(0.5 * (25.0 + 4.0 * (1.0 + 2.0 / 4.0 + 2.0 / 9.0)), rel=1e-5)
