"""Medians of costs that are measured in turn, so that a busy moment of the machine hits all candidates alike."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from statistics import median


@dataclass(frozen=True, slots=True)
class Candidate:
    """What is measured: a function of the number of its call (for fresh inputs), called so often in every round."""

    function: Callable[[int], object]
    calls: int = 1


def medians(
    candidates: Mapping[str, Candidate], rounds: int, clock: Callable[[], float] = time.process_time, first: int = 0
) -> dict[str, float]:
    """Return the median cost [s] of one call of every candidate.

    Parameters
    ----------
    candidates : name -> Candidate
        Called in turn, round by round.
    rounds : int
    clock : callable
        By default the CPU time of this process, which other processes disturb least; `time.perf_counter` for wall time.
    first : int
        Number of the first call, so that calls before (to compile) do not share inputs with the measured ones.
    """
    costs: dict[str, list[float]] = {name: [] for name in candidates}
    for _ in range(rounds):
        for name, candidate in candidates.items():
            for _ in range(candidate.calls):
                number = first + len(costs[name])
                start = clock()
                candidate.function(number)
                costs[name].append(clock() - start)
    return {name: median(values) for name, values in costs.items()}
