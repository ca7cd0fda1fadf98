"""A set of healthy recordings and of the same with injected damage, with the origin of every row.

Where a generated set has a gearbox (`specimen_id`) it has a recording: all rows of one are on one side of the split.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pyarrow as pa

import siggen
from diagnostics.calibration.healthy_blocks import HealthyBlocks
from diagnostics.calibration.injected_rows import RECORDED, injected_rows
from siggen.errors import UsageError

ORIGIN = pa.schema(
    {
        "recording": pa.string(),
        "origin": pa.string(),
        "simulated_gearbox": pa.int64(),
        "path_number": pa.int64(),
        "identity": pa.string(),
        "difference_db": pa.float64(),
        "difference_torque_nm": pa.float64(),
    }
)
TEXT = """# Recordings with injected damage

Rows with `origin` recorded are your healthy recordings. Rows with `origin` injected are the same recordings plus the
simulated difference between a damaged and a healthy gearbox, at the recording's own course of speed. `recording` names
the file; `simulated_gearbox`, `path_number`, `identity`, `difference_torque_nm` and `difference_db` (energy of the
difference over that of the recording) say what was added; -1 stands for nothing.

`specimen_id` is the number of the recording, so all rows of a recording are on one side of the split: the last fifth,
one at least, is the test. Recordings are cut to the length of the shortest. `torque_nm` is the middle of the
configuration's range in all rows: a recording does not say it. `siggen-diagnostics report --models-only` reads this
folder; it needs two recordings for training and one for the test.

**Your recordings are in this folder. `siggen publish` refuses it.** Whether a detector gains by such rows is open:
`docs/scripts/transfer_control.py` compares them with shuffled phases and white noise.
"""


def write_injected(
    blocks: HealthyBlocks, mine: Path, gearboxes: int, folder: Path, seed: int, advance: Callable[[], None]
) -> Path:
    """Write the set into a new folder; return the folder.

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
    config = siggen.load_config(mine)
    rows = list(injected_rows(blocks, mine, gearboxes, seed, advance))
    if all(row["origin"] == RECORDED for row in rows):
        raise UsageError(f"{mine}: no damage could be simulated; see siggen plan {mine}")
    _complete(rows, config)
    facts = {"kind": "injected", "configuration": mine.name, "recordings": [block.name for block in blocks.blocks]}
    return siggen.write_recorded_set(config, folder, rows, ORIGIN, facts, TEXT)


def _complete(rows: Sequence[dict[str, Any]], config: Any) -> None:
    """Add what rows of one set have in common: numbers of the states, teeth, the torque that is assumed."""
    torque = config.canonical()["operating_points"][0]["torque_nm"]
    drawn = torque.get("values") or (torque["low"], torque["high"]) if isinstance(torque, dict) else (torque,)
    torque_nm = 0.5 * (min(drawn) + max(drawn))
    states = dict.fromkeys(["healthy", *(row["state"] for row in rows)])
    numbers = {state: number for number, state in enumerate(states)}
    for row in rows:
        row["state_id"], row["torque_nm"] = numbers[row["state"]], float(torque_nm)
        row |= {"teeth_pinion": config.gears.pinion.teeth, "teeth_gear": config.gears.gear.teeth}
