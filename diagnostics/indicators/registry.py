"""All indicators of the package, in the order of the signal chain.

What people call the columns of indicators: `sideband_pinion_h2_upper1` is a sideband amplitude of the pinion.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from diagnostics.indicators import angle, average, cepstrum, history, level, sidebands
from diagnostics.indicators.indicator import INDICATORS, OF_CHANNEL, Indicator
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.channel_quantities import RECORDED
from diagnostics.records.gear_train import PAIR, GearNames, MeshNames
from diagnostics.signal.order_bands import ORDER_BANDS, band_name
from siggen.errors import UsageError

WORDS = {
    "shaft": "{}",
    "harmonic": "mesh harmonic {}",
    "harmonics": "mesh harmonics 1 to {}",
    "demodulated_harmonic": "mesh harmonic {}",
    "ratio_sidebands": "sidebands 1 to {}",
    "shaft_order": "order {}",
}

BANDS = {band_name(*band): band for band in ORDER_BANDS}

FILES = (level, cepstrum, average, history, sidebands, angle)
ALL: tuple[Indicator, ...] = tuple(
    entry for file in FILES for entry in INDICATORS if entry.function.__module__ == file.__name__
)
BY_NAME = {entry.name: entry for entry in ALL}


@dataclass(frozen=True, slots=True)
class IndicatorColumn:
    """What a column holds: an indicator of a mesh, or of one of its gears, and the fields by which it differs."""

    entry: Indicator
    mesh: MeshNames
    fields: Mapping[str, Any]
    of_first: bool

    @property
    def title(self) -> str:
        """What people call it, without its unit."""
        of_mesh = [mesh_words(self.mesh.name)] if self.entry.is_of_mesh and "shaft" not in self.fields else []
        return ", ".join([self.entry.title, *_words(dict(self.fields)), *filter(None, of_mesh)])


@cache
def indicator_columns(settings: IndicatorSettings, named: GearNames = PAIR) -> dict[str, IndicatorColumn]:
    """Return what every column of a channel holds, without the channel's name, those with a history too.

    Raises
    ------
    UsageError
        If names of gears make two columns one.
    """
    found = [
        (column, IndicatorColumn(entry, mesh, chosen, mesh is named[0]))
        for mesh in named
        for entry in ALL
        if entry.is_of_mesh or mesh is named[0]
        for column, chosen in entry.columns(settings, mesh)
    ]
    if twice := [name for name, count in Counter(name for name, _ in found).items() if count > 1]:
        raise UsageError(f"indicators: two of them are called {twice[0]}; give the gears and meshes other names")
    return dict(found)


def first_columns(settings: IndicatorSettings, named: GearNames, indicator: str, **fields: Any) -> tuple[str, ...]:
    """Return the columns of an indicator about the first gear, of a planetary set about each of its members."""
    gears = named[0].gears if named[0].planetary else named[0].gears[:1]
    return tuple(
        column
        for column, one in indicator_columns(settings, named).items()
        if one.entry.name == indicator
        and one.of_first
        and one.fields.get("shaft", gears[0]) in gears
        and all(one.fields[key] == value for key, value in fields.items())
    )


@cache
def taken_of(quantity: str) -> tuple[Indicator, ...]:
    """Return the indicators that a channel has which holds this quantity."""
    return tuple(entry for entry in ALL if entry.is_taken_of(quantity))


def check_quantity(column: str, known: Mapping[str, IndicatorColumn], quantities: Mapping[str, str]) -> None:
    """Check that a column with its channel is taken of what the channel holds; other columns pass.

    Parameters
    ----------
    column : str
        Such as `crest_factor__bearing_vertical`.
    known : mapping of str to IndicatorColumn
        As of `indicator_columns`.
    quantities : mapping of str to str
        What channels hold.

    Raises
    ------
    UsageError
        If the indicator is taken of other quantities.
    """
    name, _, channel = column.partition("__")
    one, held = known.get(name), quantities.get(channel)
    if one is None or held is None or one.entry.is_taken_of(held):
        return
    fitting = [name for name, quantity in quantities.items() if one.entry.is_taken_of(quantity)]
    there = f"a channel that holds it ({', '.join(fitting)})" if fitting else "a set with such a channel"
    raise UsageError(
        f"{column}: received channel {channel!r}, which holds {held}; {one.entry.name} is taken of "
        f"{' or '.join(one.entry.quantities)} alone. Name {there}, or another indicator: `table.names()` lists them."
    )


def indicator_titles(
    settings: IndicatorSettings, channel_unit: str = RECORDED.unit, named: GearNames = PAIR
) -> dict[str, str]:
    """Return the title of every column of a channel of this unit, with its unit, without the channel's name."""
    found: dict[str, str] = {}
    for column, one in indicator_columns(settings, named).items():
        unit = channel_unit if one.entry.unit == OF_CHANNEL else one.entry.unit
        found[column] = f"{one.title} [{unit}]" if unit else one.title
    return found


def column_title(column: str, named: GearNames) -> str:
    """Return what people call a column, by its name without the channel; the user's own keep their names."""
    one = indicator_columns(IndicatorSettings(), named).get(column)
    return one.title if one else column


def mesh_words(mesh: str) -> str:
    """Return a mesh as titles name it; one without a name is empty."""
    return f"mesh {mesh}" if mesh else ""


def indicator_definitions(settings: IndicatorSettings, named: GearNames = PAIR) -> dict[str, str]:
    """Return by column how the value is taken."""
    known = indicator_columns(settings, named)
    return {column: f"{one.entry.formula}; from {one.entry.signal}" for column, one in known.items()}


def _words(chosen: dict[str, Any]) -> list[str]:
    """Return what a column differs by, in words."""
    found = [WORDS[field].format(value) for field, value in chosen.items() if field in WORDS]
    if "sideband" in chosen:
        found.append(" ".join([*([chosen["side"]] if "side" in chosen else []), f"sideband {chosen['sideband']}"]))
    if "band" in chosen:
        found.append("orders {} to {}".format(*BANDS[chosen["band"]]))
    return found


def columns(settings: IndicatorSettings, quantity: str = RECORDED.word, named: GearNames = PAIR) -> tuple[str, ...]:
    """Return the columns of one channel that a record alone gives, without the channel's name."""
    return tuple(
        column
        for column, one in indicator_columns(settings, named).items()
        if one.entry.is_taken_of(quantity) and not one.entry.history
    )
