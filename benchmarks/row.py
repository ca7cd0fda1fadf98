"""Row: one line of the table, a cost beside that of a named alternative."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Row:
    """One line of the table.

    Attributes
    ----------
    what
        What was measured.
    measured, alternative
        Cost of siggen, and of what it is compared with (named), as text.
    ratio
        Alternative over siggen (how many times siggen is cheaper) unless `what` says otherwise; None without one.
    goal
        The bound that the measurement should keep, as text; empty without one.
    met
        Whether it does; None without a goal.
    numbers
        What a figure is drawn from, by name; None without.
    """

    what: str
    measured: str
    alternative: str = ""
    ratio: float | None = None
    goal: str = ""
    met: bool | None = None
    numbers: Mapping[str, float | str | bool] | None = None


def cost_row(what: str, cost_s: float, alternative: str, alternative_s: float, goal_s: float | None = None) -> Row:
    """Return the row of a time [s] against the time of an alternative [s], with an upper bound [s] as its goal."""
    return Row(
        what=what,
        measured=duration_text(cost_s),
        alternative=f"{alternative}: {duration_text(alternative_s)}",
        ratio=alternative_s / cost_s,
        goal="" if goal_s is None else f"<= {duration_text(goal_s)}",
        met=None if goal_s is None else cost_s <= goal_s,
    )


def duration_text(time_s: float) -> str:
    """Return a time with three digits in s, ms or us."""
    for unit, factor in (("s", 1.0), ("ms", 1e3)):
        if time_s * factor >= 1.0:
            return f"{time_s * factor:.3g} {unit}"
    return f"{time_s * 1e6:.3g} us"
