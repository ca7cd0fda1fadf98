"""What makes a set: shards that are missing, then tables, card and manifest; what such a run did."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field
from itertools import islice
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

from siggen.columns.column import Column
from siggen.columns.internals import internals_group_rows, internals_name, internals_schema
from siggen.columns.record import RecordFailure, record_schema
from siggen.dataset.card import card
from siggen.dataset.chunk import Chunk, ChunkResult, ChunkSimulation, chunks
from siggen.dataset.environment import environment
from siggen.dataset.extensions import EXTENSIONS
from siggen.dataset.folder import config_bytes
from siggen.dataset.id_ranges import IdRanges
from siggen.dataset.label_tables import write_damage, write_metadata
from siggen.dataset.manifest import CARD, CONFIG, MANIFEST, RUN, SPLITS, build_manifest, read_manifest
from siggen.dataset.seal import sealed
from siggen.dataset.shard import TableFile, table_draft
from siggen.dataset.sidecar import Sidecar, committed, data_name, put_sidecar, sidecar_name
from siggen.dataset.storage import Storage
from siggen.engines.processes import ProcessEngine
from siggen.engines.protocol import Engine
from siggen.engines.registry import running
from siggen.errors import EXIT_INTERRUPTED, SiggenError
from siggen.planning.plan import ShardPlan, record_ids_of, rows_per_group, shards
from siggen.record.compilation import run_part
from siggen.sets import physics as contents
from siggen.sets.interruption import Interruption
from siggen.sets.manifest_facts import manifest_facts
from siggen.sets.run_facts import run_facts
from siggen.sets.run_journal import Events, RunJournal

if TYPE_CHECKING:
    from siggen.config import Config

Progress = Callable[[int, int], None]
"""(records done, records of the set); called after every chunk."""


class InterruptionError(SiggenError):
    """Generation was stopped by Ctrl-C or SIGTERM; the same call continues it."""

    exit_code = EXIT_INTERRUPTED


@dataclass(frozen=True, slots=True)
class Generation:
    """What a call of `generate` did to the finished set at `path`.

    Attributes
    ----------
    records_made, shards_taken_over
        Work of this call, and of earlier ones.
    was_finished
        The set was there already; nothing was written.
    rows, failures
        Of the whole set.
    """

    path: PurePath
    rows: int
    failures: tuple[RecordFailure, ...]
    records_made: int = 0
    shards_taken_over: int = 0
    seconds: float = 0.0
    was_finished: bool = False


def _silent(done: int, total: int) -> None:
    """Show nothing."""


def set_run(
    config: Config,
    storage: Storage,
    engine: Engine,
    progress: Progress | None,
    interruption: Interruption,
    earlier: Sequence[int] = (),
    events: Events | None = None,
) -> SetRun:
    """Return a run that makes what is missing of a set; `earlier` as for `planning.plan.shards`."""
    journal = RunJournal(events)
    with journal.driver.during("planning"):
        physics = contents.physics()
        quantities = physics.stored(config)
        planned = planned_shards(config, earlier)
    run = SetRun(config, storage, engine, physics, quantities, progress or _silent, interruption, planned, journal)
    run.total = sum(shard.record_count for shard in planned)
    journal.start(config, str(storage.location), engine, run.total, len(planned))
    return run


def planned_shards(config: Config, earlier: Sequence[int] = ()) -> list[ShardPlan]:
    """Return the shards of a set in the order in which they are made; `earlier` as for `plan.shards`."""
    return [shard for split in SPLITS for shard in shards(config, split, earlier)]


@dataclass(slots=True)
class SetRun:
    """One call of `generate` or its kin on a set that is not finished.

    Attributes
    ----------
    planned
        All shards of the set.
    """

    config: Config
    storage: Storage
    engine: Engine
    physics: contents.Physics
    quantities: tuple[Column, ...]
    progress: Progress
    interruption: Interruption
    planned: Sequence[ShardPlan]
    journal: RunJournal = field(default_factory=RunJournal)
    environment: dict[str, str] = field(default_factory=environment)
    sidecars: dict[str, Sidecar] = field(default_factory=dict)
    done: int = 0
    made: int = 0
    shards_made: int = 0
    total: int = 0

    def finish(self) -> Generation:
        """Make what is missing, from the first shard to the manifest.

        Raises
        ------
        InterruptionError
            After SIGINT or SIGTERM.
        """
        with self._told():
            if not self.storage.exists(CONFIG):
                self.storage.put(CONFIG, config_bytes(self.config))
            taken_over = self.make(self.planned)
            return self.conclude(taken_over)

    def finish_some(self, wanted: Sequence[ShardPlan]) -> Generation:
        """Make some shards and nothing else; `rows` and `failures` are theirs.

        Raises
        ------
        InterruptionError
            After SIGINT or SIGTERM.
        """
        with self._told():
            if not self.storage.exists(CONFIG):
                self.storage.put(CONFIG, config_bytes(self.config))
            taken_over = self.make(wanted)
        sidecars = [self.sidecars[shard.key] for shard in wanted]
        return Generation(
            path=self.storage.path,
            rows=sum(sidecar.data.rows for sidecar in sidecars),
            failures=tuple(failure for sidecar in sidecars for failure in sidecar.failures),
            records_made=self.made,
            shards_taken_over=taken_over,
            seconds=self.journal.seconds,
        )

    def make(self, wanted: Sequence[ShardPlan]) -> int:
        """Make those of the wanted shards that no earlier run committed; return how many one did."""
        self.total = sum(shard.record_count for shard in wanted)
        self._advance(0)
        with self.journal.driver.during("taking over"):
            self.take_over(wanted)
        taken_over = len(self.sidecars)
        self._make([shard for shard in wanted if shard.key not in self.sidecars])
        return taken_over

    def conclude(self, taken_over: int) -> Generation:
        """Write tables, card and manifest over all shards, which are there."""
        sidecars = [self.sidecars[shard.key] for shard in self.planned]
        with self.journal.driver.during("closing"):
            manifest = self._conclude(sidecars, taken_over)
        return Generation(
            path=self.storage.path,
            rows=manifest["rows"],
            failures=tuple(failure for sidecar in sidecars for failure in sidecar.failures),
            records_made=self.made,
            shards_taken_over=taken_over,
            seconds=self.journal.seconds,
        )

    def take_over(self, wanted: Sequence[ShardPlan]) -> None:
        """Find the shards that earlier runs committed."""
        for shard in (shard for shard in wanted if shard.key not in self.sidecars):
            self.interruption.check()
            specimens, records = _ranges(shard)
            sidecar = committed(self.storage, shard.key, self.config.identity, specimens)
            if sidecar is not None:
                self.sidecars[shard.key] = sidecar.without_bulk(specimens, records)
                self._advance(sum(last - first + 1 for first, last in sidecar.records))
                self.journal.taken_over(sidecar, self.done, self.total)

    def _make(self, missing: Sequence[ShardPlan]) -> None:
        """Simulate and write shards one after the other, from one stream of chunks."""
        tasks = (chunk for shard in missing for chunk in self._chunks(shard))
        if missing and isinstance(self.engine, ProcessEngine):
            with self.journal.driver.during("compiling"):
                self._compile(self.engine)
        function = ChunkSimulation(self.config, self.physics.simulate, self.quantities)
        with self.journal.driver.during("engine"), running(self.engine, function, tasks) as results:
            ordered = self.journal.waiting(in_order(results))
            for shard in missing:
                # cut once more rather than kept: chunks of all shards would fill memory before the first is made
                chunked = self._chunks(shard)
                with self.journal.driver.during("writing"):
                    self._write(shard, zip(chunked, islice(ordered, len(chunked)), strict=True))

    def _compile(self, engine: ProcessEngine) -> None:
        """Compile once for all workers, which would compile the same side by side."""
        parts = self.physics.to_compile(self.config)
        if parts:
            with running(engine, run_part, parts) as compiled:
                for _ in compiled:
                    self.interruption.check()

    def _chunks(self, shard: ShardPlan) -> list[Chunk]:
        config = self.config
        specimens = [record_ids_of(config, specimen) for specimen in shard.specimens]
        rows = internals_group_rows(config, self.quantities) if self.quantities else rows_per_group(config)
        return list(chunks(shard.key, specimens, min(rows, rows_per_group(config))))

    def _write(self, shard: ShardPlan, results: Iterator[tuple[Chunk, ChunkResult]]) -> None:
        """Write the rows of a shard as they come, then commit it with its sidecar."""
        begun_s = self.journal.seconds
        failures: list[RecordFailure] = []
        rows_per_state = dict.fromkeys((state.name for state in self.config.states), 0)
        with self._data(shard) as data, self._internals(shard) as internals:
            for chunk, result in results:
                self.interruption.check()
                batch = result.batch()
                failures.extend(result.failures)
                self.journal.add(result.cpu_s)
                self.journal.failed(shard.key, result.failures)
                for state in batch.column("state").to_pylist():
                    rows_per_state[state] += 1
                data.add(batch)
                if internals is not None and (inner := result.internals_batch()) is not None:
                    internals.add(inner)
                self.made += len(chunk.records)
                self._advance(len(chunk.records))
            facts = data.finish()
            internal_facts = None if internals is None else internals.finish()
        specimens, records = _ranges(shard)
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
        self.sidecars[shard.key] = sidecar.without_bulk(specimens, records)
        self.shards_made += 1
        seconds = self.journal.seconds - begun_s
        self.journal.shard_done(sidecar, seconds, self.made, self.done, self.total)

    def _data(self, shard: ShardPlan) -> AbstractContextManager[TableFile]:
        schema, rows = record_schema(self.config), rows_per_group(self.config)
        return table_draft(self.storage, data_name(shard.key), schema, rows)

    def _internals(self, shard: ShardPlan) -> AbstractContextManager[TableFile | None]:
        if not self.quantities:
            return nullcontext()
        schema = internals_schema(self.config, self.quantities)
        rows = internals_group_rows(self.config, self.quantities)
        return table_draft(self.storage, internals_name(shard.key), schema, rows)

    def _conclude(self, sidecars: Sequence[Sidecar], taken_over: int) -> dict[str, Any]:
        """Write configuration, tables, card and run.json; the manifest comes last and makes the set a finished one."""
        self.storage.put(CONFIG, config_bytes(self.config))
        tables = []
        for split in SPLITS:
            of_split = [sidecar for sidecar in sidecars if sidecar.split == split]
            if of_split:
                tables.append(write_metadata(self.storage, self.config, split, of_split))
                tables.append(write_damage(self.storage, self.config, split, of_split, self.physics.damage_rows))
            self.interruption.check()
        self.storage.put(CARD, card(self.config, sidecars, self.quantities).encode())
        written = [CONFIG, CARD, *([EXTENSIONS] if self.storage.exists(EXTENSIONS) else [])]
        manifest = build_manifest(self.storage, manifest_facts(self.config, self.quantities), sidecars, tables, written)
        counts = {"made": self.made, "taken_over": taken_over}
        facts = run_facts(self.config, self.engine, sidecars, self.journal, **counts, environment=self.environment)
        self.storage.put(RUN, sealed(facts))
        self.storage.put(MANIFEST, sealed(manifest))
        return manifest

    @contextmanager
    def _told(self) -> Iterator[None]:
        """Tell how the run ended; a signal is put into words."""
        try:
            yield
        except KeyboardInterrupt:
            self.journal.end("interrupted", self._how_to_continue(), self.made, len(self.sidecars) - self.shards_made)
            raise InterruptionError(self._how_to_continue()) from None
        except Exception as error:
            self.journal.end("failed", str(error), self.made, len(self.sidecars) - self.shards_made)
            raise
        self.journal.end("done", "", self.made, len(self.sidecars) - self.shards_made)

    def _how_to_continue(self) -> str:
        # a signal may come between the commit of the first shard that is missing here and its note
        following = next((shard.key for shard in self.planned if shard.key not in self.sidecars), "")
        kept = len(self.sidecars) + self.storage.exists(sidecar_name(following))
        return (
            f"stopped: {kept} of {len(self.planned)} shards of {self.storage.location} are finished and "
            "stay; the same command continues from there"
        )

    def _advance(self, records: int) -> None:
        self.done += records
        self.progress(self.done, self.total)


def _ranges(shard: ShardPlan) -> tuple[IdRanges, IdRanges]:
    """Return the ranges of specimens and of records of a planned shard."""
    return IdRanges(shard.specimens), IdRanges(shard.specimens, shard.records_per_specimen)


def in_order(results: Iterator[tuple[int, ChunkResult]]) -> Iterator[ChunkResult]:
    """Yield results by position; the engine's window bounds how many wait for a slow one."""
    waiting: dict[int, ChunkResult] = {}
    following = 0
    for index, result in results:
        waiting[index] = result
        while following in waiting:
            yield waiting.pop(following)
            following += 1


def unchanged(storage: Storage, events: Events | None = None) -> Generation:
    """Return what a call did that found the set finished."""
    manifest = read_manifest(storage)
    failures = tuple(RecordFailure(**failure) for failure in manifest["failures"])
    RunJournal(events).end("finished before", "", 0, 0)
    return Generation(storage.path, manifest["rows"], failures, was_finished=True)
