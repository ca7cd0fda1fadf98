"""From missing shards to committed ones: chunks to workers, their results in order into files, pieces meanwhile."""

from __future__ import annotations

from array import array
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from siggen.columns.internals import internals_group_rows, internals_schema
from siggen.columns.record import RecordFailure, record_schema
from siggen.dataset.chunk import Chunk, ChunkResult, ChunkSimulation, chunks
from siggen.dataset.id_ranges import IdRanges
from siggen.dataset.object_name import data_name, internals_name
from siggen.dataset.pieces import Pieces
from siggen.dataset.shard import TableFile, table_draft
from siggen.dataset.sidecar import Sidecar, put_sidecar
from siggen.dataset.storage import Storage
from siggen.engines.processes import ProcessEngine
from siggen.engines.protocol import DrainingEngine, Engine, Unfinished
from siggen.engines.registry import running
from siggen.keys.column import Column
from siggen.planning.plan import ShardPlan, record_ids_of, rows_per_group
from siggen.record.compilation import run_part
from siggen.sets import physics as contents
from siggen.sets.interruption import Interruption
from siggen.sets.run_journal import RunJournal
from siggen.sets.under_way import STOP_AT_ONCE_S, Answer, PartSimulation, UnderWay

if TYPE_CHECKING:
    from siggen.config import Config


class Segment(NamedTuple):
    """Records of a shard that a piece holds, or that have to be made."""

    chunk: Chunk
    is_kept: bool


@dataclass(slots=True)
class ShardMaking:
    """Makes shards of a set.

    Attributes
    ----------
    advance : callable
        Called with records that were written, and whether this run made them.
    under_way
        What the workers have, from the first task on.
    """

    config: Config
    storage: Storage
    engine: Engine
    physics: contents.Physics
    quantities: tuple[Column, ...]
    interruption: Interruption
    journal: RunJournal
    environment: dict[str, str]
    pieces: Pieces
    advance: Callable[[int, bool], None]
    under_way: UnderWay | None = field(default=None, init=False)

    def make(self, missing: Sequence[ShardPlan], committed: Callable[[ShardPlan, Sidecar, float], None]) -> None:
        """Simulate and write shards one after the other, from one stream of chunks.

        Parameters
        ----------
        committed : callable
            Called with every shard that is there, its sidecar and the seconds that it took.
        """
        with self.journal.driver.during("taking over"):
            self.pieces.find({shard.key for shard in missing})
        if missing and isinstance(self.engine, ProcessEngine):
            with self.journal.driver.during("compiling"):
                self._compile(self.engine)
        self.under_way = UnderWay(self.engine.workers)
        tasks = self.under_way.taken(s.chunk for shard in missing for s in self._segments(shard) if not s.is_kept)
        with (
            self.journal.driver.during("engine"),
            running(self.engine, self._function(), tasks) as results,
            self.interruption.drained_by(self._drain),
        ):
            ordered = self.journal.waiting(in_order(self._heard(results)))
            for shard in missing:
                with self.journal.driver.during("writing"):
                    self._write(shard, ordered, committed)
        self.under_way = None

    def _function(self) -> Callable[[Chunk], Answer]:
        simulation = ChunkSimulation(self.config, self.physics.simulate, self.quantities)
        return PartSimulation(simulation) if isinstance(self.engine, DrainingEngine) else simulation

    def _drain(self) -> bool:
        """Let the workers finish what they are at, where a minute of work would be lost otherwise."""
        assert self.under_way is not None
        longest_s = max(self.under_way.lost_s(), default=0.0)
        if longest_s <= STOP_AT_ONCE_S or not isinstance(self.engine, DrainingEngine):
            return False
        self.engine.drain()
        self.journal.say(
            f"stopping as soon as the records under way are finished, for which {longest_s:.0f} s were spent; "
            "Ctrl-C once more stops at once and loses them"
        )
        return True

    def _heard(self, results: Iterator[tuple[int, Answer]]) -> Iterator[tuple[int, Answer]]:
        """Yield results which can no longer be lost; those that come at the end of a run are kept alone."""
        assert self.under_way is not None
        for index, answer in results:
            self.pieces.add(self.under_way.hear(answer))
            if not self.interruption.draining:
                yield index, answer
        if self.interruption.draining:
            self.under_way = None
            raise KeyboardInterrupt

    def _compile(self, engine: ProcessEngine) -> None:
        """Compile once for all workers, which would compile the same side by side."""
        parts = self.physics.to_compile(self.config)
        if parts:
            with running(engine, run_part, parts) as compiled:
                for _ in compiled:
                    self.interruption.check()

    def _segments(self, shard: ShardPlan) -> Iterator[Segment]:
        """Cut a shard at what pieces hold; once more rather than kept, since all of a set would fill memory."""
        config = self.config
        specimens = [record_ids_of(config, specimen) for specimen in shard.specimens]
        rows = internals_group_rows(config, self.quantities) if self.quantities else rows_per_group(config)
        kept = {chunk.records.start: chunk for chunk in self.pieces.found.get(shard.key, ())}
        for chunk in chunks(shard.key, specimens, min(rows, rows_per_group(config))):
            yield from _cut(chunk, kept)

    def _write(
        self,
        shard: ShardPlan,
        made: Iterator[ChunkResult],
        committed: Callable[[ShardPlan, Sidecar, float], None],
    ) -> None:
        """Write the rows of a shard as they come, then commit it with its sidecar."""
        begun_s = self.journal.seconds
        failures: list[RecordFailure] = []
        rows_per_state = dict.fromkeys(self.config.state_names, 0)
        with self._data(shard) as data, self._internals(shard) as internals:
            for result in self._results(shard, made):
                self.interruption.check()
                batch = result.batch()
                failures.extend(result.failures)
                for state in batch.column("state").to_pylist():
                    rows_per_state[state] += 1
                data.add(batch)
                if internals is not None and (inner := result.internals_batch()) is not None:
                    internals.add(inner)
            facts = data.finish()
            internal_facts = None if internals is None else internals.finish()
        specimens, records = ranges(shard)
        sidecar = Sidecar(
            shard=shard.key,
            split=shard.split,
            identity=self.config.identity,
            data=facts,
            internals=internal_facts,
            specimens=specimens,
            records=records,
            rows_per_state=rows_per_state,
            failures=tuple(failures),
            environment=self.environment,
        )
        put_sidecar(self.storage, sidecar)
        committed(shard, sidecar, self.journal.seconds - begun_s)
        self.pieces.drop(shard.key)

    def _results(self, shard: ShardPlan, made: Iterator[ChunkResult]) -> Iterator[ChunkResult]:
        """Yield the results of a shard in order, from its pieces and from the workers."""
        for segment in self._segments(shard):
            if segment.is_kept:
                yield self.pieces.read(segment.chunk)
                self.advance(len(segment.chunk.records), False)
                continue
            following = segment.chunk.records.start
            while following < segment.chunk.records.stop:
                result = next(made)
                assert result.chunk.records.start == following  # whatever the engine, in_order puts it right
                self.journal.add(result.cpu_s)
                self.journal.failed(shard.key, result.failures)
                yield result
                following = result.chunk.records.stop
                self.advance(len(result.chunk.records), True)

    def _data(self, shard: ShardPlan) -> AbstractContextManager[TableFile]:
        schema, rows = record_schema(self.config), rows_per_group(self.config)
        return table_draft(self.storage, data_name(shard.key), schema, rows)

    def _internals(self, shard: ShardPlan) -> AbstractContextManager[TableFile | None]:
        if not self.quantities:
            return nullcontext()
        schema = internals_schema(self.config, self.quantities)
        rows = internals_group_rows(self.config, self.quantities)
        return table_draft(self.storage, internals_name(shard.key), schema, rows)


def ranges(shard: ShardPlan) -> tuple[IdRanges, IdRanges]:
    """Return the ranges of specimens and of records of a planned shard."""
    if shard.counts:
        return IdRanges(shard.specimens), IdRanges(array("q", shard.record_ids))
    return IdRanges(shard.specimens), IdRanges(shard.specimens, shard.records_per_specimen)


def _cut(chunk: Chunk, kept: dict[int, Chunk]) -> Iterator[Segment]:
    """Cut a chunk at what is kept of it, given by its first record."""
    start, stop = chunk.records.start, chunk.records.stop
    while start < stop:
        found = kept.get(start)
        if found is not None and found.records.stop <= stop:
            yield Segment(found, True)
            start = found.records.stop
        else:
            end = min((first for first in kept if start < first < stop), default=stop)
            yield Segment(Chunk(chunk.shard, range(start, end)), False)
            start = end


def in_order(answers: Iterator[tuple[int, Answer]]) -> Iterator[ChunkResult]:
    """Yield results by position of their task; the engine's window bounds how many wait for a slow one."""
    waiting: dict[int, deque[Answer]] = {}
    following = 0
    for index, answer in answers:
        waiting.setdefault(index, deque()).append(answer)
        while waiting.get(following):
            first = waiting[following].popleft()
            if isinstance(first, Unfinished):
                yield first.result
            else:
                del waiting[following]
                following += 1
                yield first
