"""Data flows one way: the rooms stand in one order, and a room imports only from rooms before it.

Imports inside functions and for types alone count like all others.
"""

from __future__ import annotations

import re
from functools import cache
from graphlib import CycleError, TopologicalSorter

import pytest

from tests.house.source_tree import ROOT, imports, modules

SIGGEN_ROOMS = (
    "uncollected", "errors", "names", "live_process", "file_writing", "printable", "plain_json", "sources", "seeding",
    "child_environment", "arrays", "compiled", "uniform_spline", "lanes", "keys",
    "gears", "drivetrain", "damage", "mesh", "motion", "sensing", "noise", "sensors", "life", "config", "rig",
    "gearbox", "columns", "record", "checks", "dataset", "workers", "sets", "views", "publication", "library", "cli",
)  # fmt: skip
DIAGNOSTICS_ROOMS = (
    "base", "signal", "records", "indicators", "statistics", "loader", "training", "judging", "scoring", "recordings",
    "page", "prediction", "machine", "audit", "bench", "calibration", "explore", "report", "cli",
)  # fmt: skip
ROOMS = {"siggen": SIGGEN_ROOMS, "diagnostics": DIAGNOSTICS_ROOMS}
PHYSICS = ("siggen.gears.", "siggen.drivetrain.", "siggen.mesh.", "siggen.motion.", "siggen.sensing.")
PHYSICS_MAY_IMPORT = {"numpy", "scipy", "numba", "siggen", "__future__", "collections", "dataclasses", "enum"} | {
    "fractions", "functools", "itertools", "math", "typing",
}  # fmt: skip
DOOR = {
    "siggen", "siggen.errors", "siggen.printable", "siggen.columns.record", "siggen.columns.drivetrain",
    "siggen.dataset.reading", "siggen.keys.column",
}  # fmt: skip
SHARED = {
    "siggen.child_environment",
    "siggen.dataset.seal",
    "siggen.file_writing",
    "siggen.keys.yaml_source",
    "siggen.plain_json",
} | {f"siggen.cli.{name}" for name in ("echo", "option_groups", "json_output", "program", "working")}
"""What both programs are built with; it knows no set."""
TREE = {package: modules(package) for package in ROOMS}
KNOWN = {name for paths in TREE.values() for name in paths}


@cache
def imported_by() -> dict[str, set[str]]:
    return {name: imports(path, KNOWN) for paths in TREE.values() for name, path in paths.items()}


def room(module: str) -> int | None:
    """Return the position of a module's room; None for the packages themselves, which hold no logic."""
    package, _, rest = module.partition(".")
    found = [i for i, name in enumerate(ROOMS[package]) if rest == name or rest.startswith(f"{name}.")]
    assert found or module in {"siggen", "diagnostics"}, f"{module} has no room"
    return max(found) if found else None


@pytest.mark.parametrize("package", ROOMS)
def test_a_room_imports_only_from_rooms_before_it(package: str) -> None:
    against = []
    for module in TREE[package]:
        own = room(module)
        for imported in imported_by()[module] & set(TREE[package]):
            other = room(imported)
            if own is not None and (other is None or other > own):
                against.append(f"{module} imports {imported}")
    assert not against, "\n".join(sorted(against))


KNOW_THE_FILE = {"config", "rig", "gearbox", "cli"}
"""Rooms that import the configuration: what reads and writes files, and the one door to what is drawn of them."""


def test_what_moves_and_measures_knows_a_drawn_gearbox_and_no_file() -> None:
    asking = {m for m, names in imported_by().items() if any(n.startswith("siggen.config") for n in names)}
    rooms = {m.removeprefix("siggen.").split(".")[0] for m in asking if m.startswith("siggen.")}
    assert rooms == KNOW_THE_FILE


@pytest.mark.parametrize("package", ROOMS)
def test_no_modules_import_each_other_in_a_circle(package: str) -> None:
    paths = TREE[package]
    # The package itself only names where its public functions stand.
    graph = {m: {i for i in imported_by()[m] if i in paths and i != m} for m in paths if m != package}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as circle:
        pytest.fail(" -> ".join(circle.args[1]))


def test_physics_knows_neither_files_nor_configuration() -> None:
    physics = [m for m in TREE["siggen"] if m.startswith(PHYSICS)]
    foreign = {m: {i.split(".")[0] for i in imported_by()[m]} - PHYSICS_MAY_IMPORT for m in physics}
    assert not {m: names for m, names in foreign.items() if names}


def test_diagnostics_reads_sets_only_through_the_public_door() -> None:
    used = {m: {i for i in imported_by()[m] if i.split(".")[0] == "siggen"} for m in TREE["diagnostics"]}
    assert not {m: names for m, names in used.items() if names - DOOR - SHARED}


def test_siggen_never_imports_diagnostics() -> None:
    assert not [m for m in TREE["siggen"] if any(i.split(".")[0] == "diagnostics" for i in imported_by()[m])]


@pytest.mark.parametrize("package", ROOMS)
def test_the_architecture_page_lists_the_same_rooms_in_the_same_order(package: str) -> None:
    page = next((ROOT / "docs").rglob("architecture.md")).read_text(encoding="utf-8")
    section = page.split(f"## Rooms of {package}")[1].split("\n## ")[0]
    rows = re.findall(r"^\* (`[a-z_.,\s`]+`):", section, re.MULTILINE)  # a long row goes over several lines
    assert [name for row in rows for name in row.replace("`", "").replace(",", "").split()] == list(ROOMS[package])
