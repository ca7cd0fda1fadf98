"""Scores of predictions as rows: for reading, and as a table for further use."""

from __future__ import annotations

import math
from dataclasses import dataclass

import pyarrow as pa

from diagnostics.statistics.evaluation import Interval
from diagnostics.statistics.judgement import TITLES
from siggen.errors import counted

FEWEST_GEARBOXES = 6
"""Test gearboxes from which on a difference whose limits exclude 0 is worth a word, as in the report."""


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
    """

    task: str
    measure: str
    records: str
    name: str
    score: Interval
    chance: float
    difference: Interval | None


@dataclass(frozen=True, slots=True)
class Scored:
    """Scores of predictions on one split of a set; `print` shows them as a table.

    Attributes
    ----------
    set_name, identity, split : str
        Which records; scores of sets with different identities are not comparable.
    records, gearboxes : int
    rows : tuple of ScoreRow
    """

    set_name: str
    identity: str
    split: str
    records: int
    gearboxes: int
    rows: tuple[ScoreRow, ...]

    def to_table(self) -> pa.Table:
        """Return one row per score: task, measure, records, name, score, low, high, chance, difference with limits."""
        return pa.Table.from_pylist([self._entry(row) for row in self.rows])

    def _entry(self, row: ScoreRow) -> dict[str, object]:
        apart = row.difference or Interval(math.nan, math.nan, math.nan)
        return {
            "set": self.set_name, "identity": self.identity, "split": self.split,
            "task": row.task, "measure": row.measure, "records": row.records, "name": row.name,
            "score": row.score.value, "low": row.score.low, "high": row.score.high, "chance": row.chance,
            "difference": apart.value, "difference_low": apart.low, "difference_high": apart.high,
        }  # fmt: skip

    def __str__(self) -> str:
        """Return the table as text, a block for every task, measure and part of the records."""
        head = (
            f"{self.set_name} ({self.identity[:12]}), {self.split}: {counted(self.records, 'record')} of "
            f"{counted(self.gearboxes, 'gearbox', 'gearboxes')}; limits of 95 % over gearboxes"
        )
        lines, block, first = [head], "", self.rows[0].name
        width = max(len(TITLES.get(row.name, row.name)) for row in self.rows)
        for row in self.rows:
            title = f"{row.task}: {row.measure}, {row.records} (chance {row.chance:.2f})"
            if title != block:
                lines += ["", title]
                block = title
            difference = f"   {first} minus this {_shown(row.difference, '+.3f')}" if row.difference else ""
            lines.append(f"  {TITLES.get(row.name, row.name):{width}}  {_shown(row.score, '.3f')}{difference}")
        if self.gearboxes < FEWEST_GEARBOXES:
            few = counted(self.gearboxes, "gearbox", "gearboxes")
            lines += ["", f"{few}: too few to tell classifiers apart; from {FEWEST_GEARBOXES} on limits mean something"]
        return "\n".join(lines)


def _shown(found: Interval, form: str) -> str:
    if not math.isfinite(found.low):
        return f"{found.value:{form}} [no limits]"
    return f"{found.value:{form}} [{found.low:{form}}, {found.high:{form}}]"
