"""Workflows call the commands of the Makefile, and nothing that only they know."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.house.source_tree import ROOT

WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
TARGETS = set(re.findall(r"^([a-z][a-z-]*):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))

DRAFTING = {"contents": "write", "id-token": "write", "attestations": "write"}
"""What the one job may do that makes the draft of a release and attests where its files come from."""


def jobs(path: Path) -> dict[str, Any]:
    found: dict[str, Any] = yaml.safe_load(path.read_text(encoding="utf-8"))["jobs"]
    return found


def commands(path: Path) -> list[str]:
    return [step["run"] for job in jobs(path).values() for step in job["steps"] if "run" in step]


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_every_command_is_a_target_of_the_makefile(path: Path) -> None:
    assert commands(path)
    for command in commands(path):
        program, target = command.split()
        assert (program, target in TARGETS) == ("make", True), command


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_a_workflow_has_the_parts_that_github_asks_for(path: Path) -> None:
    content = yaml.safe_load(path.read_text(encoding="utf-8"))
    assert content[True]  # YAML 1.1 reads the key `on` as true
    assert content["permissions"] == {"contents": "read"}
    for job in content["jobs"].values():
        drafts = any(step.get("run") == "make draft" for step in job["steps"])
        assert job.get("permissions") == (DRAFTING if drafts else None)
        assert job["runs-on"] == "ubuntu-latest"
        assert job["timeout-minutes"] <= 180
        assert job["steps"][0]["uses"].startswith("actions/checkout@v")
        for step in job["steps"]:
            assert ("uses" in step) != ("run" in step)
            assert "uses" not in step or re.fullmatch(r"actions/[a-z-]+@v\d+", step["uses"])


def test_every_check_of_the_makefile_is_called() -> None:
    called = {command.split()[1] for path in WORKFLOWS for command in commands(path)}
    assert called >= {"lint", "test", "test-slow", "docs", "wheel", "container", "holes"}
