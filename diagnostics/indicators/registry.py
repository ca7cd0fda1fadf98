"""All indicators of the package, in the order of the signal chain.

What people call the columns of indicators: `sideband_pinion_h2_upper1` is a sideband amplitude of the pinion.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from typing import Any

from diagnostics.indicators import angle, average, cepstrum, history, level, sidebands
from diagnostics.indicators.indicator import INDICATORS, OF_CHANNEL, Indicator, base_name, of_mesh
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.channel_quantities import RECORDED
from diagnostics.records.gear_train import PAIR, GearNames
from diagnostics.records.planetary_members import MEMBERS
from siggen.errors import UsageError

WORDS = {
    "shaft": "{}",
    "harmonic": "mesh harmonic {}",
    "harmonics": "mesh harmonics 1 to {}",
    "demodulated_harmonic": "mesh harmonic {}",
    "ratio_sidebands": "sidebands 1 to {}",
    "shaft_order": "order {}",
}

FILES = (level, cepstrum, average, history, sidebands, angle)
ALL: tuple[Indicator, ...] = tuple(
    entry for file in FILES for entry in INDICATORS if entry.function.__module__ == file.__name__
)
BY_NAME = {entry.name: entry for entry in ALL}


@cache
def taken_of(quantity: str) -> tuple[Indicator, ...]:
    """Return the indicators that a channel has which holds this quantity."""
    return tuple(entry for entry in ALL if entry.is_taken_of(quantity))


def check_quantity(column: str, quantities: Mapping[str, str]) -> None:
    """Check that a column with its channel is taken of what the channel holds; other columns pass.

    Parameters
    ----------
    column : str
        Such as `crest_factor__bearing_vertical`.
    quantities : mapping of str to str
        What channels hold.

    Raises
    ------
    UsageError
        If the indicator is taken of other quantities.
    """
    _, _, channel = column.partition("__")
    entry, held = BY_NAME.get(base_name(column)), quantities.get(channel)
    if entry is None or held is None or entry.is_taken_of(held):
        return
    fitting = [name for name, quantity in quantities.items() if entry.is_taken_of(quantity)]
    there = f"a channel that holds it ({', '.join(fitting)})" if fitting else "a set with such a channel"
    raise UsageError(
        f"{column}: received channel {channel!r}, which holds {held}; {entry.name} is taken of "
        f"{' or '.join(entry.quantities)} alone. Name {there}, or another indicator: `table.names()` lists them."
    )


def indicator_titles(
    settings: IndicatorSettings, channel_unit: str = RECORDED.unit, named: GearNames = PAIR
) -> dict[str, str]:
    """Return the title of every column of a channel of this unit, with its unit, without the channel's name."""
    found: dict[str, str] = {}
    for mesh, entry, column, chosen in _every(settings, ALL, named):
        title = ", ".join([entry.title, *_words(chosen), *([mesh_words(mesh)] if mesh else [])])
        unit = channel_unit if entry.unit == OF_CHANNEL else entry.unit
        found[of_mesh(column, mesh)] = f"{title} [{unit}]" if unit else title
    return found


def _every(
    settings: IndicatorSettings, entries: Iterable[Indicator], named: GearNames
) -> Iterator[tuple[str, Indicator, str, dict[str, Any]]]:
    """Yield mesh, indicator, column as the first mesh has it, and the fields by which it differs."""
    known = tuple(entries)
    for mesh in ("", *named.meshes):
        for entry in known:
            if entry.is_of_mesh or not mesh:
                for column, chosen in entry.columns(settings, named.shafts):
                    yield mesh, entry, column, chosen


def mesh_words(mesh: str) -> str:
    """Return a further mesh, or a member of a planetary set, as titles name it."""
    return mesh if mesh in MEMBERS else f"mesh {mesh}"


def indicator_definitions(settings: IndicatorSettings, named: GearNames = PAIR) -> dict[str, str]:
    """Return by column how the value is taken."""
    return {
        of_mesh(column, mesh): f"{entry.formula}; from {entry.signal}"
        for mesh, entry, column, _ in _every(settings, ALL, named)
    }


def _words(chosen: dict[str, Any]) -> list[str]:
    """Return what a column differs by, in words."""
    found = [WORDS[field].format(value) for field, value in chosen.items() if field in WORDS]
    if "sideband" in chosen:
        found.append(" ".join([*([chosen["side"]] if "side" in chosen else []), f"sideband {chosen['sideband']}"]))
    if "band" in chosen:
        found.append("orders " + str(chosen["band"]).removeprefix("o").replace("_", " to "))
    return found


def columns(settings: IndicatorSettings, quantity: str = RECORDED.word, named: GearNames = PAIR) -> tuple[str, ...]:
    """Return the columns of one channel that a record alone gives, without the channel's name."""
    taken = (entry for entry in taken_of(quantity) if not entry.history)
    return tuple(of_mesh(column, mesh) for mesh, _, column, _ in _every(settings, taken, named))
