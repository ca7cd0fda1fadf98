"""The measured part of docs/develop/benchmarks.md: `python docs/scripts/benchmark_page.py FILE [FILE ...] [--write]`.

Prints one table per topic of files that `python -m benchmarks --json FILE` wrote: the rows with a goal, and all rows
where a topic has none. With `--write` they take the place of what stands between the marks of the page.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

PAGE = Path(__file__).resolve().parents[1] / "develop" / "benchmarks.md"
BEGIN, END = "<!-- benchmark_page.py: begin -->", "<!-- benchmark_page.py: end -->"
SHOWN = {
    "presets": "CPU time of a record, per second of signal; healthy, two middle and the severest state.",
    "precision": "CPU time of the time loop at equal error, and errors of healthy and of severe records.",
    "stiffness": "CPU time of curves and tables of mesh stiffness; every call has a new module and new pits.",
    "background": "CPU time of the healthy background of `bench`.",
    "sensing": "CPU time of paths, instrument and disturbances of `industrial`.",
    "indicators": "All gear indicators of a synthetic record of 10 s, one channel.",
    "pages": "`report` and `audit` of sets of `linear_pits`.",
    "workers": "Wall time of one and of two workers in turn, median of five.",
    "quickstart": "All 240 records of `linear_pits`.",
    "loader": "Records read in shuffled windows, files in the system's cache.",
    "memory": "Largest resident size of a process that makes one record.",
    "startup": "Wall time of a command that needs no physics.",
    "cold": "A first run in an empty cache.",
}
"""Topic that the page shows -> what its rows hold; results of the others stay in the files."""
LEFT_OUT = "by proportion, not measured"


def printed(results: Sequence[Mapping[str, Any]]) -> str:
    """Return the tables of some runs as markdown; a topic of a later run takes the place of an earlier one."""
    topics: dict[str, Mapping[str, Any]] = {}
    for result in results:
        topics |= result["topics"]
    machines = dict.fromkeys(line for result in results for line in result["machine"] if "others are using" not in line)
    tables = (line for name in SHOWN if name in topics for line in _topic(name, topics[name]["rows"]))
    return "\n".join((f"{'; '.join(machines)}.", *tables))


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
    yield from ("", f"### {name}", "", SHOWN[name], "")
    yield from ("| what | measured | beside it | ratio | goal |", "|---|---|---|---:|---|")
    yield from map(_row, [row for row in kept if row["goal"]] or kept)


def _row(row: Mapping[str, Any]) -> str:
    ratio = "" if row["ratio"] is None else f"{row['ratio']:.3g}"
    met = {None: "", True: ": met", False: ": **missed**"}[row["met"]]
    cells = (row["what"], row["measured"], row["alternative"], ratio, row["goal"] + met)
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
