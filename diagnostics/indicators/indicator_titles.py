"""What people call the columns of indicators: `sideband_pinion_h2_upper1` is a sideband amplitude of the pinion."""

from __future__ import annotations

from itertools import product
from typing import Any

from diagnostics.indicators.registry import ALL
from diagnostics.indicators.settings import IndicatorSettings

WORDS = {
    "shaft": "{}",
    "harmonic": "mesh harmonic {}",
    "harmonics": "mesh harmonics 1 to {}",
    "demodulated_harmonic": "mesh harmonic {}",
    "ratio_sidebands": "sidebands 1 to {}",
}


def indicator_titles(settings: IndicatorSettings) -> dict[str, str]:
    """Return the title of every column of one channel, with its unit, without the channel's name."""
    found: dict[str, str] = {}
    for entry in ALL:
        for values in product(*(settings.choices(field) for field in entry.fields)):
            chosen: dict[str, Any] = dict(zip(entry.fields, values, strict=True))
            title = ", ".join([entry.title, *_words(chosen)])
            found[entry.column.format(**chosen)] = f"{title} [{entry.unit}]" if entry.unit else title
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
