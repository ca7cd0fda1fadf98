"""A program that `beside` runs in any checkout: a line with a number in, what the loop of that gearbox costs out.

It uses only what older versions have as well, and stands by itself: of this package it imports nothing.
"""

from __future__ import annotations

import json
import sys
import time
from typing import Any

from siggen.checks.loading import load_config
from siggen.dynamics.time.exponential_motion import ExponentialMotion
from siggen.planning.plan import record_ids_of
from siggen.record.simulation import simulate_specimen


class LoopCost:
    """Counts what every motion is advanced by: steps tried, CPU time; a record's motion is that of most states."""

    def __init__(self) -> None:
        self.motions: dict[int, dict[str, Any]] = {}
        kind: Any = ExponentialMotion
        plain = kind.advance

        def advance(motion: Any, pitches: Any, inputs: Any, trajectory: Any) -> Any:
            tried, begin = motion.steps_tried, time.process_time()
            result = plain(motion, pitches, inputs, trajectory)
            spent_s = time.process_time() - begin
            found = self.motions.setdefault(id(motion), {"motion": motion, "states": 0, "tried": 0, "cpu_s": 0.0})
            found["states"] += pitches.size - 1
            found["tried"] += motion.steps_tried - tried
            found["cpu_s"] += spent_s
            return result

        kind.advance = advance

    def taken(self) -> dict[str, float]:
        """Return what the record before cost and forget it."""
        motions = list(self.motions.values())
        self.motions = {}
        record = max(motions, key=lambda one: one["states"])
        return {
            "cpu_s": sum(one["cpu_s"] for one in motions),
            "record_cpu_s": record["cpu_s"],
            "tried": sum(one["tried"] for one in motions),
            "record_tried": record["tried"],
            "step_s": float(record["motion"].scheme.steps_s[0]),
            "coordinates": len(record["motion"].structure.coordinates),
        }


def main() -> None:
    """Answer numbers of gearboxes, one a line, with a list: the cost of their first and of their last record."""
    config = load_config(sys.argv[1], sys.argv[2:])
    cost = LoopCost()
    for line in sys.stdin:
        ids, found = record_ids_of(config, int(line)), []
        for record in simulate_specimen(config, [ids[0], ids[-1]]):
            if not hasattr(record, "channels"):
                raise SystemExit(f"gearbox {line.strip()} made no record: {record}")
            found.append({**cost.taken(), "duration_s": config.duration_s, "fs_hz": config.fs_hz})
        print(json.dumps(found), flush=True)


if __name__ == "__main__":
    main()
