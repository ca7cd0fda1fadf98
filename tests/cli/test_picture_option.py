"""--open draws a picture and shows it; without --png it goes to a temporary file, and no table is needed."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from typer.testing import CliRunner

from siggen.cli.app import app
from siggen.errors import UsageError
from siggen.views.pictures import PALETTE, save_figure

runner = CliRunner()


@pytest.fixture
def shown(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    addresses: list[str] = []
    monkeypatch.setattr(webbrowser, "open", lambda address: bool(addresses.append(address)) or True)
    return addresses


def run(*arguments: object) -> str:
    result = runner.invoke(app, [*map(str, arguments)], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


@pytest.mark.parametrize("command", ["errors", "modes"])
def test_open_draws_without_a_place_and_shows_what_it_drew(command: str, shown: list[str]) -> None:
    said = run("inspect", command, "configs/paper_b.yaml", "--open")
    (address,) = shown
    picture = Path(unquote(urlsplit(address).path))
    assert picture.name == f"{command}.png"
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert str(picture) in said


def test_open_with_a_place_shows_that_file_and_without_open_nothing_is_shown(tmp_path: Path, shown: list[str]) -> None:
    run("inspect", "modes", "configs/paper_b.yaml", "--png", tmp_path / "modes.png")
    assert shown == []
    run("inspect", "modes", "configs/paper_b.yaml", "--png", tmp_path / "modes.png", "--open")
    assert shown == [(tmp_path / "modes.png").as_uri()]


def test_a_command_with_nothing_to_write_says_what_it_can_write() -> None:
    with pytest.raises(UsageError, match=r"nothing to write; give --out tvms.csv"):
        runner.invoke(app, ["inspect", "tvms", "configs/paper_b.yaml"], catch_exceptions=False)


def test_every_picture_has_the_one_palette_and_other_figures_keep_theirs(tmp_path: Path) -> None:
    import matplotlib as mpl
    from matplotlib.figure import Figure

    seen: list[str] = []

    def draw() -> Figure:
        figure = Figure()
        axis = figure.subplots()
        seen.extend(axis.plot([0, 1], [k, k])[0].get_color() for k in range(len(PALETTE)))
        return figure

    before = mpl.rcParams["axes.prop_cycle"]
    save_figure(draw, tmp_path / "picture.png")
    assert seen == list(PALETTE)
    assert mpl.rcParams["axes.prop_cycle"] == before
