"""A finished set against its manifest: every byte, and a sample of records simulated again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

import numpy as np

from siggen.columns.internals import FOLDER as INTERNALS_FOLDER
from siggen.columns.record import signal_column
from siggen.columns.versions import READ_VERSIONS, SIMULATION_VERSION
from siggen.dataset.chunk import Chunk, ChunkResult, ChunkSimulation
from siggen.dataset.environment import environment
from siggen.dataset.id_ranges import in_ranges
from siggen.dataset.manifest import (
    CONFIG,
    DAMAGE_FOLDER,
    INJECTED,
    MANIFEST,
    METADATA_FOLDER,
    PHYSICS,
    RUN,
    read_manifest,
    simulation_version,
)
from siggen.dataset.promises import has_checksums
from siggen.dataset.reading import Dataset, as_internals, as_record
from siggen.dataset.seal import unsealed
from siggen.dataset.sidecar import DATA_FOLDER
from siggen.dataset.sidecar import FOLDER as SIDECAR_FOLDER
from siggen.dataset.storage import Storage, sha256
from siggen.dataset.storage_at import storage_at
from siggen.engines.protocol import Engine
from siggen.engines.registry import engine_of, running
from siggen.errors import ConfigError, DatasetError, VerificationError, counted
from siggen.sets import physics as contents

if TYPE_CHECKING:
    from siggen.config import Config

OWN_FOLDERS = (DATA_FOLDER, INTERNALS_FOLDER, METADATA_FOLDER, DAMAGE_FOLDER, SIDECAR_FOLDER)

EXACT = "bit for bit"
CLOSE = "within one step of the converter"
HASHES_ALONE = "hashes checked"
"""How the comparison begins of a set whose records another version of the simulation made."""

LABEL_TOLERANCE = 1e-6
"""Relative difference that other instructions and versions may make in a label: well above rounding, below meaning."""

PULSE_TOLERANCE_S = 1e-9


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
    has_checksums
        Whether a reader of signals checks every byte as well; sets made before there were checksums have none.
    """

    path: str
    files: int
    bytes: int
    records: tuple[int, ...]
    comparison: str
    mismatches: tuple[Mismatch, ...]
    has_checksums: bool = True


def verify(
    path: Path | str, sample: int = 0, *, workers: int | None = None, engine: Engine | str | None = None
) -> Verification:
    """Compare a finished set with its manifest, and `sample` of its records with a new simulation.

    Records are compared bit for bit if versions and CPU family are those that made them; elsewhere signals may
    differ by one step of the converter. A set that another version of the simulation made, or whose files are of a
    version that this siggen does not read, is compared with its hashes alone, and `comparison` says so.

    Parameters
    ----------
    path : path
    sample : int
        Number of records; which ones follows from the manifest, so a verification can be repeated.
    workers : int, optional
        Worker processes, by default 1; 0 simulates in this process.
    engine : Engine or str, optional
        As for `generate`.

    Raises
    ------
    DatasetError
        If there is no finished set.
    """
    storage = storage_at(path)
    if not storage.exists(MANIFEST):
        read_manifest(storage)  # says what is there instead
    try:
        manifest = unsealed(MANIFEST, storage.get(MANIFEST))
    except VerificationError as error:
        return Verification(storage.location, 1, storage.size(MANIFEST), (), "none", (Mismatch(MANIFEST, str(error)),))
    mismatches = [
        *_file_mismatches(storage, manifest["files"]),
        *_strangers(storage, manifest["files"]),
        *_run(storage),
    ]
    records: tuple[int, ...] = ()
    comparison = "none asked for"
    if sample and mismatches:
        comparison = "none, since files differ"
    elif sample and (reason := why_not_again(manifest, sample)):
        comparison = reason
    elif sample:
        records, comparison, different = _simulate_again(storage, sample, engine, workers)
        mismatches += different
    total = sum(facts["bytes"] for facts in manifest["files"].values())
    count, checked = len(manifest["files"]) + 2, has_checksums(manifest)
    return Verification(storage.location, count, total, records, comparison, tuple(mismatches), checked)


def why_not_again(manifest: Mapping[str, Any], sample: int) -> str:
    """Return why no record of a set can be compared with a new simulation, or an empty string."""
    made_by, schema = simulation_version(manifest), manifest.get("schema_version")
    if INJECTED in manifest.get("files", ()):
        return f"{HASHES_ALONE}: its rows hold recordings, which no simulation makes again"
    head = f"{HASHES_ALONE}; {counted(min(sample, manifest.get('rows', sample)), 'record')} not simulated again: "
    if schema not in READ_VERSIONS:
        return f"{head}its files have schema version {schema}, this siggen reads {' and '.join(READ_VERSIONS)}"
    if made_by != SIMULATION_VERSION:
        return f"{head}made by simulation version {made_by}, this is {SIMULATION_VERSION}"
    return ""


def _file_mismatches(storage: Storage, files: Mapping[str, Mapping[str, Any]]) -> Iterator[Mismatch]:
    sizes = storage.sizes()
    for name, facts in sorted(files.items()):
        if name not in sizes:
            yield Mismatch(name, "missing")
        elif sizes[name] != facts["bytes"]:
            yield Mismatch(name, f"{sizes[name]} bytes instead of {facts['bytes']}")
        elif sha256(storage, name) != facts["sha256"]:
            yield Mismatch(name, "content differs (SHA-256)")


def _strangers(storage: Storage, files: Mapping[str, object]) -> Iterator[Mismatch]:
    for folder in OWN_FOLDERS:
        yield from (Mismatch(name, "not part of the set") for name in storage.names(folder) if name not in files)


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
        config = stored_config(storage, dataset.manifest)
    except (ConfigError, DatasetError) as error:
        why = f"this version of siggen reads the configuration otherwise ({error})"
        return (), f"none: {why}", [Mismatch("records", f"cannot be simulated again: {why}")]
    ids = _sample(dataset, sample)
    here = environment()
    exact = {record_id: _environment(dataset.manifest, record_id) == here for record_id in ids}
    tasks = [Chunk("again", range(record_id, record_id + 1)) for record_id in ids]
    mismatches = []
    function = ChunkSimulation(config, contents.physics().simulate, dataset.internal_columns)
    chosen = engine_of(engine, 1 if engine is None and workers is None else workers)
    with running(chosen, function, tasks) as results:
        for index, result in results:
            record_id, batch = ids[index], result.batch()
            if result.failures:
                problem = f"now fails: {result.failures[0].status} ({result.failures[0].reason})"
            else:
                problem = _difference(config, dataset.record(record_id), as_record(batch), exact=exact[record_id])
                problem = problem or _internal_difference(dataset, record_id, result, exact=exact[record_id])
            mismatches += [Mismatch(f"record {record_id}", problem)] if problem else []
    comparison = EXACT if all(exact.values()) else f"{CLOSE} (made with other versions or another CPU family)"
    return tuple(ids), comparison, sorted(mismatches, key=lambda mismatch: mismatch.what)


def stored_config(storage: Storage, manifest: Mapping[str, Any]) -> Config:
    """Return the set's configuration; its identity must be the one that this version computes, too.

    Raises
    ------
    ConfigError, DatasetError
        If this version reads it otherwise.
    """
    from siggen.config import STORED_NUMBERS, parse, parse_yaml

    parsed = parse(parse_yaml(storage.get(CONFIG).decode(), CONFIG, STORED_NUMBERS))
    if parsed.config is None:
        raise ConfigError(parsed.problems, CONFIG)
    if parsed.config.identity != manifest["identity"]:
        raise DatasetError("its identity differs")
    return parsed.config


def _sample(dataset: Dataset, count: int) -> list[int]:
    ids = sorted(dataset.labels(columns=["record_id"])["record_id"].to_pylist())
    return sorted(Random(dataset.manifest["identity"]).sample(ids, min(count, len(ids))))


def _environment(manifest: Mapping[str, Any], record_id: int) -> Mapping[str, str] | None:
    for shard in manifest["shards"]:
        if in_ranges(record_id, shard["records"]):
            found: Mapping[str, str] = manifest["environments"][shard["environment"]]
            return found
    return None


def _difference(config: Config, stored: Mapping[str, Any], again: Mapping[str, Any], *, exact: bool) -> str:
    """Return in what two versions of a record differ, or an empty string."""
    steps = {} if exact else _steps_m_s2(config)
    for name, before in stored.items():
        now = again[name]
        if isinstance(before, np.ndarray):
            tolerance = steps.get(name, 0.0 if exact else PULSE_TOLERANCE_S)
            if before.shape != now.shape:
                return f"{name} has {counted(len(now), 'value')} instead of {len(before)}"
            largest = float(np.max(np.abs(before.astype(float) - now), initial=0.0))
            if largest > tolerance or (exact and before.tobytes() != now.tobytes()):
                return f"{name} differs by up to {largest:.3g} (allowed {tolerance:.3g})"
        elif not _same_label(before, now, exact=exact):
            return f"{name} is {now} instead of {before}"
    return ""


def _internal_difference(dataset: Dataset, record_id: int, result: ChunkResult, *, exact: bool) -> str:
    """Return in which internal quantity two versions of a record differ, or an empty string."""
    batch = result.internals_batch()
    stored = dataset.record_internals(record_id) if dataset.internal_columns else None
    again = as_internals(batch) if batch is not None and batch.num_rows else None
    if stored is None or again is None:
        return "" if stored is again else "its internal quantities are stored but not asked for, or missing"
    for name, now in again.items():
        before, after = stored[name].astype(float), now.astype(float)
        apart = np.isnan(after)  # pairs that do not touch
        if (np.isnan(before) != apart).any():
            return f"internal quantity {name} differs in where it is NaN"
        largest = float(np.abs(before - after)[~apart].max(initial=0.0))
        tolerance = 0.0 if exact else LABEL_TOLERANCE * float(np.abs(after[~apart]).max(initial=0.0))
        if largest > tolerance or (exact and stored[name].tobytes() != now.tobytes()):
            return f"internal quantity {name} differs by up to {largest:.3g} (allowed {tolerance:.3g})"
    return ""


def _same_label(before: object, now: object, *, exact: bool) -> bool:
    if exact or not isinstance(before, float) or not isinstance(now, float):
        return before == now
    return before == now or abs(before - now) <= LABEL_TOLERANCE * max(1.0, abs(before))


def _steps_m_s2(config: Config) -> dict[str, float]:
    """Return the converter's step of every signal column; without one, the rounding of float32 at full range."""
    from siggen.sensing.measurement import power_of_two_from

    steps: dict[str, float] = {}
    for sensor in config.sensors:
        bits = 24 if sensor.bits is None else sensor.bits
        step = power_of_two_from(2.0 * sensor.range_m_s2 / 2.0**bits)
        steps |= {signal_column(f"{sensor.name}_{axis}"): step for axis in sensor.axes}
    return steps


def problem_lines(mismatches: Sequence[Mismatch]) -> list[str]:
    """Return one line per mismatch."""
    return [f"{mismatch.what}: {mismatch.problem}" for mismatch in mismatches]
