"""Endless records of a design in an order that can be repeated, simulated by worker processes while they are asked for.

Gearboxes are counted as those of a set, so a streamed record is the one that a set with as many gearboxes holds. So
many gearboxes at a time are mixed: their records come in an order that seed and place alone decide, whoever simulates
which of them first. A renewal is a record once more: its gearbox moves as it did, and noise and sensors are others.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import closing
from functools import cached_property
from itertools import count
from numbers import Integral
from typing import Any

from siggen.columns.record import ChannelColumn, RecordFailure
from siggen.dataset.environment import environment
from siggen.dataset.reading import as_record
from siggen.dataset.simulated_rows import SimulatedRows
from siggen.errors import EngineError, UsageError
from siggen.gearbox.channels import MOST_RENEWALS
from siggen.gearbox.design import SetDesign, expect_design
from siggen.gearbox.plan import record_ids_of
from siggen.record.compilation import run_part
from siggen.seeding import Stream, generator
from siggen.sets import physics as contents
from siggen.workers.choice import workers_of
from siggen.workers.tasks import OPEN_PER_WORKER, results

MIXED = 16
"""Gearboxes whose records are mixed: of `quickstart` 80 records, 25 MB."""


class RecordStream:
    """Endless records; iterate it.

    A record is a mapping as `siggen.open(...).record` returns it: labels, channels as float32 (n,), `tacho_s`; besides,
    `renewal` counts from 0, the record of the set itself. Leaving the loop ends the workers; iterating again goes on
    behind what was yielded.

    Attributes
    ----------
    failures
        Records that could not be simulated since the stream was made, by their number; the stream goes on behind them.
    """

    def __init__(
        self, design: SetDesign, first_gearbox: int, seed: int, mixed: int, renewals: int, share: tuple[int, int],
        workers: int | None, executor: Executor | str | None,
    ) -> None:  # fmt: skip
        self.design, self.first_gearbox, self.seed = design, first_gearbox, seed
        self.mixed, self.renewals = mixed, renewals
        self.rank, self.ranks = share
        self.failures: dict[int, RecordFailure] = {}
        self._workers = workers_of(executor, workers)
        self._passed = 0
        self._reader: object = None

    @cached_property
    def channels(self) -> tuple[ChannelColumn, ...]:
        """What is measured, and the names under which records hold it."""
        from siggen.sets.drawn import set_columns

        return set_columns(self.design).channels

    def __iter__(self) -> Iterator[dict[str, Any]]:
        """Yield records from the present place on."""
        for records in self.blocks():
            reader = self._reader
            for record in records[self._passed % len(records) :]:
                self._passed += 1
                if record is not None:
                    yield record
                    if self._reader is not reader:
                        break

    def __repr__(self) -> str:
        size = self.mixed * self.design.records_per_specimen * (1 + self.renewals)
        first = self._first(self._passed // size)
        return (
            f"<stream of {self.design.name}: {self._passed} records given, next those of gearboxes {first} to "
            f"{first + self.mixed - 1}>"
        )

    def blocks(self) -> Iterator[list[dict[str, Any] | None]]:
        """Yield the records of so many mixed gearboxes in their order, from the block of the present place on.

        What failed is None. A block has passed when the next one is asked for.

        Raises
        ------
        UsageError
            If another loop began, or a place was loaded, since this one did: a stream has one reader.
        EngineError
            If no record of a block could be simulated.
        """
        self._reader = reader = object()
        physics = contents.physics()
        self._compile(physics)
        size = self.mixed * self.design.records_per_specimen * (1 + self.renewals)
        block = self._passed // size
        made: dict[int, tuple[SimulatedRows, ...]] = {}
        first = block * self.mixed

        def room() -> bool:
            # the gearboxes mixed next, while those before are used up
            return len(made) < self.mixed + OPEN_PER_WORKER * self._workers.count

        tasks = (self._record_ids(number) for number in count(first))
        ahead = 0 if self._workers.name == "serial" else self.mixed
        simulation = physics.simulation(self.design, self.renewals)
        with closing(results(self._workers, simulation.renewed, tasks, room=room, ahead=ahead)) as answers:
            while True:
                wanted = range(block * self.mixed, (block + 1) * self.mixed)
                while not all(number in made for number in wanted):
                    number, rows = next(answers)
                    made[first + number] = rows
                yield self._mixed(block, [made.pop(number) for number in wanted])
                if self._reader is not reader:
                    raise UsageError(
                        "the stream: received another loop or another place while this loop ran; allowed: one loop at "
                        "a time. Make a second stream for a second reader"
                    )
                block += 1
                self._passed = max(self._passed, block * size)

    def state_dict(self) -> dict[str, Any]:
        """Return the place behind the last record as plain values."""
        return {"passed": self._passed, **self._facts()}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go on where another stream was; its block of mixed gearboxes is simulated once more.

        Raises
        ------
        UsageError
            If that stream had another configuration, version of siggen, gearboxes, seed or share.
        """
        if not isinstance(state, Mapping):
            raise UsageError(f"state: received {state!r}; allowed: what state_dict returned")
        facts = self._facts()
        differing = [f"{name} {state.get(name)!r} instead of {facts[name]!r}" for name in facts
                     if state.get(name) != facts[name]]  # fmt: skip
        passed = state.get("passed")
        if differing or type(passed) is not int or passed < 0:
            what = ", ".join(differing) or f"passed {passed!r}"
            raise UsageError(
                f"the place belongs to another stream: it has {what}. Make the stream with the same configuration and "
                "arguments, or begin anew"
            )
        self._passed, self._reader = passed, None

    def _facts(self) -> dict[str, Any]:
        return {
            "configuration": self.design.identity, "sources": environment()["sources"],
            "first_gearbox": self.first_gearbox, "seed": self.seed,
            "mixed": self.mixed, "renewals": self.renewals, "rank": self.rank, "ranks": self.ranks,
        }  # fmt: skip

    def _record_ids(self, number: int) -> range:
        """Return the records of the gearbox with a number of this share's."""
        block, place = divmod(number, self.mixed)
        gearbox = self._first(block) + place
        if gearbox >= self.design.most_specimens:
            raise UsageError(
                f"the stream has come to gearbox {gearbox}; a configuration has {self.design.most_specimens} of them"
            )
        return record_ids_of(self.design, gearbox)

    def _first(self, block: int) -> int:
        """Return the first gearbox of a block of this share's."""
        return self.first_gearbox + (block * self.ranks + self.rank) * self.mixed

    def _mixed(self, block: int, made: Sequence[tuple[SimulatedRows, ...]]) -> list[dict[str, Any] | None]:
        """Return the records of a block of gearboxes in the order that is drawn for it; None for what failed."""
        records: list[dict[str, Any] | None] = []
        for place, renewed in enumerate(made):
            for renewal, rows in enumerate(renewed):
                self.failures |= {failure.record_id: failure for failure in rows.failures}
                row_of = {number: row for row, number in enumerate(rows.rows["record_id"].to_pylist())}
                for record_id in self._record_ids(block * self.mixed + place):
                    row = row_of.get(record_id)
                    found = None if row is None else {**as_record(rows.rows.slice(row, 1)), "renewal": renewal}
                    records.append(found)
        if not any(records):
            first = made[0][0].failures[0]
            raise EngineError(
                f"no record of {len(made)} gearboxes, of records from {first.record_id} on, could be simulated; the "
                f"first is {first.status}: {first.reason}"
            )
        drawn = generator(self.seed, Stream.STREAM_ORDER, block * self.ranks + self.rank)
        return [records[place] for place in drawn.permutation(len(records))]

    def _compile(self, physics: contents.Physics) -> None:
        """Compile once for all workers, which would compile the same side by side."""
        parts = physics.to_compile(self.design) if self._workers.name == "processes" else ()
        with closing(results(self._workers, run_part, parts)) as compiled:
            for _ in compiled:
                pass


def stream(
    design: SetDesign,
    *,
    first_gearbox: int | None = None,
    seed: int = 0,
    mixed: int = MIXED,
    renewals: int = 0,
    rank: int = 0,
    ranks: int = 1,
    workers: int | None = None,
    executor: Executor | str | None = None,
) -> RecordStream:
    """Return endless records of a design, simulated by worker processes; nothing is written.

    Records and their order depend on the design and on `first_gearbox`, `seed`, `mixed`, `renewals`, `rank` and `ranks`
    alone.

    Parameters
    ----------
    design : SetDesign
        What `load_config` returns.
    first_gearbox : int, optional
        Number of the first gearbox; default: the first behind those of the set, so that none is in both.
    seed : int
        Of the order.
    mixed : int
        Gearboxes whose records are mixed, and which are in memory at a time.
    renewals : int
        How often each record is given again. Its gearbox moves as it did; noise, gains, mounts, measured paths and
        what carries them from casing to reading are drawn anew. Where sensors stand, speed and torque stay.
    rank, ranks : int
        Which of how many processes that train together this is: every gearbox goes to one of them.
    workers : int, optional
        Worker processes, by default one per core.
    executor : Executor or str, optional
        As of `generate`; 'serial' simulates in this process.

    Raises
    ------
    UsageError
        If an argument cannot be, or the gearboxes run to failure or are never damaged.
    """
    expect_design(design)
    if design.lives:
        raise UsageError("design: received one with `life`; allowed: one with `states`; a life has an order of its own")
    if not design.damaged_states(0):
        raise UsageError("design: received states without damage; a stream is to learn from: give a state `damages`")
    first = design.specimens if first_gearbox is None else first_gearbox
    wholes: dict[str, int] = {}
    for name, value, least, most in (
        ("first_gearbox", first, 0, design.most_specimens - 1), ("seed", seed, 0, 2**63 - 1),
        ("mixed", mixed, 1, 10_000), ("renewals", renewals, 0, MOST_RENEWALS),
        ("ranks", ranks, 1, 100_000), ("rank", rank, 0, 0), ("workers", 1 if workers is None else workers, 1, 10_000),
    ):  # fmt: skip
        allowed = wholes["ranks"] - 1 if name == "rank" else most
        if isinstance(value, bool) or not isinstance(value, Integral) or not least <= value <= allowed:
            here = "; executor='serial' simulates in this process" if name == "workers" else ""
            raise UsageError(f"{name}: received {value!r}; allowed: whole numbers from {least} to {allowed}{here}")
        wholes[name] = int(value)
    share = wholes["rank"], wholes["ranks"]
    count_of = None if workers is None else wholes["workers"]
    first, seed, mixed, renewals = (wholes[name] for name in ("first_gearbox", "seed", "mixed", "renewals"))
    return RecordStream(design, first, seed, mixed, renewals, share, count_of, executor)
