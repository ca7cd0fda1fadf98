"""What a saved classifier names every record of a set, for the page's columns."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from diagnostics.indicators.own_indicator import OwnIndicator
from diagnostics.indicators.table import RecordTable
from diagnostics.prediction.released_model import load_model
from diagnostics.records.state_classes import HEALTHY, class_names
from siggen.errors import UsageError

RIGHT, WRONG = "rightly", "wrongly"


def predicted_labels(table: RecordTable, folder: Path, own: Sequence[OwnIndicator] = ()) -> dict[str, np.ndarray]:
    """Return columns `class`, `predicted` and `named`, (records,) each, by the logistic regression of a model folder.

    Parameters
    ----------
    table : RecordTable
        Indicators of the whole set.
    folder : Path
        What `siggen-diagnostics train` wrote, or the folder of a report, which holds one as `models`.
    own : sequence of OwnIndicator
        The user's indicators that the model takes.

    Raises
    ------
    UsageError
        If the folder holds no model, or one of other channels.
    """
    inside = folder / "models"
    model = load_model(inside if inside.is_dir() else folder, own).classifier
    labels, present = table.labels(), set(table.names())
    if lost := [name for name in model.features if name not in present]:
        raise UsageError(
            f"{folder}: this model takes {len(lost)} columns that the set does not have, such as {lost[0]}; allowed: a "
            f"model of the channels {', '.join(table.channels)}. Train one: siggen-diagnostics train"
        )
    probability = model.probability(table.values(model.features))
    predicted = np.array(model.classes)[probability.argmax(axis=1)]
    healthy = labels["fault"] == HEALTHY
    known = [name for name in np.unique(labels["state"][healthy]).tolist() if name in model.classes]
    truth = class_names(labels, known[0] if known else None)
    return {"class": truth, "predicted": predicted, "named": np.where(predicted == truth, RIGHT, WRONG)}
