"""Settings of all tests."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Iterator

import pytest
from hypothesis import settings

from tests.blank_pictures import blank_pictures

# No deadline: the first example of a property compiles its kernels. The same examples in every run, so that a failure
# can be found again, and few, since every run repeats them; HYPOTHESIS_PROFILE=explore looks for new ones.
settings.register_profile("repeatable", deadline=None, derandomize=True, max_examples=40)
settings.register_profile("explore", deadline=None, max_examples=500)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeatable"))


@pytest.fixture(autouse=True, scope="session")
def one_worker() -> Iterator[None]:
    """Commands that are not told how many workers start one, not one per core: each start costs ten short records."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("siggen.workers.choice.default_workers", lambda: 1)
        yield


@pytest.fixture(autouse=True, scope="session")
def nothing_forced_to_the_disk() -> Iterator[None]:
    """Wait for no disk, hundreds of times: no test cuts the power, and files are as whole without."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("os.fsync", lambda descriptor: None)
        yield


@pytest.fixture(autouse=True)
def nothing_said_yet(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each test says whole what it takes of a file: a process says the same table only once."""
    if (taken := sys.modules.get("diagnostics.recordings.taken")) is not None:
        monkeypatch.setattr(taken, "_said", {})


_looked_at: set[str] = set()
"""The test that runs, if it looks at its pictures."""


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    _looked_at.clear()
    if item.get_closest_marker("drawn"):
        _looked_at.add(item.nodeid)


@pytest.fixture(autouse=True, scope="session")
def pictures() -> Iterator[None]:
    """Leave pictures blank but for tests marked `drawn`, and commands in processes of their own."""
    with blank_pictures(lambda: bool(_looked_at)):
        yield


LONG = ("tests/walks/", "tests/diagnostics/", "tests/sets/", "tests/dataset/")
"""Folders whose files take longest."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with long files: where one of them came last, one process would wait for the other."""
    items.sort(key=lambda item: not item.nodeid.startswith(LONG))


gc.disable()  # while tests are collected, which leaves nearly nothing and takes a sixth longer with it


def pytest_collection_finish() -> None:
    """Collect garbage a tenth as often, and never among modules and tests: it took 7 % of all time and found little."""
    gc.enable()
    gc.collect()
    gc.freeze()
    gc.set_threshold(10 * gc.get_threshold()[0], *gc.get_threshold()[1:])
