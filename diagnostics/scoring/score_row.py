"""One score of one classifier, with its limits, what chance gives, and the difference to what it is compared with."""

from __future__ import annotations

from dataclasses import dataclass

from diagnostics.statistics.evaluation import Interval


@dataclass(frozen=True, slots=True)
class ScoreRow:
    """One score.

    Attributes
    ----------
    task, measure, records, name : str
        What was asked, how it was measured, on which records, and whose predictions they are.
    score : Interval
        With 95 % limits over gearboxes.
    chance : float
        What an answer without knowledge reaches.
    difference : Interval or None
        The first predictions minus these, on the same resampled gearboxes; None for the first themselves.
    falls : bool
        Whether less is better.
    """

    task: str
    measure: str
    records: str
    name: str
    score: Interval
    chance: float
    difference: Interval | None
    falls: bool = False
