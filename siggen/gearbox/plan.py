"""The whole set as indices: which record belongs to which specimen, state, operating point, repeat and split.

Nothing here is drawn except the order of splits within a few specimens, so a set of any size is listed in no time.
"""

from __future__ import annotations

from array import array
from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import chain, pairwise
from numbers import Integral
from typing import overload

from siggen.config.config import MOST_REPEATS
from siggen.errors import UsageError
from siggen.gearbox.channels import sensors_of
from siggen.gearbox.design import SetDesign, expect_design
from siggen.keys.problems import received_text
from siggen.seeding import Stream, generator
from siggen.sensors.converter import FROM_NOISE
from siggen.sensors.sensor import SensorBase

SPLITS = ("train", "validation", "test")

SUB_BLOCK = 5
"""Specimens among which splits are shuffled; small, so that a set cut off anywhere is still nearly balanced."""

SHARD_BYTES = 16_000_000
"""Most bytes of a shard on disk, unless a gearbox alone has more."""

SHARDS = 256
"""Shards that gearboxes made at once are spread over, as far as they reach: work for as many workers, and little that
a stop loses. A gearbox is never cut: its teeth, housing and tables are made once for all its records."""

DISK_SHARE_PERCENT = 45
"""Assumed size on disk over raw size: 16-bit readings as float32, byte-split and compressed (measured 0.43 to 0.47)."""

UNQUANTISED_SHARE_PERCENT = 81
"""The same for readings that are not quantised, or finer than 16 bits (measured 0.76 to 0.81)."""

NOISE_SHARE_PERCENT = 55
"""The same for a converter as fine as the noise asks for (measured 0.54 and 0.55)."""

MANY_QUANTITIES = 30
"""Assumed number of internal quantities where all are stored: 14 with the linear mesh law, 41 with pairs and casing."""


@dataclass(frozen=True, slots=True)
class PlannedRecord:
    """Where one record stands in the set; a `renewal` above 0 is it once more, with other noise and sensors."""

    record_id: int
    specimen_id: int
    state_id: int
    operating_point_id: int
    repeat: int
    split: str
    renewal: int = 0

    @property
    def owner(self) -> tuple[int, int, int, int]:
        """Keys of what is drawn per record, and moves its gearbox."""
        return self.specimen_id, self.state_id, self.operating_point_id, self.repeat

    @property
    def noise_owner(self) -> tuple[int, int, int, int]:
        """Keys of noise that moves nothing: of a renewal those of a repeat beyond all that a set may have."""
        return *self.owner[:3], self.repeat + self.renewal * MOST_REPEATS

    @property
    def sensors_of(self) -> int:
        """Key of what is drawn of the sensors: of a renewal that of a gearbox beyond all that a set may have."""
        return sensors_of(self.specimen_id, self.renewal)


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

    def __str__(self) -> str:
        first = next(self.record_ids, -1)
        return f"shard {self.key} ({self.record_count} records from {first} on)"


class Records(Sequence[PlannedRecord]):
    """All planned records in ascending order, each worked out when it is asked for."""

    def __init__(self, design: SetDesign) -> None:
        self._design = design
        self._ids: Sequence[int] = range(design.specimens * design.records_per_specimen)
        if design.lives:
            of_each = (record_ids_of(design, one) for one in range(design.specimens))
            self._ids = tuple(chain.from_iterable(of_each))

    def __len__(self) -> int:
        return len(self._ids)

    def __iter__(self) -> Iterator[PlannedRecord]:
        return (planned_record(self._design, i) for i in self._ids)

    @overload
    def __getitem__(self, index: int) -> PlannedRecord: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[PlannedRecord, ...]: ...
    def __getitem__(self, index: int | slice) -> PlannedRecord | tuple[PlannedRecord, ...]:
        if isinstance(index, slice):
            return tuple(planned_record(self._design, i) for i in self._ids[index])
        return planned_record(self._design, self._ids[index])


def plan(design: SetDesign) -> Records:
    """Return all records of a set in ascending order."""
    expect_design(design)
    return Records(design)


def planned_record(design: SetDesign, record_id: int) -> PlannedRecord:
    """Return where a record stands; depends on the design (without `specimens`) and the index alone.

    Raises
    ------
    IndexError
        If the index is negative.
    """
    if record_id < 0:
        raise IndexError(f"record {record_id}: indices begin at 0")
    rest, repeat = divmod(record_id, design.repeats)
    rest, operating_point_id = divmod(rest, design.points)
    specimen_id, state_id = divmod(rest, design.state_count)
    split = split_of(design, specimen_id)
    return PlannedRecord(record_id, specimen_id, state_id, operating_point_id, repeat, split)


def expect_record(design: SetDesign, record_id: int, called: str) -> None:
    """Refuse the number of a record that a set does not hold, in the words of whoever was asked for it."""
    of_each, last = design.records_per_specimen, design.specimens * design.records_per_specimen - 1
    if not isinstance(record_id, Integral) or not 0 <= record_id <= last:
        raise UsageError(f"{called}: received {received_text(record_id)}; allowed: a whole number from 0 to {last}")
    if record_id not in (ids := record_ids_of(design, record_id // of_each)):
        raise UsageError(
            f"{called}: received {record_id}, but this gearbox fails, or is taken out, before; allowed: {ids[0]} to "
            f"{ids[-1]}, or those of another one"
        )


def record_ids_of(design: SetDesign, specimen_id: int) -> range:
    """Return the indices of a specimen's records; with `life` the rest of its indices stays free."""
    first = specimen_id * design.records_per_specimen
    return range(first, first + design.inspections(specimen_id) * design.points * design.repeats)


def split_of(design: SetDesign, specimen_id: int) -> str:
    """Return the split of a specimen; depends on seed, `splits` and the specimen, or its gear pair, alone."""
    block, place = divmod(_owner(design, specimen_id), design.block)
    return _splits_of_block(design.seed, design.shares, block)[place]


def _owner(design: SetDesign, specimen_id: int) -> int:
    """Return the index that a split belongs to: the specimen's own, or that of its gear pair."""
    pair = design.pair_of(specimen_id) if design.split_by_pair else None
    return specimen_id if pair is None else pair


@lru_cache(maxsize=4096)
def _splits_of_block(seed: int, shares: tuple[tuple[str, int], ...], block: int) -> tuple[str, ...]:
    rng = generator(seed, Stream.SPLIT, block)
    labels = _even_sequence(dict(shares))
    shuffled: list[str] = []
    for start in range(0, len(labels), SUB_BLOCK):
        shuffled += [labels[start + i] for i in rng.permutation(SUB_BLOCK)]
    return tuple(shuffled)


def _even_sequence(wanted: Mapping[str, int]) -> tuple[str, ...]:
    """Spread the labels of a block evenly: each place goes to the split that lags most behind its share (derived).

    The shares lag by 1 in total before each place, so the largest of three lags is at least 1/3 and no split is ever
    more than 2/3 ahead: the counts come out exactly.
    """
    given, block = dict.fromkeys(SPLITS, 0), sum(wanted.values())
    sequence = []
    for place in range(1, block + 1):
        # whole numbers, so that equal lags are equal; the smaller split goes first among them
        label = max(SPLITS, key=lambda name: (wanted[name] * place - given[name] * block, -wanted[name]))
        given[label] += 1
        sequence.append(label)
    return tuple(sequence)


def shards(design: SetDesign, split: str, earlier: Sequence[int] = ()) -> tuple[ShardPlan, ...]:
    """Return the shards of a split, of as many gearboxes each but the last.

    Parameters
    ----------
    design : SetDesign
    split : str
    earlier : sequence of int
        Numbers of specimens, ascending, that the set had before it was extended: shards never hold specimens from
        both sides of one, so that those of the smaller set stay as they are.
    """
    members = array("q", (i for i in range(design.specimens) if split_of(design, i) == split))
    groups: list[Sequence[int]] = []
    for first, end in pairwise((0, *earlier, design.specimens)):
        size = specimens_per_shard(design, end - first)
        own = members[bisect_left(members, first) : bisect_left(members, end)]
        groups += [own[start : start + size] for start in range(0, len(own), size)]
    return tuple(
        ShardPlan(split, number, group, design.records_per_specimen, _counts(design, group))
        for number, group in enumerate(groups)
    )


def _counts(design: SetDesign, specimens: Sequence[int]) -> tuple[int, ...]:
    return tuple(len(record_ids_of(design, one)) for one in specimens) if design.lives else ()


def specimen_count(design: SetDesign, split: str) -> int:
    """Return the number of specimens of a split without listing them: all whole blocks hold as many."""
    block = design.pairs if design.split_by_pair else design.block
    blocks, rest = divmod(design.specimens, block)
    first = blocks * block
    own = sum(split_of(design, specimen) == split for specimen in range(block)) if blocks else 0
    tail = sum(split_of(design, specimen) == split for specimen in range(first, first + rest))
    return blocks * own + tail


def shard_count(design: SetDesign, split: str) -> int:
    """Return the number of shards of a split of a set that is made at once, without listing them."""
    return -(-specimen_count(design, split) // specimens_per_shard(design, design.specimens))


def specimens_per_shard(design: SetDesign, stretch: int) -> int:
    """Return the number of specimens in a full shard, from how many are made at once and the raw bytes of each."""
    specimen_bytes = _row_bytes(design) * len(design.channels) * design.records_per_specimen + _internal_bytes(design)
    return max(1, min(stretch // SHARDS, SHARD_BYTES * 100 // (specimen_bytes * DISK_SHARE_PERCENT)))


def largest_shard_share(design: SetDesign) -> float:
    """Return which share of its gearboxes the largest shard of a set has, made at once: a worker makes it alone."""
    most = max(specimen_count(design, split) for split in SPLITS)
    return min(specimens_per_shard(design, design.specimens), most) / design.specimens


def estimated_bytes(design: SetDesign, records: int) -> int:
    """Return about how many bytes the signals of a set of so many records will take on disk."""
    percents = [_disk_percent(sensor) for sensor in design.sensors for _ in sensor.axes]
    internals = design.specimens * _internal_bytes(design) * UNQUANTISED_SHARE_PERCENT // 100
    return records * _row_bytes(design) * sum(percents) // 100 + internals


def _disk_percent(sensor: SensorBase) -> int:
    if sensor.bits == FROM_NOISE:
        return NOISE_SHARE_PERCENT
    return UNQUANTISED_SHARE_PERCENT if sensor.bits is None or sensor.bits > 16 else DISK_SHARE_PERCENT


def _internal_bytes(design: SetDesign) -> int:
    """Return about how many raw bytes of internal quantities a specimen with some has."""
    if design.stored is None:
        return 0
    series = MANY_QUANTITIES if design.stores_all else len(design.stored)
    return design.records_per_specimen * series * _row_bytes(design)


def _row_bytes(design: SetDesign) -> int:
    return design.samples * 4
