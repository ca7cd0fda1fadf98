"""Where a command writes what it finds about a set, if its user names no place: beside the set."""

from __future__ import annotations

from pathlib import Path, PurePath


def beside(place: PurePath, ending: str) -> Path:
    """Return the set's path with an ending; for a set in an object store, its name in the working folder.

    Parameters
    ----------
    place : path
        Of a set (`Dataset.path`).
    ending : str
        Such as "_report".
    """
    if isinstance(place, Path):
        folder = place.resolve()
        return folder.with_name(f"{folder.name}{ending}")
    return Path(f"{place.name}{ending}")
