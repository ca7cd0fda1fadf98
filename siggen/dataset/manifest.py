"""manifest.json, written last and sealed once: what a finished set is."""

from __future__ import annotations

from pathlib import Path, PurePath

from siggen.dataset.gate import manifest_facts
from siggen.dataset.inventory import Inventory
from siggen.dataset.storage import Storage
from siggen.errors import DatasetError, VerificationError
from siggen.keys.problems import nearest

MANIFEST = "manifest.json"
CONFIG = "config.yaml"
CARD = "README.md"
CROISSANT, PREVIEWS = "croissant.json", "previews"
"""What a published set has beside."""
PHYSICS = "physics.json"
"""What `siggen verify --physics` found last; beside the set, in no manifest."""
INJECTED = "injected.json"
"""In a set of recordings with injected damage, as `siggen-diagnostics calibrate --inject` writes it."""
BLIND = "blind.json"
"""In a set without what tells its states, as `diagnostics.make_benchmark` writes it."""


def read_manifest(storage: Storage) -> Inventory:
    """Return what the manifest of a finished set says.

    Raises
    ------
    DatasetError
        If there is no set, only part of one, a damaged manifest, or one of another schema version.
    """
    if not storage.exists(MANIFEST):
        raise DatasetError(_why_no_manifest(storage))
    try:
        return manifest_facts(MANIFEST, storage.get(MANIFEST))
    except DatasetError as error:
        raise DatasetError(f"{storage.location}/{error}") from error
    except VerificationError as error:
        raise DatasetError(
            f"{storage.location}: {error}; `siggen generate` with the set's config.yaml makes it again from its shards"
        ) from error


def _nearest_folder(path: PurePath) -> str:
    """Return which folder may be meant: the one next in name to the first part of a path that is not there."""
    try:
        if not isinstance(path, Path) or path.is_dir():
            return ""
        absent = path
        while not absent.parent.is_dir():
            absent = absent.parent
        return nearest(absent.name, [one.name for one in absent.parent.iterdir() if one.is_dir()])
    except OSError:
        return ""


def _why_no_manifest(storage: Storage) -> str:
    where = storage.location
    if not storage.names():
        return f"{where}: there is no data set here (no such folder, or an empty one){_nearest_folder(storage.path)}"
    if not storage.exists(CONFIG):
        return f"{where}: not a siggen data set (it has neither {MANIFEST} nor {CONFIG})"
    return (
        f"{where}: the data set is not finished (no {MANIFEST}). The same command that began it completes it: "
        f"siggen generate {where}/{CONFIG} --out {where}"
    )
