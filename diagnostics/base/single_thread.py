"""Numeric libraries that use one thread: on a few hundred records threads mostly wait for each other."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_LIMITED = ContextVar("_LIMITED", default=False)


@contextmanager
def single_thread() -> Iterator[None]:
    """Give each numeric library (BLAS, OpenMP) one thread, in a block or as a decorator; afterwards as many as before.

    Where scikit-learn is missing, nothing is limited: what needs it says so itself. Within another one nothing is
    done: to look for the loaded libraries takes as long as a small fit.
    """
    if _LIMITED.get():
        yield
        return
    try:
        import sklearn.ensemble  # noqa: F401 - only libraries that are loaded can be limited
        from threadpoolctl import threadpool_limits
    except ImportError:
        yield
        return
    outer = _LIMITED.set(True)
    try:
        with threadpool_limits(1):
            yield
    finally:
        _LIMITED.reset(outer)


@contextmanager
def single_blas_thread() -> Iterator[None]:
    """Give numpy one thread, in a block: for many small products, where scikit-learn is not needed otherwise."""
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, user_api="blas"):
        yield
