"""`siggen tvms` as a user calls it."""

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


def run(*arguments: object) -> None:
    result = runner.invoke(app, ["tvms", *map(str, arguments)], catch_exceptions=True)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code == 0, result.output


def test_the_table_holds_one_column_per_state_and_healthy_is_the_upper_bound(tmp_path: Path) -> None:
    run("configs/paper_a.yaml", "--out", tmp_path / "tvms.csv", "--png", tmp_path / "tvms.png")
    table = pyarrow.csv.read_csv(tmp_path / "tvms.csv")
    assert table.column_names == ["angle_deg", *(f"{s}_n_per_m" for s in ("healthy", "slight", "moderate", "severe"))]
    healthy = table["healthy_n_per_m"].to_numpy()
    for state in ("slight", "moderate", "severe"):
        loss = healthy - table[f"{state}_n_per_m"].to_numpy()
        assert loss.min() >= 0.0
        assert loss.max() > 0.02 * healthy.min()
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
