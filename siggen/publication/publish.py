"""A finished set as a folder that the Hugging Face hub and Zenodo take: its files, a card, metadata, previews."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa

from siggen.dataset.card import quantities_text, tags
from siggen.dataset.manifest import BLIND, CARD, CROISSANT, INJECTED, MANIFEST, PREVIEWS
from siggen.dataset.new_folder import new_folder
from siggen.dataset.reading import Dataset
from siggen.dataset.reading import open as open_set
from siggen.dataset.seal import sealed
from siggen.dataset.storage import LocalFolder, Storage
from siggen.dataset.storage_at import storage_at
from siggen.errors import DatasetError, UsageError, counted
from siggen.gearbox.description import faults_text, machine_word
from siggen.gearbox.design import SetDesign, design_of
from siggen.publication.audit_section import AUDIT, audit_section
from siggen.publication.croissant import FOLDERS, TABLES, croissant
from siggen.publication.dataset_info import dataset_info
from siggen.publication.publication_facts import TEMPLATE, PublicationFacts, read_publication_facts
from siggen.publication.published_card import published_card


@dataclass(frozen=True, slots=True)
class Publication:
    """What is, or would be, written.

    Attributes
    ----------
    texts
        Files made for publication by name.
    copied
        Names of the set's own files that go along unchanged.
    bytes
        Of all copied files.
    audit
        The audit that the card quotes, or None.
    """

    texts: Mapping[str, bytes]
    copied: tuple[str, ...]
    bytes: int
    audit: Path | None

    def __repr__(self) -> str:
        """One line: how many files were made and copied, and which audit the card quotes."""
        made, copied = counted(len(self.texts), "file"), counted(len(self.copied), "file")
        return f"Publication({made} made, {copied} of {self.bytes / 1e6:.1f} MB copied, audit {self.audit})"


def publication(path: Path | str, facts_file: Path | None, audit: Path | None = None) -> Publication:
    """Return what `publish` would write, after all checks but those of the target.

    Parameters
    ----------
    path : path
        A finished set.
    facts_file : Path or None
        The authors' YAML file.
    audit : Path or None
        The file `audit.json`, or its folder; default: `DIR_audit` beside the set, if it is there.

    Raises
    ------
    UsageError, ConfigError
        If the authors' file is missing, or anything in it is unset or wrong; if the audit is of another set.
    DatasetError
        If the set is not finished, or its configuration is not one of this version.
    """
    dataset = open_set(path)
    if INJECTED in dataset.inventory.files:
        raise UsageError(f"{path}: holds your recordings with injected damage; it is no set that siggen publishes")
    if BLIND in dataset.inventory.files:
        raise UsageError(f"{path}: is a test part of a benchmark, ready as it is; publish the part to learn from")
    facts = _facts(Path(path), facts_file)
    found = _audit_file(Path(path), audit)
    design = _design(dataset)
    fitted = [sensor.name for sensor in design.sensors if sensor.fitted]
    if fitted and not facts.with_recordings:
        raise UsageError(
            f"{path}: paths and lines of {', '.join(fitted)} are fitted to recordings; `with_recordings: true` in "
            f"{facts_file} publishes them"
        )
    files = dataset.files
    copied = tuple(name for name in files if name not in (CARD, CROISSANT) and not name.startswith(PREVIEWS))
    size = sum(files[name].bytes for name in copied)
    return Publication(_texts(dataset, design, facts, found), copied, size, found)


def publish(path: Path | str, to: Path | str, facts_file: Path | None, audit: Path | None = None) -> Publication:
    """Write a folder to upload, which `siggen.open` and `siggen verify` read.

    Parameters
    ----------
    to : path
        A new or empty folder. After a kill the same call begins anew, and ends with the same bytes.

    Raises
    ------
    UsageError, ConfigError, DatasetError
        As of `publication`, or if the target is not empty, is inside the set, or holds it.
    """
    _refuse_within(path, to)
    made = publication(path, facts_file, audit)
    dataset = open_set(path)
    own = {**made.texts, **_previews(dataset)}
    with _target(to, {*made.copied, *own}) as target:
        for name in made.copied:
            target.put(name, dataset.content(name))  # compared with its hash; a copy, never the same file
        for name, content in own.items():
            target.put(name, content)
        files = {name: file for name, file in dataset.manifest["files"].items() if name in made.copied}
        files |= {name: {"bytes": len(text), "sha256": hashlib.sha256(text).hexdigest()} for name, text in own.items()}
        target.put(MANIFEST, sealed({**dataset.manifest, "files": files}))
    return made


def _refuse_within(path: Path | str, to: Path | str) -> None:
    """Refuse a target in the set, which is not to change, and one that the set is in."""
    there, target = storage_at(path), storage_at(to)
    if isinstance(there, LocalFolder) != isinstance(target, LocalFolder):
        return
    is_local = isinstance(there, LocalFolder)
    own, other = (Path(one.path).resolve() if is_local else one.path for one in (there, target))
    if other.is_relative_to(own) or own.is_relative_to(other):
        raise UsageError(
            f"{to}: received a folder inside the set {path}, or one that holds it; allowed: a folder beside the set"
        )


@contextmanager
def _target(to: Path | str, names: set[str]) -> Iterator[Storage]:
    """Give the storage to fill: a folder appears when all is there, in a store the manifest comes last.

    A store may hold what a stopped `publish` of the same set left, which is written again.
    """
    target = storage_at(to)
    left = set(target.names())
    if left and (isinstance(target, LocalFolder) or not left <= names):
        raise UsageError(f"{to} is not empty; name a new or empty folder (nothing is deleted)")
    if isinstance(target, LocalFolder):
        with new_folder(target.path) as draft:
            yield draft
    else:
        with target.writing():
            yield target


def _facts(path: Path, file: Path | None) -> PublicationFacts:
    if file is None:
        raise UsageError(
            f"{path}: license is unset, and so are authors and citation: siggen cannot know them. Save this as "
            f"publication.yaml, fill it in, and give it with --facts publication.yaml:\n\n{TEMPLATE}"
        )
    return read_publication_facts(file)


def _audit_file(path: Path, given: Path | None) -> Path | None:
    if given is not None:
        file = given / AUDIT if given.is_dir() else given
        if not file.is_file():
            raise UsageError(f"{given}: holds no {AUDIT}; give the folder that `siggen-diagnostics audit` wrote")
        return file
    beside = path.resolve().with_name(f"{path.resolve().name}_audit") / AUDIT
    return beside if beside.is_file() else None


def _design(dataset: Dataset) -> SetDesign:
    design = design_of(dataset.config, f"{dataset.path}/config.yaml")
    if design.identity != dataset.inventory.identity:
        raise DatasetError(
            f"{dataset.path}: this version of siggen reads its configuration otherwise; publish with its own"
        )
    return design


def _texts(dataset: Dataset, design: SetDesign, facts: PublicationFacts, audit: Path | None) -> dict[str, bytes]:
    rows = dataset.inventory.rows
    records = counted(rows, f"labelled {quantities_text(dataset.channels)} record")
    description = (
        f"{records} of a simulated {machine_word(design)}, {faults_text(design)}, "
        f"{design.duration_s:g} s each at {design.fs_hz:g} Hz, of {counted(design.specimens, 'gearbox', 'gearboxes')}. "
        "Computed by siggen, not measured."
    )
    limits = "Simulated: a model trained on it has to be tested on measurements before it is trusted on them."
    schemas = _schemas(dataset)
    info = dataset_info(design, schemas, _counts(dataset, tuple(schemas)))
    card = published_card(dataset.card(), design, facts, info, audit_section(design.identity, audit))
    return {CARD: card.encode(), CROISSANT: _json(croissant(facts, description, tags(design), schemas, limits))}


def _schemas(dataset: Dataset) -> dict[str, pa.Schema]:
    """Return the columns of each view as they are in the files."""
    if not dataset.inventory.rows:
        raise DatasetError(f"{dataset.path} has no rows: there is nothing to publish")
    found = {
        "signals": next(dataset.records(batch_rows=1)).schema,
        "labels": dataset.labels(dataset.splits[0]).schema,
        "damage": dataset.damage(dataset.splits[0]).schema,
    }
    internals = next(dataset.internals(batch_rows=1), None) if dataset.internal_columns else None
    return found if internals is None else {**found, "internals": internals.schema}


def _counts(dataset: Dataset, views: tuple[str, ...]) -> dict[str, dict[str, tuple[int, int]]]:
    """Return view -> split -> (rows, bytes)."""
    found: dict[str, dict[str, tuple[int, int]]] = {}
    for view in views:
        if view in TABLES:
            rows = dataset.labels().num_rows if view == "labels" else dataset.damage().num_rows
            found[view] = {"records": (rows, dataset.files[TABLES[view]].bytes)}
            continue
        found[view] = {}
        for split in dataset.splits:
            size = sum(f.bytes for n, f in dataset.files.items() if n.startswith(f"{FOLDERS[view]}/{split}-"))
            found[view][split] = (_rows(dataset, view, split), size)
    return found


def _rows(dataset: Dataset, view: str, split: str) -> int:
    if view == "internals":
        return sum(batch.num_rows for batch in dataset.internals(split, ["record_id"]))
    return dataset.inventory.splits[split].rows


def _previews(dataset: Dataset) -> dict[str, bytes]:
    """Return a picture of the first record of every state."""
    from io import BytesIO

    from siggen.views.record import record_figure

    labels = dataset.labels(columns=["record_id", "state"]).to_pylist()
    first = {row["state"]: row["record_id"] for row in reversed(labels)}
    pictures = {}
    for state, record_id in sorted(first.items()):
        stream = BytesIO()
        figure = record_figure(dataset.record(record_id), dataset.channels[0], dataset.fs_hz)
        figure.savefig(stream, format="png", dpi=90, metadata={"Software": None})
        pictures[f"{PREVIEWS}/{state}.png"] = stream.getvalue()
    return pictures


def _json(content: dict[str, Any]) -> bytes:
    return (json.dumps(content, indent=1, ensure_ascii=False) + "\n").encode()
