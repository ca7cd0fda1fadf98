"""The small file beside each shard that commits it: what it holds, what failed, where it was made."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace

from siggen.columns.record import RecordFailure
from siggen.columns.versions import FIRST_SIMULATION_VERSION, SCHEMA_VERSION, SIMULATION_VERSION
from siggen.dataset.checked_file import Checksums, checksums
from siggen.dataset.id_ranges import Range
from siggen.dataset.seal import sealed, unsealed
from siggen.dataset.shard import FileFacts
from siggen.dataset.storage import Storage
from siggen.errors import DatasetError, VerificationError

FOLDER = "shards"
DATA_FOLDER = "data"


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


def data_name(shard: str) -> str:
    """Return the object name of a shard's rows."""
    return f"{DATA_FOLDER}/{shard}.parquet"


def sidecar_name(shard: str) -> str:
    """Return the object name of a shard's sidecar."""
    return f"{FOLDER}/{shard}.json"


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
        If the file was changed, or is not a sidecar of this schema version.
    """
    name = sidecar_name(shard)
    try:
        stored = storage.get(name)
        content = json.loads(stored)
        versions = (content["schema_version"], content.get("simulation_version", FIRST_SIMULATION_VERSION))
        if versions != (SCHEMA_VERSION, SIMULATION_VERSION):
            raise DatasetError(
                f"{name}: received schema version {versions[0]} and simulation version {versions[1]}; "
                f"allowed are {SCHEMA_VERSION} and {SIMULATION_VERSION}, which this siggen writes"
            )
        content = unsealed(name, stored)
        return Sidecar(
            shard=content["shard"],
            split=content["split"],
            identity=content["identity"],
            data=FileFacts(**content["data"]),
            specimens=tuple((first, last) for first, last in content["specimens"]),
            records=tuple((first, last) for first, last in content["records"]),
            rows_per_state=content["rows_per_state"],
            failures=tuple(RecordFailure(**failure) for failure in content["failures"]),
            environment=content["environment"],
            internals=FileFacts(**content["internals"]) if "internals" in content else None,
        )
    except (VerificationError, ValueError, KeyError, TypeError) as error:
        raise DatasetError(f"{storage.location}/{name} is not a sidecar of siggen ({error!r})") from error


def committed(storage: Storage, shard: str, identity: str, specimens: Sequence[Range]) -> Sidecar | None:
    """Return the sidecar of a shard that an earlier run finished, or None if the shard has to be made.

    The rows are read once and hashed, so that a file damaged between two runs is made again instead of being taken
    over; a set is hashed nowhere else before its manifest promises the hashes.
    """
    if not (storage.exists(sidecar_name(shard)) and storage.exists(data_name(shard))):
        return None
    try:
        sidecar = read_sidecar(storage, shard)
    except DatasetError:
        return None
    is_planned = (sidecar.shard, sidecar.identity, sidecar.specimens) == (shard, identity, specimens)
    return sidecar if is_planned and all(_is_whole(storage, facts) for facts in sidecar.files) else None


def _is_whole(storage: Storage, facts: FileFacts) -> bool:
    if not storage.exists(facts.name) or storage.size(facts.name) != facts.bytes:
        return False
    with storage.open(facts.name) as file:
        return checksums(file) == Checksums(facts.sha256, facts.crc32_per_64_kib)
