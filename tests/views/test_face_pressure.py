"""`siggen inspect pressure`: the force of a pair in a record, spread over its flank and drawn."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow.csv
import pytest
from typer.testing import CliRunner

from siggen.checks.loading import load_config
from siggen.cli.app import app
from siggen.errors import UsageError
from siggen.record.internals import record_internals
from siggen.views.pressure import FacePressure, face_pressure
from tests.config.mill import mill
from tests.config.minimal import by_name
from tests.config.staged import SPALL as SPALL_OF_STAGE
from tests.simulated import drawn_record

CONFIG = "configs/quickstart.yaml"
SPALL = "{kind: irregular, profile_length_mm: 1.2, face_share: 0.6, face_centre_mm: 8, edge_radius_mm: 0.15}"
LINEAR = (
    *("--set", "dynamics.mesh.law=linear", "--set", "dynamics.shafts=null"),
    *("--set", "dynamics.friction.model=off", "--set", "manufacture=null"),
)
OVERRIDES = [
    f"states={{healthy: {{}}, severe: {{damage: {SPALL}}}}}",
    "duration_s=0.2",
    "manufacture={accuracy_class: 6, lead_misalignment_um: 4}",
]


@pytest.fixture(scope="module")
def damaged() -> FacePressure:
    return face_pressure(*drawn_record(load_config(CONFIG, OVERRIDES), 1))


def test_loads_add_up_to_the_force_that_the_pair_has_in_the_record(damaged: FacePressure) -> None:
    config = load_config(CONFIG, OVERRIDES)
    state, _, angle, found = record_internals(*drawn_record(config, 1))
    teeth, tooth = state.pair.pinion.teeth, damaged.view.tooth
    # The pair of the damaged tooth, found by the place of its contact rather than by its number.
    slots = sum(name.endswith("_position_m") for name in found)
    turned = np.radians(damaged.roll_deg)
    entries = [
        (entered, slot)
        for entered in 2.0 * np.pi / teeth * (tooth + teeth * np.arange(80))
        for slot in range(slots)
        if angle[0] <= entered < angle[-1] - turned[-1]
    ]
    place = state.pair.pinion.base_radius_m * turned[80] + state.pair.contact_start_m
    forces = [
        np.interp(entered + turned, angle, found[f"pair_{slot}_force_n"])
        for entered, slot in entries
        if np.interp(entered + turned[80], angle, found[f"pair_{slot}_position_m"]) == pytest.approx(place, rel=1e-3)
    ]
    spread = damaged.line_load_n_per_mm.sum(axis=1) * np.diff(damaged.face_mm)[0]
    np.testing.assert_allclose(spread, damaged.force_n, rtol=2e-6)
    np.testing.assert_allclose(forces[0], damaged.force_n, rtol=1e-9)


def test_edges_press_harder_than_land_and_nothing_presses_far_inside_the_spall(damaged: FacePressure) -> None:
    assert damaged.edge_radius_mm == pytest.approx(0.15)
    land = damaged.pressure_mpa[damaged.at_edge == 0.0].max()
    assert damaged.pressure_mpa[damaged.at_edge > 0.0].max() > 1.5 * land
    (outline,) = damaged.view.outlines_mm
    middle_mm = outline.mean(axis=0)
    inside = np.argmin(np.abs(damaged.arc_mm - middle_mm[1])), np.argmin(np.abs(damaged.face_mm - middle_mm[0]))
    assert damaged.pressure_mpa[inside] == 0.0
    # Beside the spall, at the same height, land carries.
    assert damaged.pressure_mpa[inside[0]].max() > 0.0


def test_a_healthy_tooth_of_the_gear_has_no_edges() -> None:
    found = face_pressure(*drawn_record(load_config(CONFIG, OVERRIDES), 0), "gear", None)
    assert (found.view.gear, found.view.tooth) == ("gear", 0)
    assert not found.at_edge.any()
    # Contact climbs the pinion's flank and goes down the gear's.
    assert np.all(np.diff(found.arc_mm) < 0.0)


def test_a_further_mesh_is_found_by_its_gear_and_its_damaged_tooth_alone_is_unloaded() -> None:
    damage = {**SPALL_OF_STAGE, "face_length_mm": 30.0, "profile_length_mm": 2.0, "gear": "eva", "teeth": [3]}
    states = [{"name": "healthy"}, {"name": "severe", "damage": damage}]
    config = load_config(mill(duration_s=0.2, fs_hz=12_800.0, states=by_name(states)))
    damaged, before = face_pressure(*drawn_record(config, 1)), face_pressure(*drawn_record(config, 1), "eva", 0)
    assert (damaged.view.gear, damaged.view.tooth) == ("eva", 3)
    assert damaged.point.torque_nm == pytest.approx(20.0 * 47 / 18)
    single = slice(60, 90)  # where one pair carries all
    assert damaged.force_n[single].min() < 0.3 * before.force_n[single].min()  # others differ by less than a tenth
    assert before.force_n[single].mean() == pytest.approx(20.0 * 47 / 18 / (0.5 * 17 * 3e-3 * 0.9397), rel=0.05)
    with pytest.raises(UsageError, match="--tooth pinion; allowed: ida, otto, eva, karl"):
        face_pressure(*drawn_record(config, 1), "pinion")


def run(*arguments: object) -> tuple[int, str]:
    options = [part for override in OVERRIDES for part in ("--set", override)]
    result = CliRunner().invoke(app, ["inspect", "pressure", CONFIG, *map(str, arguments), *options])
    if isinstance(result.exception, UsageError):
        raise result.exception
    return result.exit_code, result.output


@pytest.mark.drawn
def test_the_command_writes_table_and_picture_and_says_the_largest_pressures(tmp_path: Path) -> None:
    out, png = tmp_path / "p.csv", tmp_path / "p.png"
    code, said = run("--out", out, "--png", png)
    assert code == 0
    assert "largest elastic pressure at edges of 0.15 mm radius" in said
    table = pyarrow.csv.read_csv(out)
    assert table.num_rows == 161 * len(set(table["face_mm"].to_pylist()))
    assert png.stat().st_size > 20_000


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--tooth", 99), r"--tooth 99: pinion has \d+ teeth"),
        (("--tooth", "gear:40", "--set", "duration_s=0.02"), "goes through mesh nowhere within the record"),
        (LINEAR, "dynamics.mesh.law: received linear"),
    ],
)
def test_what_cannot_be_drawn_is_refused_in_words(tmp_path: Path, arguments: tuple[object, ...], said: str) -> None:
    options = [part for override in OVERRIDES for part in ("--set", override)]
    whole = [
        "inspect",
        "pressure",
        CONFIG,
        *options,
        "--out",
        str(tmp_path / "p.csv"),
        *map(str, arguments),
    ]
    result = CliRunner().invoke(app, whole)
    assert isinstance(result.exception, UsageError)
    with pytest.raises(UsageError, match=said):
        raise result.exception
