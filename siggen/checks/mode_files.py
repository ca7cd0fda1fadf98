"""Modes of a user's housing from a file into the configuration, so that a set stays a function of it alone."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from siggen.dynamics.structure.makers import SEATS_OF_SET
from siggen.errors import Problem
from siggen.gearbox.mode_table import BASE, DRIVE, ModeTable, mode_table, seats_of, shape_column
from siggen.gearbox.possible import PossibleGearbox
from siggen.keys.data_file import DataRefusal, named_content, shortened_path
from siggen.keys.problems import nearest
from siggen.sensing.inputs import MOTION

KEY = "housing.modes"


def with_mode_file(raw: Mapping[str, Any], folder: Path) -> tuple[Mapping[str, Any], list[Problem]]:
    """Return a configuration's mapping with the modes of the file that its housing names, and what is wrong with them.

    Parameters
    ----------
    raw : mapping, left as it is
    folder : Path from which the file's path counts
    """
    housing = raw.get("housing")
    if not isinstance(housing, Mapping) or housing.get("kind") != "modal":
        return raw, []
    name = housing.get("modes")
    if not isinstance(name, str) or "\n" in name:  # no path: nothing, or what a file held
        return raw, []
    try:
        # neither name nor folder is part of the set: the same modes elsewhere give the same identity
        return {**raw, "housing": {**housing, "modes": _read(name, folder).text}}, []
    except DataRefusal as refused:
        return raw, [Problem(KEY, refused.received, refused.allowed)]


def _read(name: str, folder: Path) -> ModeTable:
    try:
        return mode_table(named_content(name, folder).decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise DataRefusal(f"'{shortened_path(name)}', which is no text", "allowed: a CSV file in UTF-8") from None


def mode_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield what the modes of valid sections lack for their records."""
    config = gearbox.config
    if config.housing.kind != "modal" or "\n" not in config.housing.modes:  # a file that was not read
        return
    try:
        table = mode_table(config.housing.modes)
    except DataRefusal as refused:
        yield Problem(KEY, refused.received, refused.allowed)
        return
    present = (*map(shape_column, table.shapes), *table.base)
    for column, use in _needed(gearbox).items():
        if column not in present:
            allowed = f"allowed: a column of this name, for {use}"
            yield Problem(KEY, f"no column {column}", f"{allowed}{nearest(column, present)}")


def _needed(gearbox: PossibleGearbox) -> dict[str, str]:
    """Return the columns of seats, sensors and parts of the background, and what they are for."""
    config, background = gearbox.config, gearbox.config.background
    seats = seats_of(config.names) if config.planetary is None else SEATS_OF_SET
    found = dict.fromkeys(map(shape_column, seats), "the bearing forces")
    for sensor in config.sensors:
        places = (one.name.removeprefix("casing_") for one in sensor.shown_inputs if one.kind == MOTION)
        found |= {shape_column(place): f"the sensor {sensor.name}" for place in sorted(places)}
    if background is not None and background.auxiliary_drive is not None:
        found |= dict.fromkeys(map(shape_column, DRIVE), "background.auxiliary_drive, or leave that out (null)")
    if background is not None and background.base is not None:
        found |= dict.fromkeys(BASE, "background.base, or leave that out (null)")
    return found
