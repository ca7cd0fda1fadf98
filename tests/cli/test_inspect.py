"""`siggen inspect WHAT`: what all its views have in common."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from siggen.cli.app import app
from siggen.cli.inspect import View
from siggen.errors import UsageError

SHORT = ["--set", "duration_s=0.1", "--set", "manufacture={accuracy_class: 6}"]


@pytest.mark.parametrize("view", [view for view in View if view is not View.LIFE])
def test_json_alone_is_one_object_with_numbers(view: View) -> None:
    said = CliRunner().invoke(app, ["inspect", view, "quickstart", *SHORT, "--json"], catch_exceptions=False)
    assert said.exit_code == 0, said.output
    found = json.loads(said.stdout)
    assert found
    assert all(value not in ([], {}, None) for value in found.values())


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            "modes quickstart --mesh slow",
            "--mesh: siggen inspect modes has no use for it; it takes --open",
        ),
        ("housing quickstart", "give --out housing.csv, --json for the numbers"),
        ("housing quickstart --out housing.txt", r"allowed are \.csv"),
        ("errors quickstart --state slight --state severe --json", "--state: siggen inspect errors takes one"),
        ("modes quickstart --json --gearbox 60", "quickstart has 24 gearboxes, 0 to 23; --set specimens=61 gives it"),
        ("pressure quickstart --tooth gear --json", "an index such as 4, or a gear and an index such as gear:4"),
        ("pressure quickstart --state sever --json", "--state: received 'sever'; allowed: healthy, .*"),
    ],
)
def test_what_a_view_cannot_use_is_refused_before_any_work(words: str, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        CliRunner().invoke(app, ["inspect", *words.split()], catch_exceptions=False)


def test_the_folder_of_a_set_stands_for_its_configuration(tmp_path: Path) -> None:
    source = Path("configs/quickstart.yaml").read_text(encoding="utf-8")
    (tmp_path / "config.yaml").write_text(source, encoding="utf-8")
    first, second = (
        CliRunner().invoke(app, ["inspect", "modes", str(place), "--json"], catch_exceptions=False).stdout
        for place in (tmp_path, "configs/quickstart.yaml")
    )
    assert first == second
