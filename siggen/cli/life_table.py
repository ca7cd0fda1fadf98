"""What `siggen plan` says of gearboxes that run to failure: ages of their ends, what has pitted then, inspections."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.table import Table

    from siggen.gearbox.design import SetDesign
    from siggen.gearbox.life import Lived
    from siggen.sets.record_cost import SetCost

QUANTILES = (0.05, 0.5, 0.95)
MOST_LIVES = 12
"""Gearboxes whose lives are worked out for the table; those of further ones count by proportion."""
ENDS = {"first_pit": "first pit", "rated": "rated damage", "functional": "functional end"}


def life_summary(design: SetDesign) -> dict[str, Any] | None:
    """Return quantiles of what ends the lives of the first gearboxes of a set; None for a set of states."""
    life = design.config.life
    if life is None:
        return None
    import numpy as np

    lives = [design.life(i) for i in range(min(design.specimens, MOST_LIVES))]

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
        "mean_inspections": sum(len(one.ages_h) for one in lives) / len(lives),
        "pitted_inspections": _pitted(lives) / max(sum(len(one.ages_h) for one in lives), 1),
        "history_h": lives[0].clock.round_h if life.history else None,
        "schedule_h": life.interval_h * (life.most - 1),
        "failed": sum(one.event == "failed" for one in lives),
        "pitted_in_schedule": sum(one.observed_h > age for one, age in zip(lives, ends["first_pit"], strict=True)),
    }


def _pitted(lives: Sequence[Lived]) -> int:
    """Return how many inspections see a pitted tooth."""
    return sum(one.clock.time(age_h) >= one.course.ends.first_pit for one in lives for age_h in one.ages_h)


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


def history_text(summary: dict[str, Any]) -> str:
    """Return how long the history of load is beside the schedule; nothing without one."""
    history_h, schedule_h = summary["history_h"], summary["schedule_h"]
    if history_h is None:
        return ""
    said = f"{history_h:.4g} h beside a schedule of {schedule_h:.4g} h"
    return f"{said}: it begins again {int(schedule_h // history_h)} times" if history_h <= schedule_h else said


def cost_summary(cost: SetCost, summary: dict[str, Any], design: SetDesign) -> dict[str, Any]:
    """Return the CPU hours of a set, the share of its largest shard, and what the hours were worked out from."""
    from dataclasses import asdict

    from siggen.gearbox.plan import largest_shard_share

    records = summary["records"]
    damaged = design.specimens * (design.state_count - 1)
    if summary["life"] is not None:
        damaged = round(records * summary["life"]["pitted_inspections"])
    hours = cost.hours(design.specimens, damaged, records, design.duration_s)
    return {"cpu_hours": hours, "largest_shard": largest_shard_share(design), **asdict(cost)}


def cost_text(found: dict[str, Any]) -> str:
    """Return the CPU hours and what they take here in words, with how they were estimated."""
    from siggen.errors import counted
    from siggen.workers.choice import default_workers

    workers = default_workers()
    hours, share = found["cpu_hours"], found["largest_shard"]  # a worker makes a shard by itself
    here = f"about {_duration(hours)} of this processor, {_duration(hours * max(1.0 / workers, share))} with "
    here += counted(workers, "process", "processes")
    here += f", as the largest shard is {share:.0%} of the set" if share > 1.0 / workers else ""
    of_each = f"{found['signal_s']:.2g} s per second of signal, {found['damage_s']:.2g} s per damaged state"
    return f"{here} (estimated from the trial: {of_each}, {found['gearbox_s']:.2g} s per gearbox)"


def _duration(hours: float) -> str:
    """Return a time in the unit that suits it."""
    if hours < 1.0 / 60.0:
        return f"{3600 * hours:.0f} s"
    return f"{60 * hours:.0f} min" if hours < 2.0 else f"{hours:,.3g} h"
