"""The storage at a location: a folder of this machine, or a place in an object store."""

from __future__ import annotations

from pathlib import Path, PurePath

from siggen.dataset.object_path import object_path
from siggen.dataset.object_store import ObjectStore
from siggen.dataset.storage import LocalFolder, Storage


def storage_at(location: PurePath | str) -> Storage:
    """Return the storage at a folder's path, or at s3://bucket/set.

    Raises
    ------
    UsageError
        If the location names no bucket or another kind of store, or the extra `s3` is not installed.
    """
    remote = object_path(location)
    return LocalFolder(Path(location)) if remote is None else ObjectStore(remote)
