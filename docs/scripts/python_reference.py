"""Print docs/reference/python.md: `python docs/scripts/python_reference.py > docs/reference/python.md`.

Signatures and docstrings of the public names of siggen and diagnostics.
"""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import siggen
from siggen.dataset.reading import Dataset
from siggen.sets.chosen_records import ChosenRecords
from siggen.sets.streaming import RecordStream

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
HEAD = """# Python API

This page is printed by `make reference` from the docstrings; `help(siggen.run)` says the same.
Anything else may move between versions.

```python
import siggen

gearbox = siggen.single_stage(teeth=(23, 61), module_mm=2.5)
record = siggen.run(gearbox, speed_hz=25, torque_nm=40)
record.spectrum().plot()
```
"""
SECTION = re.compile(r"^(\w+)\n-{3,}\n", re.MULTILINE)
HEADED = re.compile(r"\* `[^`]*`( \(.*\))?")
"""An entry of which nothing is said yet."""


def entry(name: str, value: Any, level: str = "###") -> str:
    """Return heading, signature and docstring of a name, of a class with those of its public methods."""
    owner = f"siggen.{name}"
    parts = [f"{level} `{owner}`", f"```text\n{signature(name, value)}\n```", described(inspect.getdoc(value) or "")]
    if inspect.isclass(value):
        parts += [member(method, one) for method, one in vars(value).items() if not method.startswith("_")]
    return "\n\n".join(part for part in parts if part)


def member(name: str, value: Any) -> str:
    """Return a method or property of a class as one item; fields are in its docstring."""
    if isinstance(value, property) or type(value).__name__ == "cached_property":
        text = inspect.getdoc(value) or ""
        return f"* `.{name}`: {first_sentence(text)}"
    value = inspect.unwrap(getattr(value, "__func__", value))
    if not inspect.isfunction(value):
        return ""
    call = re.sub(r"\(self(, )?", "(", str(inspect.signature(value)))
    return f"* `.{name}{shortened(call)}`: {first_sentence(inspect.getdoc(value) or '')}"


def signature(name: str, value: Any) -> str:
    """Return how it is called, its types as they are written."""
    if inspect.isclass(value) and is_dataclass(value):
        shown = [one for one in fields(value) if one.init and not one.name.startswith("_")]
        return f"class {name}({', '.join(f'{one.name}: {one.type}' for one in shown)})"
    if inspect.isclass(value):
        return f"class {name}"
    text = f"{name}{shortened(str(inspect.signature(value)))}"
    return text if len(text) < 100 else "\n".join(textwrap.wrap(text, 100, subsequent_indent="    "))


def shortened(text: str) -> str:
    """Return a signature without the quotes of types that are read late."""
    return re.sub(r"'([^']+)'", r"\1", text).replace("Entries", "Mapping[str, Mapping[str, Any]]")


def described(doc: str) -> str:
    """Return a docstring as Markdown: sections of numpy's form become lists."""
    pieces = SECTION.split(doc)
    text = [re.sub(r"\n(?!\n)", " ", pieces[0].strip()).replace("  ", "\n\n")] if pieces[0].strip() else []
    for title, body in zip(pieces[1::2], pieces[2::2], strict=True):
        text.append(f"**{title}**\n\n" + "\n".join(items(body)))
    return "\n\n".join(text)


def items(body: str) -> list[str]:
    """Return the entries of a section, one line each; what follows the entries stands behind them."""
    found: list[str] = []
    for line in body.strip().splitlines():
        if not line.strip():
            found.append("")
        elif line.startswith(" ") and found:
            found[-1] += f"{': ' if HEADED.fullmatch(found[-1]) else ' '}{line.strip()}"
        elif found and found[-1] == "":
            found.append(line)
        elif found and not found[-1].startswith("*"):
            found[-1] += f" {line}"
        else:
            name, _, kind = line.partition(" : ")
            found.append(f"* `{name}`" + (f" ({kind})" if kind else ""))
    return found


def first_sentence(text: str) -> str:
    """Return the first paragraph on one line."""
    return " ".join(text.split("\n\n", maxsplit=1)[0].split())


def page() -> str:
    """Return the page."""
    grouped = {name for names in GROUPS.values() for name in names}
    groups = {**GROUPS, REST: tuple(name for name in siggen.__all__ if name not in grouped)}
    parts = [HEAD]
    for title, names in groups.items():
        parts.append(f"## {title}\n")
        parts += [entry(name, getattr(siggen, name)) + "\n" for name in names]
    for name, returned in (("open", Dataset), ("stream", RecordStream)):
        parts.append(
            entry(f"{name}(...)", returned).replace(f"`siggen.{name}(...)`", f"What `siggen.{name}` returns") + "\n"
        )
    parts.append(entry("ChosenRecords", ChosenRecords) + "\n")
    return "\n".join([*parts, of_diagnostics()])


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
        "diagnostics.leaderboard": "bench.leaderboard",
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


def of_diagnostics() -> str:
    """Return the sections of diagnostics, whose sources are read: torch and scikit-learn need not be there."""
    parts = []
    for heading, homes in DIAGNOSTICS.items():
        parts += [heading, *(read_entry(name, home) for name, home in homes.items())]
    return "\n\n".join(parts) + "\n"


def read_entry(name: str, home: str) -> str:
    """Return heading, signature and docstring of a name in a source, of a class with those of its public methods."""
    source = ast.parse((ROOT / "diagnostics" / f"{home.replace('.', '/')}.py").read_text(encoding="utf-8"))
    short = name.rpartition(".")[2]
    (node,) = (one for one in source.body if getattr(one, "name", "") == short)
    doc = ast.get_docstring(node) or ""
    if isinstance(node, ast.ClassDef):
        made = next((one for one in node.body if getattr(one, "name", "") == "__init__"), None)
        shown = f"class {short}{called(made) if made else ''}".removesuffix(" -> None")
        doc += "\n\n" + (ast.get_docstring(made) or "") if made else ""
        of_class = [one for one in node.body if isinstance(one, ast.FunctionDef) and not one.name.startswith("_")]
        methods = [read_member(one) for one in of_class]
    else:
        shown, methods = f"{short}{called(node)}", []
    text = "\n".join(textwrap.wrap(shown, 100, subsequent_indent="    "))
    return "\n\n".join([f"### `{name}`", f"```text\n{text}\n```", described(doc.strip()), *methods])


def read_member(node: ast.FunctionDef) -> str:
    """Return a method or property of a source as one item."""
    is_property = any("property" in ast.unparse(one) for one in node.decorator_list)
    return f"* `.{node.name}{'' if is_property else called(node)}`: {first_sentence(ast.get_docstring(node) or '')}"


def called(node: ast.FunctionDef) -> str:
    """Return the arguments and the result of a function."""
    arguments = re.sub(r"^self(, )?", "", ast.unparse(node.args))
    return f"({arguments})" + (f" -> {ast.unparse(node.returns)}" if node.returns else "")


if __name__ == "__main__":
    print(page())
