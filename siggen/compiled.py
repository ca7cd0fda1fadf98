"""njit: numba's compiler as this package uses it, with a cache wherever the package may lie.

A function that C code could call by its address costs a wrapper, 13 % of all compilation; nothing here does that. Where
neither the package's folder nor the user's can be written to, numba refuses to cache: then a private folder of the
temporary ones is taken. `NUMBA_CACHE_DIR` goes before all of them.
"""

from __future__ import annotations

import os
import stat
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba

Function = TypeVar("Function", bound=Callable[..., Any])


def njit(**options: Any) -> Callable[[Function], Function]:
    """Return the decorator that compiles a function on its first call; options as of `numba.njit`.

    But inline="always" is done by LLVM. numba itself would copy the untyped tree into each caller, with all that was
    copied into it before: of the loop's compilation that is a third, and code of the same bytes takes more cycles.
    """
    if options.pop("inline", "") == "always":
        options["forceinline"] = True

    def decorated(function: Function) -> Function:
        try:
            return numba.njit(no_cfunc_wrapper=True, **options)(function)
        except RuntimeError:  # no folder for the cache
            folder = private_folder(Path(tempfile.gettempdir()))
            if folder is None:
                return numba.njit(no_cfunc_wrapper=True, **{**options, "cache": False})(function)
            numba.config.CACHE_DIR = str(folder)
            return numba.njit(no_cfunc_wrapper=True, **options)(function)

    return decorated


def private_folder(parent: Path) -> Path | None:
    """Return a folder that nobody else can write to, made if needed; None where there can be none.

    What is cached there is run: a folder that somebody else made is never taken.
    """
    owner = os.getuid() if hasattr(os, "getuid") else 0
    folder = parent / f"siggen-numba-{owner}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()
    except OSError:
        return None
    mine = stat.S_ISDIR(found.st_mode) and getattr(found, "st_uid", owner) == owner
    return folder if mine and (os.name == "nt" or not found.st_mode & 0o077) else None
