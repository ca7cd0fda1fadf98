"""A record maker that takes no time: real records of one gearbox, made once, under the numbers that are asked for.

What an engine costs beside the work is measured with it: start, transport, Parquet, hashes, tables, card and manifest.
`python -m benchmarks.stand_in PLACE ENGINE WORKERS SPECIMENS` generates a set of the quickstart with it.
"""

from __future__ import annotations

import os
import pickle
import sys
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING
from unittest.mock import patch

if TYPE_CHECKING:
    from siggen.columns.record import Record
    from siggen.config import Config

VARIABLE = "SIGGEN_BENCHMARK_RECORDS"
"""Names the file with the real records."""


def keep(config: Config, file: Path) -> float:
    """Simulate the first gearboxes, keep the records of the first, and return the CPU time of a gearbox [s]."""
    import time

    from siggen.planning.plan import record_ids_of
    from siggen.record.simulation import simulate_specimen

    records = list(simulate_specimen(config, record_ids_of(config, 0)))
    file.write_bytes(pickle.dumps(records))
    started_s = time.process_time()
    for specimen in (1, 2, 3):
        list(simulate_specimen(config, record_ids_of(config, specimen)))
    return (time.process_time() - started_s) / 3


def simulate(config: Config, record_ids: Sequence[int]) -> list[Record]:
    """Return the kept records under other numbers."""
    # what a worker imports is part of its start
    import siggen.record.simulation  # noqa: F401
    from siggen.planning.plan import planned_record

    kept = _kept()
    return [replace(kept[i % len(kept)], planned=planned_record(config, i)) for i in record_ids]


@cache
def _kept() -> list[Record]:
    return list(pickle.loads(Path(os.environ[VARIABLE]).read_bytes()))


def main() -> None:
    """Generate a set with the stand-in."""
    import siggen
    from siggen.sets import physics
    from siggen.sets.generation import generate

    place, engine, workers, specimens = sys.argv[1:]
    real = physics.physics()
    # by its module's name, not as a function of __main__, so that workers find it
    from benchmarks.stand_in import simulate as stand_in

    stood_in = physics.Physics(stand_in, real.damage_rows, real.quantities)
    with patch.object(physics, "physics", lambda: stood_in):
        generate(siggen.load_config("quickstart", [f"specimens={specimens}"]), place, int(workers), engine=engine)


if __name__ == "__main__":
    main()
