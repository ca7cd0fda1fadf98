"""From missing shards to committed ones: stretches of records to workers, then the closing of each shard.

The process that drives a run sees no rows: workers keep what they make in pieces, and one of them puts the pieces of a
shard together as soon as all are there.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from siggen.dataset.chunk import Chunk, ChunkSimulation
from siggen.dataset.excerpt import Excerpts
from siggen.dataset.object_name import SIDECAR_FOLDER, sidecar_name
from siggen.dataset.pieces import Pieces
from siggen.dataset.sidecar import Sidecar, ranges
from siggen.dataset.storage import Storage
from siggen.engines.processes import ProcessEngine
from siggen.engines.protocol import DrainingEngine, Engine, Unfinished
from siggen.engines.registry import running
from siggen.errors import EngineError
from siggen.gearbox.plan import ShardPlan
from siggen.record.compilation import CompilationPart, run_part
from siggen.sets.interruption import Interruption
from siggen.sets.run_journal import RunJournal
from siggen.sets.shard_work import Answer, ChunkStretch, Closing, Excerpting, GroupRows, ShardWork, Task, shard_chunks
from siggen.sets.under_way import STOP_AT_ONCE_S, UnderWay

STRETCHES_PER_WORKER = 2
"""Of what is left, a worker takes the share that leaves it so many: long stretches first, and short ones at the end.

With twice as many, 1,000 workers ended a million records 10 s later: most shards were closed by a task of its own.
"""


@dataclass(slots=True)
class Unclosed:
    """A shard that is being made: records that are neither simulated nor kept, and those that are; when it began."""

    shard: ShardPlan
    left: int
    kept: int
    begun_s: float


@dataclass(slots=True)
class ShardMaking:
    """Makes shards of a set.

    Attributes
    ----------
    advance : callable
        Called with how many records more are kept or written, and how many this run made.
    under_way
        What the workers have, from the first task on.
    """

    storage: Storage
    engine: Engine
    simulation: ChunkSimulation
    to_compile: Callable[[], Sequence[CompilationPart]]
    states: tuple[str, ...]
    group_rows: GroupRows
    interruption: Interruption
    journal: RunJournal
    pieces: Pieces
    excerpts: Excerpts
    advance: Callable[[int, int], None]
    under_way: UnderWay | None = field(default=None, init=False)
    _unclosed: dict[str, Unclosed] = field(default_factory=dict, init=False)
    _ready: deque[ShardPlan] = field(default_factory=deque, init=False)
    _open: int = field(default=0, init=False)

    def make(
        self,
        missing: Sequence[ShardPlan],
        there: Iterable[str],
        committed: Callable[[ShardPlan, Sidecar, float], None],
    ) -> None:
        """Simulate and write shards, and the excerpts of all.

        Parameters
        ----------
        there : iterable of str
            Shards that are committed; those without an excerpt get one.
        committed : callable
            Called with every shard that is there, its sidecar and the seconds that it took.
        """
        with self.journal.driver.during("taking over"):
            self._delete_sidecars(missing)
            found = self.pieces.find([shard.key for shard in missing])
            bare = self.excerpts.missing(there)
        self.advance(sum(len(chunk.records) for held in found.values() for chunk in held), 0)
        if missing and isinstance(self.engine, ProcessEngine):
            with self.journal.driver.during("compiling"):
                self._compile(self.engine)
        self._open = len(missing) + len(bare)
        self.under_way = UnderWay(self.engine.workers)
        work = self._work()
        tasks = self.under_way.taken(self._tasks(bare, self._stretches(missing, found, work)))
        with (
            self.journal.driver.during("engine"),
            running(self.engine, work, tasks) as results,
            self.interruption.drained_by(self._drain),
        ):
            for _, answer in self.journal.waiting(results):
                self._hear(answer, committed)
                if not self._open:
                    break
        self.under_way = None
        if self.interruption.draining:
            raise KeyboardInterrupt
        if self._open:
            raise EngineError(f"the engine ended before its tasks did: {self._open} shards are not closed")

    def records_kept(self, committed: Container[str]) -> int:
        """Return the number of records in pieces, without those of shards that are committed, by their names."""
        return sum(one.kept for shard, one in self._unclosed.items() if shard not in committed)

    def _delete_sidecars(self, missing: Sequence[ShardPlan]) -> None:
        """Take the sidecars of shards back that cannot be used: from now on one is there where this run made it."""
        there = set(self.storage.names(SIDECAR_FOLDER))
        for name in (sidecar_name(shard.key) for shard in missing):
            if name in there:
                self.storage.delete(name)

    def _work(self) -> ShardWork:
        is_parted = isinstance(self.engine, DrainingEngine)
        return ShardWork(self.simulation, self.pieces, self.excerpts, self.states, self.group_rows, is_parted)

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

    def _compile(self, engine: ProcessEngine) -> None:
        """Compile once for all workers, which would compile the same side by side."""
        parts = self.to_compile()
        if parts:
            with running(engine, run_part, parts) as compiled:
                for _ in compiled:
                    self.interruption.check()

    def _tasks(self, bare: Sequence[str], stretches: Iterator[ChunkStretch]) -> Iterator[Task | None]:
        """Yield what is to be done, shards that can be closed first; None where that waits for workers."""
        yield from (Excerpting(shard) for shard in bare)
        while self._open:
            if self._ready:
                yield Closing(self._ready.popleft())
            elif (stretch := next(stretches, None)) is not None or not self._ready:
                yield stretch

    def _stretches(
        self, missing: Sequence[ShardPlan], found: Mapping[str, Sequence[Chunk]], work: ShardWork
    ) -> Iterator[ChunkStretch]:
        """Cut shards into stretches of what no piece holds."""
        kept = {chunk.records.start: chunk for held in found.values() for chunk in held}
        left = sum(shard.record_count for shard in missing) - sum(len(chunk.records) for chunk in kept.values())
        for shard in missing:
            gaps = list(_gaps(shard_chunks(shard, work.group_rows), kept))
            pending = sum(len(chunk.records) for gap in gaps for chunk in gap)
            self._unclosed[shard.key] = Unclosed(shard, pending, shard.record_count - pending, self.journal.seconds)
            if not gaps:
                self._ready.append(shard)
            for gap in gaps:
                while gap:
                    chosen = _taken(gap, self._share(left, work))
                    size = sum(len(chunk.records) for chunk in chosen)
                    left -= size
                    yield ChunkStretch(shard, chosen, size == shard.record_count)

    def _share(self, left: int, work: ShardWork) -> int:
        """Return how many records a stretch may have; a chunk, if it has more, and where parts are not handed in."""
        if not work.is_parted:
            return 1
        return left if self.engine.workers == 1 else left // (STRETCHES_PER_WORKER * self.engine.workers)

    def _hear(
        self,
        heard: Answer | Unfinished[Task, Answer] | None,
        committed: Callable[[ShardPlan, Sidecar, float], None],
    ) -> None:
        self.interruption.check()
        self.storage.check_writing()
        if heard is None:
            return
        assert self.under_way is not None
        answer = self.under_way.hear(heard)
        if answer.error is not None:
            raise answer.error
        self.journal.add(answer.cpu_s)
        one = self._unclosed.get(answer.shard)
        if one is None:  # its excerpt is there
            self._open -= 1
            return
        done = min(answer.records, one.left)  # more were lost from pieces, and made once more
        one.left, one.kept = one.left - done, one.kept + done
        self.advance(done, answer.records)
        self.journal.failed(answer.shard, answer.failures)
        if answer.sidecar is not None:
            del self._unclosed[answer.shard]
            self._open -= 1
            committed(one.shard, answer.sidecar.without_bulk(*ranges(one.shard)), self.journal.seconds - one.begun_s)
        elif one.left == 0:
            self._ready.append(one.shard)


def _taken(gap: deque[Chunk], most: int) -> tuple[Chunk, ...]:
    """Take chunks from the beginning of a gap: one, and more while they have no more than so many records."""
    chosen = [gap.popleft()]
    size = len(chosen[0].records)
    while gap and (size := size + len(gap[0].records)) <= most:
        chosen.append(gap.popleft())
    return tuple(chosen)


def _gaps(planned: Iterable[Chunk], kept: Mapping[int, Chunk]) -> Iterator[deque[Chunk]]:
    """Yield chunks that follow each other, of what is missing between those kept, which come by their first record."""
    gap: deque[Chunk] = deque()
    for chunk in planned:
        start, stop = chunk.records.start, chunk.records.stop
        while start < stop:
            found = kept.get(start)
            if found is not None and found.records.stop <= stop:
                if gap:
                    yield gap
                gap, start = deque(), found.records.stop
            else:
                end = min((first for first in kept if start < first < stop), default=stop)
                gap.append(Chunk(chunk.shard, range(start, end)))
                start = end
    if gap:
        yield gap
