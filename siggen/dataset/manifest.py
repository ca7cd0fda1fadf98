"""manifest.json, written last: what a finished set is; `shard_index` has its shards."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path, PurePath
from typing import Any

from siggen.columns.versions import SCHEMA_VERSION, SIMULATION_VERSION
from siggen.dataset.gate import manifest_facts
from siggen.dataset.inventory import Inventory
from siggen.dataset.shard import FileFacts
from siggen.dataset.shard_index import write_index
from siggen.dataset.sidecar import Sidecar
from siggen.dataset.storage import Storage, sha256
from siggen.errors import DatasetError, VerificationError
from siggen.keys.problems import nearest

MANIFEST = "manifest.json"
CONFIG = "config.yaml"
CARD = "README.md"
RUN = "run.json"
PHYSICS = "physics.json"
"""What `siggen verify --physics` found last; beside the set, in no manifest."""
INJECTED = "injected.json"
"""In a set of recordings with injected damage, as `siggen-diagnostics calibrate --inject` writes it."""
BLIND = "blind.json"
"""In a set without what tells its states, as `siggen-diagnostics bench make` writes it."""
METADATA_FOLDER = "metadata"
DAMAGE_FOLDER = "damage"
LIFE_FOLDER = "life"
SPLITS = ("train", "validation", "test")


def build_manifest(
    storage: Storage,
    facts: Mapping[str, Any],
    sidecars: Sequence[Sidecar],
    tables: Sequence[FileFacts],
    written: Sequence[str],
) -> dict[str, Any]:
    """Write the index of a set whose other files are all stored, and return its manifest.

    Parameters
    ----------
    storage : Storage
    facts : mapping
        What the configuration says about the set: name, identity, channels, ...
    sidecars : sequence of Sidecar
        All shards, by split and number; their data files were hashed when they were committed or taken over.
    tables : sequence of FileFacts
        The tables of labels, of damage and of lives.
    written : sequence of str
        Names of all other files but those of the shards; hashed here.
    """
    makers = [json.dumps(dict(sidecar.environment), sort_keys=True) for sidecar in sidecars]
    environments = sorted(set(makers))
    own = write_index(storage, sidecars, [environments.index(maker) for maker in makers])
    files = {}
    for table in (*own, *tables):
        files[table.name] = {
            "bytes": table.bytes,
            "sha256": table.sha256,
            "crc32_per_64_kib": table.crc32_per_64_kib,
        }
    for name in written:
        files[name] = {"bytes": storage.size(name), "sha256": sha256(storage, name)}
    return {
        "format": "siggen data set",
        "schema_version": SCHEMA_VERSION,
        "simulation_version": SIMULATION_VERSION,
        **facts,
        "splits": _splits(sidecars),
        "rows": sum(sidecar.data.rows for sidecar in sidecars),
        "failures": [asdict(failure) for sidecar in sidecars for failure in sidecar.failures],
        "environments": [json.loads(text) for text in environments],
        "files": files,
    }


def _splits(sidecars: Sequence[Sidecar]) -> dict[str, dict[str, Any]]:
    return {
        split: _split([sidecar for sidecar in sidecars if sidecar.split == split])
        for split in SPLITS
        if any(sidecar.split == split for sidecar in sidecars)
    }


def _split(sidecars: Sequence[Sidecar]) -> dict[str, Any]:
    states: dict[str, int] = {}
    for sidecar in sidecars:
        for state, rows in sidecar.rows_per_state.items():
            states[state] = states.get(state, 0) + rows
    return {
        "specimens": sum(last - first + 1 for sidecar in sidecars for first, last in sidecar.specimens),
        "rows": sum(sidecar.data.rows for sidecar in sidecars),
        "failed": sum(len(sidecar.failures) for sidecar in sidecars),
        "states": states,
        "shards": len(sidecars),
        "bytes": sum(sidecar.data.bytes for sidecar in sidecars),
    }


def read_manifest(storage: Storage) -> Inventory:
    """Return what the manifest of a finished set says.

    Raises
    ------
    DatasetError
        If there is no set, only part of one, a damaged manifest, or one of another schema version.
    """
    if not storage.exists(MANIFEST):
        raise DatasetError(_why_no_manifest(storage))
    try:
        return manifest_facts(MANIFEST, storage.get(MANIFEST))
    except DatasetError as error:
        raise DatasetError(f"{storage.location}/{error}") from error
    except VerificationError as error:
        raise DatasetError(
            f"{storage.location}: {error}; `siggen generate` with the set's config.yaml makes it again from its shards"
        ) from error


def _nearest_folder(path: PurePath) -> str:
    """Return which folder may be meant: the one next in name to the first part of a path that is not there."""
    try:
        if not isinstance(path, Path) or path.is_dir():
            return ""
        absent = path
        while not absent.parent.is_dir():
            absent = absent.parent
        return nearest(absent.name, [one.name for one in absent.parent.iterdir() if one.is_dir()])
    except OSError:
        return ""


def _why_no_manifest(storage: Storage) -> str:
    where = storage.location
    if not storage.names():
        return f"{where}: there is no data set here (no such folder, or an empty one){_nearest_folder(storage.path)}"
    if not storage.exists(CONFIG):
        return f"{where}: not a siggen data set (it has neither {MANIFEST} nor {CONFIG})"
    return (
        f"{where}: the data set is not finished (no {MANIFEST}). The same command that began it completes it: "
        f"siggen generate {where}/{CONFIG} --out {where}; parts of a set are put together by `siggen merge`"
    )
