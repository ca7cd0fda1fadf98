"""What makes a set: shards that are missing, then tables, card and manifest; what such a run did."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import PurePath

from siggen.columns.record import RecordFailure
from siggen.dataset.environment import environment
from siggen.dataset.inventory import Inventory
from siggen.dataset.manifest import CONFIG
from siggen.dataset.object_name import DATA_FOLDER, data_name
from siggen.dataset.shard import PackedTable
from siggen.dataset.simulated_rows import RowSimulation
from siggen.dataset.storage import Storage
from siggen.errors import EXIT_INTERRUPTED, DatasetError, SiggenError, UsageError, counted
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import SPLITS, ShardPlan, shards
from siggen.record.compilation import run_part
from siggen.sets import physics as contents
from siggen.sets.interruption import Interruption
from siggen.sets.loss_limit import LossLimit
from siggen.sets.run_journal import Events, RunJournal
from siggen.sets.set_files import MadeShards, put_last
from siggen.sets.shard_making import MadeShard, ShardMaker, table_schemas
from siggen.workers.tasks import Workers, results

Progress = Callable[[int, int], None]
"""(records done, records of the set); called after every shard."""

Part = tuple[int, int]
"""Number of a part, from 1, and how many there are."""


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
        Of the whole set, or of its part.
    notes
        Sentences on shards that another version made, and on damaged ones.
    """

    path: PurePath
    rows: int
    failures: tuple[RecordFailure, ...]
    records_made: int = 0
    shards_taken_over: int = 0
    seconds: float = 0.0
    was_finished: bool = False
    notes: tuple[str, ...] = ()


def _silent(done: int, total: int) -> None:
    """Show nothing."""


def planned_shards(design: SetDesign, earlier: Sequence[int] = ()) -> list[ShardPlan]:
    """Return the shards of a set in the order in which they are made; `earlier` as for `plan.shards`."""
    return [shard for split in SPLITS for shard in shards(design, split, earlier)]


@dataclass(slots=True)
class SetRun:
    """One call of `generate` on a set that is not finished.

    Attributes
    ----------
    earlier
        Numbers of gearboxes at which the set was finished before.
    part
        Which shards are made, and nothing else; None: all, and the files of the set.
    """

    design: SetDesign
    storage: Storage
    workers: Workers
    interruption: Interruption
    earlier: tuple[int, ...] = ()
    part: Part | None = None
    progress: Progress = _silent
    events: Events | None = None
    limit: LossLimit | None = None
    journal: RunJournal = field(init=False)
    made: MadeShards = field(init=False)
    planned: Sequence[ShardPlan] = field(init=False)
    _wanted: Sequence[ShardPlan] = field(init=False)
    _done: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        self.journal = RunJournal(self.events, limit=self.limit)
        with self.journal.driver.during("planning"):
            self.planned = planned_shards(self.design, self.earlier)
        number, of = self.part or (1, 1)
        if not 1 <= number <= of:
            raise UsageError(f"part: received {number} of {of}; allowed: i of N with i from 1 to N, such as (3, 16)")
        self._wanted = self.planned[number - 1 :: of]
        self.made = MadeShards([shard.key for shard in self._wanted])

    def run(self) -> Generation:
        """Make what is missing.

        Raises
        ------
        InterruptionError
            After SIGINT or SIGTERM.
        """
        records = sum(shard.record_count for shard in self._wanted)
        design = self.design
        self.journal.start(
            design.name, design.identity, self.storage.location, self.workers, records, len(self._wanted)
        )
        with self._told():
            self._refuse_others()
            if not self.storage.exists(CONFIG):
                self.storage.put(CONFIG, design.text.encode())
            with self.journal.driver.during("planning"):
                physics = contents.physics()
                maker = self._maker(physics, physics.simulation(design))
            if self.part is None:
                schemas = table_schemas(maker.simulation.columns)
                self.made.tables = {name: PackedTable(schema) for name, schema in schemas.items()}
            self._compile(physics)
            self._make(maker, records)
            if self.part is None:
                with self.journal.driver.during("closing"):
                    extensions = [*self.earlier, design.specimens]
                    columns = maker.simulation.columns
                    put_last(design, self.storage, columns, self.planned, self.made, extensions, maker.environment)
        return self._generation()

    def _refuse_others(self) -> None:
        """Refuse shards that are none of this set: an extension to more gearboxes was begun, and is to be finished."""
        own = {data_name(shard.key) for shard in self.planned}
        strange = [name for name in self.storage.names(DATA_FOLDER) if name not in own]
        if strange:
            where = self.storage.location
            raise DatasetError(
                f"{where}: holds {counted(len(strange), 'file')} that a set of {self.design.specimens} gearboxes does "
                f"not have ({', '.join(strange[:3])}). If an extension was begun, end it: siggen generate "
                f"{where}/{CONFIG} --set specimens=N --out {where} with the number it had; else move them away"
            )

    def _maker(self, physics: contents.Physics, simulation: RowSimulation) -> ShardMaker:
        return ShardMaker(
            simulation,
            self.storage,
            partial(physics.damage_rows, self.design),
            partial(physics.life_rows, self.design),
            environment(),
            self.earlier,
            self.design.state_names,
            with_tables=self.part is None,
        )

    def _compile(self, physics: contents.Physics) -> None:
        """Compile once for all workers, which would compile the same side by side."""
        parts = physics.to_compile(self.design) if self.workers.name == "processes" else ()
        if parts:
            with self.journal.driver.during("compiling"), closing(results(self.workers, run_part, parts)) as compiled:
                for _ in compiled:
                    self.interruption.check()

    def _make(self, maker: ShardMaker, records: int) -> None:
        self.progress(0, records)
        answers = results(self.workers, maker, self._wanted, self.journal.say)
        with self.journal.driver.during("workers"), closing(answers):
            for number, made in self.journal.waiting(answers):
                self.interruption.check()
                if made.error is not None:
                    raise made.error
                self._hear(self._wanted[number], made, records)

    def _hear(self, shard: ShardPlan, made: MadeShard, records: int) -> None:
        self.made.add(made)
        self._done += shard.record_count
        self.progress(self._done, records)
        self.journal.shard(made, self._done, records)

    def _generation(self) -> Generation:
        made = [self.made.by_name[shard.key] for shard in self._wanted]
        return Generation(
            path=self.storage.path,
            rows=sum(shard.rows for shard in made),
            failures=tuple(failure for shard in made for failure in shard.failures),
            records_made=self._records_made,
            shards_taken_over=self._taken_over,
            seconds=self.journal.seconds,
            notes=tuple(f"{shard.shard} is made again: {shard.note}" for shard in made if shard.note),
        )

    @property
    def _records_made(self) -> int:
        return sum(shard.made for shard in self.made.by_name.values())

    @property
    def _taken_over(self) -> int:
        return sum(not shard.made for shard in self.made.by_name.values())

    @contextmanager
    def _told(self) -> Iterator[None]:
        """Tell how the run ended; a signal is put into words."""
        try:
            with closing(self.made):
                yield
        except KeyboardInterrupt:
            self._tidy()
            message = self._how_to_continue()
            self.journal.end("interrupted", message, self._records_made, self._taken_over)
            raise InterruptionError(message) from None
        except Exception as error:
            self._tidy()
            self.journal.end("failed", str(error), self._records_made, self._taken_over)
            raise
        self.journal.end("done", "", self._records_made, self._taken_over)

    def _tidy(self) -> None:
        """Delete what workers had half written when they were ended."""
        with suppress(SiggenError, OSError):  # what went wrong first is what has to be said
            self.storage.delete_leftovers(of_dead=True)

    def _how_to_continue(self) -> str:
        # workers may have committed shards of which this process has not heard
        there = set(self.storage.names(DATA_FOLDER))
        finished = sum(data_name(shard.key) in there for shard in self._wanted)
        return (
            f"stopped: {finished} of {len(self._wanted)} shards of {self.storage.location} are finished and stay; lost "
            "is what was under way, a shard of each worker at most; the same command continues from there"
        )


def unchanged(storage: Storage, manifest: Inventory, events: Events | None = None) -> Generation:
    """Return what a call did that found the set finished."""
    RunJournal(events).end("finished before", "", 0, 0)
    return Generation(storage.path, manifest.rows, manifest.failures, was_finished=True)
