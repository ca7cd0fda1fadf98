"""A finished set against its manifest: every byte, and a sample of records simulated again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random
from shlex import quote

from siggen.columns.versions import SIMULATION_VERSION
from siggen.dataset.chunk import Chunk
from siggen.dataset.environment import environment, fingerprint, version_text
from siggen.dataset.gate import manifest_facts, sidecar_facts
from siggen.dataset.inventory import Inventory, PromisedFile
from siggen.dataset.manifest import (
    BLIND,
    CONFIG,
    DAMAGE_FOLDER,
    INJECTED,
    LIFE_FOLDER,
    MANIFEST,
    METADATA_FOLDER,
    PHYSICS,
    RUN,
    read_manifest,
)
from siggen.dataset.object_name import CHECKSUMS, DATA_FOLDER, INDEX, INTERNALS_FOLDER, SIDECAR_FOLDER, sidecar_name
from siggen.dataset.reading import Dataset
from siggen.dataset.seal import unsealed
from siggen.dataset.shard_index import ShardIndex, promised_files
from siggen.dataset.storage import Storage, sha256
from siggen.dataset.storage_at import storage_at
from siggen.engines.protocol import Engine
from siggen.engines.registry import engine_of, running
from siggen.errors import ConfigError, DatasetError, VerificationError, counted
from siggen.gearbox.design import SetDesign, stored_design
from siggen.sets import physics as contents
from siggen.sets.record_comparison import result_difference

OWN_FOLDERS = (DATA_FOLDER, INTERNALS_FOLDER, METADATA_FOLDER, DAMAGE_FOLDER, LIFE_FOLDER, SIDECAR_FOLDER)

EXACT = "bit for bit"
CLOSE = "within one step of the converter"
STRANGER = "not part of the set"
HASHES_ALONE = "hashes checked"
"""How the comparison begins of a set whose records another version of the simulation made."""


@dataclass(frozen=True, slots=True)
class Mismatch:
    """A file or record that is not what the manifest promises."""

    what: str
    problem: str


@dataclass(frozen=True, slots=True)
class Verification:
    """What was compared, how, and what differs.

    Attributes
    ----------
    files, bytes
        Read and hashed.
    records
        Ids of the records that were simulated again, ascending.
    comparison
        How they were compared, or why none was.
    mismatches
        Empty for a set that is what it promises to be.
    made_by
        The versions that made the shards, each with its fingerprint.
    here
        The version that compared.
    """

    path: str
    files: int
    bytes: int
    records: tuple[int, ...]
    comparison: str
    mismatches: tuple[Mismatch, ...]
    made_by: tuple[str, ...] = ()
    here: str = ""


def verify(
    path: Path | str, sample: int = 0, *, workers: int | None = None, engine: Engine | str | None = None
) -> Verification:
    """Compare a finished set with its manifest, and `sample` of its records with a new simulation.

    Records are compared bit for bit if versions and CPU family are those that made them; elsewhere signals may
    differ by one step of the converter. A set that another version of the simulation made is compared with its hashes
    alone, and `comparison` says so.

    Parameters
    ----------
    path : path
    sample : int
        Number of records; which ones follows from the manifest, so a verification can be repeated.
    workers : int, optional
        Worker processes; by default none, since a few records cost less than the start of one.
    engine : Engine or str, optional
        As for `generate`.

    Raises
    ------
    DatasetError
        If there is no finished set, or its files are of another version.
    """
    storage = storage_at(path)
    if not storage.exists(MANIFEST):
        read_manifest(storage)  # says what is there instead
    try:
        manifest = manifest_facts(MANIFEST, storage.get(MANIFEST))
    except DatasetError as error:
        raise DatasetError(f"{storage.location}/{error}") from error
    except VerificationError as error:
        return Verification(storage.location, 1, storage.size(MANIFEST), (), "none", (Mismatch(MANIFEST, str(error)),))
    mismatches = [*_file_mismatches(storage, manifest.files), *_run(storage)]
    files, shard_mismatches = _with_shards(storage, manifest, mismatches)
    mismatches += shard_mismatches
    if not mismatches:
        mismatches += _sidecar_mismatches(storage, manifest)
    records: tuple[int, ...] = ()
    comparison = "none asked for"
    if sample and mismatches:
        comparison = "none, since files differ"
    elif sample and (reason := why_not_again(manifest, sample)):
        comparison = reason
    elif sample:
        records, comparison, different = _simulate_again(storage, sample, engine, workers)
        mismatches += different
    total = sum(facts.bytes for facts in files.values())
    count = len(files) + 2
    versions = tuple(dict.fromkeys(map(version_text, manifest.environments))), version_text(environment())
    return Verification(storage.location, count, total, records, comparison, tuple(mismatches), *versions)


def why_not_again(manifest: Inventory, sample: int) -> str:
    """Return why no record of a set can be compared with a new simulation, or an empty string."""
    made_by = manifest.simulation_version
    if INJECTED in manifest.files:
        return f"{HASHES_ALONE}: its rows hold recordings, which no simulation makes again"
    if BLIND in manifest.files:
        return f"{HASHES_ALONE}: what its rows were made of is secret until it is revealed"
    if made_by == SIMULATION_VERSION:
        return ""
    head = f"{HASHES_ALONE}; {counted(min(sample, manifest.rows), 'record')} not simulated again: "
    return f"{head}made by simulation version {made_by}, this is {SIMULATION_VERSION}"


def _file_mismatches(storage: Storage, files: Mapping[str, PromisedFile]) -> Iterator[Mismatch]:
    sizes = storage.sizes()
    for name, facts in sorted(files.items()):
        if name not in sizes:
            yield Mismatch(name, "missing")
        elif sizes[name] != facts.bytes:
            yield Mismatch(name, f"{sizes[name]} bytes instead of {facts.bytes}")
        elif problem := _content_problem(storage, name, facts.sha256):
            yield Mismatch(name, problem)


def _with_shards(
    storage: Storage, manifest: Inventory, found: Sequence[Mismatch]
) -> tuple[Mapping[str, PromisedFile], list[Mismatch]]:
    """Return all files that are promised, and what is wrong with those of the shards.

    Where the table that promises them is damaged, they are neither compared nor called strangers.
    """
    files = dict(manifest.files)
    if any(one.what == CHECKSUMS for one in found):
        return files, []
    try:
        promised = dict(promised_files(storage, files[CHECKSUMS]))
    except DatasetError as error:
        return files, [Mismatch(CHECKSUMS, str(error))]
    files |= promised
    return files, [*_file_mismatches(storage, promised), *_strangers(storage, files)]


def _sidecar_mismatches(storage: Storage, manifest: Inventory) -> Iterator[Mismatch]:
    """Yield the sidecars that say something else than the index, which a stranger may have sealed around them."""
    try:
        index = ShardIndex(storage, manifest)
    except DatasetError as error:
        yield Mismatch(INDEX, str(error))
        return
    for shard in index.shards():
        name = sidecar_name(shard.shard)
        try:
            facts = sidecar_facts(name, storage.get(name))
        except (VerificationError, DatasetError) as error:
            yield Mismatch(name, str(error))
            continue
        tables = {
            table.name: PromisedFile(bytes=table.bytes, sha256=table.sha256, crc32_per_64_kib=table.crc32_per_64_kib)
            for table in (facts.data, facts.internals)
            if table
        }
        promised = {table: index.promised(table) for table in shard.tables}
        listed = (shard.specimens, shard.records, shard.rows, manifest.environments[shard.environment])
        if tables != promised or listed != (facts.specimens, facts.records, facts.data.rows, facts.environment):
            yield Mismatch(name, "says something else than the index")


def _content_problem(storage: Storage, name: str, promised: str) -> str:
    try:
        return "" if sha256(storage, name) == promised else "content differs (SHA-256)"
    except DatasetError as error:  # a link out of the set, or no regular file
        return str(error)


def _strangers(storage: Storage, files: Mapping[str, object]) -> Iterator[Mismatch]:
    for folder in OWN_FOLDERS:
        yield from (Mismatch(name, STRANGER) for name in storage.names(folder) if name not in files)


def _run(storage: Storage) -> Iterator[Mismatch]:
    """Check run.json and physics.json by their own digests; they may be left out when a set is published."""
    for name in (RUN, PHYSICS):
        if storage.exists(name):
            try:
                unsealed(name, storage.get(name))
            except VerificationError as error:
                yield Mismatch(name, str(error))


def _simulate_again(
    storage: Storage, sample: int, engine: Engine | str | None, workers: int | None
) -> tuple[tuple[int, ...], str, list[Mismatch]]:
    dataset = Dataset(storage)
    try:
        design = design_of_set(storage, dataset.inventory)
    except (ConfigError, DatasetError) as error:
        why = f"this version of siggen reads the configuration otherwise ({error})"
        return (), f"none: {why}", [Mismatch("records", f"cannot be simulated again: {why}")]
    ids = _sample(dataset, sample)
    here = fingerprint(environment())
    exact = {record_id: fingerprint(_environment(dataset, record_id)) == here for record_id in ids}
    tasks = [Chunk("again", range(record_id, record_id + 1)) for record_id in ids]
    mismatches = []
    function = contents.physics().simulation(design)
    chosen = engine_of(engine, 0 if engine is None and workers is None else workers)
    with running(chosen, function, tasks) as results:
        for index, result in results:
            record_id = ids[index]
            stored = dataset.record(record_id)
            internals = dataset.record_internals(record_id) if dataset.internal_columns else None
            problem = result_difference(design, stored, internals, result, exact=exact[record_id])
            mismatches += [Mismatch(f"record {record_id}", problem)] if problem else []
    comparison = EXACT if all(exact.values()) else f"{CLOSE} (made with other versions or another CPU family)"
    return tuple(ids), comparison, sorted(mismatches, key=lambda mismatch: mismatch.what)


def design_of_set(storage: Storage, manifest: Inventory) -> SetDesign:
    """Return the set's design; its identity must be the one that this version computes, too.

    Raises
    ------
    ConfigError, DatasetError
        If this version reads it otherwise.
    """
    design = stored_design(storage.get(CONFIG), CONFIG)
    if design.identity != manifest.identity:
        raise DatasetError("its identity differs")
    return design


def _sample(dataset: Dataset, count: int) -> list[int]:
    ids = sorted(dataset.labels(columns=["record_id"])["record_id"].to_pylist())
    return sorted(Random(dataset.inventory.identity).sample(ids, min(count, len(ids))))


def _environment(dataset: Dataset, record_id: int) -> Mapping[str, str]:
    owner = dataset.index.owner(record_id)
    return {} if owner is None else dataset.inventory.environments[owner.environment]


def problem_lines(found: Verification) -> list[str]:
    """Return one line per mismatch, and what repairs the set."""
    lines = [f"{one.what}: {one.problem}" for one in found.mismatches]
    spare = [one.what for one in found.mismatches if one.problem == STRANGER or one.what in (RUN, PHYSICS)]
    damaged = [one.what for one in found.mismatches if one.what not in spare and not one.what.startswith("record")]
    if spare:
        lines.append(f"to repair it: remove {', '.join(spare)}")
    if damaged and not found.comparison.startswith(HASHES_ALONE):
        config = "CONFIG, the file that the set was made of," if CONFIG in damaged else quote(f"{found.path}/{CONFIG}")
        lines.append(f"to make again what is missing or differs: siggen generate {config} --out {quote(found.path)}")
    return lines
