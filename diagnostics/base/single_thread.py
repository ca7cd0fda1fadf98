"""A function whose numeric libraries use one thread: on a few hundred records threads mostly wait for each other."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from importlib.util import find_spec
from typing import ParamSpec, TypeVar

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")


def single_thread(function: Callable[Parameters, Result]) -> Callable[Parameters, Result]:
    """Return the function, run with one thread per numeric library (BLAS, OpenMP); others get theirs back after it."""

    @wraps(function)
    def limited(*positional: Parameters.args, **named: Parameters.kwargs) -> Result:
        import sklearn.ensemble  # noqa: F401 - only libraries that are loaded can be limited
        from threadpoolctl import threadpool_limits

        with threadpool_limits(1), known_to_be_missing("pandas"):
            return function(*positional, **named)

    return limited


@contextmanager
def known_to_be_missing(name: str) -> Iterator[None]:
    """Let imports of a package that is not installed fail at once.

    scikit-learn tries to import pandas at every fit and prediction of an imputer. Where it is missing, Python looks
    through all folders each time: a tenth of a training.
    """
    if name in sys.modules or find_spec(name) is not None:
        yield
        return
    sys.modules[name] = None  # type: ignore[assignment] # Python's own word for a module that is not there
    try:
        yield
    finally:
        sys.modules.pop(name, None)
