import json

import pytest
from typer.testing import CliRunner

from siggen.cli.app import app


def test_inspect_prints_speeds_orders_and_phases() -> None:
    command = ["inspect", "planetary", "24", "27", "78", "--carrier-hz", "2"]
    found = json.loads(CliRunner().invoke(app, [*command, "--json"]).stdout)
    assert found["shafts"]["sun"] == {"order": 4.25, "hz": 8.5}
    assert found["passing"]["mesh"]["hz"] == 156.0
    assert "harmonic 1 of the mesh moves: rotation" in CliRunner().invoke(app, command).stdout


@pytest.mark.parametrize(
    ("at", "words"), [("0,118,240", "planet does not fit"), ("0,nan,240", "numbers"), ("0;120", "numbers")]
)
def test_a_set_that_does_not_fit_is_refused(at: str, words: str) -> None:
    found = CliRunner().invoke(app, ["inspect", "planetary", "24", "27", "78", "--at", at])
    assert found.exit_code != 0
    assert words in str(found.exception)


def test_teeth_that_need_a_shift_still_have_orders() -> None:
    found = json.loads(CliRunner().invoke(app, ["inspect", "planetary", "12", "45", "102", "--json"]).stdout)
    assert found["shafts"]["sun"]["order"] == 9.5
    assert "undercut" in found["meshes"]["do not mesh"]
