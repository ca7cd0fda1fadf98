"""Records of sensors on a housing and behind instruments, from the configuration on."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from siggen.gearbox.mode_table import seats_of
from siggen.gearbox.plan import planned_record
from siggen.names import PAIR
from siggen.record.housing import specimen_housing
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state
from tests.config.minimal import by_name, minimal
from tests.simulated import label_names, simulate

INPUTS = seats_of(PAIR)

LID = {"name": "lid", "place": "lid", "axes": ["vertical", "axial"], "bits": None, "range_m_s2": 1e6}
UP = {**LID, "axes": ["vertical"]}
RIGID = {**LID, "place": "casing", "axes": ["vertical"], "position_mm": [60.0, 50.0]}


def raw(*sensors: dict[str, Any], **changes: Any) -> dict[str, Any]:
    """Return a mapping; sensors on a casing have a rigid one."""
    housing = {"kind": "rigid"} if any(sensor["place"] == "casing" for sensor in sensors) else {}
    changes = {"duration_s": 0.1, "specimens": 2, "housing": housing, **changes}
    return minimal(sensors=by_name(sensors), **changes)


def loaded(*sensors: dict[str, Any], **changes: Any) -> SetDesign:
    return load_config(raw(*sensors, **changes))


def record(config: SetDesign, record_id: int = 0) -> SimulatedRecord:
    result = simulate(config, [record_id])[0]
    assert isinstance(result, SimulatedRecord), result
    return result


def problems(*sensors: dict[str, Any], **changes: Any) -> dict[str, str]:
    with pytest.raises(ConfigError) as refused:
        loaded(*sensors, **changes)
    return {p.path: f"{p.received}; {p.allowed}" for p in refused.value.problems}


def test_a_sensor_on_a_plate_sees_bearing_forces_through_all_modes() -> None:
    config = loaded(UP, {**LID, "name": "wall", "place": "wall"})
    channels, specimen = record(config).channels, config.gearbox(0)
    response, _ = record_response(specimen, specimen_state(specimen, 0), planned_record(config, 0))
    housing = specimen_housing(specimen)
    assert housing is not None
    length = 2**16  # one transform, in which nothing wraps round
    grid = np.arange(length // 2 + 1) * config.fs_hz / length
    history, forces = response.history.bearing_force_n, response.bearing_force_n
    whole = {name: np.concatenate([history[name], forces[name]]) - history[name].mean() for name in INPUTS}
    spectra = np.array([np.fft.rfft(values, length) for values in whole.values()])
    behind = whole[INPUTS[0]].size
    for name in ("lid_vertical", "wall_vertical", "wall_axial"):
        rows = housing.accelerance(housing.motions[f"casing_{name.replace('_', '/')}"], INPUTS, grid)
        expected = np.fft.irfft((rows * spectra).sum(axis=0), length)[behind - config.samples : behind]
        # filters end where 1e-3 of the slowest mode is left; here forces break off with the record
        error = (channels[name] - expected)[:-512]
        assert np.abs(error).max() < 1e-2 * expected.std()
    # along the shafts nothing pushes; a wall that bends moves that way all the same
    assert channels["wall_axial"].std() > 0.1 * channels["wall_vertical"].std()


def test_a_rigid_casing_shows_its_own_motion() -> None:
    config = loaded(RIGID)
    specimen = config.gearbox(0)
    response, _ = record_response(specimen, specimen_state(specimen, 0), planned_record(config, 0))
    expected = response.acceleration_m_s2["casing_lid/vertical"].astype(np.float32)
    np.testing.assert_array_equal(record(config).channels["lid_vertical"], expected)


def test_adding_or_moving_a_sensor_leaves_the_bytes_of_the_others() -> None:
    noisy = {**LID, "noise": {"floor_m_s2": 0.1}, "pink_noise": {"density_m_s2_per_sqrt_hz": 0.01}}
    alone = record(loaded(noisy), 1).channels
    other = {**LID, "name": "other", "place": "wall", "high_pass_hz": 1.0, "mains": {"amplitude_m_s2": 0.1}}
    for sensors in ((noisy, other), (other, noisy), (noisy, {**other, "position_mm": [40.0, -20.0]})):
        both = record(loaded(*sensors), 1).channels
        for name, signal in alone.items():
            assert both[name].tobytes() == signal.tobytes()


def test_an_instrument_without_a_path_leaves_plain_channels_as_they_were() -> None:
    filtered = {**RIGID, "name": "filtered", "mounting": {"frequency_hz": 9000.0}, "high_pass_hz": 1.0}
    alone = record(loaded(RIGID)).channels["lid_vertical"]
    both = record(loaded(RIGID, filtered)).channels
    assert both["lid_vertical"].tobytes() == alone.tobytes()
    assert both["filtered_vertical"].tobytes() != alone.tobytes()


DISTURBED = {
    **LID,
    "gain": [0.9, 1.1],
    "noise": {"floor_m_s2": [0.1, 0.2]},
    "pink_noise": {"density_m_s2_per_sqrt_hz": [0.01, 0.02]},
    "mains": {"amplitude_m_s2": [0.1, 0.2]},
    "mounting": {"frequency_hz": [5000, 15000]},
    "resonance": {"frequency_hz": [20000, 50000]},
    "high_pass_hz": [0.5, 2.0],
    "cross_axis": [0.03, 0.05],
}
PARTS = ("noise_floor_", "pink_noise_", "mains_")


def test_what_is_added_does_not_depend_on_the_state() -> None:
    """The same gearbox and levels, only the damage differs: disturbances of a record are drawn by its index alone."""
    damaged = loaded(DISTURBED)
    milder = raw(DISTURBED)
    milder["states"]["slight"]["damage"]["depth_mm"] = 0.1
    first, second = record(damaged, 1), record(load_config(milder), 1)
    drawn = [name for name in label_names(damaged) if name.startswith(PARTS)]
    assert len(drawn) == 6
    assert {name: first.labels[name] for name in drawn} == {name: second.labels[name] for name in drawn}
    assert first.channels["lid_vertical"].tobytes() != second.channels["lid_vertical"].tobytes()
    paths = {name: first.labels[name] for name in label_names(damaged) if name.startswith("path_")}
    assert paths == {name: record(damaged, 0).labels[name] for name in paths}
    assert int(paths["path_modes_lid_vertical"]) > 50  # type: ignore[call-overload]


@pytest.mark.parametrize(
    ("sensor", "changes", "path", "said"),
    [
        (UP, {"dynamics__model": "8dof"}, "sensors.lid.place", "pinion_bearing, gear_bearing (dynamics.model: 8dof)"),
        (UP, {"housing": {"kind": "rigid"}}, "sensors.lid.place", "casing, pinion_bearing, gear_bearing"),
        ({**RIGID, "axes": ["axial"]}, {}, "sensors.lid.axes", "axial needs housing.kind: plates or modal"),
        (RIGID, {"housing": {}}, "sensors.lid.place", "one of lid, wall"),
        ({**LID, "path": {"kind": "modal"}}, {}, "sensors.lid.path.kind", "needs no path"),
        ({**LID, "mounting": {"frequency_hz": 0.0}}, {}, "sensors.lid.mounting.frequency_hz", "above 0"),
        ({**LID, "mains": {}}, {}, "sensors.lid.mains.amplitude_m_s2", "needed"),
    ],
)  # fmt: skip
def test_contradictions_are_named(sensor: dict, changes: dict, path: str, said: str) -> None:
    found = problems(sensor, **changes)
    assert list(found) == [path]
    assert said in found[path]


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
    channels = record(loaded(RIGID, filtered)).channels
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
    channels = record(loaded(both, {**both, "name": "leaky", "cross_axis": 0.05})).channels
    leak = channels["leaky_vertical"].astype(float) - channels["lid_vertical"] + channels["lid_vertical"].mean()
    across = channels["lid_horizontal"].astype(float)
    share = (leak @ across) / (across @ across)
    assert 0.0 < abs(share) <= 0.05
    # what is left is rounding to float32, and the mean, which is not passed on
    assert (leak - share * across).std() < 1e-5 * across.std()


def test_other_machines_and_hum_are_where_the_labels_say() -> None:
    plain = record(loaded(RIGID)).channels["lid_vertical"]
    hum = record(loaded({**RIGID, "mains": {"amplitude_m_s2": 5.0}}))
    spectrum = np.abs(np.fft.rfft(hum.channels["lid_vertical"].astype(float) - plain)) * 2.0 / plain.size
    assert spectrum[5] == pytest.approx(5.0, rel=1e-5)
    assert hum.labels["mains_lid_vertical_m_s2"] == pytest.approx(
        5.0 * np.sqrt(0.5 * sum(1.0 / h**2 for h in range(1, 6)))
    )
