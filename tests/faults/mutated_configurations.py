"""Configurations with a mistake or a malice in them: each has to be accepted, or refused in words within seconds."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import Any

import yaml

from benchmarks.row import Row
from siggen.checks.loading import load_config
from tests.faults.mutations import Case, judged, outcomes_row

PRESETS = Path(__file__).resolve().parents[2] / "configs"
COUNT, QUICK_COUNT = 2_000, 200
LIMIT_S = 10.0
"""CPU time of one configuration, which others on the machine do not stretch; the command has 2 s with its start."""

VALUES: tuple[Any, ...] = (
    *(None, True, False, 0, 1, -1, -0.0, 2, 3, 0.5, 1e-300, 1e300, 1e308, -1e308, 5e-324, 10**30, 10**390, -(10**30)),
    *(float("nan"), float("inf"), float("-inf"), "", " ", "no", "1e3", "x" * 3000, "../file", "\u2028", "healthy"),
    *([], {}, [[]], [{}], [1.0, 2.0], [2.0, 1.0], [0.0] * 40, ["a"] * 40, {"kind": "uniform"}, {"kind": "x"}),
    *({"normal": [1e300, 1e300], "within": [0, 1]}, {"log": [1, 0]}, {"each": [1, 0]}, {"a": {"b": {"c": {"d": 1}}}}),
)
CHARACTERS = "&*!|>'\"%@`{}[],?:-#\t\n \\0a\u00e9\u0000\ufeff~="


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the row of all configurations."""
    count = QUICK_COUNT if quick else COUNT
    load_presets()
    with tempfile.TemporaryDirectory() as folder:
        cases = (judged_configuration(text, Path(folder)) for text in mutated(count))
        yield outcomes_row(f"{count} mutated configurations", cases, count, "accepted", "CPU")


def load_presets() -> None:
    """Load every preset, so that no mutated one pays for the compiler, which the first run on a machine needs."""
    for preset in PRESETS.glob("*.yaml"):
        load_config(preset)


def mutated(count: int, seed: int = 0) -> Iterator[str]:
    """Yield texts of configurations: a preset with one to three values, keys or characters changed."""
    chance = Random(seed)
    presets = [path.read_text(encoding="utf-8") for path in sorted(PRESETS.glob("*.yaml"))]
    for _ in range(count):
        text = chance.choice(presets)
        if chance.random() < 0.35:
            for _ in range(chance.randint(1, 3)):
                text = _other_text(text, chance)
            yield text
            continue
        tree = yaml.safe_load(text)
        for _ in range(chance.randint(1, 3)):
            _other_tree(tree, chance)
        yield yaml.safe_dump(tree, sort_keys=False, allow_unicode=True)


def judged_configuration(text: str, folder: Path) -> Case:
    """Return what `siggen plan` would do with a text: load it, all checks of form and physics."""
    file = folder / "mutated.yaml"
    file.write_text(text, encoding="utf-8", errors="surrogatepass")
    return judged(text, lambda: load_config(file), LIMIT_S)


def _other_tree(tree: Any, chance: Random) -> None:
    """Change one value or key somewhere in a tree."""
    parent = chance.choice([place for place in _containers(tree) if place] or [tree])
    if not parent:
        return
    key = chance.choice(list(parent) if isinstance(parent, dict) else range(len(parent)))
    match chance.randrange(6):
        case 0:
            del parent[key]
        case 1 if isinstance(parent, dict):
            parent[f"{key}{chance.choice('sx_')}"] = parent.pop(key)
        case 1:
            parent += [parent[key]] * chance.randint(1, 30)
        case 2:
            parent[key] = chance.choice(list(_containers(tree)))
        case 3 if isinstance(parent[key], (int, float)) and not isinstance(parent[key], bool):
            parent[key] = parent[key] * chance.choice((-1, 0, 1e-6, 0.1, 2, 10, 1e3, 1e9))
        case _:
            parent[key] = chance.choice(VALUES)


def _containers(tree: Any, depth: int = 0) -> Iterator[Any]:
    if isinstance(tree, (dict, list)) and depth < 12:
        yield tree
        for value in list(tree.values() if isinstance(tree, dict) else tree):
            yield from _containers(value, depth + 1)


def _other_text(text: str, chance: Random) -> str:
    """Change one character or line."""
    place = chance.randrange(len(text))
    lines = text.splitlines(keepends=True)
    line = chance.randrange(len(lines))
    match chance.randrange(5):
        case 0:
            return text[:place] + chance.choice(CHARACTERS) + text[place + 1 :]
        case 1:
            return text[:place] + chance.choice(CHARACTERS) * chance.choice((1, 2, 50)) + text[place:]
        case 2:
            return "".join(lines[:line] + lines[line + 1 :])
        case 3:
            return "".join([*lines[:line], " " * chance.randint(1, 5), *lines[line:]])
        case _:
            return "".join([*lines[: line + 1], *lines[line:]])
