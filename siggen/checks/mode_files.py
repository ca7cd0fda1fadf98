"""Modes of a user's housing from a file into the configuration, so that a set stays a function of it alone."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from siggen.config import Background, ModalHousing
from siggen.config.data_file import data_file_bytes, shortened_path
from siggen.config.short_form import names_in
from siggen.dynamics.structure.makers import SEATS_OF_SET
from siggen.errors import Problem
from siggen.gearbox.mode_table import BASE, DRIVE, ModesRefusal, ModeTable, mode_table, seats_of, shape_column
from siggen.keys.problems import nearest
from siggen.sensing.inputs import MOTION
from siggen.sensors.sensor import SensorBase

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
    except ModesRefusal as refused:
        return raw, [Problem(KEY, refused.received, refused.allowed)]


def _read(name: str, folder: Path) -> ModeTable:
    try:
        return mode_table(data_file_bytes(folder / name).decode("utf-8-sig"))
    except OSError as error:
        received = f"'{shortened_path(name)}', which cannot be read ({error.strerror})"
        raise ModesRefusal(received, f"allowed: a file in {folder}") from None
    except UnicodeDecodeError:
        raise ModesRefusal(f"'{shortened_path(name)}', which is no text", "allowed: a CSV file in UTF-8") from None


def mode_problems(sections: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield what the modes of valid sections lack for their records."""
    housing = sections.get("housing")
    if not isinstance(housing, ModalHousing) or "\n" not in housing.modes:  # a file that was not read
        return
    try:
        table = mode_table(housing.modes)
    except ModesRefusal as refused:
        yield Problem(KEY, refused.received, refused.allowed)
        return
    present = (*map(shape_column, table.shapes), *table.base)
    sensors = tuple(sections.get("sensors", {}).values())
    planetary = sections.get("planetary") is not None
    names = names_in(sections.get("machine"), planetary=planetary)
    seats = SEATS_OF_SET if planetary else seats_of(names)
    for column, use in {**_needed(sensors, seats), **_needed_behind(sections.get("background"))}.items():
        if column not in present:
            allowed = f"allowed: a column of this name, for {use}"
            yield Problem(KEY, f"no column {column}", f"{allowed}{nearest(column, present)}")


def _needed(sensors: tuple[SensorBase, ...], seats: tuple[str, ...]) -> dict[str, str]:
    """Return the columns of seats and sensors, and what they are for."""
    found = dict.fromkeys(map(shape_column, seats), "the bearing forces")
    for sensor in sensors:
        places = (one.name.removeprefix("casing_") for one in sensor.shown_inputs if one.kind == MOTION)
        found |= {shape_column(place): f"the sensor {sensor.name}" for place in sorted(places)}
    return found


def _needed_behind(background: Background | None) -> dict[str, str]:
    found: dict[str, str] = {}
    if background is not None and background.auxiliary_drive is not None:
        found |= dict.fromkeys(map(shape_column, DRIVE), "background.auxiliary_drive, or leave that out (null)")
    if background is not None and background.base is not None:
        found |= dict.fromkeys(BASE, "background.base, or leave that out (null)")
    return found
