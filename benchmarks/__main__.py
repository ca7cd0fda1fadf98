"""`python -m benchmarks [topic ...] [--quick] [--json FILE]`: what siggen costs, beside named alternatives.

`python -m benchmarks golden` says which numbers of records moved since they were kept, and by how much.
"""

from __future__ import annotations

import argparse
import importlib
import os
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from benchmarks.machine import load_average, machine_lines
from benchmarks.results_file import ResultsFile
from benchmarks.row import Row
from siggen.child_environment import ONE_THREAD

DEFAULT = (
    *("presets", "precision", "loader", "cold", "memory", "startup", "score"),
    *("workers", "quickstart", "indicators", "pages"),
)
"""CPU time and memory first, then wall time, then what takes long."""
APART = ("anywhere", "start", "many_workers", "growth", "stream")
"""Only where they are named: each takes long."""


def main(package: str = "benchmarks", default: Sequence[str] = DEFAULT, apart: Sequence[str] = APART) -> int:
    """Measure the topics of the command line (without one: all), print the table and return 1 if one failed."""
    if sys.argv[1:2] == ["golden"]:
        os.environ.update(ONE_THREAD)
        return int(importlib.import_module("benchmarks.golden").main(sys.argv[2:]))
    arguments = _arguments(package, default, apart)
    # before numpy is loaded by a topic; idle threads of its linear algebra spin, which would count as CPU time
    os.environ.update(ONE_THREAD)
    console = Console(width=None if Console().is_terminal else 160)
    lines = machine_lines()
    for line in lines:
        console.print(line, style="yellow" if line.startswith("WARNING") else None, highlight=False)
    if arguments.json is not None:
        arguments.json.parent.mkdir(parents=True, exist_ok=True)
    results = ResultsFile(arguments.json, " ".join([f"python -m {package}", *sys.argv[1:]]), lines)
    rows: list[tuple[str, Row]] = []
    for topic in arguments.topics or default:
        begin = time.perf_counter()
        found = list(_rows(f"{package}.{topic}", arguments.quick, console))
        seconds = time.perf_counter() - begin
        results.add(topic, found, seconds, load_average())
        console.print(f"{topic}: {seconds:.0f} s, load average {load_average():.2f}", highlight=False)
        rows += [(topic, row) for row in found]
    console.print(_table(rows))
    console.print(f"load average at the end: {load_average():.2f}", highlight=False)
    return int(any(row.what == f"{topic} failed" for topic, row in rows))


def _arguments(package: str, default: Sequence[str], apart: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog=f"python -m {package}", description=__doc__)
    # no `choices`: argparse would refuse the empty list of a call without topics
    parser.add_argument(
        "topics",
        nargs="*",
        metavar="topic",
        help=f"one or more of {', '.join((*default, *apart))}; default: all but {', '.join(apart) or 'none'}",
    )
    parser.add_argument("--quick", action="store_true", help="fewer repeats, smaller sets, no whole quickstart")
    parser.add_argument(
        "--json", type=Path, metavar="FILE", help="keep the rows here; docs/scripts/benchmark_page.py prints them"
    )
    arguments = parser.parse_args()
    if unknown := [topic for topic in arguments.topics if topic not in (*default, *apart)]:
        parser.error(f"received topic {unknown[0]!r}; allowed: {', '.join((*default, *apart))}")
    return arguments


def _rows(topic: str, quick: bool, console: Console) -> Iterator[Row]:
    """Yield the rows of a topic; one that fails becomes a row that says so, and the others are still measured."""
    with console.status(f"measuring {topic}"):
        try:
            # imported one by one: a topic that is not asked for costs nothing
            yield from importlib.import_module(topic).rows(quick=quick)
        except Exception as error:
            console.print_exception()
            yield Row(f"{topic} failed", f"{type(error).__name__}: {error}", met=False)


def _table(rows: Sequence[tuple[str, Row]]) -> Table:
    table = Table(show_lines=False)
    for column in ("what", "measured", "alternative"):
        table.add_column(column, overflow="fold")
    for column in ("ratio", "goal", "met"):
        table.add_column(column, justify="right", no_wrap=True)
    previous = ""
    for topic, row in rows:
        if topic != previous:
            table.add_section()
            table.add_row(f"[bold]{topic}")
        previous = topic
        met = "-" if row.met is None else "yes" if row.met else "[red]no"
        ratio = "" if row.ratio is None else f"{row.ratio:.3g}"
        table.add_row(row.what, row.measured, row.alternative, ratio, row.goal, met)
    return table


if __name__ == "__main__":
    sys.exit(main())
