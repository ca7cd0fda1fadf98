"""The classifier on indicators as a skops file: loading lists the types inside and executes nothing unknown."""

from __future__ import annotations

import json
import zipfile
from dataclasses import asdict
from pathlib import Path
from typing import Any

from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.training.baselines import FeatureClassifier
from siggen.errors import UsageError

CLASSIFIER_FILE, NAMES_FILE = "classifier.skops", "feature_names.json"
TRUSTED_TYPES = ("numpy.dtype",)
"""Types besides those that skops trusts by itself: the imputer remembers the type of its input."""


def save_classifier(
    model: FeatureClassifier, settings: IndicatorSettings, identity: str, folder: Path, prefix: str = ""
) -> Path:
    """Write `classifier.skops` and `feature_names.json` (features, states, settings, identity); return the former.

    A prefix before both names keeps variants of a classifier apart.
    """
    import skops.io

    path = folder / f"{prefix}{CLASSIFIER_FILE}"
    skops.io.dump(model.pipeline, path)
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
    (folder / f"{prefix}{NAMES_FILE}").write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    return path


def untrusted_types(path: Path) -> tuple[str, ...]:
    """Return the types in a skops file that neither skops nor `TRUSTED_TYPES` names; nothing is executed."""
    import skops.io

    return tuple(name for name in skops.io.get_untrusted_types(file=path) if name not in TRUSTED_TYPES)


def load_classifier(folder: Path, prefix: str = "") -> FeatureClassifier:
    """Read a classifier written by `save_classifier`.

    Raises
    ------
    UsageError
        If the file is missing, damaged, or holds types that are not trusted, which are listed; it is then not loaded.
    """
    import skops.io

    path = folder / f"{prefix}{CLASSIFIER_FILE}"
    try:
        found = untrusted_types(path)
        facts = _facts(folder, prefix)
    except (OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
        raise UsageError(f"{folder}: no readable {path.name} with {prefix}{NAMES_FILE} ({error})") from error
    if found:
        raise UsageError(f"{path}: holds types that are not trusted: {', '.join(found)}; it is not loaded")
    pipeline = skops.io.load(path, trusted=list(TRUSTED_TYPES))
    return FeatureClassifier(
        pipeline=pipeline,
        features=tuple(facts["features"]),
        classes=tuple(facts["classes"]),
        strength=float(facts["strength"]),
        note=str(facts["note"]),
        temperature=float(facts.get("temperature", 1.0)),
        logarithms=tuple(facts.get("logarithms", ())),
    )


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
