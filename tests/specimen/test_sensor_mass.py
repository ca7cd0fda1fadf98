"""The mass of an accelerometer on its place: closed forms, matrices that hold the mass, and whole records."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.linalg

from siggen.checks.loading import load_config
from siggen.columns.record import Record
from siggen.config import Config, yaml_text
from siggen.errors import ConfigError
from siggen.planning.specimen import Specimen, draw_specimen
from siggen.record.simulation import simulate
from siggen.sensing.inputs import MOTION, Input
from siggen.sensing.mass_loading import mass_loading
from siggen.specimen.background import ChannelWay, drawn_background, mean_mesh, specimen_background
from siggen.specimen.gears import gear_pair
from siggen.specimen.housing import specimen_housing
from siggen.specimen.sensor_mass import Loading, sensor_loading
from siggen.specimen.structure import linear_structure
from tests.config.minimal import minimal

OPEN = {"bits": None, "range_m_s2": 1e6}
ON_CASING = {"name": "lid", "place": "casing", "position_mm": [60.0, 50.0], "axes": ["vertical"], **OPEN}
ON_LID = {"name": "lid", "place": "lid", "axes": ["vertical"], **OPEN}
UP = Input(MOTION, "casing_lid/vertical")


def loaded(*sensors: dict[str, Any], **changes: Any) -> Config:
    return load_config(minimal(sensors=list(sensors), **{"dynamics__model": "casing", "duration_s": 0.1, **changes}))


def loading_of(config: Config, frequency_hz: np.ndarray) -> tuple[Specimen, Loading]:
    specimen = draw_specimen(config, 0)
    found = sensor_loading(config, specimen, specimen_housing(config, specimen), specimen.sensors[0], frequency_hz)
    assert found is not None
    return specimen, found


def channels(config: Config) -> dict[str, np.ndarray]:
    (found,) = simulate(config, [0])
    assert isinstance(found, Record), found
    return {name: values.astype(float) for name, values in found.channels.items()}


def test_a_mass_on_a_mass_on_a_spring_is_one_mass_on_a_spring() -> None:
    """F/(k - (M + m) w² + i w c): the closed form of both masses together."""
    big, small, k, c = 2.0, 0.5, 3e6, 40.0
    w = 2.0 * np.pi * np.linspace(0.0, 500.0, 400)
    alone = -(w**2) / (k - big * w**2 + 1j * w * c)
    together = -(w**2) / (k - (big + small) * w**2 + 1j * w * c)
    np.testing.assert_allclose(mass_loading(alone[None, None], small)[0, 0] * alone, together, rtol=1e-12)


def test_a_mass_loads_all_directions_of_its_place_as_in_a_matrix_that_holds_it() -> None:
    """Three springs, three directions, three forces: M + m r rᵀ of all directions, solved by a library."""
    rng = np.random.default_rng(3)
    n, m = 5, 0.3
    half = rng.normal(size=(n, n))
    stiffness, mass, damping = (
        1e6 * half @ half.T + 1e5 * np.eye(n),
        np.diag(rng.uniform(0.5, 2.0, n)),
        30.0 * np.eye(n),
    )
    place, forces = rng.normal(size=(3, n)), rng.normal(size=(2, n))
    for w in 2.0 * np.pi * np.geomspace(5.0, 2000.0, 12):

        def motion(more: np.ndarray, pressed: np.ndarray, w: float = w) -> np.ndarray:
            return -(w**2) * place @ np.linalg.solve(stiffness + 1j * w * damping - w**2 * (mass + more), pressed.T)

        left = mass_loading(motion(np.zeros((n, n)), place)[..., None], m)[..., 0]
        expected = motion(m * place.T @ place, forces)
        np.testing.assert_allclose(left @ motion(np.zeros((n, n)), forces), expected, rtol=1e-9)


def test_a_heavy_sensor_on_a_rigid_casing_is_the_gearbox_with_that_mass_in_its_matrix() -> None:
    """2 kg: M + m r rᵀ of both directions of the place, driven by a belt, solved by a library."""
    background = {"belt": {"pull_n": 1000.0}}
    config = loaded({**ON_CASING, "mass_g": 2000.0}, housing={"kind": "rigid"}, background=background)
    frequency = np.geomspace(20.0, 10_000.0, 60)
    specimen, loading = loading_of(config, frequency)
    assert loading.names == ("casing_lid/vertical", "casing_lid/horizontal")
    section = drawn_background(config, 0)
    assert section is not None
    ways = {
        "with": ChannelWay(loading.weights({UP: 1.0}), None, None),
        "without": ChannelWay({UP: 1.0}, None, None),
    }
    responses = specimen_background(config, specimen, section, ways, frequency).responses
    model, _ = linear_structure(config, specimen)
    mesh = mean_mesh(specimen.dynamics, gear_pair(specimen.gears), model.mesh.mass_kg)
    p, rows = model.mesh.vector, np.array([model.motions[name] for name in loading.names])
    stiffness = model.stiffness + mesh.stiffness_n_per_m * np.outer(p, p)
    damping = model.damping + mesh.damping_n_s_per_m * np.outer(p, p)
    expected = {}
    for name, mass_kg in (("with", 2.0), ("without", 0.0)):
        total = model.mass + mass_kg * rows.T @ rows
        # the force of the belt by reciprocity: what the sensor's force does to the pulley's shaft
        pulled = [
            np.linalg.solve(stiffness + 1j * w * damping - w**2 * total, -(w**2) * rows[0])
            for w in 2.0 * np.pi * frequency
        ]
        x, y = (np.array(pulled)[:, model.coordinates.index(one)] for one in ("x_1", "y_1"))
        expected[name] = np.array([x, y])
    # both rows of the pulley's motion, in the drawn direction of the pull, which the case without a mass gives
    basis = np.concatenate([expected["without"].real, expected["without"].imag], axis=1).T
    wanted = responses["without"][0]
    direction, *_ = np.linalg.lstsq(basis, np.concatenate([wanted.real, wanted.imag]), rcond=None)
    assert np.hypot(*direction) == pytest.approx(1.0, rel=1e-6)
    # ten digits: stiffnesses of 1e9 and inertias of 1e-4 stand in one matrix
    np.testing.assert_allclose(responses["with"][0], direction @ expected["with"], rtol=1e-6)
    assert np.abs(responses["with"][0] / wanted - 1.0).max() > 0.3


def test_a_record_has_the_modes_of_the_housing_that_carries_the_sensor(tmp_path: Path) -> None:
    """Modes of Omega² and I + m r rᵀ, by a library, given as those of a housing; damping in proportion to stiffness."""
    shapes = {"pinion_bearing_vertical": (0.2, 0.10), "pinion_bearing_horizontal": (0.05, -0.15),
              "gear_bearing_vertical": (0.18, -0.12), "gear_bearing_horizontal": (0.04, 0.2),
              "lid_vertical": (0.25, 0.4), "lid_horizontal": (0.3, -0.2)}  # fmt: skip
    own, stiff = 2.0 * np.pi * np.array([410.0, 1730.0]), 2e-5
    table = np.array(list(shapes.values()))
    carried = np.eye(2) + 0.06 * table[4:].T @ table[4:]
    squares, vectors = scipy.linalg.eigh(np.diag(own**2), carried)
    signals = []
    for omega, rows, mass_g in ((own, table, 0.0), (own, table, 60.0), (np.sqrt(squares), table @ vectors, 0.0)):
        head = "frequency_hz,damping_ratio," + ",".join(f"{name}_per_sqrt_kg" for name in shapes)
        lines = [
            ",".join(map(str, (w / (2.0 * np.pi), 0.5 * stiff * w, *rows[:, r].tolist()))) for r, w in enumerate(omega)
        ]
        (tmp_path / "modes.csv").write_text("\n".join([head, *lines]))
        sensor = {"name": "lid", "place": "casing", "axes": ["vertical", "horizontal"], "mass_g": mass_g, **OPEN}
        housing = {"kind": "modal", "modes": "modes.csv"}
        source = tmp_path / "set.yaml"
        source.write_text(
            yaml_text(minimal(sensors=[sensor], dynamics__model="casing", housing=housing, duration_s=0.1))
        )
        signals.append(channels(load_config(source)))
    bare, corrected, carrying = signals
    for name, expected in carrying.items():
        wrong = (bare[name] - expected).std() / expected.std()
        left = (corrected[name] - expected).std() / expected.std()
        # what is left: the stiffness of the mesh varies, and the correction takes its mean
        assert wrong > 5e-3
        assert left < 0.1 * wrong


def test_beyond_the_gears_a_plate_with_a_sensor_is_its_modes_with_the_mass_among_them() -> None:
    """(Omega² + 2i zeta Omega w - w² (I + m r rᵀ)) eta = r_seat F over all modes of the box, solved by a library."""
    config = loaded({**ON_LID, "mass_g": 100.0}, fs_hz=25_600.0)
    frequency = np.linspace(2500.0, 9000.0, 200)
    specimen, loading = loading_of(config, frequency)
    housing = specimen_housing(config, specimen)
    assert housing is not None
    place = [housing.motions[name] for name in loading.names]
    seat = housing.seats["pinion_bearing/vertical"]
    shapes, driven = housing.modes.shapes(place), housing.modes.shapes([seat])[0]
    up = loading.names.index(UP.name)
    give = housing.modes.residual_flexibility(place, [*place, seat])
    own, total = 2.0 * np.pi * housing.modes.frequency_hz, np.empty((2, frequency.size), dtype=complex)
    for i, w in enumerate(2.0 * np.pi * frequency):
        free = np.diag(own**2 - w**2 + 2j * housing.damping_ratio * own * w)
        alone = -(w**2) * (np.linalg.solve(free, np.column_stack([shapes.T, driven])).T @ shapes.T).T - w**2 * give
        loaded_too = np.linalg.solve(np.eye(3) + 0.1 * alone[:, :3], alone[:, 3])
        total[:, i] = alone[up, 3], loaded_too[up]
    first = {name: loading.weights({UP: 1.0})[Input(MOTION, name)] for name in loading.names}
    found = housing.shown_accelerance(first, ("pinion_bearing/vertical",), frequency)[0]
    without, wanted = total
    error, effect = (np.sqrt(np.mean(np.abs(one - wanted) ** 2)) for one in (found, without))
    # gears still move a little with the place, which the box alone does not know: 1 to 5 % of its accelerance
    assert error < 0.03 * np.sqrt(np.mean(np.abs(wanted) ** 2))
    assert error < 0.03 * effect


def test_no_mass_leaves_the_bytes_and_a_mass_leaves_those_of_other_sensors() -> None:
    other = {**ON_LID, "name": "wall", "place": "wall"}
    found = [channels(loaded({**ON_LID, **mass}, other)) for mass in ({}, {"mass_g": 0.0}, {"mass_g": 50.0})]
    assert found[0]["lid_vertical"].tobytes() == found[1]["lid_vertical"].tobytes()
    assert found[0]["lid_vertical"].tobytes() != found[2]["lid_vertical"].tobytes()
    assert found[0]["wall_vertical"].tobytes() == found[2]["wall_vertical"].tobytes()


def test_a_measured_response_takes_no_mass() -> None:
    with pytest.raises(ConfigError) as refused:
        loaded({"name": "lid", "place": "casing", "path": {"file": "x.csv"}, "mass_g": 30.0})
    (problem,) = [one for one in refused.value.problems if one.path.endswith("mass_g")]
    assert problem.path == "sensors.0.mass_g"
    assert "a measured response has its sensor's mass in it" in problem.allowed
