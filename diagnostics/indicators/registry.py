"""All indicators of the package, in the order of the signal chain; the table in the documentation is made from them."""

from __future__ import annotations

from itertools import product

# importing a file puts its indicators into the list, in this order
from diagnostics.indicators import average, cepstrum, history, level, modulation, order_bands, sidebands
from diagnostics.indicators.indicator import INDICATORS, Indicator
from diagnostics.indicators.settings import IndicatorSettings

FILES = (level, cepstrum, average, history, sidebands, modulation, order_bands)
ALL: tuple[Indicator, ...] = tuple(
    entry for file in FILES for entry in INDICATORS if entry.function.__module__ == file.__name__
)
BY_NAME = {entry.name: entry for entry in ALL}


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
