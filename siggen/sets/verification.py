"""A finished set against its manifest: every byte, and a sample of records simulated again."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from random import Random
from shlex import quote

import pyarrow as pa

from siggen.columns.versions import SIMULATION_VERSION
from siggen.dataset.environment import environment, fingerprint, version_text
from siggen.dataset.gate import manifest_facts
from siggen.dataset.inventory import Inventory
from siggen.dataset.manifest import BLIND, CONFIG, CROISSANT, INJECTED, MANIFEST, PHYSICS, read_manifest
from siggen.dataset.object_name import DATA_FOLDER, INTERNALS_FOLDER, LABELS, LIFE_FOLDER, internals_name
from siggen.dataset.reading import Dataset
from siggen.dataset.seal import unsealed
from siggen.dataset.shard import about_of, packed, unpacked
from siggen.dataset.storage import LocalFolder, Storage
from siggen.dataset.storage_at import storage_at
from siggen.errors import ConfigError, DatasetError, UsageError, VerificationError, counted
from siggen.gearbox.design import SetDesign, stored_design
from siggen.sets import physics as contents
from siggen.sets.record_comparison import result_difference
from siggen.workers.choice import workers_of
from siggen.workers.tasks import results

OWN_FOLDERS = (DATA_FOLDER, INTERNALS_FOLDER, LIFE_FOLDER)

EXACT = "bit for bit"
CLOSE = "within one step of the converter"
STRANGER, MISSING = "not part of the set", "missing"
EXTENDING = "of an extension that is not finished"
HASHES_ALONE = "hashes checked"
"""How the comparison begins of a set whose records another version of the simulation made."""


class OneRecord(tuple[int]):
    """The id of a record that is simulated by itself; says so."""

    __slots__ = ()

    def __str__(self) -> str:
        return f"record {self[0]}"


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
        The version that made the shards, with its fingerprint.
    here
        The version that compared.
    repair
        Sentences on how to make the set what it promises to be.
    """

    path: str
    files: int
    bytes: int
    records: tuple[int, ...]
    comparison: str
    mismatches: tuple[Mismatch, ...]
    made_by: str = ""
    here: str = ""
    repair: tuple[str, ...] = ()


def verify(
    path: Path | str, sample: int = 0, *, workers: int | None = None, executor: Executor | str | None = None
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
    executor : Executor or str, optional
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
        size = storage.sizes().get(MANIFEST, 0)
        lost = (Mismatch(MANIFEST, str(error)),)
        return Verification(storage.location, 1, size, (), "none", lost, repair=_repair(storage, None, lost))
    mismatches = [*_file_mismatches(storage, manifest), *_strangers(storage, manifest), *_physics(storage)]
    if not mismatches:
        mismatches += _other_labels(storage, manifest)
    records: tuple[int, ...] = ()
    comparison = "none asked for, so a set that somebody changed and sealed again is not noticed"
    if sample and mismatches:
        comparison = "none, since files differ"
    elif sample and (reason := why_not_again(manifest, sample)):
        comparison = reason
    elif sample:
        records, comparison, different = _simulate_again(storage, sample, executor, workers)
        mismatches += different
    total = sum(facts.bytes for facts in manifest.files.values())
    versions = version_text(manifest.environment), version_text(environment())
    read, found = len(manifest.files) + 1, tuple(mismatches)
    repair = _repair(storage, manifest, found)
    return Verification(storage.location, read, total, records, comparison, found, *versions, repair)


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


def _file_mismatches(storage: Storage, manifest: Inventory) -> Iterator[Mismatch]:
    sizes = storage.sizes()
    for name, facts in sorted(manifest.files.items()):
        if name not in sizes:
            yield Mismatch(name, MISSING)
        elif sizes[name] != facts.bytes:
            yield Mismatch(name, f"{sizes[name]} bytes instead of {facts.bytes}")
        elif problem := _content_problem(storage, name, facts.sha256):
            yield Mismatch(name, problem)


def _content_problem(storage: Storage, name: str, promised: str) -> str:
    try:
        same = hashlib.sha256(storage.get(name)).hexdigest() == promised
    except DatasetError as error:  # a link out of the set, or no regular file
        return str(error)
    return "" if same else "content differs (SHA-256)"


def _strangers(storage: Storage, manifest: Inventory) -> Iterator[Mismatch]:
    strangers = [name for folder in OWN_FOLDERS for name in storage.names(folder) if name not in manifest.files]
    begun = {name for name in strangers if _is_of_extension(storage, name, manifest)}
    begun |= {internals_name(PurePosixPath(name).stem) for name in begun}
    yield from (Mismatch(name, EXTENDING if name in begun else STRANGER) for name in strangers)


def _is_of_extension(storage: Storage, name: str, manifest: Inventory) -> bool:
    """Tell whether a file is a shard of this set with more gearboxes than it was finished with."""
    try:
        about = about_of(unpacked(storage.get(name), ["record_id"]))
        return bool(about["identity"] == manifest.identity and min(about["specimens"]) >= manifest.specimens)
    except (VerificationError, DatasetError, KeyError, TypeError, ValueError):
        return False


def _physics(storage: Storage) -> Iterator[Mismatch]:
    """Check physics.json by its own digest; it may be left out when a set is published."""
    if storage.exists(PHYSICS):
        try:
            unsealed(PHYSICS, storage.get(PHYSICS))
        except VerificationError as error:
            yield Mismatch(PHYSICS, str(error))


def _other_labels(storage: Storage, manifest: Inventory) -> Iterator[Mismatch]:
    """Yield the shards that say something else of their records than the labels, which a stranger may have sealed."""
    dataset = Dataset(storage)
    try:
        labels = dataset.labels()
    except DatasetError as error:
        yield Mismatch(LABELS, str(error))
        return
    first = 0
    for shard in manifest.shards:
        try:
            own = pa.Table.from_batches([dataset.shard_rows(shard, labels.column_names)])
        except (DatasetError, UsageError) as error:
            yield Mismatch(shard.file, str(error))
            continue
        if _bytes(own) != _bytes(labels.slice(first, shard.rows)):
            yield Mismatch(shard.file, f"says something else of its records than {LABELS}")
        first += shard.rows


def _bytes(rows: pa.Table) -> bytes:
    """Return rows as bytes, by which NaN equals itself."""
    return packed(rows.replace_schema_metadata(None))


def _simulate_again(
    storage: Storage, sample: int, executor: Executor | str | None, workers: int | None
) -> tuple[tuple[int, ...], str, list[Mismatch]]:
    dataset = Dataset(storage)
    try:
        design = design_of_set(storage, dataset.inventory)
    except (ConfigError, DatasetError) as error:
        why = f"this version of siggen reads the configuration otherwise ({error})"
        return (), f"none: {why}", [Mismatch("records", f"cannot be simulated again: {why}")]
    ids = _sample(dataset, sample)
    exact = fingerprint(dataset.inventory.environment) == fingerprint(environment())
    tasks = [OneRecord((record_id,)) for record_id in ids]
    mismatches = []
    function = contents.physics().simulation(design)
    chosen = workers_of(executor, 0 if executor is None and workers is None else workers)
    with closing(results(chosen, function, tasks)) as answers:
        for index, result in answers:
            record_id = ids[index]
            stored = dataset.record(record_id)
            internals = dataset.record_internals(record_id) if dataset.internal_columns else None
            problem = result_difference(design, stored, internals, result, exact=exact)
            mismatches += [Mismatch(f"record {record_id}", problem)] if problem else []
    comparison = EXACT if exact else f"{CLOSE} (made with other versions or another CPU family)"
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


def problem_lines(found: Verification) -> list[str]:
    """Return one line per mismatch, and what repairs the set."""
    return [*(f"{one.what}: {one.problem}" for one in found.mismatches), *found.repair]


def _repair(storage: Storage, manifest: Inventory | None, mismatches: Sequence[Mismatch]) -> tuple[str, ...]:
    """Say what is to be removed, and the command that makes again what the set then lacks."""
    spare = [one.what for one in mismatches if one.problem == STRANGER or one.what == PHYSICS]
    begun = [one.what for one in mismatches if one.problem == EXTENDING]
    others = {*spare, *begun}
    damaged = [one for one in mismatches if one.what not in others and not one.what.startswith("record")]
    lines = [f"to repair it: {_removed(storage, spare)}"] if spare else []
    if begun:
        where = quote(storage.location)
        lines.append(
            f"an extension to more gearboxes was begun, or is under way. To end it: siggen generate {where}/{CONFIG} "
            f"--set specimens=N --out {where} with the number it had. To give it up: {_removed(storage, begun)}"
        )
    if damaged and (manifest is None or not why_not_again(manifest, 1)):
        where = quote(storage.location)
        again = f"siggen generate {where}/{CONFIG} --out {where}"
        if manifest is not None and any(one.what == CONFIG for one in damaged):
            again = f"siggen generate CONFIG --set specimens={manifest.specimens} --out {where}"
            lines.append("CONFIG is the file that the set was made of, with all that was changed in it then")
        if manifest is not None and CROISSANT in manifest.files:
            lines.append(
                "the set was published: publishing the set that it is a copy of into a new folder brings all back. "
                "What follows makes records and tables again, but not card, croissant.json and previews"
            )
        # `generate` compares sizes alone of a finished set, and makes what is missing
        there = [one.what for one in damaged if one.problem != MISSING]
        first = f"{_removed(storage, there)}\n" if there else ""
        lines.append(f"to make again what is missing or differs:\n{first}{again}")
    return tuple(lines)


def _removed(storage: Storage, names: Sequence[str]) -> str:
    places = " ".join(quote(f"{storage.location}/{name}") for name in names)
    return f"rm {places}" if isinstance(storage, LocalFolder) else f"remove {places}"
