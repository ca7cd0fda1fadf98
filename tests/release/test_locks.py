"""Locks hold every pin with its hashes, and no file of the repository names an index."""

from __future__ import annotations

import re
import tomllib

from tests.house.source_tree import ROOT

PIN = re.compile(r"^([A-Za-z0-9._-]+)==([^\s;\\]+)", re.MULTILINE)
PINNED = re.compile(r"constraints\.txt|PINNED|locks/|--no-deps|--require-hashes")
INDEX = re.compile(r"--(?:extra-)?index-url|--find-links|--trusted-host|^index-url|^find-links", re.MULTILINE)


def pins(name: str) -> dict[str, str]:
    text = (ROOT / name).read_text(encoding="utf-8")
    return {re.sub(r"[-_.]+", "-", package).lower(): version for package, version in PIN.findall(text)}


def test_every_pin_of_a_lock_has_hashes() -> None:
    for name in ("locks/siggen.txt", "locks/all.txt"):
        blocks = re.split(r"^(?=\S)", (ROOT / name).read_text(encoding="utf-8"), flags=re.MULTILINE)
        packages = [block for block in blocks if PIN.match(block)]
        assert len(packages) == len(pins(name)) > 15
        assert [block.split("\n")[0] for block in packages if not re.search(r"--hash=sha256:[0-9a-f]{64}", block)] == []


def test_locks_and_constraints_agree() -> None:
    constraints, everything, bare = pins("constraints.txt"), pins("locks/all.txt"), pins("locks/siggen.txt")
    assert bare.items() <= everything.items()
    known = {package: version for package, version in everything.items() if package in constraints}
    assert known == {package: constraints[package] for package in known}
    assert set(constraints) <= set(everything), "run `make locks`, and take out pins that nothing needs any more"


def test_every_dependency_of_the_project_is_locked() -> None:
    content = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    project, groups = content["project"], [one for group in content["dependency-groups"].values() for one in group]
    extras = [entry for entries in project["optional-dependencies"].values() for entry in entries]
    for wanted, lock in ((project["dependencies"], "locks/siggen.txt"), ([*extras, *groups], "locks/all.txt")):
        named = {re.sub(r"[-_.]+", "-", re.match(r"[A-Za-z0-9._-]+", entry)[0]).lower() for entry in wanted}
        assert named - set(pins(lock)) == set()


def test_every_tool_is_installed_at_its_pin() -> None:
    for name in ("Makefile", "docs/scripts/release_files.py"):
        text = (ROOT / name).read_text(encoding="utf-8").replace('", "', " ")
        installs = [line for line in text.splitlines() if "pip install" in line]
        assert installs
        assert [line for line in installs if not PINNED.search(line)] == []


def test_no_file_that_installs_names_an_index() -> None:
    names = ("constraints.txt", "locks/siggen.txt", "locks/all.txt", "pyproject.toml", "Containerfile", "Makefile")
    files = [*(ROOT / name for name in names), *(ROOT / ".github").rglob("*.yml")]
    text = {file.name: file.read_text(encoding="utf-8").replace("--no-emit-index-url", "") for file in files}
    assert [name for name, content in text.items() if INDEX.search(content)] == []
    assert "http" not in re.sub(r"http(core2|x2|x2-jsfetch)\b", "", text["all.txt"])
