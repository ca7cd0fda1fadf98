"""Earlier checks of a machine, one line of JSON each beside its facts: what a trend is drawn from."""

from __future__ import annotations

import json
from dataclasses import dataclass
from datetime import UTC, datetime
from math import isfinite
from pathlib import Path

from diagnostics.machine.check import Check
from diagnostics.machine.machine import CHECKS
from siggen.errors import UsageError


@dataclass(frozen=True, slots=True)
class PastCheck:
    """One line: when it was made (UTC), of what, with which verdict, score and limit (None where there was none)."""

    made: str
    recording: str
    verdict: str
    speed_hz: float | None
    score: float | None
    limit: float | None


def add_checks(folder: Path, checks: list[Check]) -> None:
    """Append checks to the machine's history."""
    made = datetime.now(UTC).isoformat(timespec="seconds")
    with (folder / CHECKS).open("a", encoding="utf-8") as file:
        for check in checks:
            speed = check.speed_hz if isfinite(check.speed_hz) else None
            score, limit = (None, None) if check.score is None else (check.score.score, check.score.limit)
            row = PastCheck(made, check.recording, check.verdict, speed, score, limit)
            file.write(json.dumps({name: getattr(row, name) for name in PastCheck.__slots__}) + "\n")


def past_checks(folder: Path) -> list[PastCheck]:
    """Return the history, oldest first.

    Raises
    ------
    UsageError
        If a line cannot be read; names it.
    """
    file = folder / CHECKS
    if not file.exists():
        return []
    found = []
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), start=1):
        try:
            found.append(PastCheck(**json.loads(line)))
        except (TypeError, ValueError) as error:
            raise UsageError(f"{file}: line {number} is damaged ({error}); delete that line") from None
    return found
