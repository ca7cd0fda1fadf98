"""A set in an object store that speaks S3: one PUT per object, which is there as a whole or not at all."""

from __future__ import annotations

import hashlib
import os
import secrets
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO, cast

from siggen.dataset.object_file import ObjectFile
from siggen.dataset.object_path import ObjectPath
from siggen.dataset.s3_client import error_code, in_words, s3_client
from siggen.dataset.writer_lock import ABSENT, WriterLock
from siggen.errors import DatasetError
from siggen.file_writing import LEFTOVER_SUFFIX

LOCK = f".writer{LEFTOVER_SUFFIX}"
LARGEST_PUT_BYTES = 5 * 1024**3
"""S3 takes no more in one PUT; shards are 50 times smaller."""

PAGE_OBJECTS = 1000
"""Of one answer to a listing, the most that S3 gives."""

BODY_ATTEMPTS = 4
"""An answer that breaks off in the middle is asked for again; botocore repeats only what fails before."""


class ObjectStore:
    """The objects below s3://bucket/key.

    Parameters
    ----------
    path : ObjectPath

    Raises
    ------
    UsageError
        If boto3 is not installed.
    """

    def __init__(self, path: ObjectPath) -> None:
        self.path = path
        self._of_process: tuple[int, Any] = (os.getpid(), s3_client())
        self._lock: WriterLock | None = None

    def __reduce__(self) -> tuple[type[ObjectStore], tuple[ObjectPath]]:
        return ObjectStore, (self.path,)

    @property
    def location(self) -> str:
        """The place as the user wrote it."""
        return str(self.path)

    def put(self, name: str, content: bytes) -> None:
        """Store an object in one request."""
        with self._writing(name):
            self._client.put_object(**self._place(name), Body=content)

    @contextmanager
    def draft(self, name: str) -> Iterator[Path]:
        """Yield a path in the folder for temporary files (TMPDIR); it is sent in one request when the block ends."""
        part = Path(tempfile.gettempdir()) / f"{self._stem}{secrets.token_hex(8)}{LEFTOVER_SUFFIX}"
        try:
            yield part
            if part.stat().st_size > LARGEST_PUT_BYTES:
                raise DatasetError(f"{self.path / name} would have {part.stat().st_size} bytes; S3 takes 5 GiB at once")
            with self._writing(name), part.open("rb") as file:
                self._client.put_object(**self._place(name), Body=file)
        finally:
            part.unlink(missing_ok=True)

    def get(self, name: str) -> bytes:
        """Return the whole object.

        Raises
        ------
        DatasetError
            If it is missing or cannot be reached.
        """
        return self._fetch(name, None)

    def open(self, name: str, size: int | None = None) -> BinaryIO:
        """Open the object for reading; pieces are fetched as they are asked for, its size only if it is not promised.

        Raises
        ------
        DatasetError
            If it is missing or cannot be reached.
        """
        size = self.size(name) if size is None else size
        return cast("BinaryIO", ObjectFile(size, lambda first, end: self._fetch(name, (first, end))))

    def size(self, name: str) -> int:
        """Return the object's size in bytes."""
        size = self._size(name)
        if size is None:
            raise self._missing(name)
        return size

    def exists(self, name: str) -> bool:
        """Tell whether the object is there."""
        return self._size(name) is not None

    def sizes(self, folder: str = "") -> dict[str, int]:
        """Return name -> bytes of all objects below a folder, without leftovers; one request per 1000 objects."""
        root = f"{self.path.key}/"
        below = root + (f"{folder}/" if folder else "")
        with in_words(self.location, "listed"):
            pages = self._client.get_paginator("list_objects_v2").paginate(
                Bucket=self.path.bucket, Prefix=below, PaginationConfig={"PageSize": PAGE_OBJECTS}
            )
            listed = [one for page in pages for one in page.get("Contents", ())]
        found = {one["Key"].removeprefix(root): int(one["Size"]) for one in listed}
        # consoles make empty objects that end in a slash and stand for folders
        return {name: found[name] for name in sorted(found) if not name.endswith((LEFTOVER_SUFFIX, "/"))}

    def names(self, folder: str = "") -> list[str]:
        """Return the sorted names of all objects below a folder, without leftovers."""
        return list(self.sizes(folder))

    def delete(self, name: str) -> None:
        """Delete the object, if it is there."""
        with self._writing(name):
            self._client.delete_object(**self._place(name))

    def delete_below(self, folder: str) -> None:
        """Delete all objects below a folder; one request per 1000 of them."""
        names = self.names(folder)
        for start in range(0, len(names), PAGE_OBJECTS):
            keys = [{"Key": self._place(name)["Key"]} for name in names[start : start + PAGE_OBJECTS]]
            with self._writing(folder):
                self._client.delete_objects(Bucket=self.path.bucket, Delete={"Objects": keys, "Quiet": True})

    def delete_leftovers(self) -> list[str]:
        """Delete what a killed process of this machine left of this set among the temporary files.

        The store itself has no leftovers: an upload that breaks off leaves nothing there.
        """
        parts = sorted(Path(tempfile.gettempdir()).glob(f"{self._stem}*{LEFTOVER_SUFFIX}"))
        for part in parts:
            part.unlink(missing_ok=True)
        return [part.name for part in parts]

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Hold the set for one writer; see `writer_lock`.

        Raises
        ------
        DatasetError
            If another process is writing it, or the store cannot be reached.
        """
        lock = WriterLock(self._client, self._place(LOCK), self.location)
        lock.acquire()
        self._lock = lock
        try:
            yield
        finally:
            self._lock = None
            lock.release()

    def check_writing(self) -> None:
        """Raise DatasetError if another writer took the lock over; this one was silent for too long."""
        if self._lock is not None:
            self._lock.check()

    @property
    def _client(self) -> Any:
        """The client of this process: connections must not be shared with a forked one."""
        if self._of_process[0] != os.getpid():
            self._of_process = (os.getpid(), s3_client())
        return self._of_process[1]

    @property
    def _stem(self) -> str:
        """What temporary files of this set begin with, whoever writes them."""
        return f"siggen-{hashlib.sha256(self.location.encode()).hexdigest()[:16]}-"

    def _place(self, name: str) -> dict[str, str]:
        return {"Bucket": self.path.bucket, "Key": f"{self.path.key}/{name}"}

    @contextmanager
    def _writing(self, name: str) -> Iterator[None]:
        self.check_writing()
        with in_words(str(self.path / name), "written"):
            yield

    def _size(self, name: str) -> int | None:
        from botocore.exceptions import ClientError

        with in_words(str(self.path / name), "read"):
            try:
                return int(self._client.head_object(**self._place(name))["ContentLength"])
            except ClientError as error:
                if error_code(error) in ABSENT:
                    return None
                raise

    def _fetch(self, name: str, borders: tuple[int, int] | None) -> bytes:
        """Return an object, or its bytes from a place to before another, asked for again if an answer breaks off."""
        from botocore.exceptions import ClientError, HTTPClientError, IncompleteReadError

        asked = {} if borders is None else {"Range": f"bytes={borders[0]}-{borders[1] - 1}"}
        with in_words(str(self.path / name), "read"):
            for attempt in range(BODY_ATTEMPTS):
                try:
                    return bytes(self._client.get_object(**self._place(name), **asked)["Body"].read())
                except ClientError as error:
                    if error_code(error) in ABSENT:
                        raise self._missing(name) from error
                    raise
                except (HTTPClientError, IncompleteReadError):
                    if attempt == BODY_ATTEMPTS - 1:
                        raise
                    time.sleep(0.5 * 2**attempt)
        raise AssertionError("unreachable")

    def _missing(self, name: str) -> DatasetError:
        return DatasetError(f"{self.path / name} is missing; generating the same set again restores it")
