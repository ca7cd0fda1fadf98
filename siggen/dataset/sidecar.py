"""The small file beside each shard that commits it: what it holds, what failed, where it was made."""

from __future__ import annotations

from array import array
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING

from siggen.columns.record import RecordFailure
from siggen.columns.versions import SCHEMA_VERSION, SIMULATION_VERSION
from siggen.dataset.checked_file import Checksums, checksums
from siggen.dataset.gate import sidecar_facts
from siggen.dataset.id_ranges import IdRanges, Range
from siggen.dataset.inventory import SidecarTable
from siggen.dataset.object_name import sidecar_name
from siggen.dataset.seal import sealed
from siggen.dataset.shard import FileFacts
from siggen.dataset.storage import Storage
from siggen.errors import DatasetError, VerificationError

if TYPE_CHECKING:
    from siggen.gearbox.plan import ShardPlan


@dataclass(frozen=True, slots=True)
class Sidecar:
    """A committed shard.

    Attributes
    ----------
    shard
        Name without folder and ending, `<split>-<number>`.
    specimens, records
        Inclusive ranges of ids that the plan gives to the shard, failed records included.
    rows_per_state
        Rows by the state's name.
    environment
        Versions and CPU family that made the rows.
    internals
        The shard's rows of internal quantities, in sets that store them.
    """

    shard: str
    split: str
    identity: str
    data: FileFacts
    specimens: Sequence[Range]
    records: Sequence[Range]
    rows_per_state: Mapping[str, int]
    failures: tuple[RecordFailure, ...]
    environment: Mapping[str, str]
    internals: FileFacts | None = None

    @property
    def name(self) -> str:
        """The sidecar's own object name."""
        return sidecar_name(self.shard)

    @property
    def files(self) -> tuple[FileFacts, ...]:
        """The files that the sidecar commits."""
        return (self.data,) if self.internals is None else (self.data, self.internals)

    def without_bulk(self, specimens: Sequence[Range], records: Sequence[Range]) -> Sidecar:
        """Return what a run keeps of it: equal ranges that take no memory, and no checksums of blocks."""
        internals = None if self.internals is None else replace(self.internals, crc32_per_64_kib="")
        data = replace(self.data, crc32_per_64_kib="")
        return replace(self, data=data, internals=internals, specimens=specimens, records=records)


def ranges(shard: ShardPlan) -> tuple[IdRanges, IdRanges]:
    """Return the ranges of specimens and of records of a planned shard."""
    if shard.counts:
        return IdRanges(shard.specimens), IdRanges(array("q", shard.record_ids))
    return IdRanges(shard.specimens), IdRanges(shard.specimens, shard.records_per_specimen)


def put_sidecar(storage: Storage, sidecar: Sidecar) -> None:
    """Commit a shard whose rows are already stored."""
    ranges = {"specimens": list(sidecar.specimens), "records": list(sidecar.records)}
    content = {"schema_version": SCHEMA_VERSION, "simulation_version": SIMULATION_VERSION, **asdict(sidecar), **ranges}
    if sidecar.internals is None:
        del content["internals"]  # as in sets that were made before internals could be stored
    storage.put(sidecar.name, sealed(content))


def read_sidecar(storage: Storage, shard: str) -> Sidecar:
    """Return a shard's sidecar.

    Raises
    ------
    DatasetError
        If the file is missing or was changed, or is not a sidecar of this schema version.
    """
    name = sidecar_name(shard)
    try:
        facts = sidecar_facts(name, storage.get(name))
    except VerificationError as error:
        raise DatasetError(f"{storage.location}/{name} is not a sidecar of siggen ({error})") from error
    versions = (facts.schema_version, facts.simulation_version)
    if versions != (SCHEMA_VERSION, SIMULATION_VERSION):
        raise DatasetError(
            f"{name}: received schema version {versions[0][:20]} and simulation version {versions[1]}; "
            f"allowed are {SCHEMA_VERSION} and {SIMULATION_VERSION}, which this siggen writes"
        )
    return Sidecar(
        shard=facts.shard,
        split=facts.split,
        identity=facts.identity,
        data=file_facts(facts.data),
        specimens=facts.specimens,
        records=facts.records,
        rows_per_state=facts.rows_per_state,
        failures=facts.failures,
        environment=facts.environment,
        internals=None if facts.internals is None else file_facts(facts.internals),
    )


def file_facts(table: SidecarTable) -> FileFacts:
    """Return what a sidecar promises of a file."""
    return FileFacts(table.name, table.bytes, table.sha256, table.crc32_per_64_kib, table.rows)


def promised_shard(storage: Storage, shard: str, identity: str, specimens: Sequence[Range]) -> Sidecar | str:
    """Return the sidecar of a shard of this very set, or why it cannot be used; empty if there is none.

    Its files are not read.
    """
    if not storage.exists(sidecar_name(shard)):
        return ""
    try:
        sidecar = read_sidecar(storage, shard)
    except DatasetError as error:
        return str(error)
    is_planned = (sidecar.shard, sidecar.identity, sidecar.specimens) == (shard, identity, specimens)
    return sidecar if is_planned else f"{storage.location}/{sidecar.name} is of another set"


def committed(storage: Storage, shard: str, identity: str, specimens: Sequence[Range]) -> Sidecar | str:
    """Return the sidecar of a shard that an earlier run finished, or why it has to be made; empty if nothing is there.

    The rows are read once and hashed, so that a file damaged between two runs is made again instead of being taken
    over; a set is hashed nowhere else before its manifest promises the hashes.
    """
    found = promised_shard(storage, shard, identity, specimens)
    if isinstance(found, str):
        return found
    broken = [facts.name for facts in found.files if not _is_whole(storage, facts)]
    return f"{storage.location}/{broken[0]} is missing or damaged" if broken else found


def _is_whole(storage: Storage, facts: FileFacts) -> bool:
    if not storage.exists(facts.name) or storage.size(facts.name) != facts.bytes:
        return False
    with storage.open(facts.name) as file:
        return checksums(file) == Checksums(facts.sha256, facts.crc32_per_64_kib)
