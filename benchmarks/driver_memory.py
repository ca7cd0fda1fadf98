"""Peak memory of a driver that plans, cuts, hands out and takes back a set, with tasks that do nothing."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from unittest.mock import patch

from siggen.dataset.checked_file import BLOCK_BYTES, DIGITS
from siggen.dataset.chunk import Chunk, ChunkResult
from siggen.dataset.shard import FileFacts
from siggen.dataset.sidecar import Sidecar, data_name, id_ranges
from siggen.planning.plan import ShardPlan, estimated_bytes
from siggen.sets import set_run
from siggen.sets.set_run import SetRun

PER_GEARBOX = 4
"""Records of the quickstart."""


def peak_bytes(records: int) -> int:
    """Return the peak of this process after a plan of the quickstart with so many records was worked off.

    Everything is real but two things: a task returns nothing, and a shard is not written. What a run keeps of a
    written shard, its sidecar with the checksums of all blocks, is made with as many checksums as it would have.
    """
    import siggen
    from siggen.dataset.environment import peak_memory_bytes
    from siggen.dataset.storage import LocalFolder
    from siggen.engines.serial import SerialEngine
    from siggen.sets.interruption import Interruption

    config = siggen.load_config("quickstart", [f"specimens={records // PER_GEARBOX}"])
    blocks = estimated_bytes(config) // records // BLOCK_BYTES + 1

    def write(run: SetRun, shard: ShardPlan, results: Iterator[tuple[Chunk, ChunkResult]]) -> None:
        for chunk, _ in results:
            run.made += len(chunk.records)
        checksums = "0" * (DIGITS * blocks * shard.record_count) + shard.key
        facts = FileFacts(data_name(shard.key), 0, "0" * 64, checksums, shard.record_count)
        run.sidecars[shard.key] = Sidecar(
            shard.key,
            shard.split,
            config.identity,
            facts,
            id_ranges(shard.specimens),
            id_ranges(shard.record_ids),
            {},
            (),
            run.environment,
        )

    with (
        tempfile.TemporaryDirectory() as name,
        Interruption() as interruption,
        patch.object(SetRun, "_write", write),
        patch.object(set_run, "ChunkSimulation", lambda *_: _nothing),
    ):
        run = set_run.set_run(config, LocalFolder(Path(name)), SerialEngine(), None, interruption)
        run.make(run.planned)
    assert run.made == records
    return peak_memory_bytes()["parent"]


def _nothing(chunk: Chunk) -> ChunkResult:  # noqa: ARG001 - as every task
    return ChunkResult(b"", ())
