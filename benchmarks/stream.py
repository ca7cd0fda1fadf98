"""Windows of endless gearboxes per CPU second: fresh, used often, with renewals; memory."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import closing
from itertools import islice
from pathlib import Path

import siggen
from benchmarks.row import Row
from benchmarks.shipped import ROOT, shipped
from diagnostics.loader import StreamedWindows
from siggen.columns.record import RecordFailure
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import record_ids_of
from siggen.sets.drawn import simulated

MIXED, REPLAY = 2, 16
TURNS, HOP = 8, 4
RENEWALS = 15
LEAST, LEAST_REPLAYED, LEAST_RENEWED, MOST_GROWN = 0.8, 10.0, 3.0, 1.1


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield windows of 8 turns per CPU second, fresh and used 16 times, and by how much memory grows."""
    design = shipped(ROOT / "configs" / "quickstart.yaml")
    blocks = 2 if quick else 6
    list(simulated(design, record_ids_of(design, 0)))  # compiles
    gearboxes = range(design.specimens, design.specimens + blocks * MIXED)
    begin, count = time.process_time(), 0
    for gearbox in gearboxes:
        for record in simulated(design, record_ids_of(design, gearbox)):
            count += 0 if isinstance(record, RecordFailure) else len(range(0, record.tacho_s.size - TURNS, HOP))
    alone_s = time.process_time() - begin
    fresh_s, used_s = (_windows(design, count, reuse) for reuse in (1, REPLAY))
    rate, alone, replayed = count / fresh_s, count / alone_s, REPLAY * count / used_s
    yield Row(
        "fresh windows of 8 turns per CPU s, quickstart", f"{rate:.1f}", f"records alone: {alone:.1f}", rate / alone,
        f">= {LEAST:g}", rate >= LEAST * alone,
    )  # fmt: skip
    ratio = replayed / rate
    yield Row(
        f"the same, each used {REPLAY} times", f"{replayed:.0f}", f"fresh: {rate:.1f}", ratio,
        f">= {LEAST_REPLAYED:g}", ratio >= LEAST_REPLAYED,
    )  # fmt: skip
    part = count // blocks
    renewed = (1 + RENEWALS) * part / _windows(design, part, renewals=RENEWALS)
    yield Row(
        f"windows of 8 turns with {RENEWALS} renewals of each record", f"{renewed:.0f}", f"fresh: {rate:.1f}",
        renewed / rate, f">= {LEAST_RENEWED:g}", renewed >= LEAST_RENEWED * rate,
    )  # fmt: skip
    records = iter(siggen.stream(design, mixed=MIXED, executor="serial"))
    each = MIXED * design.records_per_specimen
    with closing(records):  # type: ignore[type-var]
        list(islice(records, each))
        before = _resident_mb()
        list(islice(records, blocks * each))
        after = _resident_mb()
    yield Row(
        f"memory after {(blocks + 1) * each} records", f"{after:.0f} MB", f"after {each}: {before:.0f} MB",
        after / before, f"<= {MOST_GROWN:g}", after <= MOST_GROWN * before,
    )  # fmt: skip


def _windows(design: SetDesign, count: int, reuse: int = 1, renewals: int = 0) -> float:
    """Return the CPU time of so many windows of the set, each renewed and used so often [s]."""
    begin = time.process_time()
    stream = siggen.stream(design, mixed=MIXED, renewals=renewals, executor="serial")
    for _ in islice(StreamedWindows(stream, reuse=reuse), reuse * (1 + renewals) * count):
        pass
    return time.process_time() - begin


def _resident_mb() -> float:
    """Return the memory of this process that is in use."""
    for line in Path("/proc/self/status").read_text(encoding="utf-8").splitlines():
        if line.startswith("VmRSS"):
            return float(line.split()[1]) / 1024.0
    return 0.0
