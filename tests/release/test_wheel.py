"""The files of a release are whole, its wheel works where nothing else is, the container file does what it says."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.command import command
from tests.house.source_tree import ROOT
from tests.release.test_locks import pins


def steps() -> list[list[tuple[str, str]]]:
    """Return (instruction, arguments) of every stage of the container file."""
    text = (ROOT / "Containerfile").read_text(encoding="utf-8")
    found = [line.split(" ", 1) for line in text.splitlines() if line and not line.startswith("#")]
    starts = [number for number, (name, _) in enumerate(found) if name == "FROM"]
    return [[(a, b) for a, b in found[i:j]] for i, j in zip(starts, [*starts[1:], len(found)], strict=True)]


def test_the_container_file_has_what_it_copies_and_ends_as_a_user_without_rights() -> None:
    build, final = steps()
    for stage in (build, final):
        assert re.match(r"docker\.io/library/python:3\.11-slim", stage[0][1])
        sources = [
            part for name, rest in stage if name == "COPY" and "--from" not in rest for part in rest.split()[:-1]
        ]
        assert sources
        assert all((ROOT / source).exists() for source in sources)
    rest = dict(final)
    assert rest["USER"].isdigit()
    assert rest["USER"] != "0"
    assert json.loads(rest["ENTRYPOINT"]) == ["siggen"]
    assert any("--require-hashes -r /locks/siggen.txt" in arguments for _, arguments in final)


@pytest.mark.slow  # installs numpy, scipy, numba and pyarrow, and compiles
@pytest.mark.timeout(1800)
def test_the_files_of_a_release_are_whole_and_its_wheel_works_in_a_bare_environment(tmp_path: Path) -> None:
    finished, page = tmp_path / "quickstart", ROOT / "docs/reports/quickstart_report.html"
    small = ["--set", "specimens=1", "--set", "duration_s=0.2", "--workers", "0"]
    assert command("siggen", "generate", "quickstart", "--out", str(finished), *small).returncode == 0
    files = [ROOT / "docs/scripts/release_files.py", tmp_path / "dist", finished, page]
    done = subprocess.run([sys.executable, *map(str, files)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "siggen verify quickstart" in done.stdout

    subprocess.run(["sha256sum", "--check", "--strict", "SHA256SUMS"], cwd=tmp_path / "dist", check=True)
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    stem = f"siggen_gears-{version}"
    wanted = {f"{stem}{end}" for end in ("-py3-none-any.whl", ".tar.gz", ".cdx.json")}
    wanted |= {"quickstart.zip", "quickstart_report.html"}
    hashed = {line.split()[1] for line in (tmp_path / "dist/SHA256SUMS").read_text(encoding="utf-8").splitlines()}
    assert hashed == wanted == {file.name for file in (tmp_path / "dist").iterdir()} - {"SHA256SUMS"}

    listed = json.loads((tmp_path / "dist" / f"{stem}.cdx.json").read_text(encoding="utf-8"))
    assert listed["bomFormat"] == "CycloneDX"
    described = listed["metadata"]["component"]
    assert (described["name"], described["version"]) == ("siggen-gears", version)
    components = {component["name"]: component["version"] for component in listed["components"]}
    assert components == pins("locks/siggen.txt")
    assert len(listed["components"]) == len(components)


@pytest.mark.slow  # as above
@pytest.mark.timeout(1800)
def test_the_steps_of_the_container_file_give_a_siggen_that_runs(tmp_path: Path) -> None:
    """Carries the steps out in folders instead of images, with an environment of its own for each stage."""
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONHOME")}
    for number, stage in enumerate(steps()):
        root = tmp_path / str(number)
        subprocess.run([sys.executable, "-m", "venv", root / "python"], check=True)
        environment["PATH"] = f"{root}/python/bin:{os.environ['PATH']}"
        for name, arguments in stage:
            if name == "COPY":
                _copy(arguments, root, tmp_path / "0")
            elif name == "RUN":
                line = re.sub(r"(?<= )/(?=source|wheel|locks)", f"{root}/", arguments)
                subprocess.run(line, shell=True, check=True, env=environment)
    (root / "sets").mkdir()
    small = [
        "generate",
        "paper_a",
        "--set",
        "specimens=1",
        "--set",
        "duration_s=0.1",
        "--out",
        "set",
        "--workers",
        "0",
    ]
    subprocess.run([root / "python/bin/siggen", *small], check=True, cwd=root / "sets", env=environment)
    assert (root / "sets/set/manifest.json").is_file()


def _copy(arguments: str, root: Path, built: Path) -> None:
    *sources, target = [part for part in arguments.split() if not part.startswith("--from")]
    origin = built if "--from=build" in arguments else ROOT
    place = root / target.lstrip("/")
    for source in sources:
        for found in origin.glob(source.strip("/")):
            if found.is_dir():
                shutil.copytree(found, place, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                (place if target.endswith("/") else place.parent).mkdir(parents=True, exist_ok=True)
                shutil.copy(found, place)
