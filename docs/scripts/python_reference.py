"""Print docs/reference/python.md: `python docs/scripts/python_reference.py > docs/reference/python.md`.

A line for every public name of siggen and diagnostics: how it is called, and the first sentence of its docstring.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import siggen

ROOT = Path(__file__).parents[2]
GROUPS = {
    "Gearboxes": ("single_stage", "machine", "planetary", "draw", "Gearbox", "State", "Point"),
    "Records": ("run", "runs", "Case", "Record", "Spectrum", "LineOrders"),
    "Gears and damage": (
        *("GearPair", "Gear", "mesh_stiffness", "Curve", "flank_picture", "Damage", "Pit", "Spall", "Crack", "Chip"),
        *("Wear", "BearingSpall", "pits_in_layers", "random_pits"),
    ),
    "Sensors": ("Sensor", "Channel", "Reading"),
}
"""Heading -> names; all others are of sets."""
REST = "Files and sets"
RETURNED = {
    "what `siggen.open` returns": "siggen.dataset.reading.Dataset",
    "what `siggen.stream` returns": "siggen.sets.streaming.RecordStream",
    "what `.select` of a set returns": "siggen.sets.chosen_records.ChosenRecords",
}
"""Classes that are met, not made -> where they are defined."""
HEAD = """# Python API

**`help(siggen.run)` says what each argument means, its unit, the errors and the source.** This page has the names,
printed by `make reference`. Anything else may move between versions.
"""
TABLE = "name|what|has\n---|---|---"

DIAGNOSTICS = {
    "## diagnostics\n\n`import diagnostics` loads nothing. An example: "
    "[your own classifier](../understand/baselines.md#your-own-classifier).": {
        "diagnostics.table": "indicators.classifier_table", "diagnostics.averages": "training.average_rows",
        "FeatureMatrix": "indicators.matrix", "diagnostics.windows": "loader.window_arrays",
        "Windows": "loader.window_arrays", "diagnostics.LogisticBaseline": "training.classifiers",
        "diagnostics.BoostingBaseline": "training.classifiers", "diagnostics.evaluate": "judging.alarms",
        "JudgedDetector": "judging.alarms", "diagnostics.score": "scoring.score",
        "Scores": "scoring.score", "ScoreRow": "scoring.score_rows", "diagnostics.open_benchmark": "scoring.benchmark",
        "diagnostics.score_benchmark": "scoring.benchmark_scores",
        "diagnostics.make_benchmark": "bench.making", "diagnostics.commit_benchmark": "bench.making",
        "diagnostics.reveal_benchmark": "bench.making", "diagnostics.benchmark_baselines": "bench.leaderboard",
        "diagnostics.leaderboard": "bench.leaderboard", "diagnostics.pretrained_features": "training.shipped_network",
        "diagnostics.pretrain": "training.pretraining",
        "diagnostics.PretrainingSettings": "training.pretraining",
    },
    "## diagnostics.loader\n\nWindows of a set for PyTorch. [Load a set](../start/load_a_set.md) has an example.": {
        "diagnostics.loader.WindowStream": "loader.window_stream",
        "diagnostics.loader.WindowLoader": "loader.window_stream",
        "diagnostics.loader.WindowDataset": "loader.window_dataset",
        "diagnostics.loader.ShardSampler": "loader.window_dataset",
        "diagnostics.loader.StreamedWindows": "loader.streamed_windows",
        "diagnostics.loader.StreamSettings": "loader.window_index",
        "diagnostics.loader.Shuffling": "loader.epoch_order",
    },
    "## A measured recording\n\nAll indicators of a file in one call: `diagnostics.machine.recording_indicators`.": {
        "recording_indicators": "machine.recording_indicators", "RecordingIndicators": "machine.recording_indicators",
        "RecordingFacts": "recordings.taken",
    },
}  # fmt: skip
"""Heading -> name, as it is imported or the class that a function returns -> module that defines it."""


def defined(path: str, name: str) -> ast.FunctionDef | ast.ClassDef:
    """Return the definition of a name in a source: torch and scikit-learn need not be there."""
    source = ast.parse((ROOT / path).read_text(encoding="utf-8"))
    (node,) = (one for one in source.body if getattr(one, "name", "") == name)
    assert isinstance(node, ast.FunctionDef | ast.ClassDef)
    return node


def defined_in_siggen(value: Any) -> ast.FunctionDef | ast.ClassDef:
    """Return the definition of a public name of siggen."""
    value = inspect.unwrap(value)
    return defined(str(Path(inspect.getsourcefile(value) or "").relative_to(ROOT)), value.__name__)


def row(name: str, node: ast.FunctionDef | ast.ClassDef) -> str:
    """Return the line of a name: its call, its first sentence, and of a class what it has."""
    shown = f"`{name}{called(node)}`" if "`" not in name else name
    has = ", ".join(f"`{one}`" for one in members(node)) if isinstance(node, ast.ClassDef) else ""
    return "|".join([shown, first_sentence(ast.get_docstring(node) or ""), *([has] if has else [])])


def called(node: ast.FunctionDef | ast.ClassDef) -> str:
    """Return the names and defaults of the arguments; of a class those of its fields, where it is made so."""
    if isinstance(node, ast.FunctionDef):
        return f"({untyped(node.args)})"
    made = next((one for one in node.body if isinstance(one, ast.FunctionDef) and one.name == "__init__"), None)
    if made is not None:
        return f"({untyped(made.args)})"
    fields = [one for one in node.body if isinstance(one, ast.AnnAssign) and isinstance(one.target, ast.Name)]
    names = [one.target.id for one in fields if isinstance(one.target, ast.Name) and "init=False" not in written(one)]
    return f"({', '.join(one for one in names if not one.startswith('_'))})" if names else ""


def written(field: ast.AnnAssign) -> str:
    """Return the default of a field as it is written."""
    return ast.unparse(field.value) if field.value is not None else ""


def untyped(arguments: ast.arguments) -> str:
    """Return arguments as they are called: without types, without `self`."""
    for one in [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg]:
        if one is not None:
            one.annotation = None
    shown = ast.unparse(arguments)
    return shown.removeprefix("self, ").removeprefix("self").removeprefix("cls, ").removeprefix("cls")


def members(node: ast.ClassDef) -> Iterator[str]:
    """Yield the public methods, as they are called, and properties of a class."""
    for one in node.body:
        if isinstance(one, ast.FunctionDef) and not one.name.startswith("_"):
            marks = [ast.unparse(mark) for mark in one.decorator_list]
            if f"{one.name}.setter" in marks:
                continue
            is_property = any("property" in mark for mark in marks)
            yield f".{one.name}{'' if is_property else called(one)}"


def first_sentence(doc: str) -> str:
    """Return the first paragraph on one line; of what is returned the thing alone."""
    text = " ".join(doc.split("\n\n", maxsplit=1)[0].split()).replace("|", "\\|")
    told = text.removeprefix("Return ")
    return told[:1].upper() + told[1:]


def page() -> str:
    """Return the page."""
    grouped = {name for names in GROUPS.values() for name in names}
    parts = [HEAD]
    for title, names in {**GROUPS, REST: [name for name in siggen.__all__ if name not in grouped]}.items():
        parts.append(f"## {title}\n\n{TABLE}")
        for name in names:
            parts.append(row(f"siggen.{name}", defined_in_siggen(getattr(siggen, name))))
        if title == REST:
            for name, home in RETURNED.items():
                module, _, class_name = home.rpartition(".")
                parts.append(row(name, defined(f"{module.replace('.', '/')}.py", class_name)))
        parts.append("")
    for heading, homes in DIAGNOSTICS.items():
        parts.append(f"{heading}\n\n{TABLE}")
        for name, home in homes.items():
            path = f"diagnostics/{home.replace('.', '/')}.py"
            parts.append(row(name, defined(path, name.rpartition(".")[2])))
        parts.append("")
    return "\n".join(parts).rstrip()


if __name__ == "__main__":
    print(page())
