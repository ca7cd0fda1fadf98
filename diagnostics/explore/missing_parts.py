"""What a set does not give to the page, and how it would."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diagnostics.page.wording import counted
from diagnostics.records.state_classes import HEALTHY


def missing_parts(
    labels: Mapping[str, np.ndarray],
    overlaid: Sequence[int | None],
    damaged_flanks: bool,
    internals: bool,
    *,
    named: bool,
) -> list[str]:
    """Return sentences on what is missing; none for a set that has everything."""
    healthy = labels["fault"] == HEALTHY
    alone = sum(other is None for other in overlaid)
    found = []
    if not healthy.any():
        found.append(
            "No healthy records: no overlay, no difference, and no place of an indicator among healthy gearboxes. A "
            "state without damage under “states” in the configuration gives them."
        )
    elif alone:
        found.append(
            f"{counted(alone, 'record')} of {healthy.size} without another healthy record of the same gearbox at the "
            "same operating point: these have no overlay. More “repeats” give healthy records a second one."
        )
    if healthy.any() and np.unique(labels["specimen_id"][healthy]).size < 2:
        found.append("Healthy records of one gearbox only: an indicator has no place among other healthy gearboxes.")
    if not damaged_flanks:
        found.append("No table of damage beside the labels, or no damaged record: no flank is drawn.")
    if not internals:
        found.append(
            "Neither transmission error nor mesh force in the set: quantities that no sensor sees are not there to "
            "show. “internals” in the configuration stores them."
        )
    if not named:
        found.append(
            "No model: the page does not say what a classifier names each record. `--model` takes the folder of train "
            "or report."
        )
    return found
