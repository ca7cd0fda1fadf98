"""How many gearboxes an audit needs, where so few were judged that chance alone looks like damage."""

from __future__ import annotations

import math

from diagnostics.audit.bank_detections import ChanceLimit
from diagnostics.audit.detectability import TARGETS
from diagnostics.audit.simple_thresholds import LARGEST_AUC


def gearboxes_needed(chance: ChanceLimit | None, specimens: int) -> int | None:
    """Return the least number of gearboxes that may tell; None where those that were judged do.

    So few tell nothing where the strongest attacker reaches by chance what a trap is accused of, 0.9. As many are
    needed as bring that limit down to the lowest AUC that counts as found, 0.75: its distance from 0.5 falls as one
    over the root of the gearboxes, as does the scatter of an AUC (Birnbaum and Klose 1957). Derived. An AUC ends at 1,
    so the number is the least.

    Parameters
    ----------
    chance : ChanceLimit, optional
        What the strongest attacker reaches by chance; undefined where nothing could be judged.
    specimens : int
        Gearboxes that were judged.
    """
    if chance is None or not math.isfinite(chance.auc) or chance.auc < LARGEST_AUC:
        return None
    excess = (chance.auc - 0.5) / (TARGETS[0] - 0.5)
    # the last digits are of floating point: 24.000000000000004 gearboxes are 24
    return math.ceil(round(specimens * excess * excess, 9))
