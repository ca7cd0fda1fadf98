"""What the manifest of a finished set promises of its files, as a reader checks it: sizes, hashes, checksums."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

from siggen.dataset.seal import unsealed
from siggen.dataset.sidecar import sidecar_name
from siggen.dataset.storage import Storage, sha256
from siggen.errors import DatasetError, VerificationError

CRC = "crc32_per_64_kib"


def has_checksums(manifest: Mapping[str, Any]) -> bool:
    """Tell whether a set's files have checksums of their blocks; tables and shards were given them together."""
    return any(CRC in facts for facts in manifest["files"].values())


class Promises:
    """The files of a set: the manifest holds the checksums of the tables, each sidecar those of its shard.

    Parameters
    ----------
    storage : Storage
    manifest : mapping

    Attributes
    ----------
    has_checksums : bool
    """

    def __init__(self, storage: Storage, manifest: Mapping[str, Any]) -> None:
        self._storage = storage
        self._files: Mapping[str, Mapping[str, Any]] = manifest["files"]
        self._owners: dict[str, str] = {}
        for shard in manifest["shards"]:
            self._owners |= {shard[kind]: shard["shard"] for kind in ("file", "internals") if kind in shard}
        self._of_shard: dict[str, dict[str, str]] = {}
        self._hashed: set[str] = set()
        self.has_checksums = has_checksums(manifest)

    def check_sizes(self) -> None:
        """Compare the size of every file that is there; a missing one is named when it is read.

        Raises
        ------
        DatasetError
            Naming the first file of another size.
        """
        sizes = self._storage.sizes()
        for name, facts in self._files.items():
            if name in sizes and sizes[name] != facts["bytes"]:
                raise self._broken(name, f"it has {sizes[name]} bytes instead of {facts['bytes']}")

    def content(self, name: str) -> bytes:
        """Return a small file whole.

        Raises
        ------
        DatasetError
            If it is missing or its hash is another one.
        """
        content = self._storage.get(name)
        if hashlib.sha256(content).hexdigest() != self._promised(name)["sha256"]:
            raise self._broken(name, "SHA-256 differs")
        return content

    def crc32(self, name: str) -> str | None:
        """Return the checksums of a file's blocks, or None where the set has none.

        A table of a set without checksums is hashed whole instead, once.

        Raises
        ------
        DatasetError
            If the sidecar or the table is missing, or not what the manifest promises.
        """
        promised = self._promised(name)
        if CRC in promised:
            return str(promised[CRC])
        if self.has_checksums and name in self._owners:
            return self._shard_checksums(self._owners[name])[name]
        if name not in self._owners and name not in self._hashed:
            if sha256(self._storage, name) != promised["sha256"]:
                raise self._broken(name, "SHA-256 differs")
            self._hashed.add(name)
        return None

    def _promised(self, name: str) -> Mapping[str, Any]:
        if name not in self._files:
            raise self._broken(name, "the manifest does not name it")
        return self._files[name]

    def _shard_checksums(self, shard: str) -> dict[str, str]:
        if shard not in self._of_shard:
            name = sidecar_name(shard)
            try:
                sidecar = unsealed(name, self.content(name))
            except VerificationError as error:
                raise self._broken(name, str(error)) from error
            tables = [sidecar[kind] for kind in ("data", "internals") if kind in sidecar]
            self._of_shard[shard] = {table["name"]: table[CRC] for table in tables}
        return self._of_shard[shard]

    def _broken(self, name: str, why: str) -> DatasetError:
        where = self._storage.location
        return DatasetError(
            f"{where}/{name} is not the file that the manifest promises ({why}); `siggen verify {where}` finds all "
            "damaged files; delete them, and `siggen generate` with the set's config.yaml makes them again"
        )
