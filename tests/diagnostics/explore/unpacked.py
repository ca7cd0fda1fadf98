"""What the page's program reads from packed arrays, written once more for the tests."""

from __future__ import annotations

import base64
import json
import re
from pathlib import Path
from typing import Any

import numpy as np

DATA = re.compile(r'<script type="application/json" id="(look-[^"]*)">(.*?)</script>', re.DOTALL)


def steps(packed: dict[str, Any]) -> np.ndarray:
    counts = np.frombuffer(base64.b64decode(packed["data"]), "<i2")
    return np.where(counts == -32768, np.nan, counts * packed["step"])


def places(packed: dict[str, Any]) -> np.ndarray:
    return np.cumsum(np.frombuffer(base64.b64decode(packed["data"]), f"<u{packed['bits'] // 8}").astype(np.int64))


def held(page: str | Path) -> dict[str, Any]:
    """Return what the elements of a page hold, by their names."""
    text = page.read_text(encoding="utf-8") if isinstance(page, Path) else page
    return {name: json.loads(value) for name, value in DATA.findall(text)}


def rows(packed: str | None) -> list[int | None] | None:
    if packed is None:
        return None
    return [None if row < 0 else row for row in np.frombuffer(base64.b64decode(packed), "<i4").tolist()]


def label(packed: dict[str, Any]) -> list[Any]:
    data = base64.b64decode(packed["data"])
    if packed["kind"] == "text":
        return [packed["names"][code - 1] if code else None for code in np.frombuffer(data, "<u2").tolist()]
    if packed["kind"] == "whole":
        return np.frombuffer(data, "<i4").tolist()
    return [None if np.isnan(value) else value for value in np.frombuffer(data, "<f4").tolist()]


def listed(data: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the labels of every record that a page holds."""
    columns = {packed["name"]: label(packed) for packed in data["labels"]}
    return [{name: values[row] for name, values in columns.items()} for row in range(data["count"])]
