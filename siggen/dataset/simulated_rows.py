"""Records of one gearbox, simulated into rows."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import pyarrow as pa

from siggen.columns.internals import internals_batch
from siggen.columns.record import RecordFailure, SetColumns, SimulatedRecord, non_finite, record_batch
from siggen.errors import EngineError
from siggen.record.stage_times import stage

Simulate = Callable[[Sequence[int]], Iterable[SimulatedRecord | RecordFailure]]
"""Ids of one specimen's records -> results in the same order, as `siggen.sets.drawn.simulated`."""

BLOCK_RECORDS = 16
"""Records that are held as arrays before they become rows: a gearbox of a life has hundreds."""


@dataclass(frozen=True, slots=True)
class SimulatedRows:
    """Rows, the records that failed, and the rows of internal quantities of a set that stores some."""

    rows: pa.RecordBatch
    failures: tuple[RecordFailure, ...]
    internals: pa.RecordBatch | None = None


@dataclass(frozen=True, slots=True)
class RowSimulation:
    """What makes rows of a set; carries to the workers once what simulates it.

    `simulate` gives so many renewals behind each record.
    """

    columns: SetColumns
    simulate: Simulate
    renewals: int = 0

    def __call__(self, records: Sequence[int]) -> SimulatedRows:
        """Return the rows of some records of one gearbox at once."""
        (only,) = self.blocks(records, max(1, len(records)))
        return only

    def renewed(self, records: Sequence[int]) -> tuple[SimulatedRows, ...]:
        """Return the rows of some records of one gearbox, and behind them those of each of their renewals."""
        results, each = list(self._results(records)), 1 + self.renewals
        return tuple(self._rows(results[renewal::each]) for renewal in range(each))

    def blocks(self, records: Sequence[int], size: int = BLOCK_RECORDS) -> Iterator[SimulatedRows]:
        """Yield rows of the records of one gearbox, some at a time.

        Raises
        ------
        EngineError
            If the simulation raises anything but MemoryError; names the record. A failure of the solver is a result.
        """
        results = self._results(records)
        for start in range(0, len(records), size):
            yield self._rows([next(results) for _ in records[start : start + size]])

    def _rows(self, results: Sequence[SimulatedRecord | RecordFailure]) -> SimulatedRows:
        failures = tuple(result for result in results if isinstance(result, RecordFailure))
        records = [result for result in results if isinstance(result, SimulatedRecord)]
        with stage("rows"):
            columns = self.columns
            internals = internals_batch(columns, records) if columns.quantities else None
            return SimulatedRows(record_batch(columns, records), failures, internals)

    def _results(self, records: Sequence[int]) -> Iterator[SimulatedRecord | RecordFailure]:
        """Yield a record or a failure for every id; a row that is not finite is a failure."""
        results = self._raw(records)
        given = [record_id for record_id in records for _ in range(1 + self.renewals)]
        for place, record_id in enumerate(given):
            result = self._next(results, given[place:])
            if isinstance(result, SimulatedRecord) and (reason := non_finite(result)):
                result = RecordFailure(record_id, "not_finite", reason)
            yield result

    def _raw(self, records: Sequence[int]) -> Iterator[SimulatedRecord | RecordFailure]:
        yield from self.simulate(records)

    def _next(
        self, results: Iterator[SimulatedRecord | RecordFailure], ids: Sequence[int]
    ) -> SimulatedRecord | RecordFailure:
        """Return the result of the first of the records that are left."""
        try:
            result = next(results, None)
        except MemoryError:
            raise
        except Exception as error:
            raise EngineError(f"{self._culprit(ids)} raised {error!r}, which is a fault of the program") from error
        if result is None:
            raise EngineError(f"the simulation of record {ids[0]} returned nothing")
        received = result.record_id if isinstance(result, RecordFailure) else result.planned.record_id
        if received != ids[0]:
            raise EngineError(f"the simulation of record {ids[0]} returned record {received}")
        return result

    def _culprit(self, ids: Sequence[int]) -> str:
        """Return the first record that raises when simulated alone."""
        for record_id in ids:
            try:
                list(self.simulate([record_id]))
            except Exception:
                return f"record {record_id}"
        return f"one of the records {ids[0]} to {ids[-1]} (none of them alone)"
