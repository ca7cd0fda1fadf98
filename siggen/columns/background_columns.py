"""Columns about the background of a healthy machine, part of the labels of `siggen.columns.record`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.columns.planetary_columns import in_words_of_set
from siggen.keys.column import Column, Role, in_role

if TYPE_CHECKING:
    from siggen.config import Config

RUBBING = (
    ("rubbing_force_n", "N", "rms of the rubbing force along the line of action, without bursts, all frequencies"),
    ("rubbing_asperity_share", "", "share of the mean load that asperities carry at the pitch point"),
    ("rubbing_level_std", "", "s of the rubbing's random level exp(s U - s^2/2)"),
    ("rubbing_pinion_depth", "", "modulation of the rubbing by the pinion's shaft"),
    ("rubbing_gear_depth", "", "modulation of the rubbing by the gear's shaft"),
)
BEARINGS = tuple(
    (f"bearing_velocity_{shaft}_um_s", "um/s", f"waviness of the {shaft}'s bearings, 1800 to 10000 Hz at 30 turns/s")
    for shaft in ("pinion", "gear")
)
MACHINES = (
    ("machine_force_n_per_sqrt_hz", "N/sqrt(Hz)", "noise of the force of each machine beside, above its low corner"),
)
SHAFTS = tuple(
    (f"coupling_force_{shaft}_n", "N", f"once per turn, of the misaligned coupling on the {shaft}'s shaft")
    for shaft in ("pinion", "gear")
)


def background_columns(config: Config) -> tuple[Column, ...]:
    """Return the columns of the parts that a configuration has; none without the section `background`."""
    section = config.background
    if section is None:
        return ()
    parts = {"bearings": BEARINGS, "machines": MACHINES, "rubbing": RUBBING, "shafts": SHAFTS}
    numbers = [one for part, columns in parts.items() if getattr(section, part) is not None for one in columns]
    for name in ("second_stage", "auxiliary_drive"):
        if getattr(section, name) is not None:
            what = name.replace("_", " ")
            numbers.append((f"{name}_order", "", f"mesh of the {what}, per turn of the pinion"))
            numbers.append((f"{name}_force_n", "N", f"first line of the {what}"))
    columns = [Column(name, pa.float64(), unit, meaning) for name, unit, meaning in numbers]
    if section.rubbing is not None and section.rubbing.bursts is not None:
        columns.append(Column("burst_count", pa.int32(), "", "bursts of the rubbing that begin within the record"))
    return in_words_of_set(config, in_role(Role.PROVENANCE, *columns, section="background"))
