"""CPU and wall time of the audit, step by step: `python docs/scripts/audit_cost.py SET [SET ...]`.

Several sets of the same channels and length count as one: the gearboxes of each are others. One process, one thread,
`--paired --realism`, the pass over the records included; nothing that was kept of a set is read.
"""

from __future__ import annotations

import resource
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pyarrow as pa

import siggen
from diagnostics.audit.audit_report import AuditOptions, audit_set, write_audit
from siggen.dataset.reading import Dataset
from siggen.keys.column import Role

NUMBERED = ("specimen_id", "record_id")


class Joined:
    """Sets behind the interface of one, with the labels that all of them have."""

    def __init__(self, datasets: Sequence[Dataset], path: Path) -> None:
        self.datasets, self.path, self.splits = datasets, path, ("all",)
        schemas = [each.labels().schema for each in datasets]
        self.names = [name for name in schemas[0].names if all(name in schema.names for schema in schemas)]

    def __getattr__(self, name: str) -> Any:
        return getattr(self.datasets[0], name)

    def _numbered(self, part: Any, first: dict[str, int]) -> Any:
        """Return a table or batch with ids behind those of the sets before."""
        for name in NUMBERED:
            if name in part.schema.names:
                place, column = part.schema.get_field_index(name), part.column(name)
                moved = pa.array([value + first[name] for value in column.to_pylist()], column.type)
                part = part.set_column(place, part.schema.field(place), moved)
        return part

    def _each(self) -> Iterator[tuple[Dataset, dict[str, int]]]:
        first = dict.fromkeys(NUMBERED, 0)
        for dataset in self.datasets:
            yield dataset, dict(first)
            ids = dataset.labels(columns=list(NUMBERED))
            first = {name: first[name] + max(ids.column(name).to_pylist()) + 1 for name in NUMBERED}

    def role(self, name: str) -> Role:
        """Return a role as the first set has it."""
        return self.datasets[0].role(name)

    def section(self, name: str) -> str:
        """Return a section as the first set has it."""
        return self.datasets[0].section(name)

    def labels(self, _: str | None = None, columns: Sequence[str] | None = None) -> pa.Table:
        """Return the labels of all sets."""
        wanted = list(columns) if columns is not None else self.names
        tables = [self._numbered(each.labels(columns=wanted), first) for each, first in self._each()]
        return pa.concat_tables(tables, promote_options="permissive")

    def records(
        self, *, split: str, columns: Sequence[str] | None = None, batch_rows: int | None = None
    ) -> Iterator[pa.RecordBatch]:
        """Yield the records of all sets in the order of their labels."""
        for dataset, first in self._each():
            for part in dataset.splits if split == "all" else (split,):
                for batch in dataset.records(split=part, columns=columns, batch_rows=batch_rows):
                    yield self._numbered(batch, first)


@contextmanager
def timed(name: str, _: int) -> Iterator[Callable[[], None]]:
    """Print what a step took."""
    wall, cpu = time.perf_counter(), time.process_time()
    yield lambda: None
    print(f"| {name} | {time.process_time() - cpu:.0f} s | {time.perf_counter() - wall:.0f} s |", flush=True)


def main(paths: list[str]) -> None:
    """Print one row per step."""
    with tempfile.TemporaryDirectory() as folder:
        dataset: Any = Joined([siggen.open(path) for path in paths], Path(folder) / "joined")
        wall, cpu = time.perf_counter(), time.process_time()
        print("| step | CPU | wall |\n|---|---|---|")
        audit = audit_set(dataset, AuditOptions(paired=True, with_realism=True), stage=timed)
        with timed("page and figures", 1):
            write_audit(audit, dataset, Path(folder) / "audit")
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    print(
        f"| all: {audit.records} records, {audit.specimens} gearboxes, {memory:.0f} MB | {cpu:.0f} s | {wall:.0f} s |"
    )
    print(f"\n{cpu / audit.records * 1000:.0f} s of CPU per 1,000 records; {audit.verdict}")


if __name__ == "__main__":
    main(sys.argv[1:])
