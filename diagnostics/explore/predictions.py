"""What a saved classifier names every record of a set, for the page's columns."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from diagnostics.indicators.own_indicator import OwnIndicator
from diagnostics.indicators.table import RecordTable
from diagnostics.page.wording import counted
from diagnostics.prediction.released_model import load_model
from diagnostics.records.state_classes import HEALTHY, class_names
from diagnostics.training.splits import TEST
from siggen.errors import UsageError

RIGHT, WRONG = "rightly", "wrongly"
SEEN, UNSEEN = "seen in training", "no"


def predicted_labels(
    table: RecordTable, identity: str, folder: Path, own: Sequence[OwnIndicator] = ()
) -> dict[str, np.ndarray]:
    """Return columns `class`, `predicted`, `named`, `seen`, (records,) each, by a model folder's logistic regression.

    A record is seen where its split is one that the model learnt from or was chosen on, of the very set.

    Parameters
    ----------
    table : RecordTable
        Indicators of the whole set.
    identity : str
        Of the set.
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
    truth = class_names(labels, known[0] if known else None)
    seen = (labels["split"] != TEST) & (released.facts.identity == identity)
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
