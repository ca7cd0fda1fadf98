"""Columns of what a gearbox draws as a whole: its gear pair, its oil, where its sensors are."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.keys.column import Column, Role, in_role

if TYPE_CHECKING:
    from siggen.config import Config

MILLIMETRE = "mm"
PAIR_COLUMNS = in_role(
    Role.CONDITION,
    Column("pair", pa.int32(), "", "index of the gear pair in `gears.pairs` of config.yaml"),
    Column("module_mm", pa.float64(), MILLIMETRE, "normal module"),
    Column("face_width_mm", pa.float64(), MILLIMETRE, "width of the teeth in contact"),
    Column("centre_distance_mm", pa.float64(), MILLIMETRE, "working centre distance"),
    Column("contact_ratio", pa.float64(), "", "transverse contact ratio of the unloaded pair"),
    section="gears",
)
"""Columns of sets with several gear pairs."""
HOUSING_COLUMNS = in_role(
    Role.PROVENANCE,
    Column("housing_mass_kg", pa.float64(), "kg", "mass of the housing, without gears and shafts"),
    Column(
        "housing_first_mode_hz",
        pa.float64(),
        "Hz",
        "lowest mode of the housing above the six on its bolts",
    ),
    section="housing",
)
"""Columns of sets whose housings are drawn from their geometry."""
OIL_COLUMN = Column("oil", pa.string(), "", "oil of the gearbox", Role.CONDITION, "dynamics")


def gearbox_columns(config: Config) -> tuple[Column, ...]:
    """Return the columns of what gearboxes draw as a whole; none for what they share."""
    return (
        *(PAIR_COLUMNS if config.gears.pairs else ()),
        *((OIL_COLUMN,) if draws_oil(config) else ()),
        *(HOUSING_COLUMNS if config.has_plates else ()),
        *(
            Column(name, pa.float64(), MILLIMETRE, _place_text(config, i, axis), Role.CONDITION, "sensors")
            for i, axis, name in drawn_places(config)
        ),
    )


def _place_text(config: Config, i: int, axis: int) -> str:
    return f"{('first', 'second')[axis]} distance of the sensor {config.sensors[i].name} from where its place counts"


def draws_oil(config: Config) -> bool:
    """Tell whether gearboxes draw their oil."""
    return isinstance(config.dynamics.friction.oil, tuple)


def drawn_places(config: Config) -> Iterator[tuple[int, int, str]]:
    """Yield sensor, axis and column of every coordinate that gearboxes draw; all of them in a set of several pairs."""
    for i, sensor in enumerate(config.sensors):
        for axis, number in enumerate(sensor.place_on_casing_mm):
            if config.gears.pairs or not isinstance(number, float):
                yield i, axis, f"position_{'xy'[axis]}_{sensor.name}_mm"
