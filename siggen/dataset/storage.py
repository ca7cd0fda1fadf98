"""Where a set's files live: the one place that touches files."""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from pathlib import Path, PurePath
from typing import BinaryIO, Protocol

from siggen.dataset.object_name import check_below
from siggen.errors import DatasetError
from siggen.file_writing import LEFTOVER_SUFFIX, UNWRITABLE, drafted

READ_BYTES = 1 << 20
MAKE_ATTEMPTS = 5
HOW_TO_GO_ON = (
    "`siggen verify` finds all damaged files of a set; delete them, and `siggen generate` with the set's config.yaml "
    "makes them again"
)


class Storage(Protocol):
    """Objects by name ('data/train-00000.parquet'); an object is there as a whole or not at all."""

    @property
    def path(self) -> PurePath:
        """Where the objects are; a Path of this machine, or one that is none of it (`ObjectPath`)."""

    @property
    def location(self) -> str:
        """Where the objects are, as a user writes it."""

    def put(self, name: str, content: bytes) -> None:
        """Store an object, replacing an older one in a single step."""

    def draft(self, name: str) -> AbstractContextManager[Path]:
        """Give a local path to fill; the file becomes the object when the block ends without an error."""

    def get(self, name: str) -> bytes:
        """Return the whole object."""

    def open(self, name: str, size: int | None = None) -> BinaryIO:
        """Open an object for reading with seek (what a Parquet reader needs).

        A promised size saves a store one request. Whoever gives it compares what is read with checksums.
        """

    def size(self, name: str) -> int:
        """Return the object's size in bytes."""

    def exists(self, name: str) -> bool:
        """Tell whether the object is there."""

    def sizes(self, folder: str = "") -> dict[str, int]:
        """Return name -> bytes of all objects below a folder, by name, without leftovers."""

    def names(self, folder: str = "") -> list[str]:
        """Return the sorted names of all objects below a folder, without leftovers."""

    def delete(self, name: str) -> None:
        """Delete an object, if it is there."""

    def delete_below(self, folder: str) -> None:
        """Delete all objects below a folder."""

    def delete_leftovers(self) -> list[str]:
        """Delete files that a killed process left half written, and return their names."""

    def writing(self) -> AbstractContextManager[None]:
        """Return a guard that keeps a second writer out.

        Of the set, not of its files: workers of whoever holds it write them, each with a copy of the storage.
        """

    def check_writing(self) -> None:
        """Raise DatasetError if another writer took the set over inside `writing()`."""


def sha256(storage: Storage, name: str) -> str:
    """Return the SHA-256 of an object, read in pieces."""
    with storage.open(name) as file:
        return file_sha256(file)


def file_sha256(file: BinaryIO) -> str:
    """Return the SHA-256 of an open file, read in pieces."""
    digest = hashlib.sha256()
    while piece := file.read(READ_BYTES):
        digest.update(piece)
    return digest.hexdigest()


def copy_object(source: Storage, name: str, target: Storage, promised_sha256: str, *, links: bool = True) -> None:
    """Copy an object into another storage under the same name, if it is the one that is promised.

    With `links`, both names lead to the same bytes afterwards between folders of one file system, where it has hard
    links. Nothing here writes into a file that is there: whoever makes one of them again puts another in its place.

    Raises
    ------
    DatasetError
        If it is missing, or its SHA-256 is another one; then nothing is stored.
    """
    with source.open(name) as file, target.draft(name) as draft:
        if links and isinstance(source, LocalFolder) and source.link(name, draft):
            with draft.open("rb") as linked:
                digest = file_sha256(linked)
        else:
            digest = _copied(file, draft)
        if digest != promised_sha256:
            raise DatasetError(
                f"{source.location}/{name} is not the file that is promised (SHA-256 differs), and was not copied; "
                f"`siggen verify {source.location}` finds all damaged files"
            )


def _copied(file: BinaryIO, draft: Path) -> str:
    """Copy an open file and return its SHA-256."""
    digest = hashlib.sha256()
    with draft.open("wb") as copy:
        while piece := file.read(READ_BYTES):
            digest.update(piece)
            copy.write(piece)
    return digest.hexdigest()


class LocalFolder:
    """A folder on a local file system."""

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)

    @property
    def location(self) -> str:
        """The folder as the user wrote it."""
        return str(self.path)

    def __reduce__(self) -> tuple[type[LocalFolder], tuple[Path]]:
        return LocalFolder, (self.path.absolute(),)  # whoever reads it may work in another folder

    def put(self, name: str, content: bytes) -> None:
        """Write the content to a hidden file, then rename it: a reader never sees half of it."""
        with self.draft(name) as draft:
            draft.write_bytes(content)

    @contextmanager
    def draft(self, name: str) -> Iterator[Path]:
        """Yield a hidden path in the target's folder; flushed to disk and renamed when the block ends."""
        target = self._file(name)
        self._check_links(target.parent)
        try:
            _make(target.parent)
            is_taken = target.is_dir() and not target.is_symlink()
        except (FileExistsError, NotADirectoryError):
            is_taken = True
        if is_taken:
            raise DatasetError(f"{target}: a folder stands where a file belongs, or a file in its way; remove it")
        with drafted(target) as draft:
            yield draft

    def get(self, name: str) -> bytes:
        """Return the file's content."""
        with self.open(name) as file:
            return file.read()

    def open(self, name: str, size: int | None = None) -> BinaryIO:
        """Open the file for reading.

        Raises
        ------
        DatasetError
            If there is no such file, it cannot be read, is no regular file, has another size than the promised one,
            or a link leads out of the folder.
        """
        path = self._file(name)
        self._check_links(path)
        try:
            found = path.stat()
            if not stat.S_ISREG(found.st_mode):  # a pipe would wait for ever, a device give without end
                raise DatasetError(f"{path} is no regular file; a set has no others")
            if size not in (None, found.st_size):
                raise DatasetError(f"{path} has {found.st_size} bytes instead of {size}; {HOW_TO_GO_ON}")
            return path.open("rb")
        except FileNotFoundError as error:
            raise DatasetError(f"{path} is missing; generating the same set again restores it") from error
        except OSError as error:
            raise DatasetError(f"{path} cannot be read ({error.strerror})") from error

    def link(self, name: str, path: Path) -> bool:
        """Give a file a second name, a path outside; False where the file system cannot."""
        try:
            os.link(_real(self._file(name)), path)  # never a link that is there: it may lead elsewhere from the path
        except OSError:
            return False
        return True

    def size(self, name: str) -> int:
        """Return the file's size in bytes."""
        return self._file(name).stat().st_size

    def exists(self, name: str) -> bool:
        """Tell whether the name is a file."""
        return self._file(name).is_file()

    def names(self, folder: str = "") -> list[str]:
        """Return the sorted POSIX names of all files below a folder, without leftovers."""
        return list(self.sizes(folder))

    def sizes(self, folder: str = "") -> dict[str, int]:
        """Return POSIX name -> bytes of all files below a folder, by name, without leftovers."""
        root = self._file(folder) if folder else self.path
        files = (path for path in root.rglob("*") if not path.is_dir() and path.suffix != LEFTOVER_SUFFIX)
        # not followed: a link that leads nowhere is a stranger, too
        found = {path.relative_to(self.path).as_posix(): path.stat().st_size if path.exists() else 0 for path in files}
        return {name: found[name] for name in sorted(found)}

    def delete(self, name: str) -> None:
        """Delete the file if it is there, and its folders that are empty then."""
        file = self._file(name)
        self._check_links(file.parent)
        file.unlink(missing_ok=True)
        for folder in file.parents:
            if folder == self.path:
                return
            try:
                folder.rmdir()
            except OSError:  # another process put something there
                return

    def delete_below(self, folder: str) -> None:
        """Delete all files below a folder, and the folders that are empty then."""
        for name in self.names(folder):
            self.delete(name)

    def delete_leftovers(self) -> list[str]:
        """Delete half-written files; call it only while holding `writing()`."""
        parts = sorted(
            path for path in self.path.rglob(f".*{LEFTOVER_SUFFIX}") if path.is_symlink() or not path.is_dir()
        )
        for part in parts:
            part.unlink(missing_ok=True)
        return [part.relative_to(self.path).as_posix() for part in parts]

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Hold the folder for one writer; the lock dies with the process, so nothing has to be cleaned up.

        Raises
        ------
        DatasetError
            If another process is writing the folder, the path is a file, or the disk takes no more.
        """
        if self.path.exists() and not self.path.is_dir():
            raise DatasetError(f"{self.path} is a file; a data set is a folder: name another path")
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            lock = _lock(self.path)
        except OSError as error:
            raise DatasetError(
                f"{self.path} cannot be written: {error.strerror or error}; name another folder"
            ) from error
        try:
            yield
        except OSError as error:
            if error.errno is None or error.errno not in UNWRITABLE:
                raise
            raise DatasetError(
                f"{self.path} cannot be written any further: {os.strerror(error.errno)}; finished shards stay, and the "
                "same command continues from there once that is mended (or name another folder)"
            ) from error
        finally:
            if lock is not None:
                os.close(lock)

    def check_writing(self) -> None:
        """Do nothing: the lock of a folder ends with its process alone."""

    def _file(self, name: str) -> Path:
        check_below(name, self.location)
        return self.path / name

    def _check_links(self, path: Path) -> None:
        """Refuse a path that a link leads out of the folder: a stranger's set is to show and to change nothing else."""
        steps = [path, *path.parents]
        below = steps[: steps.index(self.path)]
        if any(step.is_symlink() for step in below) and not _real(path).is_relative_to(_real(self.path)):
            raise DatasetError(
                f"{path} leads out of {self.path} by a link; a set has all its files in its own folder: "
                "copy the set with what its links lead to (cp -rL), and read the copy"
            )


def _make(folder: Path) -> None:
    """Make a folder and those above it, which another process may delete, empty as they are, at the same moment."""
    for _ in range(MAKE_ATTEMPTS - 1):
        with suppress(FileNotFoundError):
            folder.mkdir(parents=True, exist_ok=True)
            return
    folder.mkdir(parents=True, exist_ok=True)


def _real(path: Path) -> Path:
    """Return where links lead; a circle of them leads to itself."""
    return Path(os.path.realpath(path))


def _lock(folder: Path) -> int | None:
    """Lock a folder (not a file in it, which a crash would leave behind); None where folders cannot be locked."""
    try:
        import fcntl
    except ImportError:  # not a POSIX system
        return None
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        raise DatasetError(
            f"{folder} is being written by another siggen process; wait for it or name another"
        ) from None
    except OSError:  # file systems without locks: go on without one
        pass
    return descriptor
