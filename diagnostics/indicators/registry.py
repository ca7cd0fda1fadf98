"""All indicators of the package, in the order of the signal chain; the table in the documentation is made from them.

What people call the columns of indicators: `sideband_pinion_h2_upper1` is a sideband amplitude of the pinion.
"""

from __future__ import annotations

from itertools import product
from typing import Any

from diagnostics.indicators import average, cepstrum, history, level, sidebands
from diagnostics.indicators.indicator import INDICATORS, OF_CHANNEL, Indicator
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.channel_quantities import RECORDED

WORDS = {
    "shaft": "{}",
    "harmonic": "mesh harmonic {}",
    "harmonics": "mesh harmonics 1 to {}",
    "demodulated_harmonic": "mesh harmonic {}",
    "ratio_sidebands": "sidebands 1 to {}",
}

FILES = (level, cepstrum, average, history, sidebands)
ALL: tuple[Indicator, ...] = tuple(
    entry for file in FILES for entry in INDICATORS if entry.function.__module__ == file.__name__
)
BY_NAME = {entry.name: entry for entry in ALL}


def indicator_titles(settings: IndicatorSettings, channel_unit: str = RECORDED.unit) -> dict[str, str]:
    """Return the title of every column of a channel of this unit, with its unit, without the channel's name."""
    found: dict[str, str] = {}
    for entry in ALL:
        for values in product(*(settings.choices(field) for field in entry.fields)):
            chosen: dict[str, Any] = dict(zip(entry.fields, values, strict=True))
            title = ", ".join([entry.title, *_words(chosen)])
            unit = channel_unit if entry.unit == OF_CHANNEL else entry.unit
            found[entry.column.format(**chosen)] = f"{title} [{unit}]" if unit else title
    return found


def indicator_definitions(settings: IndicatorSettings) -> dict[str, str]:
    """Return by column how the value is taken."""
    return {
        entry.column.format(**dict(zip(entry.fields, values, strict=True))): f"{entry.formula}; from {entry.signal}"
        for entry in ALL
        for values in product(*(settings.choices(field) for field in entry.fields))
    }


def _words(chosen: dict[str, Any]) -> list[str]:
    """Return what a column differs by, in words."""
    found = [WORDS[field].format(value) for field, value in chosen.items() if field in WORDS]
    if "sideband" in chosen:
        found.append(" ".join([*([chosen["side"]] if "side" in chosen else []), f"sideband {chosen['sideband']}"]))
    if "band" in chosen:
        found.append("orders " + str(chosen["band"]).removeprefix("o").replace("_", " to "))
    return found


def definition_table() -> str:
    """Return all definitions as a Markdown table."""
    head = "| column starts with | indicator | taken from | value | unit | on known signals | undefined when | source |"
    rows = [
        f"| `{d.name}` | {d.title} | {d.signal} | {_cell(d.formula)} | {d.unit or '-'} | {d.known} | {d.undefined} | "
        f"{d.source} |"
        for d in ALL
    ]
    return "\n".join([head, "|---|---|---|---|---|---|---|---|", *rows])


def _cell(text: str) -> str:
    """Return text in which a bar does not end a cell."""
    return text.replace("|", "\\|")


def columns(settings: IndicatorSettings) -> tuple[str, ...]:
    """Return the columns of one channel that a record alone gives, without the channel's name."""
    return tuple(
        entry.column.format(**dict(zip(entry.fields, chosen, strict=True)))
        for entry in ALL
        if not entry.history
        for chosen in product(*(settings.choices(field) for field in entry.fields))
    )
