"""Column: name, type, unit and meaning of one column of a data set."""

from __future__ import annotations

from dataclasses import dataclass

import pyarrow as pa

MILLIMETRE, MICROMETRE, HERTZ, DECIBEL = "mm", "um", "Hz", "dB"


@dataclass(frozen=True, slots=True)
class Column:
    """Name, Arrow type, unit and meaning of one column."""

    name: str
    type: pa.DataType
    unit: str
    meaning: str

    def field(self) -> pa.Field:
        """Return the Arrow field; no column of a set holds nulls."""
        metadata = {"unit": self.unit, "meaning": self.meaning}
        return pa.field(self.name, self.type, nullable=False, metadata={k: v for k, v in metadata.items() if v})


def list_of(value: pa.DataType, size: int = -1) -> pa.DataType:
    """Return a list type whose elements are not null; 'element' is the name Parquet gives them."""
    return pa.list_(pa.field("element", value, nullable=False), size)
