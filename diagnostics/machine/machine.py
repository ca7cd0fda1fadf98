"""Machine: one machine as its healthy recordings show it, saved as a folder."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.recordings.taken import RecordingFacts
from siggen.columns.drivetrain import GearTrain
from siggen.errors import UsageError
from siggen.file_writing import write_file

FACTS, TABLE, CHECKS = "machine.json", "references.parquet", "checks.jsonl"
VERSION = 5


@dataclass(frozen=True, slots=True)
class Machine:
    """What is known of a machine.

    Attributes
    ----------
    train : GearTrain
        What turns in it.
    channels : tuple of str
    facts : RecordingFacts
        How its files are read.
    speed_range_hz : (float, float) or None
        Where the first shaft's speed is searched without a tacho.
    fs_hz, duration_s : float
        Rate and length of the pieces whose indicators are compared.
    false_alarms : float
        Wanted rate.
    names : tuple of str
        Features, `<indicator>__<channel>`.
    values : (references, features) float64
        Medians over the pieces of a reference; NaN where undefined.
    references : tuple of str
        Names of the recordings.
    speed_hz, load : (references,) float64
        Speed of the first shaft, and load as the user gave it (NaN where he did not).
    load_from_slip : bool
        Whether differences of speed tell the load.
    doubts : tuple of str
        What is said of references that are unlike the others.
    angles : tuple of str
        Where the angles of the references come from, and how sure they are.
    """

    train: GearTrain
    channels: tuple[str, ...]
    facts: RecordingFacts
    speed_range_hz: tuple[float, float] | None
    fs_hz: float
    duration_s: float
    false_alarms: float
    names: tuple[str, ...]
    values: np.ndarray
    references: tuple[str, ...]
    speed_hz: np.ndarray
    load: np.ndarray
    load_from_slip: bool = False
    doubts: tuple[str, ...] = ()
    angles: tuple[str, ...] = ()


def save_machine(machine: Machine, folder: Path) -> None:
    """Write the folder of a machine; no sample of a recording goes into it.

    Raises
    ------
    UsageError
        If the folder holds a machine already.
    """
    import pyarrow as pa
    from pyarrow import parquet

    if (folder / FACTS).exists():
        raise UsageError(f"{folder}: holds a machine already; give --out a new folder")
    columns = {"recording": list(machine.references), "speed_hz": machine.speed_hz, "load": machine.load}
    columns |= {name: machine.values[:, k] for k, name in enumerate(machine.names)}
    table = pa.table(columns)
    write_file(folder / TABLE, lambda draft: parquet.write_table(table, draft, write_page_checksum=True))
    facts = asdict(machine.facts) | {"columns": dict(machine.facts.columns)}
    content = {
        "version": VERSION,
        "drivetrain": asdict(machine.train),
        "channels": machine.channels,
        "facts": facts,
        "speed_range_hz": machine.speed_range_hz,
        "fs_hz": machine.fs_hz,
        "duration_s": machine.duration_s,
        "false_alarms": machine.false_alarms,
        "load_from_slip": machine.load_from_slip,
        "doubts": machine.doubts,
        "angles": machine.angles,
    }
    write_file(folder / FACTS, json.dumps(content, indent=1) + "\n")


def load_machine(folder: Path) -> Machine:
    """Return the machine of a folder that `save_machine` wrote.

    Raises
    ------
    UsageError
        If it is not one, is damaged, or was written by another version.
    """
    import pyarrow as pa
    from pyarrow import parquet
    from pydantic import TypeAdapter

    try:
        content: dict[str, Any] = json.loads((folder / FACTS).read_text(encoding="utf-8"))
        table = parquet.read_table(folder / TABLE, page_checksum_verification=True)
    except FileNotFoundError:
        raise UsageError(f"{folder}: is no machine; make one with `siggen-diagnostics baseline`") from None
    except (OSError, ValueError, pa.ArrowInvalid) as error:
        raise UsageError(f"{folder}: is damaged; make it again from the healthy recordings") from error
    if content.get("version") != VERSION:
        raise UsageError(
            f"{folder}: is of version {content.get('version')}, this program reads {VERSION}; make it again"
        )
    names = tuple(name for name in table.column_names if name not in {"recording", "speed_hz", "load"})
    span = content["speed_range_hz"]
    return Machine(
        TypeAdapter(GearTrain).validate_python(content["drivetrain"]),
        tuple(content["channels"]),
        RecordingFacts(**content["facts"]),
        None if span is None else (span[0], span[1]),
        content["fs_hz"],
        content["duration_s"],
        content["false_alarms"],
        names,
        np.stack([_column(table, name) for name in names], axis=1),
        tuple(table["recording"].to_pylist()),
        _column(table, "speed_hz"),
        _column(table, "load"),
        content["load_from_slip"],
        tuple(content["doubts"]),
        tuple(content["angles"]),
    )


def _column(table: Any, name: str) -> np.ndarray:
    return np.asarray(table[name].to_numpy(), dtype=np.float64)
