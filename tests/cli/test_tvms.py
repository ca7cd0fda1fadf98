"""`siggen inspect tvms` as a user calls it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow.csv
import pyarrow.parquet
import pytest
from typer.testing import CliRunner

from siggen.cli.app import app
from siggen.errors import UsageError

runner = CliRunner()


def run(*arguments: object, view: str = "tvms") -> str:
    result = runner.invoke(app, ["inspect", view, *map(str, arguments)], catch_exceptions=True)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code == 0, result.output
    return result.output


@pytest.mark.drawn
def test_the_table_holds_one_column_per_state_and_healthy_is_the_upper_bound(tmp_path: Path) -> None:
    run("configs/paper_a.yaml", "--out", tmp_path / "tvms.csv", "--png", tmp_path / "tvms.png")
    table = pyarrow.csv.read_csv(tmp_path / "tvms.csv")
    assert table.column_names == ["angle_deg", *(f"{s}_n_per_m" for s in ("healthy", "slight", "moderate", "severe"))]
    healthy = table["healthy_n_per_m"].to_numpy()
    for state in ("slight", "moderate", "severe"):
        loss = healthy - table[f"{state}_n_per_m"].to_numpy()
        assert loss.min() >= 0.0
        assert loss.max() > 0.015 * healthy.min()
    assert (tmp_path / "tvms.png").stat().st_size > 10_000


def test_the_stiffness_is_the_same_until_the_contact_reaches_the_pits(tmp_path: Path) -> None:
    run("configs/paper_a.yaml", "--out", tmp_path / "tvms.parquet")
    table = pyarrow.parquet.read_table(tmp_path / "tvms.parquet")
    before = table["angle_deg"].to_numpy() < 16.1  # the pits begin at 16.110 degrees
    assert np.array_equal(table["healthy_n_per_m"].to_numpy()[before], table["severe_n_per_m"].to_numpy()[before])


@pytest.mark.parametrize("name", ["tvms.txt", "tvms"])
def test_an_unknown_ending_is_refused_before_any_work(tmp_path: Path, name: str) -> None:
    with pytest.raises(UsageError, match="allowed are"):
        run("configs/paper_a.yaml", "--out", tmp_path / name)


@pytest.mark.drawn
def test_parts_add_up_to_the_pair_of_the_damaged_tooth(tmp_path: Path) -> None:
    run("configs/paper_a.yaml", "--out", tmp_path / "parts.parquet", "--png", tmp_path / "parts.png", view="parts")
    table = pyarrow.parquet.read_table(tmp_path / "parts.parquet")
    parts = [name for name in table.column_names if name.startswith("severe_") and name.endswith("_m_per_n")]
    assert len(parts) == 9
    total = sum(table[name].to_numpy() for name in parts)
    degrees, mesh = table["angle_deg"].to_numpy(), table["severe_n_per_m"].to_numpy()
    # Alone in contact from the end of double contact, 12.735 degrees, to the next pair's entry at 20.
    single = (degrees > 12.8) & (degrees < 19.95)
    np.testing.assert_allclose(1.0 / total[single], mesh[single], rtol=1e-12)
    in_contact = ~np.isnan(total)
    # Contact ratio 1.63676 times a pitch of 20 degrees.
    assert degrees[in_contact][[0, -1]] == pytest.approx([0.0, 32.735], abs=0.051)
    assert table["severe_contact_m_per_n"].null_count == int(np.sum(~in_contact))
    assert (tmp_path / "parts.png").stat().st_size > 10_000


def test_limits_of_the_models_are_told_beside_the_table(tmp_path: Path) -> None:
    out = str(tmp_path / "tvms.csv")
    result = runner.invoke(
        app, ["inspect", "tvms", "tests/configs/linear_pits.yaml", "--out", out, "--set", "gears.gear.bore_radius_mm=8"]
    )
    assert result.exit_code == 0
    assert "gear (47 teeth): calibration: h_f" in result.stderr
    assert result.stdout.strip() == out


def test_a_picture_with_an_unknown_ending_is_refused_before_any_work(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="allowed are"):
        run("configs/paper_a.yaml", "--out", tmp_path / "tvms.csv", "--png", tmp_path / "tvms.bmp")
    assert not (tmp_path / "tvms.csv").exists()


@pytest.mark.drawn
def test_damage_as_geometry_is_drawn_as_it_is_simulated(tmp_path: Path) -> None:
    spall = "{kind: spall, teeth: 1, profile_length_mm: 1.5, face_length_mm: 20.0, depth_mm: 0.2}"
    states = f"states={{healthy: {{}}, severe: {{damage: {spall}}}}}"
    arguments = ("--torque", 45, "--png", tmp_path / "tvms.png", "--set", states)
    said = run("tests/configs/ideal.yaml", "--out", tmp_path / "tvms.csv", *arguments, view="parts")
    assert "quasi-static mesh stiffness at 45\u00a0N\u00a0m: force over approach, as simulated" in said
    table = pyarrow.csv.read_csv(tmp_path / "tvms.csv")
    columns = {name: table[name].to_numpy(zero_copy_only=False) for name in table.column_names}
    healthy, severe = columns["healthy_n_per_m"], columns["severe_n_per_m"]
    energy, sink_um = columns["severe_potential_energy_n_per_m"], columns["severe_sink_um"]
    # Potential energy leaves nothing in single contact; the flank in fact comes to rest on the edges of the spall.
    assert energy.min() == 0.0
    assert np.isfinite(columns["severe_contact_m_per_n"][energy == 0.0]).all()
    assert severe.min() > 0.0
    deepest = int(np.nanargmax(sink_um))
    force = 45.0 / (0.5 * 18 * 3e-3 * np.cos(np.radians(20.0)))
    deeper_um = 1e6 * (force / severe[deepest] - force / healthy[deepest])
    # Alone in contact the approach grows by the sink; the edges carry the force that the land carried.
    assert deeper_um == pytest.approx(sink_um[deepest], rel=0.02)
    assert columns["severe_land_share"][deepest] == 0.0
    assert np.nanmax(columns["healthy_sink_um"]) == 0.0
    assert np.nanmin(columns["healthy_land_share"]) == 1.0
    # Alone in contact and without damage force over approach is softer than by energy, whose contact is as stiff under
    # any load: relief is at the tips.
    single = (np.abs(columns["angle_deg"] + 2.5) < 1.0) & (
        columns["healthy_potential_energy_n_per_m"] < 0.85 * energy.max()
    )
    assert single.any()
    softer = healthy[single] / columns["healthy_potential_energy_n_per_m"][single]
    assert 0.83 < softer.min() < softer.max() < 0.85
    assert (tmp_path / "tvms.png").stat().st_size > 10_000


def test_where_damage_takes_stiffness_the_curve_is_the_potential_energy_and_has_no_sink(tmp_path: Path) -> None:
    said = run("tests/configs/linear_pits.yaml", "--out", tmp_path / "tvms.parquet", view="parts")
    assert "mesh stiffness by potential energy" in said
    names = pyarrow.parquet.read_table(tmp_path / "tvms.parquet").column_names
    assert not [name for name in names if "sink" in name or "potential" in name]


def test_parts_of_a_contact_across_the_face_add_up_to_the_pair_that_is_simulated(tmp_path: Path) -> None:
    spall = "{kind: spall, face_length_mm: 10, profile_length_mm: 1.0, depth_mm: 0.2}"
    states = f"states={{healthy: {{}}, severe: {{damage: {spall}}}}}"
    face = ("--set", "dynamics.mesh.tip_relief_um=0", "--set", states)
    run("configs/quickstart.yaml", "--out", tmp_path / "face.parquet", "--torque", 60, *face, view="parts")
    table = pyarrow.parquet.read_table(tmp_path / "face.parquet")
    for state in ("healthy", "severe"):
        parts = [n for n in table.column_names if n.startswith(f"{state}_") and n.endswith("_m_per_n")]
        total = sum(table[name].to_numpy(zero_copy_only=False) for name in parts)
        mesh, degrees = table[f"{state}_n_per_m"].to_numpy(), table["angle_deg"].to_numpy()
        alone = (degrees > 14.5) & (degrees < 18.5)  # beyond the reach of corner contact, too
        # Alone in contact the pair is the mesh: two ways from one table, solved by halving and by false position.
        np.testing.assert_allclose(1.0 / total[alone], mesh[alone], rtol=1e-9)
    land = table["severe_land_share"].to_numpy(zero_copy_only=False)
    # Half of the face is spalled, and 200 slices tell it to one slice.
    assert np.nanmin(land) == pytest.approx(0.5, abs=0.01)
    assert np.nanmax(land) == 1.0


def test_a_torque_that_no_teeth_carry_is_refused_with_the_largest_of_the_set(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"torque: received 1e\+09 N m; allowed: up to \d+"):
        run("tests/configs/casing.yaml", "--out", tmp_path / "t.csv", "--torque", 1e9)


def test_a_study_of_a_key_names_its_curves_as_the_user_typed_them(tmp_path: Path) -> None:
    key = "states.moderate.damage.first_height_mm"
    run("configs/paper_a.yaml", "--vary", f"{key}=1.9,2.8", "--out", tmp_path / "tvms.csv")
    table = pyarrow.csv.read_csv(tmp_path / "tvms.csv")
    assert table.column_names == ["angle_deg", *(f"{s}_n_per_m" for s in ("healthy", f"{key}=1.9", f"{key}=2.8"))]
    low, high = (table[f"{key}={value}_n_per_m"].to_numpy() for value in (1.9, 2.8))
    assert low.argmin() != high.argmin()  # pits at other heights meet the mate at other angles
