"""The page of recordings of one machine: the same charts as those of a set, without what only a simulation knows."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from diagnostics.base.extras import require_packages
from diagnostics.base.progress import Stage, silent_stage
from diagnostics.explore.explorer import explorer_page
from diagnostics.explore.payload import page_payload
from diagnostics.explore.recordings_source import REFERENCE, ShownRecording, recordings_source

COLUMNS = (
    *(("record_id", "Recording"), ("state", "Verdict"), ("name", "File"), ("speed_hz", "Speed [Hz]")),
    ("torque_nm", "Load"),
)
FILTERS = (("state", "Verdict"),)


def write_recordings_page(
    name: str, shown: Sequence[ShownRecording], path: Path, *, full: bool = False, stage: Stage = silent_stage
) -> Path:
    """Write the page of recordings and return its path.

    Parameters
    ----------
    name : str
        Of the machine.
    shown : sequence of ShownRecording
        At least one.
    path : Path
        The HTML file.
    full : bool
        Whether all samples are kept, as far as 30 MB allow.
    stage : Stage
        Told of every recording.

    Raises
    ------
    UsageError
        If Jinja2 is not installed, or the recordings differ in rate or channels.
    """
    require_packages("the page to explore recordings", "jinja2")
    payload = page_payload(recordings_source(shown), stage, full=full)
    payload["served"] = False
    healthy = sum(one.healthy for one in shown)
    facts = {
        "name": name,
        "identity": "",
        "seen": "",
        "records": len(shown),
        "healthy": healthy,
        "missing": missing_sentences(healthy),
        "served": False,
        "columns": COLUMNS,
        "filters": FILTERS,
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(explorer_page(facts, payload), encoding="utf-8")
    return path


def missing_sentences(healthy: int) -> list[str]:
    """Return what recordings do not give, and how to have it."""
    found = [
        "Damage, flanks, transmission error and mesh force: a recording does not tell them.",
        "Teeth by number: tooth 1 is the one at the first pulse.",
    ]
    if healthy == 0:
        found.append(
            f"No recording is known to be a {REFERENCE}: nothing is laid over, and an indicator has no place among "
            "healthy ones. Give the recordings of `baseline` too, or `--healthy FILE`."
        )
    elif healthy < 3:
        found.append("Fewer than three healthy recordings: an indicator has no place among them.")
    return found
