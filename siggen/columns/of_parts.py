"""Columns about one gear, shaft or mesh: their names and meanings are composed of the names of the gearbox."""

from __future__ import annotations

from dataclasses import replace

import pyarrow as pa

from siggen.keys.column import HERTZ, Column, Role, list_of
from siggen.names import GearName, MeshName, ShaftName

FAULTY_TEETH = Column("faulty_teeth_{}", list_of(pa.int32()), "", "indices of {}'s damaged teeth", Role.TARGET)
TEETH = Column("teeth_{}", pa.int32(), "", "number of teeth of {}")
MESH_HZ = Column("mesh_hz", pa.float64(), HERTZ, "tooth mesh frequency", quantity="mesh_hz")


def of_gear(column: Column, gear: GearName) -> Column:
    """Return a column, whose name and meaning leave a gear open as {}, about that gear."""
    return _named(column, gear.column, gear.called, gear.word, gear.inner_column)


def of_shaft(column: Column, shaft: ShaftName) -> Column:
    """Return a column, whose name and meaning leave a shaft open as {}, about that shaft."""
    return _named(column, shaft.word, shaft.called, shaft.word, shaft.inner)


def frequency_of(mesh: MeshName) -> Column:
    """Return name and meaning of the column of a mesh's frequency."""
    meaning = f"tooth mesh frequency of {mesh.word}" if mesh.word else "tooth mesh frequency"
    label = f"mesh_{mesh.inner}_hz" if mesh.inner else "mesh_hz"
    return replace(MESH_HZ, name=mesh.frequency, meaning=meaning, of=mesh.word, label=label)


def quantity_of(column: Column) -> str:
    """Return what a column holds whose name leaves open of what."""
    return "_".join(part for part in column.name.split("_") if part != "{}")


def _named(column: Column, in_name: str, called: str, of: str, in_label: str) -> Column:
    return replace(
        column,
        name=column.name.format(in_name),
        meaning=column.meaning.format(called),
        quantity=quantity_of(column),
        of=of,
        label=column.name.format(in_label),
    )
