"""The classifier on indicators as a skops file: loading lists the types inside and executes nothing unknown."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from pathlib import Path
from types import ModuleType
from typing import Any

from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.training.feature_classifier import FeatureClassifier
from siggen.errors import UsageError
from siggen.file_writing import write_file

CLASSIFIER_FILE, NAMES_FILE = "classifier.skops", "feature_names.json"
TRUSTED_TYPES = ("numpy.dtype",)
"""Types besides those that skops trusts by itself: the imputer remembers the type of its input."""


def save_classifier(
    model: FeatureClassifier, settings: IndicatorSettings, identity: str, folder: Path, prefix: str = ""
) -> Path:
    """Write `classifier.skops` and `feature_names.json` (features, states, settings, identity); return the former.

    A prefix before both names keeps variants of a classifier apart.
    """
    path = folder / f"{prefix}{CLASSIFIER_FILE}"
    write_file(path, _skops_io().dumps(model.pipeline))
    facts = {
        "features": model.features,
        "classes": model.classes,
        "strength": model.strength,
        "note": model.note,
        "temperature": model.temperature,
        "logarithms": model.logarithms,
        "settings": asdict(settings),
        "identity": identity,
    }
    write_file(folder / f"{prefix}{NAMES_FILE}", json.dumps(facts, indent=1) + "\n")
    return path


def untrusted_types(path: Path) -> tuple[str, ...]:
    """Return the types in a skops file that neither skops nor `TRUSTED_TYPES` names; nothing is executed."""
    return tuple(name for name in _skops_io().get_untrusted_types(file=path) if name not in TRUSTED_TYPES)


def load_classifier(folder: Path, prefix: str = "") -> FeatureClassifier:
    """Read a classifier written by `save_classifier`.

    Raises
    ------
    UsageError
        If the file is missing, damaged, or holds types that are not trusted, which are listed; it is then not loaded.
        If the names beside it are of another schema, or hold values that cannot be.
    """
    path = folder / f"{prefix}{CLASSIFIER_FILE}"
    try:
        found = untrusted_types(path)
        facts = _facts(folder, prefix)
        if found:
            raise UsageError(f"{path}: holds types that are not trusted: {', '.join(found)}; it is not loaded")
        pipeline = _skops_io().load(path, trusted=list(TRUSTED_TYPES))
    except UsageError:
        raise
    except Exception as error:  # whatever a damaged archive makes its reader raise
        raise UsageError(f"{folder}: no readable {path.name} with {prefix}{NAMES_FILE} ({error})") from error
    return _classifier(folder / f"{prefix}{NAMES_FILE}", pipeline, facts)


def _skops_io() -> ModuleType:
    """Return skops.io, imported when it is needed."""
    from diagnostics.training.skops_io import skops_io

    return skops_io


def _classifier(path: Path, pipeline: Any, facts: dict[str, Any]) -> FeatureClassifier:
    """Return the classifier of a pipeline and what the names beside it say, if that can be."""
    try:
        found = FeatureClassifier(
            pipeline=pipeline,
            features=tuple(facts["features"]),
            classes=tuple(facts["classes"]),
            strength=float(facts["strength"]),
            note=str(facts["note"]),
            temperature=float(facts.get("temperature", 1.0)),
            logarithms=tuple(facts.get("logarithms", ())),
        )
    except (KeyError, TypeError, ValueError) as error:
        raise UsageError(f"{path}: received another schema ({error!r}); train again with this version") from error
    if wrong := _impossible(found):
        raise UsageError(f"{path}: received {wrong}; the folder is damaged or was edited: train again")
    return found


def _impossible(found: FeatureClassifier) -> str:
    """Return which value of a classifier cannot be, with what is allowed; empty if all can."""
    if not (math.isfinite(found.temperature) and found.temperature > 0.0):
        return f"temperature {found.temperature}; allowed: finite and above 0"
    if not math.isfinite(found.strength):
        return f"strength {found.strength}; allowed: finite"
    for what, names in (("features", found.features), ("classes", found.classes)):
        if len(set(names)) < len(names) or not all(isinstance(name, str) for name in names):
            return f"{what} that are no names or come twice; allowed: every name once"
    if unknown := set(found.logarithms) - set(found.features):
        return f"logarithms of {min(unknown)}, which is no feature; allowed: its features"
    return ""


def classifier_identity(folder: Path, prefix: str = "") -> str:
    """Return the identity of the set that a classifier written by `save_classifier` was trained on; empty if untold."""
    return str(_facts(folder, prefix).get("identity", ""))


def load_settings(folder: Path) -> IndicatorSettings:
    """Read the settings of the features of a classifier written by `save_classifier`.

    Raises
    ------
    UsageError
        If they are missing or of another version.
    """
    try:
        return IndicatorSettings(**_facts(folder, "")["settings"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise UsageError(f"{folder / NAMES_FILE}: no readable settings of features ({error})") from error


def _facts(folder: Path, prefix: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / f"{prefix}{NAMES_FILE}").read_text(encoding="utf-8"))
    return found
