"""What a run tells while it goes on: events for a log, and the time of every stage."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from typing import TypeVar

from siggen.record.stage_times import StageTimes
from siggen.sets.loss_limit import LossLimit
from siggen.sets.shard_making import MadeShard
from siggen.sources import installed_version
from siggen.workers.tasks import Workers

Events = Callable[[Mapping[str, object]], None]
"""Called with every event of a run, in the process that drives it; what it raises ends the run."""

LOG_VERSION = 2

STAMP = ("time", "event")
EVENTS: dict[str, tuple[str, ...]] = {
    "run_started": (
        *("log_version", "siggen", "name", "identity", "path", "executor", "workers", "records", "shards"),
    ),
    "shard_taken_over": ("shard", "rows", "failures", "records_done", "records_total"),
    "record_failed": ("shard", "record_id", "status", "reason"),
    "shard_done": (
        *("shard", "rows", "failures", "bytes", "seconds"),
        *("records_done", "records_total", "records_per_s", "left_s"),
    ),
    "run_ended": ("outcome", "message", "records_made", "shards_taken_over", "failures", "seconds", "stages"),
    "said": ("sentence",),
}
"""Event -> its fields beside those of STAMP; fields may be added, never renamed. Units stand in docs/reference."""

T = TypeVar("T")


@dataclass(slots=True)
class RunJournal:
    """Where a run notes what it does.

    Attributes
    ----------
    driver
        Wall seconds of the process that drives the run, by stage.
    worker_cpu_s
        CPU seconds of the workers by stage, summed over all of them.
    made, failures
        Records that this run simulated, and those of them that could not be.
    limit
        Ends a run that loses too many of them; None: no number is too many.
    """

    events: Events | None = None
    started_s: float = field(default_factory=time.perf_counter)
    driver: StageTimes = field(default_factory=StageTimes)
    worker_cpu_s: dict[str, float] = field(default_factory=dict)
    failures: int = 0
    made: int = 0
    limit: LossLimit | None = None

    @property
    def seconds(self) -> float:
        """Seconds since the run began."""
        return time.perf_counter() - self.started_s

    def start(self, name: str, identity: str, path: str, workers: Workers, records: int, shards: int) -> None:
        """Tell that a run begins, with the records and shards of the whole set."""
        facts = {"log_version": LOG_VERSION, "siggen": installed_version(), "name": name}
        who = {"executor": workers.name, "workers": workers.count}
        facts |= {"identity": identity, "path": path, **who, "records": records, "shards": shards}
        self._tell("run_started", facts)
        if self.limit is not None:
            self.limit.records = records

    def shard(self, shard: MadeShard, done: int, total: int) -> None:
        """Tell of a shard that is there, of the records that failed for it, and of the pace of this run.

        What a run does once, as compiling, is no part of its pace.

        Raises
        ------
        LossError
            If more records of a state are lost than its user allows.
        """
        content: dict[str, object] = {
            "shard": shard.shard,
            "rows": shard.rows,
            "failures": len(shard.failures),
            "records_done": done,
            "records_total": total,
        }
        self.add(shard.cpu_s)
        if not shard.made:
            self._tell("shard_taken_over", content)
        else:
            self.made += shard.made
            self.failures += len(shard.failures)
            for failure in shard.failures:
                self._tell("record_failed", {"shard": shard.shard, **asdict(failure)})
            rate = self.made / max(self.driver.so_far().get("waiting", 0.0), 1e-9)
            content |= {"bytes": sum(file.bytes for file in shard.files.values())}
            content |= {"seconds": round(sum(shard.cpu_s.values()), 3), "records_per_s": round(rate, 3)}
            self._tell("shard_done", {**content, "left_s": round((total - done) / rate, 1) if rate else None})
        if self.limit is not None:
            self.limit.set(shard.shard, shard.failures)

    def end(self, outcome: str, message: str, made: int, taken_over: int) -> None:
        """Tell that the run is over: done, interrupted, failed (with the message), or finished before."""
        facts: dict[str, object] = {"outcome": outcome, "message": message, "records_made": made}
        facts |= {"shards_taken_over": taken_over, "failures": self.failures, "seconds": round(self.seconds, 3)}
        self._tell("run_ended", {**facts, "stages": self.stages()})

    def say(self, sentence: str) -> None:
        """Say something that cannot wait for the end of the run; on stderr where nobody takes events."""
        if self.events is None:
            sys.stderr.write(f"{sentence}\n")
        self._tell("said", {"sentence": sentence})

    def _tell(self, event: str, facts: Mapping[str, object]) -> None:
        if self.events is None:
            return
        self.events(stamped(event, facts))

    def add(self, worker_cpu_s: Mapping[str, float]) -> None:
        """Add what a worker spent on a chunk."""
        for stage, seconds in worker_cpu_s.items():
            self.worker_cpu_s[stage] = self.worker_cpu_s.get(stage, 0.0) + seconds

    def waiting(self, results: Iterator[T]) -> Iterator[T]:
        """Yield results; the time until each is there counts as waiting for workers."""
        while True:
            with self.driver.during("waiting"):
                try:
                    result = next(results)
                except StopIteration:
                    return
            yield result

    def stages(self) -> dict[str, dict[str, float]]:
        """Return seconds by stage: of the driver, and CPU seconds of the workers."""
        found = {"driver_s": self.driver.so_far(), "worker_cpu_s": self.worker_cpu_s}
        return {side: {stage: round(value, 3) for stage, value in times.items()} for side, times in found.items()}


def stamped(event: str, facts: Mapping[str, object]) -> dict[str, object]:
    """Return an event with the time of now in UTC, its fields in the order of `EVENTS`."""
    now = datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
    return {"time": now, "event": event, **{name: facts[name] for name in EVENTS[event]}}
