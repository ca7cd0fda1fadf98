"""`siggen-diagnostics report`: one command that trains, and writes a page or models alone."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from diagnostics.cli.app import app
from siggen.errors import UsageError

runner = CliRunner()


@pytest.mark.parametrize(
    ("arguments", "refused"),
    [
        (("--models-only", "--open"), "--open: --models-only writes no page"),
    ],
)
def test_options_of_another_way_are_refused_before_anything_is_read(
    arguments: tuple[str, ...], refused: str, tmp_path: Path
) -> None:
    with pytest.raises(UsageError, match=refused):
        runner.invoke(app, ["report", str(tmp_path / "no_set"), *arguments], catch_exceptions=False)
