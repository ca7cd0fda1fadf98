"""Indicators as people call them, with their definitions on hover and a link to the table of definitions."""

from __future__ import annotations

import textwrap
from functools import cache

from diagnostics.indicators.indicator import base_name
from diagnostics.indicators.indicator_titles import indicator_titles
from diagnostics.indicators.registry import BY_NAME
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.page.html import Cell

AXES = ("vertical", "horizontal", "tangential", "axial")
"""As channels of simulated sensors end."""


@cache
def _titles() -> dict[str, str]:
    return indicator_titles(IndicatorSettings())


def column_title(column: str) -> str:
    """Return what people call a column; the user's own indicators keep their names."""
    name = column.partition("__")[0]
    return _titles().get(name, name).rsplit(" [", 1)[0]


def channel_title(channel: str) -> str:
    """Return what people call a channel: sensor and axis (`lid_vertical` is lid, vertical); other names as they are."""
    sensor, _, axis = channel.rpartition("_")
    return f"{sensor.replace('_', ' ')}, {axis}" if sensor and axis in AXES else channel


def term_cell(column: str) -> Cell:
    """Return the cell that names a column: its title, which leads to the definition, its channel and its own name."""
    known = BY_NAME.get(base_name(column))
    channel = column.partition("__")[2]
    small = f"{channel_title(channel)}; {column.partition('__')[0]}" if channel else column
    return Cell(column_title(column), small, link=f"#term-{known.name}" if known else "")


def in_a_sentence(column: str) -> str:
    """Return a column as a sentence names it: its title in small letters where it is no acronym, and its channel."""
    title, channel = column_title(column), column.partition("__")[2]
    if title[1:2].islower():
        title = title[:1].lower() + title[1:]
    return f"{title} at {channel_title(channel)}" if channel else title


def panel_title(column: str, width: int = 38) -> str:
    """Return title and channel of a column for a figure, in lines of at most so many signs."""
    title, channel = column_title(column), column.partition("__")[2]
    return "\n".join(textwrap.wrap(f"{title} ({channel_title(channel)})" if channel else title, width))
