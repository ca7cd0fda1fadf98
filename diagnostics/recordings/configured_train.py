"""The meshes of a machine by its configuration: teeth of all stages, or of a planetary set with its planets' places."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import siggen
from diagnostics.records.gear_train import GEARS, Mesh, gear_train, teeth_columns
from diagnostics.records.planetary_members import Planets, planet_labels
from siggen.errors import UsageError


def configured_train(file: Path) -> tuple[Mesh, ...]:
    """Return the meshes of the gearbox that a configuration describes, the first one first.

    Parameters
    ----------
    file : Path
        As `siggen init` writes it, with or without `stages` or `planetary`, or a `machine`; anything of it but teeth
        and places of planets counts nothing.

    Raises
    ------
    UsageError
        If its gears are drawn.
    ConfigError
        If it cannot be used.
    """
    config = siggen.load_config(file)
    if config.gears.pairs:
        raise UsageError(f"{file}: gears: received gears that differ within a set; allowed: one pair of known teeth")
    return config_train(config)


def config_train(config: Any) -> tuple[Mesh, ...]:
    """Return the meshes of a configuration of one gearbox of known teeth."""
    pinion, gear = config.gears.pinion.teeth, config.gears.gear.teeth
    if (planetary := config.planetary) is not None:
        places = tuple(float(degrees) / 360.0 for degrees in planetary.positions_deg)
        return gear_train(planet_labels(Planets((pinion, gear, planetary.ring_teeth), places)))
    labels = {"teeth_pinion": pinion, "teeth_gear": gear}
    for stage in config.stages:
        labels |= zip(teeth_columns([stage.name]), (getattr(stage.gears, name).teeth for name in GEARS), strict=True)
    return gear_train(labels)
