"""The window that clusters share: every task once, in any order of completion, never far ahead of the oldest."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pytest

from siggen.engines.window import WINDOW_PER_WORKER, windowed


@pytest.mark.parametrize("workers", [1, 3])
@pytest.mark.parametrize("seed", range(5))
def test_any_order_of_completion_gives_every_task_once_and_keeps_the_window(workers: int, seed: int) -> None:
    """The cluster finishes one to three open tasks at a time by chance, but task 0 only when nothing else is open."""
    rng, taken, given = np.random.default_rng(seed), list[int](), list[int]()

    def tasks() -> Iterator[int]:
        for task in range(40):
            taken.append(task)
            yield task

    def finished(opened: Sequence[str]) -> list[str]:
        ready = [one for one in opened if one != "task 0"] or list(opened)
        return [str(one) for one in rng.permutation(ready)[: rng.integers(1, 4)]]

    for index, result in windowed(
        tasks(), workers, lambda task, _: f"task {task}", finished, lambda one, task: (one, task)
    ):
        assert result == (f"task {index}", index)
        given.append(index)
        oldest = min(set(taken) - set(given), default=len(taken))
        assert len(taken) <= oldest + WINDOW_PER_WORKER * workers
    assert sorted(given) == taken == list(range(40))


def test_no_tasks_ask_nothing_of_the_cluster() -> None:
    assert list(windowed([], 2, lambda task, _: task, lambda opened: pytest.fail("asked"), lambda one, task: one)) == []
