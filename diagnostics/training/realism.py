"""What scores on a set can and cannot show, read off its configuration."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

MANUFACTURE_KEY = "manufacture"


def is_error_free(config: Mapping[str, Any]) -> bool:
    """Return whether the set's gears have no manufacturing errors: no such section, or an empty one."""
    return not config.get(MANUFACTURE_KEY)


def meaning_of_scores(config: Mapping[str, Any], *, scored: bool = True) -> str:
    """Return the sentence that has to stand before any score of the set, or say that there is none."""
    if not scored:
        return (
            "This page has no scores, for the reason in the notes at its end, so it shows nothing about how well the "
            "damage could be found, neither in simulation nor on a real machine"
            + (
                "; the gears of this set have no manufacturing errors: healthy records are free of sidebands."
                if is_error_free(config)
                else "."
            )
        )
    if is_error_free(config):
        return (
            "These scores show that the simulated damage reaches the signals and that the evaluation is "
            "sound; they do not "
            "show that such damage could be found on a real machine, because the gears of this set have no "
            "manufacturing "
            "errors: healthy records are free of sidebands, so that whatever damage rises above the noise "
            "separates trivially."
        )
    return (
        "These scores show how well the damage of this set is told apart on simulated gearboxes that were "
        "not trained on, "
        "with manufacturing errors drawn anew for each; they do not show how well it would be found on a real machine, "
        "which differs from all of them."
    )
