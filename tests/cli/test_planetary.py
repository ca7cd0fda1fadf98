import json

from typer.testing import CliRunner

from siggen.cli.app import app


def test_inspect_prints_speeds_orders_and_phases() -> None:
    command = ["inspect", "planetary", "24", "27", "78", "--carrier-hz", "2"]
    found = json.loads(CliRunner().invoke(app, [*command, "--json"]).stdout)
    assert found["shafts"]["sun"] == {"order": 4.25, "hz": 8.5}
    assert found["passing"]["mesh"]["hz"] == 156.0
    assert "harmonic 1 of the mesh moves: rotation" in CliRunner().invoke(app, command).stdout


def test_a_set_that_does_not_fit_is_refused() -> None:
    found = CliRunner().invoke(app, ["inspect", "planetary", "24", "27", "78", "--at", "0,118,240"])
    assert found.exit_code != 0
    assert "planet does not fit" in str(found.exception)
