"""A table of healthy recordings and of the same with injected damage, with the origin of every row."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.calibration.healthy_blocks import Block, HealthyBlocks
from diagnostics.calibration.injection import SPARE_TURNS, Difference, injected, simulated_differences
from siggen.errors import UsageError

TABLE, FACTS, README = "injected.parquet", "injected.json", "README.md"
KEPT = ("state", "fault", "severity", "faulty_gear", "damaged_area_mm2", "damage_profile_length_mm", "torque_nm")
TEXT = """# Recordings with injected damage

Rows with `origin` recorded are your healthy recordings. Rows with `origin` injected are the same recordings plus the
simulated difference between a damaged and a healthy gearbox, at the recording's own course of speed. `recording` names
the file; `specimen_id`, `path_number`, `identity` and `difference_db` (energy of the difference over that of the
recording) say what was added. All rows of a recording belong on one side of any split.

**Your recordings are in this folder. `siggen publish` refuses it.** Whether a detector gains by such rows is open:
`docs/scripts/transfer_control.py` compares them with shuffled phases and white noise.
"""


def write_injected(
    blocks: HealthyBlocks, mine: Path, gearboxes: int, folder: Path, seed: int, advance: Callable[[], None]
) -> Path:
    """Write the table into a new folder; return its file.

    Parameters
    ----------
    blocks : HealthyBlocks
    mine : Path
        The calibrated configuration.
    gearboxes : int
        Different ones for each recording.
    folder : Path
    seed : int
    advance : callable
        Told of every gearbox.

    Raises
    ------
    UsageError
        If no damage could be simulated.
    """
    import pyarrow as pa
    from pyarrow import parquet

    rows = list(_rows(blocks, mine, gearboxes, seed, advance))
    if all(row["origin"] == "recorded" for row in rows):
        raise UsageError(f"{mine}: no damage could be simulated; see siggen plan {mine}")
    folder.mkdir(parents=True)
    table = pa.Table.from_pylist(rows).replace_schema_metadata({"fs_hz": repr(blocks.fs_hz), "siggen.injected": "1"})
    parquet.write_table(table, folder / TABLE)
    facts = {"kind": "injected", "configuration": mine.name, "recordings": [block.name for block in blocks.blocks]}
    (folder / FACTS).write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    (folder / README).write_text(TEXT, encoding="utf-8")
    return folder / TABLE


def _rows(
    blocks: HealthyBlocks, mine: Path, gearboxes: int, seed: int, advance: Callable[[], None]
) -> Iterator[dict[str, Any]]:
    for number, block in enumerate(blocks.blocks):
        yield _row(block, dict(block.channels), None, 0)
        for k in range(gearboxes):
            gearbox = number * gearboxes + k
            start = int(generator(seed, Purpose.PATHS, 0, 1 + gearbox).integers(SPARE_TURNS))
            for difference in simulated_differences(mine, block, gearbox):
                yield _row(block, injected(block, difference, start), difference, gearbox)
            advance()


def _row(block: Block, channels: dict[str, np.ndarray], difference: Difference | None, gearbox: int) -> dict[str, Any]:
    signals = {f"accel_{name}_m_s2": signal.astype(np.float32) for name, signal in channels.items()}
    if difference is None:
        labels: dict[str, Any] = dict.fromkeys(KEPT) | {"state": "healthy", "fault": "healthy", "severity": "healthy"}
        return {"recording": block.name, "origin": "recorded", **labels, **_nothing(), **signals, **_pulses(block)}
    added = sum(float(np.mean(signal**2)) for signal in difference.channels.values())
    own = sum(float(np.var(signal)) for signal in block.channels.values())
    numbers = [value for name, value in difference.labels.items() if name.startswith("path_number_")]
    return {
        "recording": block.name,
        "origin": "injected",
        **{name: difference.labels[name] for name in KEPT},
        "specimen_id": gearbox,
        "path_number": int(numbers[0]) if numbers else 0,
        "identity": difference.identity,
        "difference_db": 10.0 * float(np.log10(max(added, 1e-30) / own)),
        **signals,
        **_pulses(block),
    }


def _nothing() -> dict[str, Any]:
    return dict.fromkeys(("specimen_id", "path_number", "identity", "difference_db"))


def _pulses(block: Block) -> dict[str, Any]:
    return {"tacho_s": block.pulses_s}
