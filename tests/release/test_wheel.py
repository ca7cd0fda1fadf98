"""The wheel works where nothing else is, and the steps of the container file do what they say."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.house.source_tree import ROOT


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
def test_the_wheel_works_in_a_bare_environment(tmp_path: Path) -> None:
    command = [sys.executable, str(ROOT / "docs/scripts/bare_wheel.py"), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "siggen verify set" in done.stdout


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
