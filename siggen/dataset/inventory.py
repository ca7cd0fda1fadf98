"""What a manifest says: the types, ranges and names that `gate` lets through."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Any

from pydantic import AfterValidator, Field, SkipValidation

from siggen.columns.drivetrain import GearTrain
from siggen.columns.record import ChannelColumn, RecordFailure
from siggen.dataset.object_name import data_name, internals_name, object_name
from siggen.keys.column import Role

LARGEST = 2**53

Count = Annotated[int, Field(ge=0, le=LARGEST)]
Quantity = Annotated[float, Field(gt=0, le=1e12, allow_inf_nan=False)]
Text = Annotated[str, Field(max_length=20_000)]
Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]{0,219}$")]
ColumnName = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,499}$")]
Sha256 = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]
ObjectName = Annotated[str, AfterValidator(object_name)]
Split = Annotated[str, Field(pattern=r"^(train|validation|test)$")]
ShardName = Annotated[str, Field(pattern=r"^(train|validation|test)-[0-9]{5,12}$")]


@dataclass(frozen=True, slots=True, kw_only=True)
class PromisedFile:
    """Size and hash of a file of a set."""

    bytes: Count
    sha256: Sha256


@dataclass(frozen=True, slots=True, kw_only=True)
class ListedShard:
    """A shard of a finished set, by its name `<split>-<number>`."""

    shard: ShardName
    rows: Count

    @property
    def split(self) -> str:
        """The split that it belongs to."""
        return self.shard.rpartition("-")[0]

    @property
    def file(self) -> str:
        """Name of its file of rows."""
        return data_name(self.shard)

    @property
    def internals(self) -> str:
        """Name of its file of internal quantities, in sets that store some."""
        return internals_name(self.shard)


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
class Inventory:
    """What a manifest says; `content` is all of it, as JSON has it.

    Attributes
    ----------
    extensions
        How many gearboxes the set had when it was finished first, and after each extension: how its shards are cut.
    """

    schema_version: Text
    files: dict[ObjectName, PromisedFile]
    shards: tuple[ListedShard, ...]
    identity: Sha256
    rows: Count
    simulation_version: Count
    content: Annotated[dict[str, Any], SkipValidation] = field(default_factory=dict)
    name: Name
    seed: int
    specimens: Count
    extensions: tuple[Count, ...]
    fs_hz: Quantity
    duration_s: Quantity
    splits: dict[Split, ListedSplit]
    channels: tuple[ChannelColumn, ...]
    drivetrain: GearTrain
    environment: dict[Name, Text]
    failures: tuple[RecordFailure, ...]
    columns: tuple[ListedColumn, ...] = ()
    internals: tuple[ListedQuantity, ...] = ()
