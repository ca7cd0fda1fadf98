"""What sets that tests make in memory say of their columns: what siggen's own are, others are conditions."""

from __future__ import annotations

from typing import Any, ClassVar

import pyarrow as pa

from diagnostics.records.gear_train import pair_train
from siggen.columns.labels import INTEGRATION_COLUMNS, operating_columns, target_columns, variation_columns
from siggen.columns.record import ID_COLUMNS
from siggen.gearbox.labels import SHAM
from siggen.keys.column import Column, Role
from siggen.names import PAIR

OF_CHANNELS = (
    Column("snr_lid_x_db", pa.float64(), "dB", "", Role.CONSEQUENCE, "sensors"),
    Column("noise_floor_lid_x_m_s2", pa.float64(), "", "", Role.PROVENANCE, "sensors"),
    Column("pitch_error_um", pa.float64(), "um", "", Role.PROVENANCE, "manufacture"),
)
COLUMNS = (
    *ID_COLUMNS,
    *target_columns(PAIR),
    *operating_columns(PAIR),
    *variation_columns(PAIR),
    *INTEGRATION_COLUMNS,
    *OF_CHANNELS,
)
LISTED = {column.name: column for column in (*COLUMNS, SHAM)}


class ListedRoles:
    """What `siggen.open` says of the columns of a set, and of its pair of gears."""

    drivetrain = pair_train((18, 47))
    gears: ClassVar[dict[str, Any]] = {}

    def role(self, name: str) -> Role:
        return LISTED[name].role or Role.CONDITION if name in LISTED else Role.CONDITION

    def section(self, name: str) -> str:
        return LISTED[name].section if name in LISTED else ""

    def columns_of(self, quantity: str) -> dict[str, str]:
        return {column.of: column.name for column in COLUMNS if column.quantity == quantity}
