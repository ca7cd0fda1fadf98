"""njit, entry: numba's compiler as this package uses it, with a cache wherever the package may lie.

What Python calls needs a wrapper that takes its objects apart, what C code calls another one. Together they are a
quarter of all compilation. So only an `entry` has the first, and nothing the second.

Where neither the package's folder nor the user's can be written to, numba refuses to cache: then a private folder of
the temporary ones is taken. `NUMBA_CACHE_DIR` goes before all of them.

numba takes a function from its cache as long as the file of that function is the same, whatever became of those that it
calls. Then a machine that has run an older version would go on with parts of it. So what is cached is of use for the
same sources of all compiled code alone.
"""

# mypy: disallow-untyped-calls=False

from __future__ import annotations

import os
import stat
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba
from numba.core import types

from siggen.sources import sources_digest

Function = TypeVar("Function", bound=Callable[..., Any])
WITH_COMPILED_CODE = (
    "*.py", "lanes/*.py", "gears/*.py", "drivetrain/*.py", "damage/*.py", "mesh/*.py", "motion/*.py",
    "life/continuation.py", "record/*.py",
    "sensing/**/*.py",
)  # fmt: skip
"""Files that compiled code may come from, constants included."""


def entry(**options: Any) -> Callable[[Function], Function]:
    """Return the decorator of compiled functions that Python calls, be it a test; options as of `njit`."""
    return _decorator(options)


def njit(**options: Any) -> Callable[[Function], Function]:
    """Return the decorator of functions that compiled code alone calls; options as of `numba.njit`.

    But inline="always" is done by LLVM. numba itself would copy the untyped tree into each caller, with all that was
    copied into it before: of the loop's compilation that is a third, and code of the same bytes takes more cycles. So a
    function keeps its own error_model and fastmath where it is inlined; a caller's do not reach into it.

    Called from Python, they raise a TypeError.
    """
    decorated = _decorator({**options, "no_cpython_wrapper": True})
    return lambda function: _kept_from_python(decorated(function))


def _kept_from_python(function: Any) -> Any:
    """Let Python see no version of a compiled function: it would jump to where there is nothing."""

    def refuse(*_: object, **__: object) -> None:
        name = f"{function.py_func.__module__}.{function.py_func.__qualname__}"
        raise TypeError(f"{name} is compiled for compiled code alone; decorate it with @entry to call it from Python")

    def keep(result: Any) -> None:
        function.overloads[tuple(result.signature.args)] = result

    function.add_overload, function._compile_for_args = keep, refuse
    return function


def _decorator(options: dict[str, Any]) -> Callable[[Function], Function]:
    if options.pop("inline", "") == "always":
        options["forceinline"] = True

    def compiled(function: Function, **other: Any) -> Function:
        made: Function = numba.njit(no_cfunc_wrapper=True, **{**options, **other})(function)
        _take_numbers_alike(made)
        return _of_these_sources(made)

    def decorated(function: Function) -> Function:
        try:
            return compiled(function)
        except RuntimeError:  # no folder for the cache
            folder = private_folder(Path(tempfile.gettempdir()))
            if folder is None:
                return compiled(function, cache=False)
            numba.config.CACHE_DIR = str(folder)
            return compiled(function)

    return decorated


def _take_numbers_alike(function: Any) -> None:
    """Let a compiled function take a number that stands in a call as any other: one version does for all of them.

    numba would make one for each; LLVM knows the number anyway where it puts the function into its caller.
    """
    template, plain = function.get_call_template, types.unliteral

    def of_any(args: tuple[Any, ...], kws: dict[str, Any]) -> Any:
        return template(tuple(map(plain, args)), {name: plain(kind) for name, kind in kws.items()})

    function.get_call_template = of_any


def is_cached(function: Any) -> bool:
    """Return whether the cache holds a compiled function, made of these sources."""
    file = _cache_file(function)
    return bool(getattr(file, "_load_index", dict)())


def _of_these_sources(function: Function) -> Function:
    """Let the cache of a compiled function know the sources of all: an index of another version is not even read."""
    file = _cache_file(function)
    if hasattr(file, "_version"):  # numba's own; where a later numba has it no more, it caches as it does by itself
        file._version = f"{file._version}, sources {sources_digest(WITH_COMPILED_CODE)}"
    return function


def _cache_file(function: Any) -> Any:
    """Return numba's file of a function's cache; None for one that is not cached."""
    return getattr(getattr(function, "_cache", None), "_cache_file", None)


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
