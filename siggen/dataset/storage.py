"""Where a set's files live: the one place that touches files."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from io import BytesIO
from pathlib import Path, PurePath
from shutil import copyfileobj
from typing import IO, Protocol

from siggen.dataset.object_name import check_below
from siggen.errors import DatasetError
from siggen.file_writing import LEFTOVER_SUFFIX, UNWRITABLE, drafted, is_of_dead_process

MAKE_ATTEMPTS = 5
HOW_TO_GO_ON = (
    "`siggen verify` finds all damaged files of a set; delete them, and `siggen generate` with the set's config.yaml "
    "makes them again"
)


class Storage(Protocol):
    """Objects by name ('data/train-00000.parquet'), written and read as a whole: one is there as a whole or not."""

    @property
    def path(self) -> PurePath:
        """Where the objects are; a Path of this machine, or one that is none of it (`ObjectPath`)."""

    @property
    def location(self) -> str:
        """Where the objects are, as a user writes it."""

    def put(self, name: str, content: bytes | IO[bytes]) -> None:
        """Store an object, or what is left of an open file, replacing an older one in a single step."""

    def get(self, name: str, size: int | None = None) -> bytes:
        """Return the whole object; one of another than the promised size is refused before it is read."""

    def exists(self, name: str) -> bool:
        """Tell whether the object is there."""

    def sizes(self, folder: str = "") -> dict[str, int]:
        """Return name -> bytes of all objects below a folder, by name, without leftovers."""

    def names(self, folder: str = "") -> list[str]:
        """Return the sorted names of all objects below a folder, without leftovers."""

    def delete_leftovers(self, *, of_dead: bool = False) -> list[str]:
        """Delete files that a killed process left half written, and return their names.

        With `of_dead` only those of processes that are known to be gone: others may write beside this one.
        """

    def writing(self, *, beside_others: bool = False) -> AbstractContextManager[None]:
        """Return a guard that says when another process of this machine writes the set, unless both may."""


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

    def put(self, name: str, content: bytes | IO[bytes]) -> None:
        """Write the content to a hidden file, then rename it: a reader never sees half of it."""
        target = self._file(name)
        self._check_links(target.parent)
        try:
            _make(target.parent)
            is_taken = target.is_dir() and not target.is_symlink()
        except (FileExistsError, NotADirectoryError):
            is_taken = True
        if is_taken:
            raise DatasetError(f"{target}: a folder stands where a file belongs, or a file in its way; remove it")
        with drafted(target) as draft, draft.open("wb") as file:
            copyfileobj(BytesIO(content) if isinstance(content, bytes) else content, file)

    def get(self, name: str, size: int | None = None) -> bytes:
        """Return the file's content.

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
            return path.read_bytes()
        except FileNotFoundError as error:
            raise DatasetError(f"{path} is missing; generating the same set again restores it") from error
        except OSError as error:
            raise DatasetError(f"{path} cannot be read ({error.strerror})") from error

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

    def delete_leftovers(self, *, of_dead: bool = False) -> list[str]:
        """Delete half-written files, all of them only while nobody else writes."""
        parts = sorted(
            path
            for path in self.path.rglob(f".*{LEFTOVER_SUFFIX}")
            if (path.is_symlink() or not path.is_dir()) and (not of_dead or is_of_dead_process(path.name))
        )
        for part in parts:
            part.unlink(missing_ok=True)
        return [part.relative_to(self.path).as_posix() for part in parts]

    @contextmanager
    def writing(self, *, beside_others: bool = False) -> Iterator[None]:
        """Hold the folder for one writer, or for parts; the lock dies with the process: nothing has to be cleaned up.

        Raises
        ------
        DatasetError
            If another process is writing the folder, the path is a file, or the disk takes no more.
        """
        if self.path.exists() and not self.path.is_dir():
            raise DatasetError(f"{self.path} is a file; a data set is a folder: name another path")
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            lock = _lock(self.path, shared=beside_others)
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


def _lock(folder: Path, *, shared: bool) -> int | None:
    """Lock a folder (not a file in it, which a crash would leave behind); None where folders cannot be locked."""
    try:
        import fcntl
    except ImportError:  # not a POSIX system
        return None
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        raise DatasetError(
            f"{folder} is being written by another siggen process; wait for it or name another"
        ) from None
    except OSError:  # file systems without locks: go on without one
        pass
    return descriptor
