"""What `model.json` promises of the files beside it: their hashes, and a digest of itself."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from siggen.errors import UsageError

FACTS_FILE = "model.json"
MODEL_FILES = (
    *("classifier.skops", "feature_names.json", "cnn.safetensors", "cnn.onnx", "model_card.md"),
    *("circular.safetensors", "circular.onnx"),
    *("referenced_classifier.skops", "referenced_feature_names.json"),
)
"""All files of a model beside `model.json`, those that not every training writes among them."""

DIGEST = "digest"


def sealed_text(content: Mapping[str, Any]) -> str:
    """Return JSON that carries the SHA-256 of itself, so that any changed byte shows."""
    return _text({**content, DIGEST: hashlib.sha256(_text(content).encode()).hexdigest()})


def unsealed_text(text: str) -> dict[str, Any]:
    """Return the content of sealed JSON.

    Raises
    ------
    ValueError
        If it is no JSON object, or not what its digest promises.
    """
    found = json.loads(text)
    if not isinstance(found, dict):
        raise ValueError(f"received {type(found).__name__} instead of an object")
    digest = found.pop(DIGEST, None)
    if sealed_text(found) != text:
        raise ValueError(f"it was changed: its content does not match its own digest {digest}")
    return found


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
            f"siggen-diagnostics report SET --models-only --out {folder}"
        )


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _text(content: Mapping[str, Any]) -> str:
    return json.dumps(dict(content), indent=1, allow_nan=False) + "\n"
