"""A folder that is there as a whole or not at all."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from siggen.dataset.storage import LocalFolder
from siggen.file_writing import LEFTOVER_SUFFIX, unwritten


@contextmanager
def new_folder(target: Path) -> Iterator[LocalFolder]:
    """Give a hidden folder beside a new or empty one to fill, for one writer; it gets the name when the block ends.

    What a killed process left of it is deleted first, and so is everything when the block fails.

    Raises
    ------
    UsageError
        If the disk takes no more, or the folder cannot get its name.
    """
    real = Path(os.path.realpath(target))
    draft = LocalFolder(real.with_name(f".{real.name}{LEFTOVER_SUFFIX}"))
    with draft.writing():
        try:
            for left in draft.path.iterdir():
                shutil.rmtree(left) if left.is_dir() and not left.is_symlink() else left.unlink()
            yield draft
            draft.path.replace(real)
        except OSError as error:
            raise unwritten(target, error) from error
        finally:
            shutil.rmtree(draft.path, ignore_errors=True)
