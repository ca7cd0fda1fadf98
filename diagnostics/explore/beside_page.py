"""The page of a machine beside its simulation: recordings and the records of a set in one table, over each other."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from diagnostics.base.extras import require_packages
from diagnostics.base.progress import Stage, silent_stage
from diagnostics.explore.beside_source import beside_source, channel_mapping
from diagnostics.explore.chosen_records import chosen_records
from diagnostics.explore.explorer import ExplorerOptions, explorer_page
from diagnostics.explore.measured_page import missing_sentences
from diagnostics.explore.missing_parts import missing_parts
from diagnostics.explore.payload import PageSource, page_payload, set_source
from diagnostics.explore.recordings_source import ShownRecording, recordings_source
from diagnostics.indicators.table import record_table
from diagnostics.records.state_classes import HEALTHY
from siggen.dataset.reading import Dataset

COLUMNS = (
    *(("record_id", "Record"), ("kind", "Kind"), ("state", "State or verdict"), ("name", "File")),
    *(("damaged_area_mm2", "Area [mm²]"), ("speed_hz", "Speed [Hz]"), ("torque_nm", "Load [N m]")),
    ("specimen_id", "Gearbox"),
)
FILTERS = (("kind", "Kind"), ("state", "State or verdict"), ("specimen_id", "Gearbox"))


def write_beside_page(
    name: str,
    shown: Sequence[ShownRecording],
    dataset: Dataset,
    path: Path,
    options: ExplorerOptions | None = None,
    stage: Stage = silent_stage,
) -> Path:
    """Write the page of recordings beside a set and return its path.

    Parameters
    ----------
    name : str
        Of the machine.
    shown : sequence of ShownRecording
        At least one.
    dataset : siggen Dataset
        The simulated set.
    path : Path
        The HTML file.
    options : ExplorerOptions, optional
        Limit (of simulated records), detail, workers.
    stage : Stage
        Told of every record.

    Raises
    ------
    UsageError
        If Jinja2 is not installed, or recordings and set differ in rate, teeth or number of channels.
    """
    require_packages("the page to explore recordings", "jinja2")
    chosen = options or ExplorerOptions()
    measured = recordings_source(shown)
    labels = dataset.labels(columns=["record_id", "specimen_id"])
    with stage("indicators", labels.num_rows) as advance:
        table = record_table(dataset, own=chosen.own, workers=chosen.workers, advance=advance)
    rows = chosen_records({"specimen_id": np.asarray(labels.column("specimen_id"))}, chosen.limit)
    simulated = set_source(dataset, table, rows)
    source = beside_source(measured, simulated)
    payload = page_payload(source, stage, full=chosen.full)
    payload["served"] = False
    facts = {
        "name": f"{name} beside {dataset.manifest.get('name') or dataset.path.name}",
        "identity": str(dataset.manifest.get("identity", ""))[:12],
        "seen": "",
        "records": len(shown) + labels.num_rows,
        "healthy": int(np.count_nonzero(simulated.labels["fault"] == HEALTHY)),
        "missing": _missing(shown, measured, simulated),
        "served": False,
        "columns": COLUMNS,
        "filters": FILTERS,
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(explorer_page(facts, payload), encoding="utf-8")
    return path


def _missing(shown: Sequence[ShownRecording], measured: PageSource, simulated: PageSource) -> list[str]:
    """Return which channel is taken for which, and what either side does not give."""
    named = {ours: theirs for ours, theirs in channel_mapping(measured, simulated).items() if ours != theirs}
    taken = [f"The recordings' channel {ours} is shown as {theirs} of the set." for ours, theirs in named.items()]
    labels = {name: simulated.labels[name] for name in ("fault", "specimen_id")}
    of_the_set = missing_parts(
        labels, simulated.overlay, bool(simulated.damage), bool(simulated.quantities), named=True
    )
    return [*taken, *missing_sentences(sum(one.healthy for one in shown)), *of_the_set]
