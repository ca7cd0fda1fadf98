"""What scores on a set can and cannot show, read off its configuration."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

MANUFACTURE_KEY = "manufacture"


def is_error_free(config: Mapping[str, Any]) -> bool:
    """Return whether the set's gears have no manufacturing errors: no such section, or an empty one."""
    return not config.get(MANUFACTURE_KEY)


def meaning_of_scores(config: Mapping[str, Any], *, scored: bool = True) -> str:
    """Return the sentences that have to stand before any score of the set, or say that there is none."""
    error_free = is_error_free(config)
    if not scored:
        sideband_free = " The gears have no manufacturing errors: healthy records are free of sidebands."
        return (
            "This page has no scores. The notes at its end give the reason. It shows nothing about how well the damage "
            f"could be found, neither in simulation nor on a real machine.{sideband_free if error_free else ''}"
        )
    if error_free:
        return (
            "These scores show that the simulated damage reaches the signals and that the evaluation is sound. They do "
            "not show that such damage could be found on a real machine. The gears of this set have no manufacturing "
            "errors: healthy records are free of sidebands. Any damage that rises above the noise is therefore "
            "trivial to separate."
        )
    return (
        "These scores show how well the damage of this set is found on simulated gearboxes that were not used for "
        "training. Each gearbox has its own manufacturing errors. The scores do not show how well the damage would be "
        "found on a real machine, which differs from all of these gearboxes."
    )
