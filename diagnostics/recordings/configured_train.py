"""The drivetrain of a machine by its configuration, for recordings."""

from __future__ import annotations

from pathlib import Path

import siggen
from siggen.columns.drivetrain import GearTrain
from siggen.errors import UsageError


def configured_train(file: Path) -> GearTrain:
    """Return the drivetrain of the gearbox that a configuration describes.

    Parameters
    ----------
    file : Path
        As `siggen init` writes it, with or without `planetary`, or a `machine`; anything of it but teeth
        and places of planets counts nothing.

    Raises
    ------
    UsageError
        If its gears are drawn.
    ConfigError
        If it cannot be used.
    """
    design = siggen.load_config(file)
    if design.pairs:
        raise UsageError(f"{file}: gears: received gears that differ within a set; allowed: one pair of known teeth")
    return siggen.draw(design).drivetrain
