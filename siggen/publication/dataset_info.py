"""`dataset_info` of a card's YAML header: columns with their types, texts of a few values as class labels.

Source: the header that the library `datasets` writes for the same features (compared in the tests).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import pyarrow as pa

from siggen.gearbox.description import class_words
from siggen.gearbox.design import SetDesign

DTYPES = {pa.float64(): "float64", pa.float32(): "float32", pa.string(): "string", pa.bool_(): "bool"}


Counts = Mapping[str, tuple[int, int]]
"""Split -> rows, and bytes of its files."""


def dataset_info(
    design: SetDesign, schemas: Mapping[str, pa.Schema], counts: Mapping[str, Counts]
) -> list[dict[str, Any]]:
    """Return one entry per view of the set (signals, labels, damage, internals), given schemas and counts by view."""
    names = class_words(design)
    return [
        _entry(view, schema, counts[view], names if view in ("signals", "labels") else {})
        for view, schema in schemas.items()
    ]


def _entry(view: str, schema: pa.Schema, counts: Counts, names: Mapping[str, Sequence[str]]) -> dict[str, Any]:
    size = sum(size for _, size in counts.values())
    return {
        "config_name": view,
        "features": [{"name": field.name, **_feature(field, names.get(field.name))} for field in schema],
        "splits": [{"name": split, "num_bytes": size, "num_examples": rows} for split, (rows, size) in counts.items()],
        "download_size": size,
        "dataset_size": size,
    }


def _feature(field: pa.Field, names: Sequence[str] | None) -> dict[str, Any]:
    if names is not None:
        return {"dtype": {"class_label": {"names": {str(number): name for number, name in enumerate(names)}}}}
    kind = field.type
    if isinstance(kind, pa.FixedSizeListType):
        return {"list": _dtype(kind.value_type), "length": kind.list_size}
    if isinstance(kind, pa.ListType):
        return {"list": _dtype(kind.value_type)}
    return {"dtype": _dtype(kind)}


def _dtype(kind: pa.DataType) -> str:
    return DTYPES.get(kind) or str(kind)
