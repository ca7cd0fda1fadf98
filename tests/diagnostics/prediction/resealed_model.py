"""A model folder that a test changed, with hashes that fit again: what no accident does."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from diagnostics.prediction.model_facts import file_hashes
from siggen.dataset.seal import sealed


def reseal(folder: Path, **entries: Any) -> None:
    """Write `model.json` again for the files that are there now, with other entries where given."""
    content = json.loads((folder / "model.json").read_text()) | entries | {"files": file_hashes(folder)}
    del content["digest"]
    (folder / "model.json").write_bytes(sealed(content))
