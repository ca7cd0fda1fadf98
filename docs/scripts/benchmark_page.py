"""The measured part of docs/develop/benchmarks.md: `python docs/scripts/benchmark_page.py FILE [FILE ...] [--write]`.

Prints one table of files that `python -m benchmarks --json FILE` wrote: the rows with a goal. With `--write` it takes
the place of what stands between the marks of the page.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

PAGE = Path(__file__).resolve().parents[1] / "develop" / "benchmarks.md"
BEGIN, END = "<!-- benchmark_page.py: begin -->", "<!-- benchmark_page.py: end -->"
SHOWN = ("presets", "precision", "indicators", "workers", "quickstart", "loader", "memory", "startup", "cold")
"""Topics on the page; results of the others stay in the files."""
LEFT_OUT = "by proportion, not measured"


def printed(results: Sequence[Mapping[str, Any]]) -> str:
    """Return the table of some runs as markdown; a topic of a later run takes the place of an earlier one."""
    topics: dict[str, Mapping[str, Any]] = {}
    for result in results:
        topics |= result["topics"]
    machines = dict.fromkeys(line for result in results for line in result["machine"] if "others are using" not in line)
    rows = (line for name in SHOWN if name in topics for line in _topic(name, topics[name]["rows"]))
    head = ("", "| topic: what | measured | beside it (×ratio) | goal |", "|---|---|---|---|")
    return "\n".join((f"{'; '.join(machines)}.", *head, *rows))


def with_tables(page: str, tables: str) -> str:
    """Return a page with these tables between its marks.

    Raises
    ------
    ValueError
        If a mark is missing.
    """
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end):
        raise ValueError(f"received a page without {BEGIN} and {END}; allowed: one with both, in this order")
    return f"{before}{BEGIN}\n\n{tables}\n\n{END}{after}"


def _topic(name: str, rows: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    kept = [row for row in rows if not _is_point(row) and LEFT_OUT not in row["what"]]
    yield from (_row(name, row) for row in kept if row["goal"])


def _row(topic: str, row: Mapping[str, Any]) -> str:
    ratio = "" if row["ratio"] is None else f" (×{row['ratio']:.3g})"
    met = {None: "", True: ": met", False: ": **missed**"}[row["met"]]
    cells = (f"{topic}: {row['what']}", row["measured"], row["alternative"] + ratio, row["goal"] + met)
    return f"| {' | '.join(cell.replace('|', '/') for cell in cells)} |"


def _is_point(row: Mapping[str, Any]) -> bool:
    """Tell whether a row is a point of the figure of work against precision."""
    return bool(row["numbers"]) and "error" in row["numbers"]


def main(*arguments: str) -> None:
    """Print the tables, or write them into the page."""
    files = [Path(argument) for argument in arguments if argument != "--write"]
    if missing := [str(file) for file in files if not file.is_file()]:
        sys.exit(f"no file {', '.join(missing)}; allowed: what `python -m benchmarks --json FILE` wrote")
    tables = printed([json.loads(file.read_text(encoding="utf-8")) for file in files])
    if "--write" in arguments:
        PAGE.write_text(with_tables(PAGE.read_text(encoding="utf-8"), tables), encoding="utf-8")
    else:
        print(tables)


if __name__ == "__main__":
    main(*sys.argv[1:])
