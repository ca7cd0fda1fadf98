"""A set in an object store that speaks S3, through pyarrow: whole objects, each there as a whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from io import BytesIO
from shutil import copyfileobj
from typing import IO, Any

from siggen.dataset.object_path import ObjectPath
from siggen.errors import DatasetError, UsageError
from siggen.file_writing import LEFTOVER_SUFFIX

ATTEMPTS = 6
CONNECT_S, REQUEST_S = 10.0, 60.0
PART_BYTES = 16 << 20
"""Of a file, at a time."""
HINTS = {
    "NO_SUCH_BUCKET": "there is no such bucket; make it first, siggen makes none",
    "ACCESS_DENIED": "these credentials may not",
    "INVALID_ACCESS_KEY_ID": "AWS_ACCESS_KEY_ID is not one of this server",
    "SIGNATURE_DOES_NOT_MATCH": "AWS_SECRET_ACCESS_KEY does not belong to AWS_ACCESS_KEY_ID",
    "EXPIRED_TOKEN": "the credentials have expired",
    "curlCode: 7": "nobody answers at its address; see AWS_ENDPOINT_URL",
}
"""What the words of an error say -> what to do."""


class ObjectStore:
    """The objects below s3://bucket/key.

    There is no lock: two writers of one set write the same bytes, and an upload is whole or absent.

    Parameters
    ----------
    path : ObjectPath
    """

    def __init__(self, path: ObjectPath) -> None:
        self.path = path

    @property
    def location(self) -> str:
        """The place as the user wrote it."""
        return str(self.path)

    def put(self, name: str, content: bytes | IO[bytes]) -> None:
        """Store an object, or what is left of an open file."""
        with self._in_words(name, "written"), _file_system().open_output_stream(self._place(name)) as stream:
            copyfileobj(BytesIO(content) if isinstance(content, bytes) else content, stream, PART_BYTES)

    def get(self, name: str, size: int | None = None) -> bytes:
        """Return the whole object.

        Raises
        ------
        DatasetError
            If it is missing, has another size than the promised one, or cannot be reached.
        """
        with self._in_words(name, "read"):
            try:
                with _file_system().open_input_file(self._place(name)) as file:
                    if size not in (None, found := file.size()):
                        raise DatasetError(f"{self.path / name} has {found} bytes instead of {size}")
                    return bytes(file.read())
            except FileNotFoundError as error:
                raise DatasetError(
                    f"{self.path / name} is missing; generating the same set again restores it"
                ) from error

    def exists(self, name: str) -> bool:
        """Tell whether the object is there."""
        with self._in_words(name, "read"):
            return bool(_file_system().get_file_info(self._place(name)).is_file)

    def sizes(self, folder: str = "") -> dict[str, int]:
        """Return name -> bytes of all objects below a folder, by name, without leftovers."""
        from pyarrow.fs import FileSelector

        root = self._place("")
        selector = FileSelector(f"{root}{folder}".rstrip("/"), recursive=True, allow_not_found=True)
        with self._in_words(folder, "listed"):
            listed = [one for one in _file_system().get_file_info(selector) if one.is_file]
        found = {one.path.removeprefix(root): int(one.size) for one in listed}
        return {name: found[name] for name in sorted(found) if not name.endswith(LEFTOVER_SUFFIX)}

    def names(self, folder: str = "") -> list[str]:
        """Return the sorted names of all objects below a folder, without leftovers."""
        return list(self.sizes(folder))

    def delete_leftovers(self, *, of_dead: bool = False) -> list[str]:  # noqa: ARG002 - as of every storage
        """Return nothing: an upload that breaks off leaves nothing."""
        return []

    @contextmanager
    def writing(self, *, beside_others: bool = False) -> Iterator[None]:  # noqa: ARG002 - as of every storage
        """Let everybody write."""
        yield

    def _place(self, name: str) -> str:
        return f"{self.path.bucket}/{self.path.key}/{name}"

    @contextmanager
    def _in_words(self, name: str, done: str) -> Iterator[None]:
        """Turn errors of the connection and of the server into words.

        Raises
        ------
        DatasetError
            Naming the object, what was to be done with it, and why it could not be.
        """
        try:
            yield
        except OSError as error:
            said = " ".join(str(error).split())
            why = next((hint for words, hint in HINTS.items() if words in said), said)
            raise DatasetError(
                f"{self.path / name} cannot be {done}: {why}; finished shards stay, and the same command continues "
                "once that is mended"
            ) from error


def _file_system() -> Any:
    """Return the file system of this process by what its environment says: AWS_* and ~/.aws."""
    return _made(os.getpid(), tuple(sorted(item for item in os.environ.items() if item[0].startswith("AWS_"))))


@cache
def _made(process: int, variables: tuple[tuple[str, str], ...]) -> Any:  # noqa: ARG001 - they tell file systems apart
    try:
        from pyarrow.fs import AwsStandardS3RetryStrategy, S3FileSystem
    except ImportError as error:
        raise UsageError("s3:// needs a build of pyarrow with S3, such as that of the package index") from error

    own = dict(variables)
    attempts = int(own.get("AWS_MAX_ATTEMPTS", ATTEMPTS))
    region = own.get("AWS_REGION") or own.get("AWS_DEFAULT_REGION")
    return S3FileSystem(
        endpoint_override=own.get("AWS_ENDPOINT_URL"),
        connect_timeout=CONNECT_S,
        request_timeout=REQUEST_S,
        retry_strategy=AwsStandardS3RetryStrategy(max_attempts=attempts),
        background_writes=False,
        **({"region": region} if region else {}),
    )
