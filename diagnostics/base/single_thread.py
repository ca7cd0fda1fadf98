"""A function whose numeric libraries use one thread: on a few hundred records threads mostly wait for each other."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")


def single_thread(function: Callable[Parameters, Result]) -> Callable[Parameters, Result]:
    """Return the function, run with one thread per numeric library (BLAS, OpenMP); others get theirs back after it."""

    @wraps(function)
    def limited(*positional: Parameters.args, **named: Parameters.kwargs) -> Result:
        import sklearn.ensemble  # noqa: F401 - only libraries that are loaded can be limited
        from threadpoolctl import threadpool_limits

        with threadpool_limits(1):
            return function(*positional, **named)

    return limited
