"""Predictions as columns: read from a file or taken from Python, and written by every training.

One row per record and classifier: `record_id`, the columns of a task (`diagnostics.scoring.task`), and `classifier`
where a file holds several. What trainings write names the set in its metadata, so that it is never laid beside another
one.

The columns of one classifier's predictions, brought into the order of the records; everything wrong in one list.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from diagnostics.base.beside import beside
from diagnostics.base.reading_process import read_apart
from diagnostics.records.record_classes import FAULT, STATE, set_classes
from diagnostics.records.state_classes import CLASS
from diagnostics.scoring.grade import PROBABILITY
from diagnostics.scoring.prediction_reading import keep_table, kept_table
from diagnostics.scoring.remaining_life import RUL
from diagnostics.scoring.size import AREA
from diagnostics.scoring.tasks import TASKS
from diagnostics.scoring.truth import Truth, is_lives
from diagnostics.statistics.evaluation import Predictions
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError, counted
from siggen.file_writing import write_file

SHOWN, MOST_CLASSIFIERS = 5, 1_000

PREDICTIONS_FILE, MODELS_FOLDER = "predictions.parquet", "models"
RECORD, CLASSIFIER, SPLIT = "record_id", "classifier", "split"
BESIDE = ("_report", "_models")
"""Folders beside a set that `siggen-diagnostics report` writes unless told otherwise."""
IDENTITY_KEY, KIND_KEY = b"diagnostics.identity", b"diagnostics.classes"


def matched_columns(table: pa.Table, truth: Truth, where: Any) -> dict[str, np.ndarray]:
    """Return the columns of tasks, (n,) each in the order of the truth; classes as positions.

    Parameters
    ----------
    table : pyarrow.Table
        One row per record; records of other splits are left out, columns of no task too.
    truth : Truth
        Of n records.
    where : path or str
        What the message begins with.

    Raises
    ------
    UsageError
        Listing every record that is missing, comes twice or is unknown, and every value that cannot be.
    """
    columns, problems = checked_columns(table, truth)
    if problems:
        raise UsageError(refusal(where, problems, truth))
    return columns


def checked_columns(table: pa.Table, truth: Truth) -> tuple[dict[str, np.ndarray], list[str]]:
    """Return the columns as `matched_columns`, as far as they can be used, and everything that is wrong."""
    problems: list[str] = []
    place = _places(table, truth, problems)
    return ({} if place is None else _columns(table.take(pa.array(place)), truth, problems)), problems


def refusal(where: Any, problems: Sequence[str], truth: Truth) -> str:
    """Return the message about predictions with problems: all of them, and what is allowed."""
    lines = "\n".join(f"  {problem}" for problem in problems)
    takes = "; ".join(f"{task.name} takes {task.takes}" for task in TASKS if task.parts(truth))
    classes = f" Classes: {', '.join(truth.classes)}." if truth.classes else ""
    return (
        f"{where}: {counted(len(problems), 'problem')}\n{lines}\nOne row is needed for each of the "
        f"{counted(truth.record_id.size, 'record')} of the split {truth.split}, with {RECORD} and the columns of a "
        f"task: {takes}.{classes}"
    )


def _places(table: pa.Table, truth: Truth, problems: list[str]) -> np.ndarray | None:
    """Return the row of each record; None where they cannot be told."""
    if RECORD not in table.column_names:
        problems.append(f"no column {RECORD}; received {', '.join(table.column_names) or 'no columns'}")
        return None
    column = table.column(RECORD)
    if not pa.types.is_integer(column.type) or column.null_count:
        problems.append(f"{RECORD} holds {column.type}, {counted(column.null_count, 'empty value')}; allowed: integers")
        return None
    found = column.to_numpy(zero_copy_only=False)
    for what, records in (
        ("not in the set", np.setdiff1d(found, np.concatenate([truth.record_id, truth.elsewhere]))),
        ("missing", np.setdiff1d(truth.record_id, found)),
        ("there more than once", _doubled(found)),
    ):
        if records.size:
            problems.append(f"{counted(records.size, 'record')} {what}: {RECORD} {_shown(records)}")
    order = np.argsort(found, kind="stable")
    kept = truth.record_id[np.isin(truth.record_id, found)]
    return np.asarray(order[np.searchsorted(found[order], kept)])


def _doubled(found: np.ndarray) -> np.ndarray:
    values, counts = np.unique(found, return_counts=True)
    return np.asarray(values[counts > 1])


def _columns(table: pa.Table, truth: Truth, problems: list[str]) -> dict[str, np.ndarray]:
    """Return the columns of tasks of a table in the order of the truth, as far as they can be used."""
    record_id = table.column(RECORD).to_numpy(zero_copy_only=False)
    known = {taken.name: taken for task in TASKS for taken in task.columns(truth)}
    columns: dict[str, np.ndarray] = {}
    for name in table.column_names:
        if name in known:
            columns[name], found = known[name].read(table.column(name))
            problems += [_bad(f"{name} {what}", record_id[bad], known[name].allowed) for what, bad in found]
        elif name.startswith(PROBABILITY):
            problems.append(f"column {name} is of no class")
    for task in TASKS:
        problems += [
            _bad(what, record_id[np.flatnonzero(bad)], allowed) for what, bad, allowed in task.problems(columns, truth)
        ]
    if not problems and all(task.answers(columns, truth) is None for task in TASKS):
        problems.append(f"no columns of a task; received {', '.join(table.column_names)}{_of_lives(table)}")
    return columns


def _of_lives(table: pa.Table) -> str:
    """Return what a question about remaining life needs, where it is asked of a set without lives."""
    if RUL not in table.column_names:
        return ""
    return f"; {RUL}, the remaining life, is asked of sets of lives alone: `siggen generate fleet --out runs/fleet`"


def _bad(what: str, records: np.ndarray, allowed: str) -> str:
    where = f" in {counted(records.size, 'record')} ({RECORD} {_shown(records)})" if records.size else ""
    return f"{what}{where}; allowed: {allowed}"


def _shown(records: np.ndarray) -> str:
    more = " ..." if records.size > SHOWN else ""
    return ", ".join(str(number) for number in records[:SHOWN].tolist()) + more


def write_predictions(parts: Sequence[pa.Table], identity: str, folder: Path, kind: str = STATE) -> Path:
    """Write the predictions of all classifiers into the folder of their models; return the file's path.

    `identity` is that of the set, `kind` what the classes are.
    """
    from pyarrow import parquet

    table = pa.concat_tables(list(parts)).replace_schema_metadata(
        {IDENTITY_KEY: identity.encode(), KIND_KEY: kind.encode()}
    )
    path = folder / PREDICTIONS_FILE
    write_file(path, lambda draft: parquet.write_table(table, draft, compression="zstd"))
    return path


def predicted_rows(
    classifier: str, split: str, record_id: np.ndarray, found: Predictions, class_areas: np.ndarray
) -> pa.Table:
    """Return the rows of a classifier: probabilities of its classes and the damaged area that they expect.

    Parameters
    ----------
    classifier, split : str
    record_id : (n,) int
    found : Predictions
    class_areas : (classes,) float64
        Mean damaged area of every class [mm^2].
    """
    columns = {f"{PROBABILITY}{name}": found.probability[:, k] for k, name in enumerate(found.classes)}
    names = {CLASSIFIER: [classifier] * record_id.size, SPLIT: [split] * record_id.size}
    areas = found.probability @ class_areas
    return pa.table({**names, RECORD: pa.array(record_id, pa.int64()), **columns, AREA: areas})


def prediction_table(predictions: Any) -> pa.Table:
    """Return predictions as a table.

    Parameters
    ----------
    predictions : path, mapping of str to (n,), pyarrow table or data frame
        Files: .parquet or .csv.

    Raises
    ------
    UsageError
        If they cannot be read, or their columns differ in length.
    """
    if isinstance(predictions, str | Path):
        with read_apart(Path(predictions), f"{keep_table.__module__}:{keep_table.__name__}") as folder:
            return _usable(kept_table(folder), predictions)
    try:
        return _usable(pa.table(predictions), "predictions")
    except (TypeError, ValueError, pa.ArrowException) as error:
        raise UsageError(f"predictions: no table ({error}); allowed: columns by name, all of one length") from error


def _usable(table: pa.Table, where: Any) -> pa.Table:
    """Return a table whose columns have a name each, with names of classifiers as texts."""
    doubled = [name for name, count in Counter(table.column_names).items() if count > 1]
    if doubled:
        raise UsageError(f"{where}: the column {', '.join(doubled[:SHOWN])} is there more than once; allowed: once")
    if CLASSIFIER not in table.column_names:
        return table
    column = table.column(CLASSIFIER)
    if column.null_count or not (pa.types.is_string(column.type) or pa.types.is_primitive(column.type)):
        empty = counted(column.null_count, "empty value")
        raise UsageError(f"{where}: {CLASSIFIER} holds {column.type}, {empty}; allowed: a name in each row")
    names = column.cast(pa.string())
    if (count := pc.count_distinct(names).as_py()) > MOST_CLASSIFIERS:
        raise UsageError(f"{where}: {count} names in {CLASSIFIER}; allowed: {MOST_CLASSIFIERS}")
    return table.set_column(table.column_names.index(CLASSIFIER), CLASSIFIER, names)


def by_classifier(table: pa.Table, name: str) -> dict[str, pa.Table]:
    """Return the rows of every classifier of a table; of the only one under the given name."""
    if CLASSIFIER not in table.column_names:
        return {name: table}
    column = table.column(CLASSIFIER)
    return {str(own): table.filter(pc.equal(column, own)) for own in pc.unique(column).to_pylist()}


def baselines_file(folder: Path) -> Path:
    """Return the file of predictions in a folder of `report`.

    Raises
    ------
    UsageError
        If there is none.
    """
    places = (folder, folder / MODELS_FOLDER)
    for place in places:
        if (place / PREDICTIONS_FILE).is_file():
            return place / PREDICTIONS_FILE
    raise UsageError(
        f"{folder}: has no {PREDICTIONS_FILE}; allowed: a folder that `siggen-diagnostics report` wrote. "
        "One of an earlier version has none: run that command again"
    )


def baselines_beside(dataset: Dataset) -> Path | None:
    """Return the predictions of what was trained on this very set and lies beside it; None where nothing does."""
    for ending in BESIDE:
        folder = beside(dataset.path, ending)
        for file in (folder / MODELS_FOLDER / PREDICTIONS_FILE, folder / PREDICTIONS_FILE):
            if file.is_file() and identity_of(prediction_table(file)) == dataset.manifest["identity"]:
                return file
    return None


def identity_of(table: pa.Table) -> str | None:
    """Return the identity of the set that predictions name; None where they name none."""
    named = (table.schema.metadata or {}).get(IDENTITY_KEY)
    return None if named is None else named.decode(errors="replace")


def check_identity(table: pa.Table, identity: str, where: Any) -> None:
    """Check that predictions which name their set are of this one.

    Raises
    ------
    UsageError
        If they are of another one.
    """
    named = identity_of(table) or identity
    if named != identity:
        raise UsageError(
            f"{where}: holds predictions of the set {named[:12]}; this one is {identity[:12]}. Train on this set: "
            "siggen-diagnostics report"
        )


def named_kind(table: pa.Table, dataset: Dataset) -> str:
    """Return what a class of predictions is: what they say, or faults where their columns name no states but those."""
    said = (table.schema.metadata or {}).get(KIND_KEY)
    if said in (STATE.encode(), FAULT.encode()):
        return str(said.decode())
    if is_lives(dataset):
        return STATE
    named = {name.removeprefix(PROBABILITY) for name in table.column_names if name.startswith(PROBABILITY)}
    if CLASS in table.column_names and pa.types.is_string(table.column(CLASS).type):
        named |= {str(name) for name in pc.unique(table.column(CLASS)).to_pylist()}
    states, faults = (set(set_classes(dataset, kind).names) for kind in (STATE, FAULT))
    return FAULT if named and named <= faults and not named <= states else STATE


def check_classes(table: pa.Table, kind: str, where: Any) -> None:
    """Check that predictions which say what their classes are mean the same by a class.

    Raises
    ------
    UsageError
        If they do not.
    """
    named = (table.schema.metadata or {}).get(KIND_KEY, kind.encode()).decode(errors="replace")
    if named != kind:
        raise UsageError(f"{where}: its classes are {named}s; asked for were {kind}s. Judge them by those")
