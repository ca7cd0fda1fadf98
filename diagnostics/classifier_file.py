"""The classifier on indicators as a skops file: loading lists the types inside and executes nothing unknown."""

from __future__ import annotations

import json
import zipfile
from dataclasses import asdict
from pathlib import Path

from diagnostics.baselines import FeatureClassifier
from diagnostics.features import FeatureSettings
from siggen.errors import UsageError

NAMES_FILE = "feature_names.json"
TRUSTED_TYPES = ("numpy.dtype",)
"""Types besides those that skops trusts by itself: the imputer remembers the type of its input."""


def save_classifier(model: FeatureClassifier, settings: FeatureSettings, identity: str, folder: Path) -> Path:
    """Write `classifier.skops` and `feature_names.json` (features, states, settings, identity); return the former."""
    import skops.io

    path = folder / "classifier.skops"
    skops.io.dump(model.pipeline, path)
    facts = {
        "features": model.features,
        "classes": model.classes,
        "strength": model.strength,
        "note": model.note,
        "temperature": model.temperature,
        "settings": asdict(settings),
        "identity": identity,
    }
    (folder / NAMES_FILE).write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    return path


def untrusted_types(path: Path) -> tuple[str, ...]:
    """Return the types in a skops file that neither skops nor `TRUSTED_TYPES` names; nothing is executed."""
    import skops.io

    return tuple(name for name in skops.io.get_untrusted_types(file=path) if name not in TRUSTED_TYPES)


def load_classifier(folder: Path) -> FeatureClassifier:
    """Read a classifier written by `save_classifier`.

    Raises
    ------
    UsageError
        If the file is missing, damaged, or holds types that are not trusted, which are listed; it is then not loaded.
    """
    import skops.io

    path = folder / "classifier.skops"
    try:
        found = untrusted_types(path)
        facts = json.loads((folder / NAMES_FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
        raise UsageError(f"{folder}: no readable classifier.skops with {NAMES_FILE} ({error})") from error
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
    )
