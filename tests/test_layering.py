"""Data flows one way: a module imports from its own folder and lower floors only, and there is no cycle."""

from __future__ import annotations

import ast
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]

# Floors by longest matching prefix. plan and specimen stand below the physics since the composition uses them.
FLOORS = {
    "siggen.errors": 0,
    "siggen.seeding": 0,
    "siggen.config": 1,
    "siggen.dataset.plan": 1.5,
    "siggen.dataset.specimen": 1.5,
    "siggen.gears": 2,
    "siggen.gears.contact": 2.5,
    "siggen.dynamics": 3,
    "siggen.sensing": 4,
    # The composition, in the order of the data; dataset lies between, since simulate makes its records.
    "siggen.specimen_physics": 5.0,
    "siggen.specimen_structure": 5.0,
    "siggen.spall_physics": 5.05,
    "siggen.specimen_friction": 5.0,
    "siggen.specimen_errors": 5.0,
    "siggen.variation_notes": 5.0,
    "siggen.specimen_forces": 5.0,
    "siggen.specimen_drive": 5.02,
    "siggen.specimen_contact": 5.0,
    "siggen.specimen_motion": 5.05,
    "siggen.state_damage": 5.1,
    "siggen.variation_problems": 5.1,
    "siggen.physical_problems": 5.2,
    "siggen.quantity_names": 5.25,
    "siggen.loading": 5.3,
    "siggen.record_labels": 5.35,
    "siggen.specimen_housing": 5.05,
    "siggen.measured_response": 5.05,
    "siggen.specimen_instrument": 5.1,
    "siggen.channel_disturbance": 5.2,
    "siggen.record_forces": 5.2,
    "siggen.path_curves": 5.45,
    "siggen.sensor_channels": 5.35,
    "siggen.stiffness_curves": 5.35,
    "siggen.natural_modes": 5.35,
    "siggen.tooth_deviations": 5.35,
    "siggen.contact_notes": 5.35,
    "siggen.damage_table": 5.35,
    "siggen.damage_outline": 5.35,
    "siggen.dataset": 5.4,
    "siggen.flank_views": 5.45,
    "siggen.internal_quantities": 5.45,
    "siggen.simulation": 5.5,
    "siggen.record_internals": 5.6,
    "siggen.exported_model": 5.6,
    "siggen.engines": 7,
    "siggen.generation": 8,
    "siggen.verification": 8,
    "siggen.cli": 9,
    "siggen": 8.5,
}
PHYSICS = ("siggen.gears", "siggen.dynamics", "siggen.sensing")
PHYSICS_MAY_IMPORT = {"numpy", "scipy", "numba", "siggen"}
DIAGNOSTICS_MAY_IMPORT = {"siggen", "siggen.errors", "siggen.dataset.record", "siggen.dataset.reading"}


def module_name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def modules(package: str) -> dict[str, Path]:
    return {module_name(p): p for p in sorted((ROOT / package).rglob("*.py"))}


def is_type_checking(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)


def imports(path: Path, known: set[str], *, top_level_only: bool = False) -> set[str]:
    """Every imported module; `from a import b` counts as a.b where that is a module."""
    found: set[str] = set()

    def visit(node: ast.AST) -> None:
        for child in ast.iter_child_nodes(node):
            if is_type_checking(child) or (top_level_only and isinstance(child, ast.FunctionDef)):
                continue
            if isinstance(child, ast.Import):
                found.update(alias.name for alias in child.names)
            elif isinstance(child, ast.ImportFrom) and child.level == 0 and child.module:
                for alias in child.names:
                    full = f"{child.module}.{alias.name}"
                    found.add(full if full in known else child.module)
            visit(child)

    visit(ast.parse(path.read_text()))
    return found


def floor(module: str) -> float:
    prefixes = [p for p in FLOORS if module == p or module.startswith(p + ".")]
    return FLOORS[max(prefixes, key=len)]


def same_folder(a: str, b: str, paths: dict[str, Path]) -> bool:
    return paths[a].parent == paths[b].parent or paths[b].parent in paths[a].parents


SIGGEN = modules("siggen")
DIAGNOSTICS = modules("diagnostics")


@pytest.mark.parametrize("module", sorted(SIGGEN))
def test_imports_come_from_lower_floors_or_the_own_folder(module: str) -> None:
    for imported in imports(SIGGEN[module], set(SIGGEN)):
        if imported not in SIGGEN:
            continue
        own_folder = SIGGEN[module].parent == SIGGEN[imported].parent and SIGGEN[module].parent != ROOT / "siggen"
        assert own_folder or floor(imported) < floor(module), f"{module} (floor {floor(module)}) imports {imported}"


@pytest.mark.parametrize("module", sorted(m for m in SIGGEN if m.startswith(PHYSICS)))
def test_physics_knows_neither_files_nor_configuration(module: str) -> None:
    allowed = PHYSICS_MAY_IMPORT | {
        "__future__", "collections", "dataclasses", "enum", "functools", "itertools", "math", "typing",
    }  # fmt: skip
    assert {name.split(".")[0] for name in imports(SIGGEN[module], set(SIGGEN))} <= allowed


@pytest.mark.parametrize("module", sorted(DIAGNOSTICS))
def test_diagnostics_reads_sets_only_through_the_public_door(module: str) -> None:
    used = {name for name in imports(DIAGNOSTICS[module], set(SIGGEN)) if name.split(".")[0] == "siggen"}
    assert used <= DIAGNOSTICS_MAY_IMPORT


@pytest.mark.parametrize("module", sorted(SIGGEN))
def test_siggen_never_imports_diagnostics(module: str) -> None:
    assert not any(name.split(".")[0] == "diagnostics" for name in imports(SIGGEN[module], set(SIGGEN)))


@pytest.mark.parametrize("paths", [SIGGEN, DIAGNOSTICS], ids=["siggen", "diagnostics"])
def test_there_is_no_import_cycle(paths: dict[str, Path]) -> None:
    graph = {
        module: {i for i in imports(path, set(paths), top_level_only=True) if i in paths and i != module}
        for module, path in paths.items()
    }
    assert len(tuple(TopologicalSorter(graph).static_order())) >= len(paths)  # raises CycleError on a cycle
