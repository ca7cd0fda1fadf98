"""Columns about the background of a healthy machine, part of the labels of `siggen.columns.record`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.columns.of_parts import of_gear, of_shaft
from siggen.keys.column import Column, Role, in_role
from siggen.names import MACHINES

if TYPE_CHECKING:
    from siggen.gearbox.specimen import Specimen

F64 = pa.float64()

RUBBING = (
    Column("rubbing_force_n", F64, "N", "rms of the rubbing force along the line of action, without bursts"),
    Column("rubbing_asperity_share", F64, "", "share of the mean load that asperities carry at the pitch point"),
    Column("rubbing_level_std", F64, "", "s of the rubbing's random level exp(s U - s^2/2)"),
)
DEPTH = Column("rubbing_{}_depth", F64, "", "modulation of the rubbing by the shaft of {}")
VELOCITY = Column(
    "bearing_velocity_{}_um_s", F64, "um/s", "waviness of the bearings of {}, 1800 to 10000 Hz at 30 turns/s"
)
COUPLING = Column("coupling_force_{}_n", F64, "N", "once per turn, of the misaligned coupling on {}")
MACHINE = Column(
    "machine_force_n_per_sqrt_hz", F64, "N/sqrt(Hz)", "noise of the force of each machine beside, above its low corner"
)


def background_columns(gearbox: Specimen) -> tuple[Column, ...]:
    """Return the columns of the parts that the background of a gearbox has; none without one."""
    drawn = gearbox.background
    if drawn is None:
        return ()
    names, columns = gearbox.names, list[Column]()
    if drawn.bearings:
        columns += [of_shaft(VELOCITY, shaft) for shaft in names.shafts]
    if drawn.machines is not None:
        columns.append(MACHINE)
    if drawn.rubbing is not None:
        columns += [*RUBBING, *(of_gear(DEPTH, gear) for gear in names.first.gears)]
    if drawn.shafts:
        columns += [of_shaft(COUPLING, names.shafts[place]) for place in MACHINES.values()]
    for name in drawn.foreign:
        what = " ".join(name.split("_"))
        columns.append(Column(f"{name}_order", F64, "", f"mesh of the {what}, per turn of the input shaft"))
        columns.append(Column(f"{name}_force_n", F64, "N", f"first line of the {what}"))
    if drawn.rubbing is not None and drawn.rubbing.bursts is not None:
        columns.append(Column("burst_count", pa.int32(), "", "bursts of the rubbing that begin within the record"))
    return in_role(Role.PROVENANCE, *columns, section="background")
