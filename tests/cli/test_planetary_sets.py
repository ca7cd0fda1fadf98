"""Planetary sets from the command line: plan, records by the closed rules of orders, labels, what is refused."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest
import yaml

from siggen.arrays import FloatArray
from siggen.checks.loading import load_config
from siggen.errors import ConfigError
from tests.cli.test_stages import rows, run
from tests.config.minimal import by_name
from tests.config.planets import CARRIER_HZ, SPALL, planets

TURNS = 3
PLANETS = 3
LID = {"name": "lid", "place": "casing", "position_mm": [70.0, 90.0], "axes": ["vertical"], "bits": None}
HOUSED = {
    "dynamics": {**planets()["dynamics"], "model": "casing"},
    "housing": {"kind": "rigid", "mass_kg": 40.0},
    "sensors": by_name([LID]),
}
MODES = "frequency_hz,damping_ratio,ring_turning_per_sqrt_kg_m,lid_vertical_per_sqrt_kg\n450,0.03,1.5,0.1\n"


def written(folder: Path, **changes: Any) -> str:
    file = folder / "set.yaml"
    file.write_text(yaml.safe_dump(planets(**changes), sort_keys=False), encoding="utf-8")
    return str(file)


def generated(folder: Path, **changes: Any) -> Path:
    done = run("generate", written(folder, **changes), "--out", str(folder / "set"), "--executor", "serial")
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / "set"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return generated(tmp_path_factory.mktemp("planets"))


def states(made: Path) -> dict[str, dict[str, Any]]:
    return {row["state"]: row for row in rows(made, "data")}


def power(record: Mapping[str, Any], channel: str = "accel_ring_horizontal_m_s2") -> FloatArray:
    """Return the power at whole and broken orders of the carrier, one third apart."""
    signal = np.asarray(record[channel], dtype=np.float64)
    return np.asarray(np.abs(np.fft.rfft(signal)) ** 2)


def share_off(found: FloatArray, step: int) -> float:
    """Return the share of the power that lies at no multiple of so many bins."""
    return float(found[np.arange(found.size) % step != 0].sum() / found.sum())


def test_a_healthy_ring_shows_multiples_of_its_planets_alone_and_none_at_the_mesh_frequency(made: Path) -> None:
    found = power(states(made)["healthy"])
    assert share_off(found, PLANETS * TURNS) < 1e-4  # -40 dB
    assert found[78 * TURNS] > 1e4 * found[77 * TURNS]


def test_a_spall_of_the_sun_adds_lines_that_no_healthy_set_has(made: Path) -> None:
    """Its tooth comes to any planet 3 * 77/25 times per turn, never on a multiple of three planets passing."""
    healthy, sun = (power(states(made)[name]) for name in ("healthy", "sun"))
    assert share_off(sun, PLANETS * TURNS) > 1e-3 > 1e1 * share_off(healthy, PLANETS * TURNS)


def test_a_spall_of_one_planet_is_heard_at_all_orders_of_the_carrier(made: Path) -> None:
    assert share_off(power(states(made)["planet"]), PLANETS * TURNS) > 1e-3


def test_a_spall_of_the_ring_fills_multiples_of_the_planets_and_adds_no_other_line(made: Path) -> None:
    """Equal planets pass its tooth after each other, so nothing is new after a third of a turn."""
    healthy, ring = (power(states(made)[name]) for name in ("healthy", "ring"))
    assert share_off(ring, PLANETS * TURNS) < 1e-4  # -40 dB
    order = np.arange(ring.size) / TURNS
    away = np.abs((order + 38.0) % 77.0 - 38.0) > 1.01  # from harmonics of the mesh, beside which healthy lines are
    assert ring[away].sum() > 1e-3 * ring.sum()
    assert healthy[away].sum() < 1e-6 * healthy.sum()


def test_labels_name_sun_planet_ring_and_carrier(made: Path) -> None:
    found = states(made)
    sun, planet = found["sun"], found["planet"]
    assert (sun["faulty_gear"], planet["faulty_gear"]) == ("sun", "planet")
    assert len(sun["faulty_teeth_sun"]) == len(planet["faulty_teeth_planet"]) == 1
    assert (sun["teeth_sun"], sun["teeth_planet"], sun["teeth_ring"]) == (25, 26, 77)
    assert sun["carrier_hz"] == pytest.approx(CARRIER_HZ)
    assert sun["mesh_hz"] == pytest.approx(77 * CARRIER_HZ)
    assert sun["planet_hz"] == pytest.approx(77 / 26 * CARRIER_HZ)
    assert sun["planet_positions_deg"] == pytest.approx([0.0, 120.0, 240.0])
    assert not [name for name in sun if "pinion" in name or "gear_" in name]
    assert {row["gear"] for row in rows(made, "damage")} == {"sun", "planet", "ring"}
    ring = found["ring"]
    assert ring["faulty_gear"] == "ring"
    assert (len(ring["faulty_teeth_ring"]), sun["faulty_teeth_ring"]) == (1, [])
    assert ring["through_face"]
    assert ring["damaged_area_mm2"] > 15.0
    assert ring["mesh_stiffness_loss_as_simulated"] > 0.3


def test_the_card_and_the_plan_say_what_the_machine_is(made: Path) -> None:
    card = (made / "README.md").read_text(encoding="utf-8")
    assert "a sun with 25 teeth drives 3 planets with 26 in a ring with 77" in " ".join(card.split())
    told = run("plan", str(made / "config.yaml"), "--trial", "0").stdout
    assert "462 Hz" in told


def test_every_mesh_carries_its_share_of_the_torque_in_the_mean(made: Path, tmp_path: Path) -> None:
    file = tmp_path / "meshes.parquet"
    done = run("show", str(made / "config.yaml"), "--record", "0", "--internals", "--out", str(file))
    assert done.returncode == 0, done.stderr
    table = pq.read_table(file)
    names = [f"{ring}_{planet}_mesh_force_n" for ring in ("sun", "ring") for planet in (1, 2, 3)]
    means = [np.mean(table.column(name).to_numpy()) for name in names]
    base_radius_m = 0.5 * 2e-3 * 25 * np.cos(np.radians(20.0))
    assert means == pytest.approx([60.0 / PLANETS / base_radius_m] * 6, rel=2e-3)


def test_what_knows_no_carrier_says_so(made: Path) -> None:
    told = run("inspect", "pressure", str(made / "config.yaml"), "--out", str(made / "../p.csv"))
    assert told.returncode == 2
    assert "planetary" in told.stderr
    assert "allowed" in told.stderr


def test_pins_out_of_place_bring_back_all_orders(tmp_path: Path) -> None:
    healthy = [{"name": "healthy"}]
    made = generated(
        tmp_path, states=by_name(healthy), planetary={"ring_teeth": 77, "pin_error_um": 20.0}, duration_s=0.5
    )
    (record,) = rows(made, "data")
    assert share_off(power(record), PLANETS * TURNS) > 1e-3  # ten times what a healthy set may have
    assert np.std(record["pin_errors_um"]) > 1.0


@pytest.mark.parametrize(
    ("changes", "path", "allowed"),
    [
        ({"planetary": {"ring_teeth": 60}}, "planetary.ring_teeth", "77 on one axis with the sun"),
        ({"planetary": {"ring_teeth": 77, "positions_deg": [0, 90, 180, 270]}}, "planetary.positions_deg", "360/102"),
        ({"planetary": {"ring_teeth": 77, "positions_deg": [0, 180]}}, "planetary.positions_deg", "3 to 5"),
        ({"dynamics": {"friction": {"model": "off"}}}, "housing.kind", "rigid or modal"),
        ({"background": {"second_stage": {"order": 20.0}}}, "background.second_stage", "auxiliary_drive"),
        ({"background": {"base": {}}}, "background.base", "dynamics.model: casing"),
        ({**HOUSED, "sensors": {"b": {"place": "lid"}}}, "sensors.b.place", "casing, ring"),
        ({**HOUSED, "sensors": {"b": {"place": "casing"}}}, "sensors.b.position_mm", "centre of gravity"),
        ({**HOUSED, "housing": {"kind": "modal", "modes": MODES}}, "housing.modes", "for the bearing forces"),
        ({"operating_points": [{"speed_hz": 20.0, "torque_nm": 0.0}]}, "operating_points.0.torque_nm", "above 0"),
        ({"sensors": {"b": {"place": "pinion_bearing"}}}, "sensors.b.place", "ring"),
        ({"planetary": None}, "states.sun.damage.gear", "allowed: one of pinion, gear, either"),
        (
            {"states": {"severe": {"damage": {"kind": "chip", "gear": "sun", "height_mm": 1.0}}}},
            "states.severe.damage.kind", "pits, spalls and cracks",
        ),
        (
            {"states": {"severe": {"damage": {"kind": "crack", "gear": "ring", "depth_share": 0.2}}}},
            "states.severe.damage.kind", "pits and spalls of a ring",
        ),
        (
            {"states": {"severe": {"damage": {**SPALL, "gear": "ring", "centre_height_mm": 9.0}}}},
            "states.severe.damage.centre_height_mm", "flank",
        ),
        (
            {"states": {"severe": {"damage": {**SPALL, "gear": "ring", "teeth": [77]}}}},
            "states.severe.damage.teeth", "the ring has 77 teeth",
        ),
        (
            {"states": {"severe": {"damage": {**SPALL, "gear": "planet", "teeth": [26]}}}},
            "states.severe.damage.teeth", "the planet has 26 teeth",
        ),
    ],
)  # fmt: skip
def test_what_a_set_cannot_be_is_refused_with_its_path_and_what_is_allowed(
    changes: dict[str, Any], path: str, allowed: str
) -> None:
    with pytest.raises(ConfigError) as told:
        load_config(planets(**changes))
    problems = {problem.path: problem for problem in told.value.problems}
    assert path in problems, problems
    assert allowed in str(problems[path])


def test_teeth_that_do_not_assemble_are_told_by_path_and_line(tmp_path: Path) -> None:
    told = run("plan", written(tmp_path, planetary={"ring_teeth": 60}))
    assert told.returncode != 0
    assert "planetary.ring_teeth" in told.stderr
    assert "line" in told.stderr
    assert "Traceback" not in told.stderr


def test_columns_of_a_set_are_read_from_plain_parquet(made: Path) -> None:
    schema = pq.read_schema(next((made / "data").iterdir()))
    assert schema.field("carrier_hz").metadata[b"unit"] == b"Hz"
    assert schema.field("accel_ring_vertical_m_s2").metadata[b"place"] == b"ring"


def test_a_healthy_set_in_a_housing_keeps_the_closed_rule_of_orders(tmp_path: Path) -> None:
    """What the housing passes on turns with the planets, and equal planets pass after each other."""
    (record,) = rows(generated(tmp_path, **HOUSED, states={"healthy": {}}), "data")
    found = power(record, "accel_lid_vertical_m_s2")
    assert share_off(found, PLANETS * TURNS) < 1e-4  # -40 dB
    assert found.sum() > 0.0
    assert record["path_accelerance_lid_vertical_m_s2_per_n"] > 0.0


def modal(*, turning: float, shift: float) -> str:
    """Return a mode of a housing that the ring turns, shifts or both."""
    seats = [f"{place}_{axis}" for place in ("sun_bearing", "carrier_bearing", "ring") for axis in AXES]
    names = [*(f"{seat}_per_sqrt_kg" for seat in seats), "ring_turning_per_sqrt_kg_m", "lid_vertical_per_sqrt_kg"]
    shape = [shift if seat.startswith("ring") else 0.0 for seat in seats]
    numbers = ",".join(map(repr, [700.0, 0.05, *shape, turning, 0.1]))
    return "\n".join([",".join(["frequency_hz", "damping_ratio", *names]), numbers, ""])


AXES = ("horizontal", "vertical")


@pytest.mark.parametrize(
    ("modes", "carrier"), [({"turning": 2.0, "shift": 0.0}, False), ({"turning": 0.0, "shift": 0.1}, True)]
)
def test_a_transfer_that_is_alike_at_all_angles_hears_no_carrier(
    tmp_path: Path, modes: dict[str, float], carrier: bool
) -> None:
    """Pins out of place make planets unlike; a ring that may turn alone passes the sum of their pushes on."""
    changes = {
        **HOUSED,
        "housing": {"kind": "modal", "modes": modal(**modes)},
        "sensors": {"lid": {"place": "casing", "axes": ["vertical"], "bits": None}},
        "planetary": {"ring_teeth": 77, "pin_error_um": 20.0},
        "states": {"healthy": {}},
    }
    (record,) = rows(generated(tmp_path, **changes), "data")
    found = power(record, "accel_lid_vertical_m_s2")
    off_mesh = share_off(found, 77 * TURNS)
    assert off_mesh > 1e-2 if carrier else off_mesh < 1e-4


@pytest.mark.slow
def test_a_set_with_housing_and_background_is_generated_verified_and_names_its_shafts(tmp_path: Path) -> None:
    background = {
        "base": {}, "rubbing": {"bursts": {}}, "bearings": {}, "machines": {}, "shafts": {},
        "auxiliary_drive": {"order": 4.7},
    }  # fmt: skip
    made = generated(
        tmp_path, **HOUSED, background=background, states=dict([*planets()["states"].items()][:2]), specimens=2
    )
    told = run("verify", str(made))
    assert told.returncode == 0, told.stdout + told.stderr
    found = rows(made, "data")
    for name in ("bearing_velocity_sun_um_s", "bearing_velocity_carrier_um_s", "coupling_force_carrier_n"):
        assert found[0][name] > 0.0
    assert not [name for name in found[0] if "pinion" in name or "gear_" in name]
    # rubbing turns with the planets, so it is heard between the lines of a healthy set, and follows no state
    noise = power(found[0], "accel_lid_vertical_m_s2")
    assert share_off(noise, PLANETS * TURNS) > 1e-3
    assert found[0]["rubbing_force_n"] == found[1]["rubbing_force_n"]
