"""What is dear to make and what tests of many files only read: made once for all processes of a session."""

from __future__ import annotations

import fcntl
import hashlib
import os
import pickle
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

import pytest

Made = TypeVar("Made")


def shared(factory: pytest.TempPathFactory, name: str, make: Callable[[], Made]) -> Made:
    """Return what `make` returns: the first process that asks makes it, all others read what it kept.

    Parameters
    ----------
    factory : TempPathFactory
        Of the session.
    name : str
        One thing has one name in all files.
    make : callable
        What it returns can be pickled.
    """
    with _locked(factory, name) as place:
        if not place.exists():
            place.write_bytes(pickle.dumps(make()))
        made: Made = pickle.loads(place.read_bytes())
    return made


def shared_folder(factory: pytest.TempPathFactory, name: str, make: Callable[[Path], object]) -> Path:
    """Return the folder that `make` filled, in the first process that asked. Nobody writes into it afterwards."""
    with _locked(factory, name) as place:
        if not place.exists():
            made = place.with_suffix(".new")
            make(made)
            made.rename(place)
    return place


@contextmanager
def _locked(factory: pytest.TempPathFactory, name: str) -> Iterator[Path]:
    """Give the place of a thing to one process at a time; the system takes the lock from one that dies."""
    own = factory.getbasetemp()
    root = (own.parent if "PYTEST_XDIST_WORKER" in os.environ else own) / "shared"
    root.mkdir(exist_ok=True)
    place = root / hashlib.sha256(name.encode()).hexdigest()[:16]
    with place.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield place
