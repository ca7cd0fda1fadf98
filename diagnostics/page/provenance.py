"""Where a page comes from, in words that are the same on every machine."""

from __future__ import annotations

import siggen
from diagnostics.page.wording import counted
from siggen.dataset.reading import Dataset

INJECTED = "injected.json"
"""File of a set that holds recordings, and the same with damage added."""


def provenance(dataset: Dataset, seed: int) -> str:
    """Return what a reader needs to cite the page and to make it again: program, set, identity, seed."""
    records = dataset.labels(columns=["record_id"]).num_rows
    return (
        f"Made by siggen-diagnostics {siggen.__version__} with seed {seed} from the set {dataset.path.name}, identity "
        f"{dataset.manifest['identity']}: {counted(records, 'record')} of {dataset.duration_s:g}\N{NO-BREAK SPACE}s in "
        f"{counted(len(dataset.channels), 'channel')} at {dataset.fs_hz:g}\N{NO-BREAK SPACE}Hz. The identity names the "
        "configuration. The same configuration gives the same records."
    )


def origin_sentence(dataset: Dataset) -> str:
    """Return what the records are, so that nobody takes a simulation for a measurement."""
    labels = dataset.labels(columns=["specimen_id"])
    gearboxes = len(set(labels.column("specimen_id").to_pylist()))
    records = f"{counted(labels.num_rows, 'vibration record')} of {counted(gearboxes, 'gearbox')}"
    if INJECTED in dataset.manifest.get("files", ()):
        return f"{records}: healthy recordings, and the same with the vibration of simulated damage added."
    return f"{records}, all simulated. No real machine was measured."


def without_path(error: Exception, dataset: Dataset) -> str:
    """Return an error's message for a page that others read: the set by its name, not by its place on this machine."""
    return str(error).replace(str(dataset.path), dataset.path.name)
