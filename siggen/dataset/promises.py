"""What a finished set promises of its files, as a reader checks it: sizes, hashes, checksums of blocks."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Iterator
from contextlib import contextmanager

import pyarrow.parquet as pq

from siggen.dataset.checked_file import CheckedTable, parquet_file
from siggen.dataset.inventory import Inventory, PromisedFile
from siggen.dataset.shard_index import ShardIndex
from siggen.dataset.storage import HOW_TO_GO_ON, Storage
from siggen.errors import DatasetError

MOST_FOOTERS = 256
"""Footers of files that are kept, each about 50 kB: a row of a shard that was read before is one request."""


class Promises:
    """The files of a set: the manifest promises the small ones and the tables, the index those of the shards.

    Parameters
    ----------
    storage : Storage
    inventory : Inventory
    index : ShardIndex
    """

    def __init__(self, storage: Storage, inventory: Inventory, index: ShardIndex) -> None:
        self._storage = storage
        self._files, self._index = inventory.files, index
        self._footers: OrderedDict[str, pq.FileMetaData] = OrderedDict()

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

    @contextmanager
    def table(self, name: str) -> Iterator[CheckedTable]:
        """Open a Parquet file of the set; what makes it unreadable becomes a message that says how to go on.

        Raises
        ------
        DatasetError
            If it is missing, or not what is promised of it.
        """
        promised = self._promised(name)
        if promised.crc32_per_64_kib is None:
            raise self._broken(name, "it has no checksums")
        footer = self._footers.get(name)
        with parquet_file(self._storage, name, promised.crc32_per_64_kib, promised.bytes, footer) as table:
            self._keep(name, table.footer)
            yield table

    def footer(self, name: str) -> pq.FileMetaData:
        """Return the footer of a Parquet file of the set, read once.

        Raises
        ------
        DatasetError
            As of `table`.
        """
        if name not in self._footers:
            with self.table(name) as table:
                return table.footer
        return self._footers[name]

    def _keep(self, name: str, footer: pq.FileMetaData) -> None:
        self._footers[name] = footer
        self._footers.move_to_end(name)
        if len(self._footers) > MOST_FOOTERS:
            self._footers.popitem(last=False)

    def _promised(self, name: str) -> PromisedFile:
        promised = self._files.get(name) or self._index.promised(name)
        if promised is None:
            raise self._broken(name, "neither the manifest nor the index names it")
        return promised

    def _broken(self, name: str, why: str) -> DatasetError:
        return DatasetError(f"{self._storage.location}/{name} is not the promised file ({why}); {HOW_TO_GO_ON}")
