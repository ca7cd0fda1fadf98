"""Shards that another version of siggen made: whether this one would give their records the same bits.

A digest of the sources changes with every comment. So where fingerprints differ, one record of every state and
operating point is simulated again. Only if every bit is equal do such shards become part of a set beside new ones.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from siggen.columns.record import RecordFailure
from siggen.dataset.checked_file import parquet_file
from siggen.dataset.chunk import Chunk, ChunkResult, ChunkSimulation
from siggen.dataset.environment import fingerprint, version_text
from siggen.dataset.id_ranges import in_ranges
from siggen.dataset.reading import as_internals, as_record, row_of
from siggen.dataset.shard import FileFacts
from siggen.dataset.sidecar import Sidecar, committed, promised_shard, ranges, read_sidecar
from siggen.dataset.storage import Storage
from siggen.engines.protocol import Engine
from siggen.engines.registry import running
from siggen.errors import counted
from siggen.keys.column import Column
from siggen.planning.plan import ShardPlan, record_ids_of
from siggen.sets.record_comparison import result_difference

if TYPE_CHECKING:
    from siggen.config import Config
    from siggen.sets.physics import Physics


class StoredShard(NamedTuple):
    """A committed shard and where it is."""

    storage: Storage
    sidecar: Sidecar


class Verdict(NamedTuple):
    """Shards that one other version made, who that was, and in what their records differ; empty if in nothing."""

    shards: tuple[str, ...]
    made_by: str
    compared: int
    difference: str

    def __str__(self) -> str:
        """Say who made the shards and what the comparison gave."""
        found = self.difference or f"{counted(self.compared, 'record')}, simulated again, equal to the bit"
        return f"{counted(len(self.shards), 'shard')} made by {self.made_by}: {found}"


class Again(NamedTuple):
    """What simulates records of a set again."""

    config: Config
    physics: Physics
    quantities: tuple[Column, ...]
    engine: Engine


@dataclass(frozen=True, slots=True)
class EarlierShards:
    """What earlier runs left in a folder.

    Attributes
    ----------
    trusted
        Fingerprints of versions whose shards are taken as they are.
    here
        The environment of this run.
    notes
        Receives a sentence on shards that are damaged, or that another version made.
    """

    storage: Storage
    trusted: frozenset[str]
    here: Mapping[str, str]
    again: Again
    notes: list[str]

    def usable(self, wanted: Sequence[ShardPlan], check: Callable[[], None]) -> Iterator[Sidecar]:
        """Yield the sidecars of whole shards whose records this version makes to the bit; `check` may stop it."""
        others: dict[str, Sidecar] = {}
        for shard in wanted:
            check()
            specimens, records = ranges(shard)
            found = committed(self.storage, shard.key, self.again.config.identity, specimens)
            found = found if isinstance(found, str) else _fitting(self.again.config, shard, found)
            if isinstance(found, str):
                self.notes.extend([f"{shard.key} is made again: {found}"] if found else [])
            elif fingerprint(found.environment) in self.trusted:
                yield found.without_bulk(specimens, records)
            else:
                others[shard.key] = found.without_bulk(specimens, records)
        for verdict in verdicts([StoredShard(self.storage, one) for one in others.values()], self.here, self.again):
            check()
            self.notes.append(f"{verdict}; they are {'made again' if verdict.difference else 'taken over'}")
            yield from (others[key] for key in verdict.shards if not verdict.difference)


def promised(config: Config, storage: Storage, shard: ShardPlan) -> Sidecar | str:
    """Return the sidecar of a planned shard, or why it cannot be used; its files are not read."""
    found = promised_shard(storage, shard.key, config.identity, ranges(shard)[0])
    return found if isinstance(found, str) else _fitting(config, shard, found)


def _fitting(config: Config, shard: ShardPlan, sidecar: Sidecar) -> Sidecar | str:
    """Return a sidecar whose counts can be those of the shard, or why they cannot."""
    states = set(config.state_names)
    rows = sum(sidecar.rows_per_state.values())
    counts = (rows, rows + len(sidecar.failures), set(sidecar.rows_per_state), sidecar.records)
    if counts != (sidecar.data.rows, shard.record_count, states, tuple(ranges(shard)[1])):
        return f"{sidecar.name} counts other records than the shard has"
    return sidecar


def verdicts(stored: Sequence[StoredShard], here: Mapping[str, str], again: Again) -> list[Verdict]:
    """Return a verdict on the shards of each version that is not the one `here`."""
    groups: dict[tuple[str, ...], list[StoredShard]] = {}
    for one in stored:
        made_in = one.sidecar.environment
        if fingerprint(made_in) != fingerprint(here):
            # without fingerprints, as old sets are, versions and processor tell the makers apart
            own = fingerprint(made_in)
            groups.setdefault((own,) if own else tuple(map(str, sorted(made_in.items()))), []).append(one)
    return [_verdict(group, again) for group in groups.values()]


def _verdict(group: Sequence[StoredShard], again: Again) -> Verdict:
    chosen = chosen_records(again.config, [one.sidecar for one in group])
    owners = {i: next(one for one in group if in_ranges(i, one.sidecar.records)) for i in chosen}
    difference = ""
    for record_id, result in _results(again, chosen):
        if (found := _difference(again.config, owners[record_id], record_id, result)) and not difference:
            difference = f"record {record_id}, simulated again, is another: {found}"
    names = tuple(one.sidecar.shard for one in group)
    return Verdict(names, version_text(group[0].sidecar.environment), len(chosen), difference)


def chosen_records(config: Config, sidecars: Sequence[Sidecar]) -> list[int]:
    """Return one record of every state and operating point, from gearboxes and repeats as different as there are."""
    specimens = [i for sidecar in sidecars for first, last in sidecar.specimens for i in (first, last)]
    places = [(s, p) for s in range(len(config.states)) for p in range(len(config.operating_points))]
    found = []
    for number, (state, point) in enumerate(places):
        ids = record_ids_of(config, specimens[number * len(specimens) // len(places) % len(specimens)])
        of_place = (state * len(config.operating_points) + point) * config.repeats
        found.append(ids[of_place + number % config.repeats])
    return sorted(set(found))


def _results(again: Again, ids: Sequence[int]) -> Iterator[tuple[int, ChunkResult]]:
    function = ChunkSimulation(again.config, again.physics.simulate, again.quantities)
    tasks = [Chunk("again", range(i, i + 1)) for i in ids]
    with running(again.engine, function, tasks) as results:
        yield from ((ids[index], result) for index, result in results)


def _difference(config: Config, owner: StoredShard, record_id: int, result: ChunkResult) -> str:
    storage = owner.storage
    sidecar = read_sidecar(storage, owner.sidecar.shard)  # a run keeps no checksums of blocks
    failed = [failure for failure in sidecar.failures if failure.record_id == record_id]
    if failed or result.failures:
        return "" if failed == list(result.failures) else f"{_ended(failed)} then, {_ended(result.failures)} now"
    stored = _row(storage, sidecar.data, record_id)
    if stored is None:
        return f"{storage.location}/{sidecar.data.name} does not hold it"
    inner = None if sidecar.internals is None else _row(storage, sidecar.internals, record_id)
    internals = None if inner is None else as_internals(inner)
    return result_difference(config, as_record(stored), internals, result, exact=True)


def _row(storage: Storage, facts: FileFacts, record_id: int) -> Any:
    with parquet_file(storage, facts.name, facts.crc32_per_64_kib) as file:
        return row_of(file, record_id)


def _ended(failures: Sequence[RecordFailure]) -> str:
    return f"failed ({failures[0].status})" if failures else "simulated"
