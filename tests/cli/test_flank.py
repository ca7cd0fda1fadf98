"""`siggen inspect flank` as a user calls it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pyarrow.csv
import pyarrow.parquet
import pytest
from matplotlib.patches import Polygon
from typer.testing import CliRunner

from siggen.checks.loading import load_config
from siggen.cli.app import app
from siggen.errors import UsageError
from siggen.views.flank import MOST_FLANKS, flank_figure, flank_views
from tests.config.minimal import design
from tests.views.test_damage_outline import polygon_area

runner = CliRunner()


def run(*arguments: object) -> None:
    result = runner.invoke(app, ["inspect", "flank", *map(str, arguments)], catch_exceptions=True)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code == 0, result.output


@pytest.mark.drawn
def test_table_and_picture_of_one_state(tmp_path: Path) -> None:
    run(
        "configs/paper_a.yaml",
        "--state",
        "severe",
        "--out",
        tmp_path / "f.parquet",
        "--png",
        tmp_path / "new" / "f.png",
    )
    table = pyarrow.parquet.read_table(tmp_path / "f.parquet")
    assert table.num_rows == 48
    assert set(table["state"].to_pylist()) == {"severe"}
    assert (tmp_path / "new" / "f.png").stat().st_size > 5_000


def test_csv_holds_lists_as_text(tmp_path: Path) -> None:
    run("configs/paper_a.yaml", "--out", tmp_path / "f.csv")
    table = pyarrow.csv.read_csv(tmp_path / "f.csv")
    assert table.num_rows == 8 + 16 + 48
    assert json.loads(table["polygon_face_mm"][0].as_py()) == []
    assert np.all(table["depth_mm"].to_numpy() == 0.4)


def test_damage_is_drawn_to_scale() -> None:
    views = flank_views(load_config("configs/paper_a.yaml").gearbox(0), state="moderate")
    figure = flank_figure(views)
    axis = figure.axes[0]
    assert axis.get_aspect() == 1.0
    patches = [patch for patch in axis.patches if isinstance(patch, Polygon) and len(patch.get_xy()) > 20]
    drawn = sum(polygon_area(patch.get_xy()[:-1]) for patch in patches)
    # Pits of one layer do not overlap; a polygon of 181 corners is 2e-4 smaller than its ellipse.
    assert drawn == pytest.approx(views[0].area_mm2, rel=3e-4)
    assert f"union {views[0].area_mm2:.2f} mm²" in axis.get_title()


def test_a_picture_with_many_flanks_says_what_it_leaves_out() -> None:
    views = flank_views(design(states__slight__damage__teeth=MOST_FLANKS + 2).gearbox(0))
    figure = flank_figure(views)
    assert f"{MOST_FLANKS} of {MOST_FLANKS + 2}" in figure.get_suptitle()


def test_a_picture_of_no_damage_is_refused_and_nothing_is_written(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no damage to draw in healthy"):
        run("configs/paper_a.yaml", "--state", "healthy", "--out", tmp_path / "f.csv", "--png", tmp_path / "f.png")
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_state_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="allowed: healthy, slight, moderate, severe"):
        run("configs/paper_a.yaml", "--state", "grave", "--out", tmp_path / "f.csv")


@pytest.mark.parametrize(
    ("preset", "state", "gear"), [("two_stage", "slight", "slow_pinion"), ("planetary", "", "ring")]
)
def test_damage_of_every_mesh_is_shown_unless_one_is_chosen(tmp_path: Path, preset: str, state: str, gear: str) -> None:
    out = tmp_path / "f.parquet"
    run(preset, "--out", out, "--png", tmp_path / "f.png", *(("--state", state) if state else ()))
    assert gear in pyarrow.parquet.read_table(out)["gear"].to_pylist()
    if state:
        run(preset, "--out", out, "--state", state, "--mesh", "fast")
        assert pyarrow.parquet.read_table(out).num_rows == 0
