"""The whole set as indices: which record belongs to which specimen, state, operating point, repeat and split.

Nothing here is drawn except the order of splits within a few specimens, so a set of any size is listed in no time.
"""

from __future__ import annotations

from array import array
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import chain, pairwise
from typing import overload

from siggen.config import BLOCK, Config, Splits
from siggen.gearbox.configured import inspection_count, pair_of
from siggen.seeding import Stream, generator
from siggen.sensors.converter import FROM_NOISE
from siggen.sensors.sensor import SensorBase

SPLITS = ("train", "validation", "test")

SUB_BLOCK = 5
"""Specimens among which splits are shuffled; small, so that a set cut off anywhere is still nearly balanced."""

SHARD_BYTES = 64_000_000
"""Aimed size of a full shard on disk."""

DISK_SHARE_PERCENT = 45
"""Assumed size on disk over raw size: 16-bit readings as float32, byte-split and compressed (measured 0.43 to 0.47)."""

UNQUANTISED_SHARE_PERCENT = 81
"""The same for readings that are not quantised, or finer than 16 bits (measured 0.76 to 0.81)."""

NOISE_SHARE_PERCENT = 55
"""The same for a converter as fine as the noise asks for (measured 0.54 and 0.55)."""

MANY_QUANTITIES = 30
"""Assumed number of internal quantities where all are stored: 14 with the linear mesh law, 41 with pairs and casing."""

GROUP_CHANNEL_BYTES = 8_000_000
"""Most raw bytes of one channel in a row group of several rows."""

GROUP_BYTES = 64_000_000
"""Most raw bytes of all channels in a row group of several rows."""


@dataclass(frozen=True, slots=True)
class PlannedRecord:
    """Where one record stands in the set."""

    record_id: int
    specimen_id: int
    state_id: int
    operating_point_id: int
    repeat: int
    split: str

    @property
    def owner(self) -> tuple[int, int, int, int]:
        """Keys of what is drawn per record."""
        return self.specimen_id, self.state_id, self.operating_point_id, self.repeat


@dataclass(frozen=True, slots=True)
class ShardPlan:
    """One file of the set: whole specimens of one split, in ascending order.

    A million records are some thousand shards, so specimens are kept as numbers of 8 bytes and records not at all.
    """

    split: str
    number: int
    specimens: Sequence[int]
    records_per_specimen: int
    counts: Sequence[int] = ()
    """Records of each specimen where they have fewer than that, as of a life that ends; ids after it stay free."""

    @property
    def record_count(self) -> int:
        """Number of records."""
        return sum(self.counts) if self.counts else len(self.specimens) * self.records_per_specimen

    @property
    def of_specimens(self) -> Iterator[range]:
        """Ids of the records of each specimen, ascending."""
        stride = self.records_per_specimen
        counts = self.counts or [stride] * len(self.specimens)
        return (range(one * stride, one * stride + own) for one, own in zip(self.specimens, counts, strict=True))

    @property
    def record_ids(self) -> Iterator[int]:
        """Ids of all records, ascending."""
        return chain.from_iterable(self.of_specimens)

    @property
    def key(self) -> str:
        """Name of the shard, such as `train-00000`."""
        return f"{self.split}-{self.number:05d}"


class Records(Sequence[PlannedRecord]):
    """All planned records in ascending order, each worked out when it is asked for."""

    def __init__(self, config: Config) -> None:
        self._config = config
        self._ids: Sequence[int] = range(config.specimens * config.records_per_specimen)
        if config.life is not None:
            of_each = (record_ids_of(config, one) for one in range(config.specimens))
            self._ids = tuple(chain.from_iterable(of_each))

    def __len__(self) -> int:
        return len(self._ids)

    def __iter__(self) -> Iterator[PlannedRecord]:
        return (planned_record(self._config, i) for i in self._ids)

    @overload
    def __getitem__(self, index: int) -> PlannedRecord: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[PlannedRecord, ...]: ...
    def __getitem__(self, index: int | slice) -> PlannedRecord | tuple[PlannedRecord, ...]:
        if isinstance(index, slice):
            return tuple(planned_record(self._config, i) for i in self._ids[index])
        return planned_record(self._config, self._ids[index])


@dataclass(frozen=True, slots=True)
class Plan:
    """The set that a configuration describes."""

    config: Config

    @property
    def records(self) -> Records:
        """All records in ascending order, worked out one by one."""
        return Records(self.config)

    @property
    def count(self) -> int:
        """Number of records."""
        return len(self.records)


def plan(config: Config) -> Plan:
    """Return the plan of a configuration."""
    return Plan(config)


def planned_record(config: Config, record_id: int) -> PlannedRecord:
    """Return where a record stands; depends on the configuration (without `specimens`) and the index alone.

    Raises
    ------
    IndexError
        If the index is negative.
    """
    if record_id < 0:
        raise IndexError(f"record {record_id}: indices begin at 0")
    rest, repeat = divmod(record_id, config.repeats)
    rest, operating_point_id = divmod(rest, len(config.operating_points))
    specimen_id, state_id = divmod(rest, config.state_count)
    split = split_of(config, specimen_id)
    return PlannedRecord(record_id, specimen_id, state_id, operating_point_id, repeat, split)


def record_ids_of(config: Config, specimen_id: int) -> range:
    """Return the indices of a specimen's records; with `life` the rest of its indices stays free."""
    first = specimen_id * config.records_per_specimen
    own = inspection_count(config, specimen_id)
    return range(first, first + own * len(config.operating_points) * config.repeats)


def split_of(config: Config, specimen_id: int) -> str:
    """Return the split of a specimen; depends on seed, `splits` and the specimen, or its gear pair, alone."""
    block, place = divmod(_owner(config, specimen_id), BLOCK)
    return _splits_of_block(config.seed, config.splits, block)[place]


def _owner(config: Config, specimen_id: int) -> int:
    """Return the index that a split belongs to: the specimen's own, or that of its gear pair."""
    pair = pair_of(config, specimen_id) if config.splits.by == "pair" else None
    return specimen_id if pair is None else pair


@lru_cache(maxsize=4096)
def _splits_of_block(seed: int, splits: Splits, block: int) -> tuple[str, ...]:
    rng = generator(seed, Stream.SPLIT, block)
    labels = _even_sequence(splits)
    shuffled: list[str] = []
    for start in range(0, BLOCK, SUB_BLOCK):
        shuffled += [labels[start + i] for i in rng.permutation(SUB_BLOCK)]
    return tuple(shuffled)


@cache
def _even_sequence(splits: Splits) -> tuple[str, ...]:
    """Spread the labels of a block evenly: each place goes to the split that lags most behind its share (derived).

    The shares lag by 1 in total before each place, so the largest of three lags is at least 1/3 and no split is ever
    more than 2/3 ahead: the counts come out exactly.
    """
    wanted = splits.model_dump()
    given = dict.fromkeys(SPLITS, 0)
    sequence = []
    for place in range(1, BLOCK + 1):
        # whole numbers, so that equal lags are equal; the smaller split goes first among them
        label = max(SPLITS, key=lambda name: (wanted[name] * place - given[name] * BLOCK, -wanted[name]))
        given[label] += 1
        sequence.append(label)
    return tuple(sequence)


def shards(config: Config, split: str, earlier: Sequence[int] = ()) -> tuple[ShardPlan, ...]:
    """Return the shards of a split; all are full but the last, so a larger set has the same full shards.

    Parameters
    ----------
    config : Config
    split : str
    earlier : sequence of int
        Numbers of specimens, ascending, that the set had before it was extended: shards never hold specimens from
        both sides of one, so that those of the smaller set stay as they are.
    """
    members = array("q", (i for i in range(config.specimens) if split_of(config, i) == split))
    size = specimens_per_shard(config)
    groups: list[Sequence[int]] = []
    for first, end in pairwise((0, *earlier, config.specimens)):
        own = members[bisect_left(members, first) : bisect_left(members, end)]
        groups += [own[start : start + size] for start in range(0, len(own), size)]
    return tuple(
        ShardPlan(split, number, group, config.records_per_specimen, _counts(config, group))
        for number, group in enumerate(groups)
    )


def _counts(config: Config, specimens: Sequence[int]) -> tuple[int, ...]:
    return () if config.life is None else tuple(len(record_ids_of(config, one)) for one in specimens)


def specimen_count(config: Config, split: str) -> int:
    """Return the number of specimens of a split without listing them: all whole blocks hold as many."""
    block = len(config.gears.pairs) if config.splits.by == "pair" else BLOCK
    blocks, rest = divmod(config.specimens, block)
    first = blocks * block
    own = sum(split_of(config, specimen) == split for specimen in range(block)) if blocks else 0
    tail = sum(split_of(config, specimen) == split for specimen in range(first, first + rest))
    return blocks * own + tail


def shard_count(config: Config, split: str) -> int:
    """Return the number of shards of a split without listing them."""
    return -(-specimen_count(config, split) // specimens_per_shard(config))


def specimens_per_shard(config: Config) -> int:
    """Return the number of specimens in a full shard, from the raw bytes of a specimen's signals."""
    specimen_bytes = _row_bytes(config) * len(config.channels) * config.records_per_specimen + _internal_bytes(config)
    return max(1, SHARD_BYTES * 100 // (specimen_bytes * DISK_SHARE_PERCENT))


def estimated_bytes(config: Config, records: int) -> int:
    """Return about how many bytes the signals of a set of so many records will take on disk."""
    percents = [_disk_percent(sensor) for sensor in config.sensors for _ in sensor.axes]
    internals = config.specimens * _internal_bytes(config) * UNQUANTISED_SHARE_PERCENT // 100
    return records * _row_bytes(config) * sum(percents) // 100 + internals


def _disk_percent(sensor: SensorBase) -> int:
    if sensor.bits == FROM_NOISE:
        return NOISE_SHARE_PERCENT
    return UNQUANTISED_SHARE_PERCENT if sensor.bits is None or sensor.bits > 16 else DISK_SHARE_PERCENT


def rows_per_group(config: Config) -> int:
    """Return the number of records in a row group: a power of two that fills 4 to 8 MB per channel.

    Fewer where all channels together would pass 64 MB, and never less than one.
    """
    row_bytes = _row_bytes(config)
    rows = min(GROUP_CHANNEL_BYTES // row_bytes, GROUP_BYTES // (row_bytes * len(config.channels)))
    return 1 << (max(1, rows).bit_length() - 1)


def _internal_bytes(config: Config) -> int:
    """Return about how many raw bytes of internal quantities a specimen with some has."""
    chosen = config.internals
    if chosen is None:
        return 0
    series = MANY_QUANTITIES if chosen.stores_all else len(chosen.quantities)
    return config.records_per_specimen * series * _row_bytes(config)


def _row_bytes(config: Config) -> int:
    return config.samples * 4
