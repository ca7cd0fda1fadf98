"""What the evaluation says about one indicator in one channel."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

from diagnostics.records.gear_train import GearNames
from diagnostics.statistics.evaluation import Interval

UNDEFINED = Interval(math.nan, math.nan, math.nan)


@dataclass(slots=True)
class StateResult:
    """One state against healthy, in one design.

    Attributes
    ----------
    separation : Interval
        Other specimens: AUC. Same specimen: share of pairs in which the indicator is higher after.
    effect : Interval
        Cohen's d; of the differences in the same-specimen design.
    p_value, holm, false_discovery : float
        Two-sided p-value over specimens, adjusted by Holm and by Benjamini and Hochberg over all indicators, channels
        and states of the design.
    """

    separation: Interval
    effect: Interval
    p_value: float = math.nan
    holm: float = math.nan
    false_discovery: float = math.nan


@dataclass(slots=True)
class IndicatorResult:
    """One indicator in one channel.

    Attributes
    ----------
    column, indicator, channel : str
        `fm4_pinion__x`, `fm4_pinion`, `x`.
    direction : int
        1 where it rises with damage, -1 where it falls (sign of the mean change of the same specimen).
    others, same : dict of str to StateResult
        By state: other specimens, and the same specimen before and after.
    score_others, score_same : Interval
        Mean over the states of the separation, turned so that 1 is perfect and 0.5 is chance.
    spearman_area, spearman_stiffness, monotonicity : Interval
        Rank correlation with damaged area and with loss of mesh stiffness; mean sign of steps up the severity ladder.
    sensitivity : dict of str to float
        Share of rank variance in healthy records that a cause explains alone.
    detectable : dict of str to Interval
        Smallest size found, e.g. `others_area_mm2_a90`; infinite where not reached.
    smallest_size : dict of str to float
        Median size of the group of smallest damage, e.g. `others_area_mm2`; what is found there is an upper bound.
    defined_share : float
        Share of records where the indicator has a value.
    gears : GearNames
        What columns are called after.
    """

    column: str
    indicator: str
    channel: str
    direction: int
    others: dict[str, StateResult]
    same: dict[str, StateResult]
    score_others: Interval
    score_same: Interval
    spearman_area: Interval
    spearman_stiffness: Interval
    monotonicity: Interval
    defined_share: float
    gears: GearNames
    sensitivity: dict[str, float] = field(default_factory=dict)
    detectable: dict[str, Interval] = field(default_factory=dict)
    smallest_size: dict[str, float] = field(default_factory=dict)

    def row(self) -> dict[str, Any]:
        """Return everything as one flat row of a table."""
        row: dict[str, Any] = {"indicator": self.indicator, "channel": self.channel, "direction": self.direction}
        row["defined_share"] = self.defined_share
        intervals = {
            "score_other_specimens": self.score_others,
            "score_same_specimen": self.score_same,
            "spearman_area": self.spearman_area,
            "spearman_stiffness": self.spearman_stiffness,
            "monotonicity": self.monotonicity,
            **self.detectable,
        }
        for design, states in (("others", self.others), ("same", self.same)):
            for state, found in states.items():
                intervals[f"{design}_separation_{state}"] = found.separation
                intervals[f"{design}_cohens_d_{state}"] = found.effect
                row[f"{design}_p_{state}"] = found.p_value
                row[f"{design}_holm_{state}"] = found.holm
                row[f"{design}_false_discovery_{state}"] = found.false_discovery
        for name, limits in intervals.items():
            row |= {name: limits.value, f"{name}_low": limits.low, f"{name}_high": limits.high}
        return row | {f"explained_by_{cause}": share for cause, share in self.sensitivity.items()}
