"""The files of a set that must not depend on how it was made, and what is wrong with those of a disturbed one."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from siggen.dataset.storage import Storage
from siggen.file_writing import LEFTOVER_SUFFIX


def set_files(storage: Storage) -> dict[str, bytes]:
    """Return name -> content of all files."""
    return {name: storage.get(name) for name in storage.names()}


def whole_set_problems(folder: Path, found: Mapping[str, bytes], reference: Mapping[str, bytes]) -> list[str]:
    """Return what is lost, added or changed in a finished set, and what was left half written."""
    names = [name for name in sorted(found.keys() | reference.keys()) if found.get(name) != reference.get(name)]
    return names + [path.name for path in folder.rglob(f"*{LEFTOVER_SUFFIX}")]


def committed_shards(found: Mapping[str, bytes]) -> list[str]:
    """Return the shards whose rows are there, which come last: what a killed run leaves whole."""
    return [Path(name).stem for name in found if name.startswith("data/")]


def committed_problems(found: Mapping[str, bytes], reference: Mapping[str, bytes]) -> list[str]:
    """Return the files of committed shards that are not those of an undisturbed set."""
    keys = committed_shards(found)
    names = [name for name in reference if Path(name).stem in keys]
    return [name for name in names if found.get(name) != reference[name]]
