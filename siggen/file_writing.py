"""The one way in which a file is written: beside its name, flushed to the disk, renamed.

A killed process cannot delete its draft. So a draft's name tells its process, and the next write of the same file
deletes what a process left that is gone.
"""

from __future__ import annotations

import errno
import hashlib
import os
import re
import secrets
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from siggen.errors import UsageError
from siggen.live_process import is_gone, this_process

LEFTOVER_SUFFIX = ".siggen-part"
"""Ending of files under construction; whatever carries it when nobody writes was left by a killed process."""

UNWRITABLE = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EACCES, errno.EPERM, errno.EIO}
"""What the user of a disk can mend: it is full, at its quota, read-only, not theirs, or broken."""


def write_file(path: Path, content: str | bytes | Callable[[Path], object]) -> None:
    """Write a file and the folders above it; a reader sees the old one or the whole new one, never a part.

    Parameters
    ----------
    path : Path
        A link is followed.
    content : str, bytes or callable
        Text (as UTF-8), bytes, or what fills a draft: it is called with a path beside the file.

    Raises
    ------
    UsageError
        If the disk takes no more, or nothing can be written there; then nothing is left behind.
    """
    target = Path(os.path.realpath(path))
    try:
        if target.exists() and not target.is_file():
            raise UsageError(f"{path} is no regular file; name another one")
        target.parent.mkdir(parents=True, exist_ok=True)
        _delete_leftovers(target)
        with drafted(target) as draft:
            if callable(content):
                content(draft)
            else:
                draft.write_bytes(content.encode() if isinstance(content, str) else content)
    except OSError as error:
        raise unwritten(path, error) from error


def unwritten(path: Path | str, error: OSError) -> UsageError:
    """Return in words why nothing was written, and that nothing is left of it."""
    why = os.strerror(error.errno) if error.errno in UNWRITABLE else error.strerror or error
    return UsageError(
        f"{path} cannot be written: {why}; no part of it is left: mend that, or name another place, and try again"
    )


@contextmanager
def drafted(target: Path) -> Iterator[Path]:
    """Give a hidden path in the target's folder to fill; flushed and renamed when the block ends without an error.

    Errors of the file system stay what they are: of a set, whoever writes it says how to go on.
    """
    machine, pid = _writer()
    draft = target.with_name(f".{target.name}.{machine}-{pid}-{secrets.token_hex(4)}{LEFTOVER_SUFFIX}")
    try:
        yield draft
        _flush(draft)
        draft.replace(target)
        _flush(target.parent)
    finally:
        draft.unlink(missing_ok=True)


def _writer() -> tuple[str, int]:
    """Return a short form of this machine since its start, and the number of this process."""
    here = this_process()
    return hashlib.sha256(f"{here['host']} {here['boot']}".encode()).hexdigest()[:8], here["pid"]


def is_of_dead_process(name: str) -> bool:
    """Tell whether a draft is of a process of this machine that is gone; those of other machines are not known."""
    machine, _ = _writer()
    form = re.fullmatch(rf"\..*\.{machine}-(\d+)-[0-9a-f]{{8}}{re.escape(LEFTOVER_SUFFIX)}", name)
    return form is not None and is_gone({**this_process(), "pid": form[1]})


def _delete_leftovers(target: Path) -> None:
    """Delete drafts of a file whose processes are gone."""
    for path in target.parent.iterdir():
        if path.name.startswith(f".{target.name}.") and is_of_dead_process(path.name):
            path.unlink(missing_ok=True)


def _flush(path: Path) -> None:
    """Wait until a file's content, or a folder's entries, are on the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
