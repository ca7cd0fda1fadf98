"""ResultsFile: the rows of a run as JSON, written after every topic, so that a run that is broken off keeps them."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from benchmarks.row import Row


@dataclass(slots=True)
class ResultsFile:
    """What a run found so far; `path` None: kept nowhere."""

    path: Path | None
    command: str
    machine: list[str]
    topics: dict[str, dict[str, Any]] = field(default_factory=dict)

    def add(self, topic: str, rows: list[Row], seconds: float, load: float) -> None:
        """Add the rows of a topic, the wall time that it took [s] and the load average at its end, and write all."""
        found = [asdict(row) for row in rows]
        self.topics[topic] = {"seconds": round(seconds, 1), "load_average": round(load, 2), "rows": found}
        if self.path is not None:
            content = {"command": self.command, "machine": self.machine, "topics": self.topics}
            self.path.write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
