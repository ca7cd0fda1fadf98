"""`python -m tests.mutants [--count N] [--seed S] [--only K ...]`: changes that the nearest tests miss.

Operators and numbers of physics and data code are drawn by a seed and changed one at a time in a copy of the working
tree; the test files that import the changed module, or one that imports it, run there, in a process of their own. A
mutant that survives is a missing check or an equivalent change; someone has to look at each. One that hangs or is
killed is told apart. Compiled code that a change cannot reach, since its module imports the changed one at no remove,
is kept.
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
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from siggen.compiled import WITH_COMPILED_CODE
from siggen.sources import sources_digest

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = (
    "gears",
    "drivetrain",
    "damage",
    "mesh",
    "motion",
    "sensing",
    "gearbox",
    "record",
    "columns",
    "dataset",
    "sets",
)
SWAPPED = {ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*", ast.Lt: "<=", ast.LtE: "<", ast.Gt: ">="}
SWAPPED |= {ast.GtE: ">", ast.Eq: "!=", ast.NotEq: "==", ast.And: "or", ast.Or: "and"}
ONE_DIGEST = """

_of_these_sources = sources_digest


def sources_digest(patterns):
    return {digest!r} if patterns == {patterns!r} else _of_these_sources(patterns)
"""
"""What the copy's `sources.py` ends with: functions stay in the cache whatever becomes of the sources of others."""
GOLDEN = ROOT / "tests" / "record" / "test_golden.py"
SURVIVES, FOUND, HANGS = "SURVIVES", "found", "hangs"
LIMIT_S = 900
"""CPU seconds of one mutant's tests, a quarter of the time by the clock: a change that hangs a test is noticed, and
what else the machine does hardly matters."""


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
    assert all((ROOT / "siggen" / folder).is_dir() for folder in FOLDERS)
    files = sorted(path for folder in FOLDERS for path in (ROOT / "siggen" / folder).rglob("*.py"))
    every = [mutant for file in files for mutant in mutants(file)]
    return random.Random(seed).sample(every, count)


def nearest_tests(file: Path) -> list[str]:
    """Return the test files that import a module, those of its folder, the golden records, and who imports its users.

    Small ones first; a user of a module is one that imports it.
    """
    tests = sorted((ROOT / "tests").rglob("test_*.py"), key=lambda path: path.stat().st_size)
    texts = {path: path.read_text(encoding="utf-8") for path in tests}
    beside = [path for path in tests if path.parent == ROOT / "tests" / file.parent.relative_to("siggen")]
    direct, *used = ([path for path in tests if module in texts[path]] for module in [_module(file), *_users(file)])
    found = [*direct, *beside, GOLDEN, *(path for each in used for path in each)]
    return [str(path.relative_to(ROOT)) for path in dict.fromkeys(found)]


def _module(file: Path) -> str:
    return ".".join(file.with_suffix("").parts)


def _users(file: Path) -> list[str]:
    return [_module(path) for path, names in _imported().items() if _module(file) in names]


def copied_tree(folder: Path) -> Path:
    """Return a copy of the working tree with what is compiled of it."""
    copy = folder / "tree"
    shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(".git", ".venv", "runs", "site", "*.pyc"))
    told = ONE_DIGEST.format(digest=sources_digest(WITH_COMPILED_CODE), patterns=WITH_COMPILED_CODE)
    with (copy / "siggen" / "sources.py").open("a", encoding="utf-8") as file:
        file.write(told)
    return copy


@contextmanager
def changed(mutant: Mutant, copy: Path) -> Iterator[None]:
    """Change the copy; what was compiled of what the change reaches lies aside until the end."""
    target = copy / mutant.file
    source, before = target.read_bytes(), target.stat()
    with tempfile.TemporaryDirectory(dir=copy.parent) as aside:
        kept = [(path, Path(aside) / str(number)) for number, path in enumerate(compiled_of(mutant.file, copy))]
        for path, away in kept:
            path.rename(away)
        target.write_bytes(source[: mutant.start] + mutant.after.encode() + source[mutant.stop :])
        try:
            yield
        finally:
            target.write_bytes(source)
            os.utime(target, ns=(before.st_atime_ns, before.st_mtime_ns))
            for path in compiled_of(mutant.file, copy):
                path.unlink()
            for path, away in kept:
                away.rename(path)


def compiled_of(file: Path, copy: Path) -> list[Path]:
    """Return what the cache of numba holds of the modules that a change reaches."""
    return [
        path
        for reached in reached_from(file)
        for path in sorted((copy / reached).parent.glob(f"__pycache__/{reached.stem}.*.nb[ic]"))
    ]


@cache
def reached_from(file: Path) -> tuple[Path, ...]:
    """Return a module of siggen and those that import it, at any remove."""
    found = [file]
    for reached in found:
        found += [path for path, names in _imported().items() if _module(reached) in names and path not in found]
    return tuple(found)


@cache
def _imported() -> dict[Path, set[str]]:
    """Return what each file of siggen imports: modules, and names of modules, which may be modules."""
    found = {}
    for path in (ROOT / "siggen").rglob("*.py"):
        nodes = [node for node in ast.walk(ast.parse(path.read_bytes())) if isinstance(node, ast.ImportFrom)]
        names = {f"{node.module}.{alias.name}" for node in nodes for alias in node.names}
        found[path.relative_to(ROOT)] = names | {str(node.module) for node in nodes}
    return found


def verdict(mutant: Mutant, copy: Path) -> str:
    """Return what the nearest tests say of the change."""
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *nearest_tests(mutant.file)]
    environment = {**os.environ, "PYTHONPATH": str(copy), "OMP_NUM_THREADS": "1"}
    with changed(mutant, copy):
        limited = ["prlimit", f"--cpu={LIMIT_S}", *command]
        try:
            run = subprocess.run(
                limited, cwd=copy, env=environment, capture_output=True, timeout=4 * LIMIT_S, check=False
            )
        except subprocess.TimeoutExpired:
            return HANGS
    return {0: SURVIVES, 1: FOUND}.get(run.returncode, HANGS)


def main() -> int:
    """Print a line per mutant and how many of them nobody found; return 0."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__)
    parser.add_argument("--count", type=int, default=100, help="mutants that are drawn")
    parser.add_argument("--seed", type=int, default=1, help="of the draw")
    parser.add_argument("--only", type=int, nargs="*", help="numbers of mutants to try, of those that are drawn")
    arguments = parser.parse_args()
    found: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        copy = copied_tree(Path(folder))
        for number, mutant in enumerate(drawn(arguments.count, arguments.seed)):
            if arguments.only is not None and number not in arguments.only:
                continue
            said = verdict(mutant, copy)
            found[said] += 1
            what = f"{mutant.file}:{mutant.line}: {mutant.before} -> {mutant.after}"
            print(f"{number:3d} {said:8} {what}", flush=True)
    print(f"{found[SURVIVES]} of {found.total()} survive, {found[HANGS]} hang or were killed: look at those too")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
