"""What makes a set: shards that are missing, then tables, card and manifest; what such a run did."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, field
from functools import partial
from pathlib import PurePath
from typing import Any

from siggen.columns.internals import internals_group_rows
from siggen.columns.record import RecordFailure, SetColumns, listed_columns, record_schema
from siggen.dataset.card import card
from siggen.dataset.chunk import ChunkSimulation
from siggen.dataset.environment import environment, fingerprint
from siggen.dataset.excerpt import Excerpt, Excerpts
from siggen.dataset.extensions import EXTENSIONS
from siggen.dataset.label_tables import write_tables
from siggen.dataset.manifest import CARD, CONFIG, MANIFEST, RUN, SPLITS, build_manifest, read_manifest
from siggen.dataset.object_name import SIDECAR_FOLDER, sidecar_name
from siggen.dataset.pieces import Pieces
from siggen.dataset.seal import sealed
from siggen.dataset.sealed_streams import Maker
from siggen.dataset.sidecar import Sidecar
from siggen.dataset.storage import Storage
from siggen.engines.protocol import Engine
from siggen.errors import EXIT_INTERRUPTED, SiggenError, counted
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import ShardPlan, rows_per_group, shards
from siggen.sets import physics as contents
from siggen.sets.committed_shards import usable_shards
from siggen.sets.interruption import Interruption
from siggen.sets.loss_limit import LossLimit
from siggen.sets.run_facts import run_facts
from siggen.sets.run_journal import Events, RunJournal
from siggen.sets.shard_making import ShardMaking
from siggen.sets.shard_work import GroupRows


def manifest_facts(design: SetDesign, columns: SetColumns) -> dict[str, Any]:
    """Return what the manifest says of a set beside its files."""
    internals = [{"name": c.name, "unit": c.unit, "meaning": c.meaning} for c in columns.quantities]
    return {
        **({"internals": internals} if internals else {}),
        "name": design.name,
        "identity": design.identity,
        "seed": design.seed,
        "specimens": design.specimens,
        "fs_hz": float(design.fs_hz),
        "duration_s": float(design.duration_s),
        "rows_per_group": rows_per_group(design),
        "channels": [asdict(channel) for channel in columns.channels],
        "columns": listed_columns(record_schema(columns)),
        "drivetrain": asdict(columns.drivetrain),
        **({} if design.tolerance is None else {"integration_tolerance": design.tolerance}),
    }


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


def set_run(
    design: SetDesign,
    storage: Storage,
    engine: Engine,
    progress: Progress | None,
    interruption: Interruption,
    earlier: Sequence[int] = (),
    events: Events | None = None,
    limit: LossLimit | None = None,
) -> SetRun:
    """Return a run that makes what is missing of a set; `earlier` as for `siggen.gearbox.plan.shards`."""
    journal = RunJournal(events, limit=limit)
    with journal.driver.during("planning"):
        physics = contents.physics()
        simulation = physics.simulation(design)
        planned = planned_shards(design, earlier)
    run = SetRun(design, storage, engine, physics, simulation, progress or _silent, interruption, planned, journal)
    run.trusted = frozenset({fingerprint(run.environment)})
    run.total = sum(shard.record_count for shard in planned)
    journal.start(design.name, design.identity, str(storage.location), engine, run.total, len(planned))
    return run


def planned_shards(design: SetDesign, earlier: Sequence[int] = ()) -> list[ShardPlan]:
    """Return the shards of a set in the order in which they are made; `earlier` as for `plan.shards`."""
    return [shard for split in SPLITS for shard in shards(design, split, earlier)]


@dataclass(slots=True)
class SetRun:
    """One call of `generate` or its kin on a set that is not finished.

    Attributes
    ----------
    planned
        All shards of the set.
    trusted
        Fingerprints whose shards are taken over.
    notes
        Sentences on shards that another version made.
    """

    design: SetDesign
    storage: Storage
    engine: Engine
    physics: contents.Physics
    simulation: ChunkSimulation
    progress: Progress
    interruption: Interruption
    planned: Sequence[ShardPlan]
    journal: RunJournal = field(default_factory=RunJournal)
    environment: dict[str, str] = field(default_factory=environment)
    sidecars: dict[str, Sidecar] = field(default_factory=dict)
    pieces: Pieces = field(init=False)
    excerpts: Excerpts = field(init=False)
    making: ShardMaking = field(init=False)
    done: int = 0
    made: int = 0
    shards_made: int = 0
    total: int = 0
    trusted: frozenset[str] = frozenset()
    notes: list[tuple[str, str]] = field(default_factory=list)

    def __post_init__(self) -> None:
        maker = Maker(self.design.identity, fingerprint(self.environment), self.environment)
        self.pieces = Pieces(self.storage, maker, self.simulation.columns)
        physics, design, columns = self.physics, self.design, self.simulation.columns
        damage, lives = partial(physics.damage_rows, design), partial(physics.life_rows, design)
        self.excerpts = Excerpts(columns, self.storage, maker, damage, lives)
        self.making = ShardMaking(
            self.storage,
            self.engine,
            self.simulation,
            partial(physics.to_compile, design),
            design.state_names,
            GroupRows(rows_per_group(design), internals_group_rows(columns) if columns.quantities else 0),
            self.interruption,
            self.journal,
            self.pieces,
            self.excerpts,
            self._advance,
        )

    def finish(self) -> Generation:
        """Make what is missing, from the first shard to the manifest.

        Raises
        ------
        InterruptionError
            After SIGINT or SIGTERM.
        """
        with self._told():
            if not self.storage.exists(CONFIG):
                self.storage.put(CONFIG, self.design.text.encode())
            taken_over = self.make(self.planned)
            return self.conclude(taken_over)

    def finish_some(self, wanted: Sequence[ShardPlan]) -> Generation:
        """Make some shards and nothing else; `rows` and `failures` are theirs. Raises as `finish`."""
        with self._told():
            if not self.storage.exists(CONFIG):
                self.storage.put(CONFIG, self.design.text.encode())
            taken_over = self.make(wanted)
        sidecars = [self.sidecars[shard.key] for shard in wanted]
        return Generation(
            path=self.storage.path,
            rows=sum(sidecar.data.rows for sidecar in sidecars),
            failures=tuple(failure for sidecar in sidecars for failure in sidecar.failures),
            records_made=self.made,
            shards_taken_over=taken_over,
            seconds=self.journal.seconds,
            notes=tuple(f"{key} is made again: {reason}" for key, reason in self.notes),
        )

    def make(self, wanted: Sequence[ShardPlan]) -> int:
        """Make those of the wanted shards that no earlier run committed; return how many one did."""
        self.total = sum(shard.record_count for shard in wanted)
        self.journal.expect(self.total)
        self.progress(self.done, self.total)
        with self.journal.driver.during("taking over"):
            self.take_over(wanted)
        taken_over = len(self.sidecars)
        missing = [shard for shard in wanted if shard.key not in self.sidecars]
        self.making.make(missing, tuple(self.sidecars), self._committed)
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
            notes=tuple(f"{key} is made again: {reason}" for key, reason in self.notes),
        )

    def take_over(self, wanted: Sequence[ShardPlan]) -> None:
        """Find the shards that earlier runs committed with a trusted fingerprint."""
        missing = [shard for shard in wanted if shard.key not in self.sidecars]
        check, of_set = self.interruption.check, (self.design.identity, self.design.state_names)
        for sidecar in usable_shards(*of_set, self.storage, missing, self.trusted, self.notes, check):
            self.accept(sidecar)

    def accept(self, sidecar: Sidecar) -> None:
        """Take a shard over."""
        self.sidecars[sidecar.shard] = sidecar
        self._advance(sum(last - first + 1 for first, last in sidecar.records), 0)
        self.journal.taken_over(sidecar, self.done, self.total)

    def _committed(self, shard: ShardPlan, sidecar: Sidecar, seconds: float) -> None:
        self.sidecars[shard.key] = sidecar
        self.shards_made += 1
        self.journal.shard_done(sidecar, seconds, self.made, self.done, self.total)

    def _conclude(self, sidecars: Sequence[Sidecar], taken_over: int) -> dict[str, Any]:
        """Write configuration, tables, card and run.json; the manifest comes last and makes the set a finished one."""
        self.storage.put(CONFIG, self.design.text.encode())
        tables, columns = [], self.simulation.columns
        for split in SPLITS:
            of_split = [sidecar for sidecar in sidecars if sidecar.split == split]
            if of_split:
                tables += write_tables(self.storage, columns, split, self._excerpts(of_split))
            self.interruption.check()
        self.storage.put(CARD, card(self.design, sidecars, columns).encode())
        written = [CONFIG, CARD, *([EXTENSIONS] if self.storage.exists(EXTENSIONS) else [])]
        manifest = build_manifest(self.storage, manifest_facts(self.design, columns), sidecars, tables, written)
        counts = {"made": self.made, "taken_over": taken_over}
        facts = run_facts(
            self.design.duration_s, self.engine, sidecars, self.journal, **counts, environment=self.environment
        )
        self.pieces.clear()
        self.excerpts.clear()
        self.storage.put(RUN, sealed(facts))
        self.storage.put(MANIFEST, sealed(manifest))
        return manifest

    def _excerpts(self, sidecars: Sequence[Sidecar]) -> Iterator[Excerpt]:
        for excerpt in self.excerpts.in_order([sidecar.shard for sidecar in sidecars]):
            self.interruption.check()
            yield excerpt

    @contextmanager
    def _told(self) -> Iterator[None]:
        """Tell how the run ended; a signal is put into words."""
        try:
            yield
        except KeyboardInterrupt:
            self._tidy()
            message = self._how_to_continue(self._lost())
            self.journal.end("interrupted", message, self.made, len(self.sidecars) - self.shards_made)
            raise InterruptionError(message) from None
        except Exception as error:
            self._tidy()
            self.journal.end("failed", str(error), self.made, len(self.sidecars) - self.shards_made)
            raise
        self.journal.end("done", "", self.made, len(self.sidecars) - self.shards_made)

    def _tidy(self) -> None:
        """Delete what workers had half written when the engine ended them."""
        with suppress(SiggenError, OSError):  # what went wrong first is what has to be said
            self.storage.delete_leftovers()

    def _lost(self) -> str:
        """Say how much work is lost."""
        under_way = self.making.under_way
        lost_s = [] if under_way is None else under_way.lost_s()
        if not lost_s:
            return "nothing is lost"
        return f"lost is what was under way, {sum(lost_s):.0f} s of work (of one worker {lost_s[-1]:.0f} s at most)"

    def _how_to_continue(self, lost: str) -> str:
        # workers may have committed shards of which this process has not heard
        there = set(self.storage.names(SIDECAR_FOLDER))
        finished = {shard.key for shard in self.planned if sidecar_name(shard.key) in there}
        kept = self.making.records_kept(finished)
        others = f", and {counted(kept, 'record')} of others" if kept else ""
        return (
            f"stopped: {len(finished)} of {len(self.planned)} shards of {self.storage.location} are finished and stay"
            f"{others}; {lost}; the same command continues from there"
        )

    def _advance(self, done: int, made: int) -> None:
        self.made += made
        if done:
            self.done += done
            self.progress(self.done, self.total)


def unchanged(storage: Storage, events: Events | None = None) -> Generation:
    """Return what a call did that found the set finished."""
    manifest = read_manifest(storage)
    RunJournal(events).end("finished before", "", 0, 0)
    return Generation(storage.path, manifest.rows, manifest.failures, was_finished=True)
