"""What `siggen plan` says of gearboxes that run to failure: ages of their ends, what has pitted then, inspections."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.table import Table

    from siggen.config import Config

QUANTILES = (0.05, 0.5, 0.95)
MOST_LIVES = 200
"""Gearboxes whose lives are worked out for the table."""
ENDS = {"first_pit": "first pit", "rated": "rated damage", "functional": "functional end"}


def life_summary(config: Config) -> dict[str, Any] | None:
    """Return quantiles of what ends the lives of the first gearboxes of a set; None for a set of states."""
    if config.life is None:
        return None
    import numpy as np

    from siggen.planning.gearbox import gearbox_life

    lives = [gearbox_life(config, i) for i in range(min(config.specimens, MOST_LIVES))]

    def spread(values: list[float]) -> list[float]:
        return [float(value) for value in np.quantile(values, QUANTILES)]

    ends = {name: [one.clock.age_h(getattr(one.course.ends, name)) for one in lives] for name in ENDS}
    return {
        "lives": len(lives),
        "quantiles": list(QUANTILES),
        "age_h": {name: spread(ages) for name, ages in ends.items()},
        "slope": {name: _slope(ages) for name, ages in ends.items()},
        "pitted_teeth_at_end": spread([len(one.course.teeth(one.course.ends.functional)) for one in lives]),
        "inspections": spread([len(one.ages_h) for one in lives]),
        "failed": sum(one.event == "failed" for one in lives),
        "pitted_in_schedule": sum(one.observed_h > age for one, age in zip(lives, ends["first_pit"], strict=True)),
    }


def life_doubts(summary: dict[str, Any] | None) -> list[str]:
    """Return what makes a schedule useless."""
    if summary is None or summary["failed"]:
        return []
    lives, last = f"no gearbox of {summary['lives']}", "before its last inspection (life.interval_h, life.most)"
    pit_h, end_h = (summary["age_h"][name][1] for name in ("first_pit", "functional"))
    if not summary["pitted_in_schedule"]:
        return [f"{lives} has a pit {last}: half of them have their first at {pit_h:.4g} h"]
    return [f"{lives} fails {last}: half of them would at {end_h:.4g} h"]


def _slope(ages_h: list[float]) -> float | None:
    """Return the Weibull slope of ages by maximum likelihood; None for fewer than two different ones."""
    from scipy.stats import weibull_min

    return float(weibull_min.fit(ages_h, floc=0)[0]) if len(set(ages_h)) > 1 else None


def life_table(summary: dict[str, Any]) -> Table:
    """Return the table of a summary."""
    from rich.table import Table

    title = f"Lives of {summary['lives']} gearboxes: {summary['failed']} fail within the schedule"
    heads = [f"{q:.0%}" for q in summary["quantiles"]]
    table = Table("", *heads, "Weibull slope", title=title, title_justify="left")
    for name, words in ENDS.items():
        slope = summary["slope"][name]
        cells = [f"{age:.4g} h" for age in summary["age_h"][name]]
        table.add_row(words, *cells, "" if slope is None else f"{slope:.2g}")
    table.add_row("pitted teeth at the end", *(f"{n:g}" for n in summary["pitted_teeth_at_end"]), "")
    table.add_row("inspections", *(f"{n:g}" for n in summary["inspections"]), "")
    return table
