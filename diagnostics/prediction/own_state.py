"""OwnState: a recording against healthy recordings of the same machine, before any state is named."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnostics.prediction.record_pieces import RecordPieces
from diagnostics.records.state_classes import HEALTHY
from diagnostics.statistics.change_score import FEWEST, ChangeScore, attainable_rate, change_score
from diagnostics.training.log_features import log_values
from siggen.errors import UsageError

FALSE_ALARMS = 0.05
UNTOLD = "cannot tell"


@dataclass(frozen=True, slots=True)
class OwnState:
    """Verdict `changed`, `unchanged` or `cannot tell`, the reason in words, and the score where there is one."""

    verdict: str
    reason: str
    score: ChangeScore | None = None

    @property
    def changed(self) -> bool:
        """Whether the machine has changed."""
        return self.score is not None and self.score.changed

    def contradicts(self, named: str) -> bool:
        """Return whether a named state and the change point different ways."""
        return self.score is not None and self.changed == (named == HEALTHY)


def own_state(pieces: RecordPieces, references: Sequence[RecordPieces]) -> OwnState:
    """Return whether a recording differs from healthy ones of the same machine, by all indicators that all define.

    Parameters
    ----------
    pieces : RecordPieces
        Of the recording.
    references : sequence of RecordPieces
        Of each healthy recording.
    """
    if len(references) < FEWEST:
        few = f"{len(references)} healthy recordings; a verdict takes {FEWEST}, and 19 a rate of false alarms of 5 %"
        return OwnState(UNTOLD, few)
    healthy = log_values(np.stack([one.medians(pieces.names) for one in references]))
    try:
        score = change_score(healthy, log_values(pieces.medians(pieces.names)[None])[0], FALSE_ALARMS)
    except UsageError as error:
        return OwnState(UNTOLD, str(error))
    rate = attainable_rate(len(references), FALSE_ALARMS)
    side = "above" if score.changed else "not above"
    reason = f"distance {score.score:.3g}, {side} the limit {score.limit:.3g}; promised false alarms: {rate:.0%}"
    return OwnState("changed" if score.changed else "unchanged", reason, score)
