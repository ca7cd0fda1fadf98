"""`siggen inspect modes` as a user calls it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow.csv
import pytest
from typer.testing import CliRunner

from siggen.cli.app import app

runner = CliRunner()


@pytest.mark.parametrize(("model", "count"), [("8dof", 8), ("casing", 11)])
@pytest.mark.drawn
def test_every_model_has_exactly_one_mode_of_free_rotation(tmp_path: Path, model: str, count: int) -> None:
    rigid = ["--set", "housing={kind: rigid}"] if model == "casing" else []
    result = runner.invoke(
        app,
        [
            "inspect", "modes", "configs/paper_a.yaml", *rigid,
            "--out", str(tmp_path / "modes.csv"), "--png", str(tmp_path / "modes.png"),
            "--set", f"dynamics.model={model}",
        ],
        catch_exceptions=False,
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    table = pyarrow.csv.read_csv(tmp_path / "modes.csv")
    frequencies = table["frequency_hz"].to_numpy()
    assert len(frequencies) == count
    assert (frequencies == 0.0).sum() == 1
    assert (np.diff(frequencies) >= 0.0).all()
    shares = table["mesh_share"].to_numpy()
    assert shares[0] == 0.0
    assert ((shares >= 0.0) & (shares <= 1.0 + 1e-12)).all()
    assert shares[-1] > 0.5  # the fastest mode is that of the teeth
    assert (tmp_path / "modes.png").stat().st_size > 10_000
