"""The measured part of docs/develop/benchmarks.md: `python docs/scripts/benchmark_page.py FILE [FILE ...] [--write]`.

Prints the tables of files that `python -m benchmarks --json FILE` wrote. With `--write` they take the place of what
stands between the marks of the page.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

PAGE = Path(__file__).resolve().parents[1] / "develop" / "benchmarks.md"
BEGIN, END = "<!-- benchmark_page.py: begin -->", "<!-- benchmark_page.py: end -->"


def printed(results: Sequence[Mapping[str, Any]]) -> str:
    """Return the tables of some runs as markdown."""
    return "\n".join(line for result in results for line in _lines(result))


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


def _lines(result: Mapping[str, Any]) -> Iterator[str]:
    topics = result["topics"]
    yield f"`{result['command']}`: {'; '.join(line.removeprefix('WARNING: ') for line in result['machine'])}."
    yield ""
    yield "Wall time of each topic, and the load average behind it, its own included:"
    yield ", ".join(f"{name} {topic['seconds']:.0f} s ({topic['load_average']:.1f})" for name, topic in topics.items())
    yield ""
    yield "| topic | what | measured | alternative | ratio | goal | met |"
    yield "|---|---|---|---|---:|---:|---:|"
    for name, topic in topics.items():
        for row in topic["rows"]:
            if not _is_point(row):
                yield _row(name, row)
    points = [row["numbers"] for topic in topics.values() for row in topic["rows"] if _is_point(row)]
    for law in dict.fromkeys(point["law"] for point in points):
        yield from _points(law, [point for point in points if point["law"] == law])


def _row(topic: str, row: Mapping[str, Any]) -> str:
    ratio = "" if row["ratio"] is None else f"{row['ratio']:.3g}"
    met = {None: "-", True: "yes", False: "no"}[row["met"]]
    cells = (topic, row["what"], row["measured"], row["alternative"], ratio, row["goal"], met)
    return f"| {' | '.join(cell.replace('|', '/') for cell in cells)} |"


def _points(law: str, points: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """Yield a table of methods by setting: CPU time per second of signal and error; the rule's steps are bold."""
    yield ""
    yield f"**Work against precision, {law}** (CPU time of the loop per s of signal, and error; bold: the steps taken)"
    yield ""
    yield "| method | |"
    yield "|---|---|"
    for method in dict.fromkeys(point["method"] for point in points):
        cells = [_point(point) for point in points if point["method"] == method]
        yield f"| {method} | {'; '.join(cells)} |"


def _point(point: Mapping[str, Any]) -> str:
    cost = point["cost_s"]
    time = f"{cost:.3g} s" if cost >= 1.0 else f"{1e3 * cost:.3g} ms"
    error = f"{point['error']:.1e}" if point["error"] < 1.0 else "no likeness"
    text = f"{point['setting']}: {time}, {error}"
    return f"**{text}**" if point["rule"] else text


def _is_point(row: Mapping[str, Any]) -> bool:
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
