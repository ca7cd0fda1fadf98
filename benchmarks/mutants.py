"""`python -m benchmarks.mutants [--count N] [--seed S] [--only K ...]`: changes that the nearest tests miss.

Operators and numbers of physics and data code are drawn by a seed and changed one at a time in a copy of the working
tree; the test files that import the changed module run there, in a process of their own. A mutant that survives is a
missing check or an equivalent change; someone has to look at each.
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("gears", "dynamics", "sensing", "specimen", "planning", "record", "columns", "dataset", "sets")
SWAPPED = {ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*", ast.Lt: "<=", ast.LtE: "<", ast.Gt: ">="}
SWAPPED |= {ast.GtE: ">", ast.Eq: "!=", ast.NotEq: "==", ast.And: "or", ast.Or: "and"}
LIMIT_S = 600
"""Of one mutant; a change that hangs a test is noticed."""


@dataclass(frozen=True, slots=True)
class Mutant:
    """One change: the file below the root, its line, and the text from which and to which a stretch changes."""

    file: Path
    line: int
    start: int
    stop: int
    before: str
    after: str


def mutants(file: Path) -> Iterator[Mutant]:
    """Yield every change of an operator or a number in a file, texts and annotations left out."""
    source = file.read_bytes()
    starts = [0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    def place(line: int, column: int) -> int:
        return starts[line - 1] + column

    def changed(line: int, start: int, stop: int, after: str) -> Mutant:
        return Mutant(file.relative_to(ROOT), line, start, stop, source[start:stop].decode(), after)

    for node in _code(ast.parse(source)):
        if isinstance(node, ast.Constant) and type(node.value) in (int, float):
            start, stop = place(node.lineno, node.col_offset), place(node.lineno, node.end_col_offset or 0)
            after = str(node.value + 1) if isinstance(node.value, int) else repr(1.3 * node.value + (not node.value))
            yield changed(node.lineno, start, stop, after)
        for left, operator, right in _operators(node):
            start, stop = place(left.end_lineno or 0, left.end_col_offset or 0), place(right.lineno, right.col_offset)
            if (after := SWAPPED.get(type(operator))) is not None:
                gap = source[start:stop].decode()
                sign = gap.strip(" ()\\\n")
                if sign and "#" not in gap and gap.count(sign) == 1:
                    at = start + source[start:stop].index(sign.encode())
                    yield changed(left.end_lineno or 0, at, at + len(sign.encode()), after)


def _operators(node: ast.AST) -> Iterator[tuple[ast.expr, ast.AST, ast.expr]]:
    if isinstance(node, ast.BinOp):
        yield node.left, node.op, node.right
    elif isinstance(node, ast.Compare):
        yield from zip((node.left, *node.comparators), node.ops, node.comparators, strict=False)
    elif isinstance(node, ast.BoolOp):
        yield from ((a, node.op, b) for a, b in zip(node.values, node.values[1:], strict=False))


def _code(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes that decide numbers: no annotations, decorators (sizes of caches) or formatted texts."""
    for name, value in ast.iter_fields(node):
        if name in {"annotation", "returns", "decorator_list"} or isinstance(value, ast.JoinedStr):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST) and not isinstance(child, (ast.JoinedStr, ast.Raise)):
                yield child
                yield from _code(child)


def drawn(count: int, seed: int) -> list[Mutant]:
    """Return as many mutants as asked for, drawn from all of physics and data code."""
    files = sorted(path for folder in FOLDERS for path in (ROOT / "siggen" / folder).rglob("*.py"))
    every = [mutant for file in files for mutant in mutants(file)]
    return random.Random(seed).sample(every, count)


def nearest_tests(file: Path) -> list[str]:
    """Return the test files that import a module, else those of its folder; small ones first."""
    module = ".".join(file.with_suffix("").parts)
    tests = sorted((ROOT / "tests").rglob("test_*.py"), key=lambda path: path.stat().st_size)
    direct = [path for path in tests if module in path.read_text(encoding="utf-8")]
    beside = [path for path in tests if path.parent == ROOT / "tests" / file.parent.relative_to("siggen")]
    return [str(path.relative_to(ROOT)) for path in dict.fromkeys([*direct, *beside])]


def survives(mutant: Mutant, copy: Path) -> bool:
    """Tell whether the nearest tests pass with the change."""
    target = copy / mutant.file
    source = target.read_bytes()
    target.write_bytes(source[: mutant.start] + mutant.after.encode() + source[mutant.stop :])
    try:
        command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *nearest_tests(mutant.file)]
        environment = {**os.environ, "PYTHONPATH": str(copy), "OMP_NUM_THREADS": "1"}
        run = subprocess.run(command, cwd=copy, env=environment, capture_output=True, timeout=LIMIT_S, check=False)
        return run.returncode == 0
    except subprocess.TimeoutExpired:
        return False
    finally:
        target.write_bytes(source)


def main() -> int:
    """Print a line per mutant and the number of survivors; return 0."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mutants", description=__doc__)
    parser.add_argument("--count", type=int, default=100, help="mutants that are drawn")
    parser.add_argument("--seed", type=int, default=1, help="of the draw")
    parser.add_argument("--only", type=int, nargs="*", help="numbers of mutants to try, of those that are drawn")
    arguments = parser.parse_args()
    survivors, tried = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "tree"
        shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(".git", ".venv", "runs", "site", "__pycache__"))
        for number, mutant in enumerate(drawn(arguments.count, arguments.seed)):
            if arguments.only is not None and number not in arguments.only:
                continue
            alive, tried = survives(mutant, copy), tried + 1
            survivors += alive
            what = f"{mutant.file}:{mutant.line}: {mutant.before} -> {mutant.after}"
            print(f"{number:3d} {'SURVIVES' if alive else 'found   '} {what}", flush=True)
    print(f"{survivors} of {tried} survive")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
