"""LossLimit: ends a run that loses more records of a state than its user allows."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import chain
from numbers import Real

from siggen.columns.record import RecordFailure
from siggen.errors import EXIT_RECORDS_FAILED, SiggenError, UsageError, counted
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import planned_record

ALLOWED_LOSS = 0.1
"""Share of a state's records that may fail before a run stops, unless told otherwise."""


class LossError(SiggenError):
    """Too many records of a state could not be simulated; what was made stays, and the same call continues."""

    exit_code = EXIT_RECORDS_FAILED


@dataclass(slots=True)
class LossLimit:
    """Counts failures by state, shard by shard; raises once a state has lost more than its share of the whole run.

    Attributes
    ----------
    design
        Whose states are counted.
    share
        Of the records of a state that may fail, from 0 to 1.
    records
        Of the whole run, which has as many of every state.
    """

    design: SetDesign
    share: float = ALLOWED_LOSS
    records: int = 0
    failures: dict[str, Sequence[RecordFailure]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse what is no share.

        Raises
        ------
        UsageError
        """
        is_number = isinstance(self.share, Real) and not isinstance(self.share, bool)
        if not (is_number and 0.0 <= self.share <= 1.0):
            raise UsageError(f"allowed_loss: received {self.share!r}; allowed: 0 to 1, where 1 never stops")

    def set(self, shard: str, failures: Sequence[RecordFailure]) -> None:
        """Count all failures of a shard, in place of what was counted before.

        Raises
        ------
        LossError
        """
        self.failures[shard] = failures
        lost = Counter(planned_record(self.design, one.record_id).state_id for one in chain(*self.failures.values()))
        each = self.records // self.design.state_count
        for state, count in sorted(lost.items()):
            if count > self.share * each:
                raise LossError(self._message(state, count, each))

    def _message(self, state: int, count: int, each: int) -> str:
        name, design = self.design.state_names[state], self.design
        of_state = (
            one for one in chain(*self.failures.values()) if planned_record(design, one.record_id).state_id == state
        )
        first = min(of_state, key=lambda one: one.record_id)
        return (
            f"stopped: of the {counted(each, 'record')} of state {name} {count} could not be simulated; allowed is a "
            f"share of {self.share:g}. Record {first.record_id}: {first.status} ({first.reason}). "
            "What was made stays. `siggen plan` says which share of every state to expect; change what the reason "
            "names and take a new folder, or go on with a larger `siggen generate --allowed-loss` (1: never "
            "stop)"
        )
