"""What the manifest of a finished set promises of its files, as a reader checks it: sizes, hashes, checksums."""

from __future__ import annotations

import hashlib

from siggen.dataset.gate import sidecar_facts
from siggen.dataset.inventory import Inventory, PromisedFile
from siggen.dataset.object_name import sidecar_name
from siggen.dataset.storage import Storage
from siggen.errors import DatasetError, VerificationError


class Promises:
    """The files of a set: the manifest holds the checksums of the tables, each sidecar those of its shard.

    Parameters
    ----------
    storage : Storage
    inventory : Inventory
    """

    def __init__(self, storage: Storage, inventory: Inventory) -> None:
        self._storage = storage
        self._files = inventory.files
        self._owners = {name: one.shard for one in inventory.shards for name in (one.file, one.internals) if name}
        self._of_shard: dict[str, dict[str, str]] = {}

    def check_sizes(self) -> None:
        """Compare the size of every file that is there; a missing one is named when it is read.

        Raises
        ------
        DatasetError
            Naming the first file of another size.
        """
        sizes = self._storage.sizes()
        for name, facts in self._files.items():
            if name in sizes and sizes[name] != facts.bytes:
                raise self._broken(name, f"it has {sizes[name]} bytes instead of {facts.bytes}")

    def content(self, name: str) -> bytes:
        """Return a small file whole.

        Raises
        ------
        DatasetError
            If it is missing or its hash is another one.
        """
        content = self._storage.get(name)
        if hashlib.sha256(content).hexdigest() != self._promised(name).sha256:
            raise self._broken(name, "SHA-256 differs")
        return content

    def crc32(self, name: str) -> str:
        """Return the checksums of a file's blocks.

        Raises
        ------
        DatasetError
            If its sidecar is missing or not what the manifest promises, or nothing promises the blocks.
        """
        promised = self._promised(name)
        if promised.crc32_per_64_kib is not None:
            return promised.crc32_per_64_kib
        if name not in self._owners:
            raise self._broken(name, "it has no checksums")
        return self._of_its_shard(name)

    def _promised(self, name: str) -> PromisedFile:
        if name not in self._files:
            raise self._broken(name, "the manifest does not name it")
        return self._files[name]

    def _of_its_shard(self, name: str) -> str:
        shard = self._owners[name]
        if shard not in self._of_shard:
            sidecar = sidecar_name(shard)
            try:
                facts = sidecar_facts(sidecar, self.content(sidecar))
            except VerificationError as error:
                raise self._broken(sidecar, str(error)) from error
            tables = (facts.data, facts.internals) if facts.internals else (facts.data,)
            self._of_shard[shard] = {table.name: table.crc32_per_64_kib for table in tables}
        if name not in self._of_shard[shard]:
            raise self._broken(name, "the sidecar of its shard does not name it")
        return self._of_shard[shard][name]

    def _broken(self, name: str, why: str) -> DatasetError:
        where = self._storage.location
        return DatasetError(
            f"{where}/{name} is not the file that the manifest promises ({why}); `siggen verify {where}` finds all "
            "damaged files; delete them, and `siggen generate` with the set's config.yaml makes them again"
        )
