"""CPU time of a set, by proportion from a few short records, without what numba compiles or loads for them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from statistics import mean
from typing import TYPE_CHECKING

from numba.core.event import Event, Listener, install_listener

from siggen.record.stage_times import collected, stage

if TYPE_CHECKING:
    from siggen.columns.record import RecordFailure, SimulatedRecord

    Result = SimulatedRecord | RecordFailure

START_S = 0.9
"""Seconds of signal that cost as much as finding the step and settling do: 0.9 to 1.3 in three gearboxes of quickstart,
0.8 in planetary, by records of 0.25 to 0.35 s and of 0.85 to 1.5 s."""
PREPARING, COMPILING = ("plan", "tables"), "compiling"


@dataclass(frozen=True, slots=True)
class RecordTime:
    """CPU seconds of one record: drawing a gearbox and its tables, and all else; whether its state has damage."""

    prepared_s: float
    run_s: float
    damaged: bool


@dataclass(frozen=True, slots=True)
class SetCost:
    """CPU seconds on this machine.

    Attributes
    ----------
    gearbox_s : float
        Of a gearbox: its drawing, its housing, its healthy gears.
    damage_s : float
        Of the tables of teeth that no earlier record had: of a state, of an inspection with pits.
    record_s : float
        Of a record, without its signal.
    signal_s : float
        Of a second of signal.
    """

    gearbox_s: float
    damage_s: float
    record_s: float
    signal_s: float

    def hours(self, gearboxes: int, damaged: int, records: int, duration_s: float) -> float:
        """Return the CPU hours of a set in which so many states of its gearboxes have damage of their own."""
        of_records = records * (self.record_s + duration_s * self.signal_s) + damaged * self.damage_s
        return (gearboxes * self.gearbox_s + of_records) / 3600.0


def timed(results: Iterator[Result], times: list[RecordTime]) -> Iterator[Result]:
    """Yield results of a simulation, with the time of each added to a list."""
    while True:
        with collected("rest") as found, install_listener("numba:compiler_lock", _Compiling()):
            result = next(results, None)
        if result is None:
            return
        prepared_s = sum(found.seconds.get(name, 0.0) for name in PREPARING)
        fault = getattr(result, "labels", {}).get("fault", "healthy")
        run_s = sum(found.seconds.values()) - prepared_s - found.seconds.get(COMPILING, 0.0)
        times.append(RecordTime(prepared_s, run_s, fault != "healthy"))
        yield result


class _Compiling(Listener):
    """Charges a stage of its own while numba compiles, or loads what it has compiled before."""

    def __init__(self) -> None:
        self._open: list[ExitStack] = []

    def on_start(self, event: Event) -> None:  # noqa: ARG002 - as every listener
        self._open.append(ExitStack())
        self._open[-1].enter_context(stage(COMPILING))

    def on_end(self, event: Event) -> None:  # noqa: ARG002
        self._open.pop().close()


def set_cost(times: Sequence[RecordTime], fresh: int, duration_s: float) -> SetCost:
    """Return what a set costs of which records of a duration took these times.

    Parameters
    ----------
    times : sequence of RecordTime
        The first one is of a gearbox that nothing was known of, with all loading.
    fresh : int
        Place of the first record of a second gearbox, with nothing left to load; 0 where only one was tried.
    duration_s : float
    """
    first = times[fresh]
    damaged = [one.prepared_s for i, one in enumerate(times) if i not in (0, fresh) and one.damaged]
    signal_s = mean(one.run_s for one in times[1:] or times) / (duration_s + START_S)
    return SetCost(first.prepared_s, mean(damaged or [first.prepared_s]), START_S * signal_s, signal_s)
