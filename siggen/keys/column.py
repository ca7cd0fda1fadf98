"""Column: name, type, unit, meaning and role of one column of a data set."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

import pyarrow as pa

MILLIMETRE, MICROMETRE, HERTZ, DECIBEL = "mm", "um", "Hz", "dB"


class Role(StrEnum):
    """What a column is to whoever learns from a set, or looks for what gives a state away."""

    KEY = "key"
    """Names a record, or what it belongs to."""
    SIGNAL = "signal"
    """What a sensor gave."""
    CONDITION = "condition"
    """Known to a user beside the signal, such as speed, load and teeth; must not tell the state."""
    MEASURED = "measured"
    """What a user can compute from the signal."""
    CONSEQUENCE = "consequence"
    """Follows from the damage, and is known to the simulation alone."""
    TARGET = "target"
    """What the damage is: to be predicted."""
    PROVENANCE = "provenance"
    """What was drawn for gearbox or record, known to the simulation alone; must not tell the state."""


@dataclass(frozen=True, slots=True)
class Column:
    """Name, Arrow type, unit and meaning of one column.

    Attributes
    ----------
    role : Role, optional
        None only of series that no sensor sees, which stand in a table of their own.
    section : str
        Section of the configuration that says how it is drawn; empty where none does.
    quantity, of : str
        What it holds, and of which gear, shaft or mesh, by the user's name; empty where the name says it all.
    label : str
        What the simulation calls its value; empty: as the column.
    """

    name: str
    type: pa.DataType
    unit: str
    meaning: str
    role: Role | None = None
    section: str = ""
    quantity: str = ""
    of: str = ""
    label: str = ""

    def field(self) -> pa.Field:
        """Return the Arrow field; no column of a set holds nulls."""
        metadata = {
            "unit": self.unit, "meaning": self.meaning, "role": self.role or "", "section": self.section,
            "quantity": self.quantity, "of": self.of,
        }  # fmt: skip
        return pa.field(self.name, self.type, nullable=False, metadata={k: v for k, v in metadata.items() if v})


def in_role(role: Role, *columns: Column, section: str = "") -> tuple[Column, ...]:
    """Return columns in one role, drawn by one section; what a column says of itself stays."""
    return tuple(replace(one, role=one.role or role, section=one.section or section) for one in columns)


def list_of(value: pa.DataType, size: int = -1) -> pa.DataType:
    """Return a list type whose elements are not null; 'element' is the name Parquet gives them."""
    return pa.list_(pa.field("element", value, nullable=False), size)
