"""Records of a set on a page: chosen, zoomed, compared; the report holds them, and they make a page of their own.

What a saved classifier names every record of a set, for the page's columns.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from diagnostics.base.progress import Stage, silent_stage
from diagnostics.explore.look import RECORDS_WORDS, TEMPLATES, Look, look_of, look_page
from diagnostics.explore.payload import PageSource, RecordList
from diagnostics.explore.set_source import chosen_records, missing_parts, set_source
from diagnostics.indicators.own_indicator import OwnIndicator
from diagnostics.indicators.table import RecordTable, record_table
from diagnostics.page.sentences import filled
from diagnostics.page.template import write_page
from diagnostics.prediction.released_model import ReleasedModel
from diagnostics.records.record_classes import set_classes
from diagnostics.records.state_classes import HEALTHY
from diagnostics.training.splits import TEST
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

RIGHT, WRONG = "rightly", "wrongly"
SEEN, UNSEEN = "seen in training", "no"

LIMIT = 40
"""Of as many records of two channels the page holds signals of full detail below 3 MB."""
COLUMNS = (
    *(("record_id", "Record"), ("state", "State"), ("damaged_area_mm2", "Area [mm²]"), ("speed_hz", "Speed [Hz]")),
    *(("torque_nm", "Load [N m]"), ("split", "Split"), ("specimen_id", "Gearbox")),
)
FILTERS = (("state", "State"), ("split", "Split"), ("specimen_id", "Gearbox"))
NAMED_COLUMNS = (("predicted", "Predicted"), ("named", "Named"), ("seen", "Seen"))
NAMED_FILTERS = (("class", "Class"), *NAMED_COLUMNS)


def predicted_labels(table: RecordTable, dataset: Dataset, released: ReleasedModel) -> dict[str, np.ndarray]:
    """Return columns `class`, `predicted`, `named`, `seen`, (records,) each, by a model's logistic regression.

    A record is seen where its split is one that the model learnt from or was chosen on, of the very set.

    Parameters
    ----------
    table : RecordTable
        Indicators of the whole set.
    dataset : siggen Dataset
        The set; what its classes are is for the model to say.
    released : ReleasedModel
        What `load_model` returned.

    Raises
    ------
    UsageError
        If the model is one of other channels.
    """
    model = released.classifier
    labels, present = table.labels(), set(table.names())
    if lost := [name for name in model.features if name not in present]:
        raise UsageError(
            f"{released.folder}: this model takes {len(lost)} columns that the set does not have, such as {lost[0]}; "
            f"allowed: a model of the channels {', '.join(table.channels)}. Train one: siggen-diagnostics report"
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


@dataclass(frozen=True, slots=True)
class LookOptions:
    """What goes on the page.

    Attributes
    ----------
    limit : int
        Most records whose signals it holds, of whole gearboxes.
    full : bool
        Whether all samples are kept, as far as 30 MB allow.
    workers : int
        Processes that take indicators.
    model : ReleasedModel, optional
        It names every record.
    own : sequence of OwnIndicator
        The user's indicators.
    first : sequence of int
        Gearboxes whose signals come before all others.
    ranked : sequence of str
        Indicators, the best first.
    """

    limit: int = LIMIT
    full: bool = False
    workers: int = 1
    model: ReleasedModel | None = None
    own: Sequence[OwnIndicator] = ()
    first: Sequence[int] = ()
    ranked: Sequence[str] = ()


@dataclass(frozen=True, slots=True)
class Lives:
    """What a set of lives adds: labels of its records with their titles, and figure and caption of a gearbox."""

    labels: Mapping[str, np.ndarray]
    titles: tuple[tuple[str, str], ...]
    figure: Callable[[int], dict[str, str]] | None


NO_LIVES = Lives({}, (), None)
LivesOf = Callable[[Dataset, RecordTable], Lives]


def set_look(
    dataset: Dataset,
    options: LookOptions,
    stage: Stage = silent_stage,
    lives_of: LivesOf | None = None,
    table: RecordTable | None = None,
) -> Look:
    """Return the records of a set as a part of a page.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    options : LookOptions
    stage : Stage
        Told of the progress.
    lives_of : callable, optional
        Returns what a set of lives adds.
    table : RecordTable, optional
        Indicators of the set, where they are there.

    Raises
    ------
    DatasetError
        If the set holds no records.
    UsageError
        If the model is none of this set's channels.
    """
    labels = dataset.labels(columns=["record_id", "specimen_id"])
    if table is None:
        with stage("indicators", labels.num_rows) as advance:
            table = record_table(dataset, own=options.own, workers=options.workers, advance=advance)
    said = predicted_labels(table, dataset, options.model) if options.model else {}
    lives = lives_of(dataset, table) if lives_of else NO_LIVES
    specimens = {"specimen_id": np.asarray(labels.column("specimen_id"))}
    kept = chosen_records(specimens, options.limit, options.first)
    source = set_source(dataset, table, kept)
    source = replace(source, labels={**source.labels, **lives.labels, **said}, life=lives.figure)
    shown = _shown(dataset, source, options, lives)
    return look_of(source, shown, stage, full=options.full)


def _shown(dataset: Dataset, source: PageSource, options: LookOptions, lives: Lives) -> RecordList:
    """Return how the page lists the records."""
    known = options.model is not None
    damaged = bool((source.labels["fault"] != HEALTHY).any()) and hasattr(dataset, "damage")
    missing = missing_parts(source.labels, source.overlay, damaged, bool(source.quantities), named=known)
    own = [f"{indicator.function.__module__}:{indicator.function.__name__}" for indicator in options.own]
    code = filled(TEMPLATES / "code.txt", name=_literal(dataset.path.name), own=_literal(own) if own else "")
    seen = int((source.labels["seen"] == SEEN).sum()) if known else 0
    return RecordList(
        columns=(*COLUMNS[:2], *(NAMED_COLUMNS if known else ()), *lives.titles, *COLUMNS[2:]),
        filters=(*FILTERS, *(NAMED_FILTERS if known else ())),
        missing=missing,
        seen=RECORDS_WORDS.seen(seen, source.labels["fault"].size, SEEN),
        code=code.rstrip(),
        ranked=list(options.ranked),
    )


def _literal(value: str | list[str]) -> str:
    """Return a value as Python writes it, whatever signs it has."""
    return json.dumps(value, ensure_ascii=False)


def write_set_page(
    dataset: Dataset,
    path: Path,
    options: LookOptions | None = None,
    stage: Stage = silent_stage,
    lives_of: LivesOf | None = None,
) -> Path:
    """Write the records of a set as a page of its own and return its path; parameters and errors as of `set_look`."""
    look = set_look(dataset, options or LookOptions(), stage, lives_of)
    write_page(path, look_page(f"Records of {set_name(dataset)}", look))
    return path


def set_name(dataset: Dataset) -> str:
    """Return what a set is called."""
    return str(dataset.manifest.get("name") or dataset.path.name)


def _identity(dataset: Dataset) -> str:
    return str(dataset.manifest.get("identity", ""))
