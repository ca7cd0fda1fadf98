"""What a manifest and a sidecar say: the types, ranges and names that `gate` lets through."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any

from pydantic import AfterValidator, Field, SkipValidation

from siggen.columns.drivetrain import GearTrain
from siggen.columns.record import ChannelColumn, RecordFailure
from siggen.dataset.id_ranges import Range
from siggen.dataset.object_name import object_name
from siggen.keys.column import Role

LARGEST = 2**53


def _ascending(ranges: tuple[Range, ...]) -> tuple[Range, ...]:
    last = -1
    for first, end in ranges:
        if not last < first <= end:
            raise ValueError("allowed: ascending ranges of ids, first and last one of each")
        last = end
    return ranges


Count = Annotated[int, Field(ge=0, le=LARGEST)]
Quantity = Annotated[float, Field(gt=0, le=1e12, allow_inf_nan=False)]
Text = Annotated[str, Field(max_length=20_000)]
Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]{0,219}$")]
ColumnName = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,499}$")]
Sha256 = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]
Blocks = Annotated[str, Field(pattern=r"^([0-9a-f]{8})*$")]
ObjectName = Annotated[str, AfterValidator(object_name)]
Split = Annotated[str, Field(pattern=r"^(train|validation|test)$")]
ShardName = Annotated[str, Field(pattern=r"^(train|validation|test)-[0-9]{5,12}$")]
Ranges = Annotated[tuple[tuple[Count, Count], ...], AfterValidator(_ascending)]
Environment = dict[Name, Text]


@dataclass(frozen=True, slots=True, kw_only=True)
class PromisedFile:
    """Size and hash of a file of a set; `crc32_per_64_kib` as `checked_file` has it, for tables alone."""

    bytes: Count
    sha256: Sha256
    crc32_per_64_kib: Blocks | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ListedShard:
    """A shard of a finished set: its files, its inclusive ranges of ids, the number of its environment."""

    shard: str
    split: str
    file: str
    rows: int
    specimens: Sequence[Range]
    records: Sequence[Range]
    environment: int
    internals: str | None = None

    @property
    def tables(self) -> tuple[str, ...]:
        """The files of rows."""
        return (self.file,) if self.internals is None else (self.file, self.internals)


@dataclass(frozen=True, slots=True, kw_only=True)
class ListedSplit:
    """Counts of a split."""

    specimens: Count
    rows: Count
    failed: Count
    states: dict[Name, Count]
    shards: Count
    bytes: Count


@dataclass(frozen=True, slots=True, kw_only=True)
class ListedQuantity:
    """An internal quantity that a set stores."""

    name: ColumnName
    unit: Text
    meaning: Text


@dataclass(frozen=True, slots=True, kw_only=True)
class ListedColumn:
    """Role of a column of records, and its `section`, `quantity` and `of` as of `Column`."""

    name: ColumnName
    role: Role
    section: Text = ""
    quantity: Text = ""
    of: Text = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class SidecarTable:
    """A file that a sidecar commits."""

    name: ObjectName
    bytes: Count
    sha256: Sha256
    rows: Count
    crc32_per_64_kib: Blocks


@dataclass(frozen=True, slots=True, kw_only=True)
class SidecarFacts:
    """Content of a sidecar."""

    schema_version: Text
    shard: ShardName
    split: Split
    identity: Sha256
    data: SidecarTable
    specimens: Ranges
    records: Ranges
    rows_per_state: dict[Name, Count]
    failures: tuple[RecordFailure, ...]
    environment: Environment
    simulation_version: Count
    internals: SidecarTable | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Inventory:
    """What a manifest says; `content` is all of it, as JSON has it."""

    schema_version: Text
    files: dict[ObjectName, PromisedFile]
    identity: Sha256
    rows: Count
    simulation_version: Count
    content: Annotated[dict[str, Any], SkipValidation] = field(default_factory=dict)
    name: Name
    seed: int
    specimens: Count
    fs_hz: Quantity
    duration_s: Quantity
    splits: dict[Split, ListedSplit]
    rows_per_group: Annotated[int, Field(ge=1, le=LARGEST)]
    channels: tuple[ChannelColumn, ...]
    drivetrain: GearTrain
    environments: tuple[Environment, ...]
    failures: tuple[RecordFailure, ...]
    columns: tuple[ListedColumn, ...] = ()
    internals: tuple[ListedQuantity, ...] = ()
