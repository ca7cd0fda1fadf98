"""JSON of what a program holds: numbers of numpy, tuples, dataclasses; what is undefined or infinite becomes null."""

from __future__ import annotations

import json
from dataclasses import fields, is_dataclass
from math import isfinite
from typing import Any


def plain(content: Any) -> Any:
    """Return the same in what JSON knows; dataclasses as mappings of their fields."""
    if is_dataclass(content):
        return {field.name: plain(getattr(content, field.name)) for field in fields(content)}
    if isinstance(content, dict):
        return {str(name): plain(value) for name, value in content.items()}
    if isinstance(content, (list, tuple)):
        return [plain(value) for value in content]
    if hasattr(content, "tolist"):
        return plain(content.tolist())
    return None if isinstance(content, float) and not isfinite(content) else content


def json_text(content: Any) -> str:
    """Return the text of a JSON file."""
    return json.dumps(plain(content), indent=1, allow_nan=False) + "\n"
