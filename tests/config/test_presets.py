"""Configurations that siggen ships are found by name, in a checkout and in a wheel."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tomllib
import venv
from pathlib import Path

import pytest

import siggen.config.presets as shipped
from siggen.checks.loading import load_config
from siggen.config.presets import config_file, presets
from siggen.errors import UsageError

ROOT = Path(__file__).resolve().parents[2]
NAMES = sorted(path.stem for path in (ROOT / "configs").iterdir())


def test_every_shipped_file_is_a_preset_under_its_name(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    assert list(presets()) == NAMES
    for name in NAMES:
        assert config_file(name).samefile(ROOT / "configs" / f"{name}.yaml")
    assert load_config("quickstart", ["specimens=3"]).name == "quickstart"


def test_a_file_of_that_name_goes_first_and_a_folder_does_not(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    Path("bench").mkdir()
    assert config_file("bench").samefile(ROOT / "configs" / "bench.yaml")
    Path("quickstart.yaml").write_text("name: mine")
    assert config_file("quickstart.yaml") == Path("quickstart.yaml")


@pytest.mark.parametrize(
    ("unknown", "meant"),
    [
        ("quikstart", "; did you mean 'quickstart'?"),
        ("configs" + "/helcial.yaml", "; did you mean 'helical'?"),
        ("sub/quickstart", ";"),
    ],
)
def test_an_unknown_name_is_answered_with_the_presets_and_the_one_next_to_it(
    unknown: str, meant: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    with pytest.raises(UsageError) as caught:
        config_file(unknown)
    assert f"{unknown}: there is no such file{meant} allowed are the path of a YAML file" in str(caught.value)
    assert ", ".join(presets()) in str(caught.value)


def test_a_wheel_carries_them_where_they_are_looked_for(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    build = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]["wheel"]
    installed = tmp_path / build["force-include"]["configs"]
    assert installed.relative_to(tmp_path) == shipped.FOLDERS[0].relative_to(shipped.PACKAGE.parent)
    installed.mkdir(parents=True)
    (installed / "mine.yaml").write_text("name: mine")
    monkeypatch.setattr(shipped, "FOLDERS", (installed, ROOT / "configs"))
    assert presets() == {"mine": installed / "mine.yaml"}


@pytest.mark.slow  # builds a wheel, for which pip fetches the build tool, and makes a virtual environment
def test_an_installed_wheel_plans_a_preset_by_name_and_writes_pages(tmp_path: Path) -> None:
    pip = [sys.executable, "-m", "pip", "-q", "--disable-pip-version-check"]
    subprocess.run([*pip, "wheel", "--no-deps", "-w", tmp_path, ROOT], check=True)
    venv.create(tmp_path / "venv", with_pip=False)
    python = tmp_path / "venv" / "bin" / "python"
    (wheel,) = tmp_path.glob("siggen_gears-*.whl")
    subprocess.run([*pip, "--python", python, "install", "--no-deps", wheel], check=True)
    # The libraries of this environment without its siggen, which stands in a file of its own.
    libraries = next(path for path in sys.path if path.endswith("site-packages"))
    begin = f"import sys; sys.path.append({libraries!r}); "

    def run(code: str, *arguments: str) -> str:
        command = [python, "-I", "-c", begin + code, *arguments]
        return subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stdout

    plan = "import siggen; print(siggen.__file__); from siggen.cli.app import main; main()"
    said = run(plan, "plan", "quickstart", "--json")
    assert said.startswith(str(tmp_path / "venv"))
    assert '"name": "quickstart"' in said
    parts = "from diagnostics.page.blocks import Page, Paragraph; from diagnostics.page.template import page_html; "
    said = run(parts + "import diagnostics; print(diagnostics.__file__, page_html(Page('Rig', [Paragraph('Turns.')])))")
    assert said.startswith(str(tmp_path / "venv"))
    assert "<p>Turns.</p>" in said
    assert "--paper" in said  # its style and scripts are in the wheel, too
    assert "aria-sort" in said
    network = "from diagnostics.training.shipped_network import shipped_network; print(shipped_network()[0].kinds)"
    assert "spalling" in run(network)  # the weights are in the wheel
    # What a newcomer writes has types with the wheel alone: py.typed is in it, and public names are resolved.
    (packages,) = (tmp_path / "venv" / "lib").glob("python3*/site-packages")
    (packages / "libraries.pth").write_text(libraries)
    shutil.copy(ROOT / "tests/library/newcomer.py", tmp_path)  # away from the sources
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file=", "--python-executable", python, "newcomer.py"]
    typed = subprocess.run(command, cwd=tmp_path, check=False, capture_output=True, text=True)
    assert typed.returncode == 0, typed.stdout
