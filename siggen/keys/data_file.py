"""The bytes of a file of numbers that a configuration names: a regular file of a bounded size, whatever the name is."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

LARGEST_BYTES = 1 << 25
"""Of a file: 400,000 numbers, the most of a response, take a third of it as text."""


class DataRefusal(Exception):  # noqa: N818 - becomes a problem of the configuration, never seen outside
    """What was received instead of usable numbers, and what is allowed."""

    def __init__(self, received: str, allowed: str) -> None:
        self.received, self.allowed = received, allowed
        super().__init__(f"{received}; {allowed}")


def named_content(name: str, folder: Path) -> bytes:
    """Return the content of a file that a configuration names.

    Raises
    ------
    DataRefusal
        If it cannot be read.
    """
    try:
        return data_file_bytes(folder / name)
    except OSError as error:
        received = f"'{shortened_path(name)}', which cannot be read ({error.strerror})"
        raise DataRefusal(received, f"allowed: a file in {folder}") from None


def data_file_bytes(path: Path) -> bytes:
    """Return the content of a file.

    Raises
    ------
    OSError
        If it cannot be read, is no regular file (a device may have no end, a pipe no beginning), or is too large;
        `strerror` says which.
    """
    if "\0" in str(path):
        raise OSError(errno.EINVAL, "its name holds a zero byte")
    if not stat.S_ISREG(path.stat().st_mode):
        raise OSError(errno.EINVAL, "it is no regular file")
    with path.open("rb") as file:
        content = file.read(LARGEST_BYTES + 1)
    if len(content) > LARGEST_BYTES:
        raise OSError(errno.EFBIG, f"it has more than {LARGEST_BYTES} bytes")
    return content


def is_file(path: Path) -> bool:
    """Tell whether there is such a file; a name that no file can have is none."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def kind_of_path(path: Path) -> str:
    """Return why a path is no file."""
    try:
        return "is a folder" if path.is_dir() else "there is no such file"
    except (OSError, ValueError) as error:
        return f"no file can have this name ({error.strerror if isinstance(error, OSError) else error})"


def shortened_path(path: str | os.PathLike[str]) -> str:
    """Return a path for a message, its middle left out where it is longer than any file's."""
    text = str(path)
    return text if len(text) <= 255 else f"{text[:60]}...{text[-60:]}"
