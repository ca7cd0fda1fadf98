"""Lines at whole orders of a shaft that stand out one by one: waves that a machine left on the flanks (ghost lines).

A wave of k periods round a gear has a line at k, with sidebands. Errors that differ from tooth to tooth have lines at
all orders of a shaft. The power of these is exponential where errors are independent: 2^-4 = 6 % of them lie 6 dB above
the median too, and are taken for waves. Source: derived.
"""

from __future__ import annotations

import numpy as np

from diagnostics.calibration.order_record import SAME_ORDER
from diagnostics.calibration.own_lines import SHAFT_ORDERS, OwnLine
from diagnostics.calibration.second_stage import Multiples, shaft_line

WAVE_EXCESS_DB = 6.0
"""Chosen on one simulated machine, from 10 and 6 dB: docs/understand/calibration.md."""


def wave_lines(
    multiples: Multiples, teeth: tuple[int, int], channel: str, known: tuple[float, ...]
) -> tuple[OwnLine, ...]:
    """Return these lines of a channel.

    Parameters
    ----------
    multiples : mapping
        By shaft and channel.
    teeth : (int, int)
    channel : str
    known : tuple of float
        Orders that are taken already: those of a second stage.
    """
    found: dict[float, OwnLine] = {}
    for shaft, step in (("pinion", 1.0), ("gear", teeth[0] / teeth[1])):
        if channel not in multiples.get(shaft, {}):
            continue
        own = multiples[shaft][channel]
        for number in (np.flatnonzero(own.excess_db >= WAVE_EXCESS_DB) + 1).tolist():
            order = number * step
            if number > SHAFT_ORDERS and all(abs(order - other) > SAME_ORDER for other in (*known, *found)):
                found[order] = shaft_line("", number, step, own).line
    return tuple(found.values())
