"""Records handed out to processes in chunks, with the results in the order of the records."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future
from itertools import islice
from typing import TypeVar

from diagnostics.base.kept_memory import keep_memory
from diagnostics.base.process_pool import process_pool
from diagnostics.records.recording import Recording

CHUNK_RECORDS = 8
WORTH_A_PROCESS = 50
"""Records of a second or two take longer than a process takes to begin."""
Result = TypeVar("Result")


def fitting_workers(records: int) -> int:
    """Return how many processes so many records are worth, at most one per core."""
    return max(1, min(os.cpu_count() or 1, records // WORTH_A_PROCESS))


def mapped(records: Iterable[Recording], function: Callable[[Recording], Result], workers: int = 1) -> Iterator[Result]:
    """Yield what a function returns of every record, with at most two chunks per worker on the way.

    Parameters
    ----------
    records : iterable of Recording
        Read by this process.
    function : callable
        One that other processes can take, see `pickle`, where there are any.
    workers : int
        Processes; 1 computes in this one.
    """
    if workers <= 1:
        yield from map(function, records)
        return
    chunks = _chunks(records)
    with process_pool(workers, keep_memory) as pool:
        waiting: deque[Future[list[Result]]] = deque()
        try:
            for chunk in chunks:
                waiting.append(pool.submit(_chunk_results, function, chunk))
                if len(waiting) >= 2 * workers:
                    yield from waiting.popleft().result()
            while waiting:
                yield from waiting.popleft().result()
        finally:
            for future in waiting:
                future.cancel()


def _chunks(records: Iterable[Recording]) -> Iterator[list[Recording]]:
    iterator = iter(records)
    while chunk := list(islice(iterator, CHUNK_RECORDS)):
        yield chunk


def _chunk_results(function: Callable[[Recording], Result], chunk: list[Recording]) -> list[Result]:
    return [function(record) for record in chunk]
