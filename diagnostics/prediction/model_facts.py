"""What a released model says about itself: data, labels, channels, rates, and where its training records lie.

What `model.json` promises of the files beside it: their hashes, and a digest of itself.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from diagnostics.indicators.table import revolution_columns
from diagnostics.prediction.training_distance import TrainingDistance, distance_from_facts
from diagnostics.records.gear_train import GearNames, MeshNames
from diagnostics.records.record_classes import check_kind
from diagnostics.records.recording import names_of, pair_teeth
from diagnostics.statistics.evaluation import Interval
from diagnostics.training.splits import TEST, SpecimenSplit
from siggen.dataset.reading import Dataset
from siggen.dataset.seal import digest_of, sealed, unsealed
from siggen.errors import UsageError, VerificationError
from siggen.file_writing import write_file
from siggen.plain_json import plain

REFERENCED = "referenced_"
"""Prefix of the files of the healthy-referenced variant."""

FACTS_FILE = "model.json"
MODEL_FILES = (
    *("classifier.skops", "feature_names.json", "cnn.safetensors", "model_card.md"),
    *("referenced_classifier.skops", "referenced_feature_names.json"),
)
"""All files of a model beside `model.json`, those that not every training writes among them."""

FORMAT = "siggen-diagnostics model 7"
"""The only one that is read: earlier ones do not say what gears and meshes are called."""


def file_hashes(folder: Path) -> dict[str, str]:
    """Return the SHA-256 of every file of a model that is there, by name."""
    return {name: _sha256(folder / name) for name in MODEL_FILES if (folder / name).is_file()}


def check_files(folder: Path, hashes: Mapping[str, str]) -> None:
    """Compare the files of a model with their hashes; files that are gone are noted by whoever needs them.

    Raises
    ------
    UsageError
        Naming every file that differs, or that nobody promised.
    """
    there = file_hashes(folder)
    if changed := [name for name, found in there.items() if hashes.get(name) != found]:
        raise UsageError(
            f"{folder}: {', '.join(changed)} not as {FACTS_FILE} promises (SHA-256 differs): damaged, changed, or of "
            "another model. The files of a model are written together; copy the folder as a whole or train again: "
            f"siggen-diagnostics report SET --out {folder}"
        )


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


@dataclass(frozen=True, slots=True)
class ModelFacts:
    """A released model's own description.

    Attributes
    ----------
    set_name, identity, manifest_digest : str
        The set it was trained on: name, SHA-256 of its configuration, SHA-256 of its manifest (which holds the hash of
        every file).
    class_kind : str
        What a class is: `state` or `fault`.
    classes, channels : tuple of str
        Names of classes and channels, in the models' order.
    units : tuple of str
        Unit of each channel.
    fs_hz, duration_s : float
        Rate and length of the training records.
    names : tuple of MeshNames
        Meshes and gears.
    teeth : tuple of (int, int)
        Pairs of teeth that occur in training and validation, as all that follows: models never saw test records.
    speed_range_hz, torque_range_nm : (float, float)
        Operating points.
    fewest_revolutions : int
        Turns of the first shaft of the shortest average.
    reference_speed_ratio : float or None
        Largest ratio, 1 or more, of the speeds of a record and of one it refers to; None without the
        healthy-referenced variant.
    """

    set_name: str
    identity: str
    manifest_digest: str
    class_kind: str
    classes: tuple[str, ...]
    channels: tuple[str, ...]
    units: tuple[str, ...]
    fs_hz: float
    duration_s: float
    names: GearNames
    teeth: tuple[tuple[int, int], ...]
    speed_range_hz: tuple[float, float]
    torque_range_nm: tuple[float, float]
    fewest_revolutions: int
    reference_speed_ratio: float | None = None

    @property
    def first_gear(self) -> str:
        """What drives the first mesh."""
        return self.names[0].gears[0]


def model_facts(dataset: Dataset, table: pa.Table, split: SpecimenSplit) -> ModelFacts:
    """Return the facts of models trained on a set; ranges are those of its training and validation records.

    Parameters
    ----------
    dataset : siggen Dataset
        The set.
    table : pyarrow.Table
        Its feature table.
    split : SpecimenSplit
        What the models tell apart.
    """
    seen = table.filter(pc.not_equal(table.column("split"), TEST))

    def column(name: str) -> np.ndarray:
        return np.asarray(seen.column(name).to_pylist())

    def limits(name: str) -> tuple[float, float]:
        return float(column(name).min()), float(column(name).max())

    pairs = {(int(a), int(b)) for a, b in zip(*map(column, pair_teeth(dataset)), strict=True)}
    return ModelFacts(
        set_name=str(dataset.manifest.get("name", dataset.path.name)),
        identity=str(dataset.manifest["identity"]),
        manifest_digest=digest_of(dataset.manifest),
        class_kind=split.kind,
        classes=split.classes,
        channels=tuple(channel.name for channel in dataset.channels),
        units=tuple(channel.unit for channel in dataset.channels),
        fs_hz=float(dataset.fs_hz),
        duration_s=float(dataset.duration_s),
        teeth=tuple(sorted(pairs)),
        names=names_of(dataset),
        speed_range_hz=limits("speed_hz"),
        torque_range_nm=limits("torque_nm"),
        fewest_revolutions=int(column(revolution_columns(names_of(dataset))[0]).min()),
    )


def write_facts(
    facts: ModelFacts,
    distance: TrainingDistance,
    referenced: TrainingDistance | None,
    scores: dict[str, Any],
    folder: Path,
) -> None:
    """Write `model.json` with the hashes of all files beside it, so it comes last."""
    content = {
        "format": FORMAT,
        "facts": facts,
        "scores": scores,
        "distance": distance,
        "referenced_distance": referenced,
        "files": file_hashes(folder),
    }
    write_file(folder / FACTS_FILE, sealed(plain(content)))


@dataclass(frozen=True, slots=True)
class ModelContent:
    """What `model.json` says.

    Attributes
    ----------
    facts : ModelFacts
    distance, referenced : TrainingDistance
        The second of the healthy-referenced variant; None where there is none.
    accuracy : dict of str to Interval
        Of every classifier on the test specimens.
    files : dict of str to str
        SHA-256 of every file beside it, by name.
    """

    facts: ModelFacts
    distance: TrainingDistance
    referenced: TrainingDistance | None
    accuracy: dict[str, Interval]
    files: dict[str, str]


def read_content(folder: Path) -> ModelContent:
    """Read `model.json`.

    Raises
    ------
    UsageError
        If it is missing, damaged or of another format.
    """
    path = folder / FACTS_FILE
    try:
        stored = path.read_bytes()
        if (found := json.loads(stored).get("format")) != FORMAT:
            raise UsageError(
                f"{path}: received format {found!r}; allowed is {FORMAT!r}, which says what gears and meshes are "
                f"called. Train again: siggen-diagnostics report SET --out {path.parent}"
            )
        content = unsealed(FACTS_FILE, stored)
        facts = {name: _tuples(value) for name, value in content["facts"].items()}
        check_kind(facts["class_kind"])
        facts["names"] = tuple(MeshNames(*mesh) for mesh in facts["names"])
        referenced = content["referenced_distance"]
        return ModelContent(
            ModelFacts(**facts),
            distance_from_facts(content["distance"]),
            distance_from_facts(referenced) if referenced else None,
            {name: _interval(score["accuracy"]) for name, score in content["scores"]["test"].items()},
            dict(content["files"]),
        )
    except UsageError:
        raise
    except (OSError, ValueError, KeyError, TypeError, AttributeError, VerificationError) as error:
        raise UsageError(
            f"{path}: cannot be used ({error}); give the folder that `siggen-diagnostics report` wrote with this "
            "version"
        ) from error


def _interval(numbers: dict[str, float | None]) -> Interval:
    return Interval(**{name: math.nan if value is None else float(value) for name, value in numbers.items()})


def _tuples(value: Any) -> Any:
    return tuple(_tuples(entry) for entry in value) if isinstance(value, list) else value
