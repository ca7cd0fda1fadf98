"""extensions.json of a set that was extended: how many specimens it had each time, so that its shards stay as they are.

Without the file a set was generated at once. It is written before the first new shard: from then on the folder says how
its shards are cut, whatever is lost or interrupted.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from siggen.dataset.seal import sealed, unsealed
from siggen.dataset.storage import Storage
from siggen.errors import DatasetError, VerificationError

EXTENSIONS = "extensions.json"


def read_extensions(storage: Storage) -> tuple[int, ...]:
    """Return the numbers of specimens that a set had and was to have, ascending; empty if it was never extended.

    Raises
    ------
    DatasetError
        If the file is not one that siggen wrote.
    """
    if not storage.exists(EXTENSIONS):
        return ()
    try:
        counts = tuple(int(count) for count in unsealed(EXTENSIONS, storage.get(EXTENSIONS))["specimens"])
    except (VerificationError, KeyError, TypeError, ValueError) as error:
        raise DatasetError(
            f"{storage.location}/{EXTENSIONS} cannot be used ({error}); it says how the shards of this set are cut: "
            "restore it from a copy of the set, or generate into a new folder"
        ) from error
    if not counts or any(after <= before for before, after in pairwise((0, *counts))):
        raise DatasetError(f"{storage.location}/{EXTENSIONS}: received {list(counts)}; allowed: ascending numbers")
    return counts


def earlier_specimens(storage: Storage, specimens: int) -> tuple[int, ...]:
    """Return the numbers of specimens that a set had before it had so many."""
    return tuple(count for count in read_extensions(storage) if count < specimens)


def put_extensions(storage: Storage, counts: Sequence[int]) -> None:
    """Say how many specimens a set has had, the number that it is to have last."""
    storage.put(EXTENSIONS, sealed({"specimens": list(counts)}))
