"""The page itself: one HTML file that needs neither server nor network.

What a saved classifier names every record of a set, for the page's columns.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.base.extras import require_packages
from diagnostics.base.progress import Stage, silent_stage
from diagnostics.explore.chosen_records import chosen_records, missing_parts
from diagnostics.explore.lives import LIFE_COLUMNS, life_pictures, of_records
from diagnostics.explore.payload import page_payload, set_source
from diagnostics.indicators.own_indicator import OwnIndicator
from diagnostics.indicators.table import RecordTable, record_table
from diagnostics.page.security_policy import security_policy
from diagnostics.page.wording import counted
from diagnostics.prediction.released_model import load_model
from diagnostics.records.record_classes import set_classes
from diagnostics.records.state_classes import HEALTHY
from diagnostics.scoring.truth import is_lives
from diagnostics.training.splits import TEST
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

RIGHT, WRONG = "rightly", "wrongly"
SEEN, UNSEEN = "seen in training", "no"

LIMIT = 100
PAGE = Path(__file__).with_name("page")
SCRIPTS = (
    *("vendored/uPlot.LICENSE", "vendored/uPlot.iife.min.js", "unpack.js", "charts.js", "waveform.js"),
    *("spectra.js", "averages.js", "internals.js", "flank.js", "life.js", "indicators.js", "records.js", "explorer.js"),
)
STYLES = ("vendored/uPlot.min.css", "explorer.css")
Columns = tuple[tuple[str, str], ...]
SET_COLUMNS = (
    *(("record_id", "Record"), ("state", "State"), ("damaged_area_mm2", "Area [mm²]"), ("speed_hz", "Speed [Hz]")),
    *(("torque_nm", "Load [N m]"), ("split", "Split"), ("specimen_id", "Gearbox")),
)
SET_FILTERS = (
    ("state", "State"),
    ("split", "Split"),
    ("speed_hz", "Speed [Hz]"),
    ("torque_nm", "Load [N m]"),
    ("specimen_id", "Gearbox"),
)
NAMED_COLUMNS = (("predicted", "Predicted"), ("named", "Named"), ("seen", "Seen"))
NAMED_FILTERS = (("class", "Class"), *NAMED_COLUMNS)
# What could end the script element, open a comment in it, or end a line of JSON for older readers.
IN_SCRIPT: dict[str, str | int | None] = {
    "<": "\\u003c",
    ">": "\\u003e",
    "&": "\\u0026",
    "\u2028": "\\u2028",
    "\u2029": "\\u2029",
}


def predicted_labels(
    table: RecordTable, dataset: Dataset, folder: Path, own: Sequence[OwnIndicator] = ()
) -> dict[str, np.ndarray]:
    """Return columns `class`, `predicted`, `named`, `seen`, (records,) each, by a model folder's logistic regression.

    A record is seen where its split is one that the model learnt from or was chosen on, of the very set.

    Parameters
    ----------
    table : RecordTable
        Indicators of the whole set.
    dataset : siggen Dataset
        The set; what its classes are is for the model to say.
    folder : Path
        What `siggen-diagnostics report` wrote.
    own : sequence of OwnIndicator
        The user's indicators that the model takes.

    Raises
    ------
    UsageError
        If the folder holds no model, or one of other channels.
    """
    released = load_model(folder, own)
    model = released.classifier
    labels, present = table.labels(), set(table.names())
    if lost := [name for name in model.features if name not in present]:
        raise UsageError(
            f"{folder}: this model takes {len(lost)} columns that the set does not have, such as {lost[0]}; allowed: a "
            f"model of the channels {', '.join(table.channels)}. Train one: siggen-diagnostics report"
        )
    probability = model.probability(table.values(model.features))
    predicted = np.array(model.classes)[probability.argmax(axis=1)]
    healthy = labels["fault"] == HEALTHY
    known = [name for name in np.unique(labels["state"][healthy]).tolist() if name in model.classes]
    truth = set_classes(dataset, released.facts.class_kind, known[0] if known else None).of(labels["state"])
    seen = (labels["split"] != TEST) & (released.facts.identity == _identity(dataset))
    return {
        "class": truth,
        "predicted": predicted,
        "named": np.where(predicted == truth, RIGHT, WRONG),
        "seen": np.where(seen, SEEN, UNSEEN),
    }


def seen_sentence(seen: Sequence[str]) -> str:
    """Say how many of the records the model has learnt from; empty where none."""
    count = sum(one == SEEN for one in seen)
    if count == 0:
        return ""
    return (
        f"{count} of {counted(len(seen), 'record')} are of the gearboxes that the model was trained or chosen on: they "
        f"are marked \N{LEFT DOUBLE QUOTATION MARK}{SEEN}\N{RIGHT DOUBLE QUOTATION MARK}. That these are rightly named "
        "says nothing about other gearboxes."
    )


@dataclass(frozen=True, slots=True)
class ExplorerOptions:
    """What goes on the page.

    Attributes
    ----------
    limit : int
        Most records; whole gearboxes are left out beyond it.
    full : bool
        Whether all samples are kept, as far as 30 MB allow.
    served : bool
        Whether a server adds the samples that the page leaves out.
    workers : int
        Processes that take indicators.
    model : Path, optional
        Folder of a model that names every record.
    own : sequence of OwnIndicator
        The user's indicators.
    first : sequence of int
        Gearboxes that the page shows before all others.
    """

    limit: int = LIMIT
    full: bool = False
    served: bool = False
    workers: int = 1
    model: Path | None = None
    own: Sequence[OwnIndicator] = ()
    first: Sequence[int] = ()


def write_explorer(
    dataset: Dataset, path: Path, options: ExplorerOptions | None = None, stage: Stage = silent_stage
) -> Path:
    """Write the page of a set and return its path.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    path : Path
        The HTML file.
    options : ExplorerOptions, optional
    stage : Stage, optional
        Told of the progress.

    Raises
    ------
    DatasetError
        If the set holds no records.
    UsageError
        If Jinja2 is not installed, or the model is none of this set's channels.
    """
    page, _ = explorer_of(dataset, options or ExplorerOptions(), stage)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(page, encoding="utf-8")
    return path


def explorer_of(dataset: Dataset, options: ExplorerOptions, stage: Stage) -> tuple[str, np.ndarray]:
    """Return the page of a set and the numbers of its records; parameters and errors as of `write_explorer`."""
    require_packages("the page to explore a set", "jinja2")
    labels = dataset.labels(columns=["record_id", "specimen_id"])
    with stage("indicators", labels.num_rows) as advance:
        table = record_table(dataset, own=options.own, workers=options.workers, advance=advance)
    said = predicted_labels(table, dataset, options.model, options.own) if options.model else {}
    specimens = {"specimen_id": np.asarray(labels.column("specimen_id"))}
    rows = chosen_records(specimens, options.limit, options.first)
    payload = page_payload(set_source(dataset, table, rows), stage, full=options.full)
    for place, record in enumerate(payload["records"]):
        record.update({name: str(values[rows[place]]) for name, values in said.items()})
    if is_lives(dataset):
        with stage("lives", 1) as advance:
            _add_lives(payload, dataset, table)
            advance()
    payload["served"] = options.served
    page = explorer_page(_facts(dataset, payload, labels.num_rows, options), payload)
    return page, np.asarray(labels.column("record_id"))[rows]


def _add_lives(payload: dict[str, Any], dataset: Dataset, table: RecordTable) -> None:
    """Give records their age and remaining life, and the page its gearboxes over their lives."""
    records = payload["records"]
    for record, life in zip(records, of_records(dataset, [row["record_id"] for row in records]), strict=True):
        record.update(life)
    payload["lives"] = life_pictures(dataset, table, sorted({row["specimen_id"] for row in records}))


def _identity(dataset: Dataset) -> str:
    return str(dataset.manifest.get("identity", ""))


def _facts(dataset: Dataset, payload: dict[str, Any], records: int, options: ExplorerOptions) -> dict[str, Any]:
    """Return what the template says in words."""
    labels = {name: np.asarray([row[name] for row in payload["records"]]) for name in ("fault", "specimen_id")}
    internals = bool(payload["quantities"])
    return {
        "name": str(dataset.manifest.get("name") or dataset.path.name),
        "identity": _identity(dataset)[:12],
        "seen": seen_sentence([row["seen"] for row in payload["records"]]) if options.model else "",
        "records": records,
        "healthy": int(np.count_nonzero(labels["fault"] == HEALTHY)),
        "missing": missing_parts(
            labels, payload["overlay"], bool(payload["damage"]), internals, named=options.model is not None
        ),
        "served": options.served,
        "columns": _columns(SET_COLUMNS, NAMED_COLUMNS if options.model else LIFE_COLUMNS if is_lives(dataset) else ()),
        "filters": [*SET_FILTERS, *(NAMED_FILTERS if options.model else ())],
    }


def _columns(
    columns: tuple[tuple[str, str], ...], after_the_state: tuple[tuple[str, str], ...]
) -> list[tuple[str, str]]:
    """Return key and title of the columns of the table."""
    return [*columns[:2], *after_the_state, *columns[2:]]


def explorer_page(facts: dict[str, Any], payload: dict[str, Any]) -> str:
    """Return the page; every text of the set is escaped, in the markup by Jinja, in the data as JSON escapes."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from markupsafe import Markup

    scripts = _files(SCRIPTS)
    policy = Markup(security_policy([str(scripts)], asks_its_server=bool(facts["served"])))
    environment = Environment(loader=FileSystemLoader(PAGE), autoescape=True, undefined=StrictUndefined)
    return environment.get_template("explorer.html").render(
        facts=facts,
        payload=payload,
        data=script_json(payload),
        policy=policy,
        scripts=scripts,
        styles=_files(STYLES),
    )


def script_json(value: Any) -> Any:
    """Return JSON that may stand inside a script element: nothing in it can close the element or open another.

    Raises
    ------
    ValueError
        If a number is not finite, which JSON cannot hold.
    """
    from markupsafe import Markup

    text = json.dumps(value, allow_nan=False, separators=(",", ":"), ensure_ascii=False)
    return Markup(text.translate(str.maketrans(IN_SCRIPT)))


def _files(names: tuple[str, ...]) -> Any:
    """Return files of the package, which are our own text, as they are."""
    from markupsafe import Markup

    return Markup("\n".join(_text(name) for name in names))


def _text(name: str) -> str:
    """Return a file of the package; a licence as a comment, since it must go along with every copy."""
    text = (PAGE / name).read_text(encoding="utf-8")
    return f"/*\n{text}*/" if name.endswith("LICENSE") else text
