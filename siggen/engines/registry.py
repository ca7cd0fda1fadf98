"""Engines by name: the one place that knows which there are."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import closing, contextmanager

from siggen.engines.dask_engine import DaskEngine
from siggen.engines.processes import ProcessEngine, default_workers
from siggen.engines.protocol import Engine, Result, Results, Task
from siggen.engines.ray_engine import RayEngine
from siggen.engines.serial import SerialEngine
from siggen.errors import UsageError

ENGINES: dict[str, Callable[[int], Engine]] = {
    "serial": lambda _: SerialEngine(),
    "processes": ProcessEngine,
    "dask": DaskEngine,
    "ray": RayEngine,
}
"""Name -> number of workers -> engine. Results do not depend on which one is chosen."""

ADDRESSED: dict[str, Callable[[int, str | None], Engine]] = {"dask": DaskEngine, "ray": RayEngine}
"""Those that can use a cluster which is there already, by its address."""


def engine_of(engine: Engine | str | None, workers: int | None, address: str | None = None) -> Engine:
    """Return an engine by its name, or the object that was given.

    Parameters
    ----------
    engine : Engine, str or None
        An object is returned as it is. None: 'serial' for no workers, else 'processes'.
    workers : int or None
        For an engine by name, by default one per core; 'serial' has one whatever is asked for.
    address : str, optional
        Of a cluster that is there already, for an engine of a cluster by its name.

    Raises
    ------
    UsageError
        If there is no engine of that name, an object is no engine, it comes with a number of workers of its own, or
        an address with an engine that has none.
    """
    if address is not None:
        if not isinstance(engine, str) or engine not in ADDRESSED:
            raise UsageError(
                f"received the address {address} and the engine {engine or 'processes'}; allowed: an address with the "
                f"engines {' and '.join(ADDRESSED)}"
            )
        return ADDRESSED[engine](default_workers() if workers is None else workers, address)
    if engine is None:
        # one worker is a process too: its libraries run one thread, as everywhere, and threads change how sums round
        engine = "serial" if workers == 0 else "processes"
    if not isinstance(engine, str):
        _check(engine)
        if workers is not None and workers != engine.workers:
            raise UsageError(
                f"received workers {workers} and an engine of {engine.workers} workers; allowed: one of the two"
            )
        return engine
    if engine not in ENGINES:
        raise UsageError(f"received the engine '{engine}'; allowed: {', '.join(ENGINES)}, or an Engine object")
    return ENGINES[engine](default_workers() if workers is None else workers)


@contextmanager
def running(engine: Engine, function: Callable[[Task], Result], tasks: Iterable[Task]) -> Iterator[Results[Result]]:
    """Give the results of tasks that an engine runs; leaving it stops the work.

    Raises
    ------
    UsageError
        If the engine's `map` gives no generator: results could not be stopped.
    """
    results = engine.map(function, tasks)
    if not (hasattr(results, "__next__") and hasattr(results, "close")):
        raise UsageError(f"map of {_named(engine)} gave {_named(results)}; {ALLOWED}")
    with closing(results):
        yield results


ALLOWED = (
    "allowed: an engine whose map(function, tasks) is a generator of (position of the task, result), with workers, a "
    "whole number from 1 (siggen.engines.protocol)"
)


def _check(engine: object) -> None:
    if not callable(getattr(engine, "map", None)):
        raise UsageError(f"received {_named(engine)} without map as an engine; {ALLOWED}")
    workers = getattr(engine, "workers", None)
    if not isinstance(workers, int) or isinstance(workers, bool) or workers < 1:
        raise UsageError(f"received {_named(engine)} with workers {workers!r} as an engine; {ALLOWED}")


def _named(value: object) -> str:
    return f"a {type(value).__name__}"
