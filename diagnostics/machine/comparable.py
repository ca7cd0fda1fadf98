"""Comparable: which references a recording is compared with, and the conditions in which they differ from it.

Near ones are taken first. Where the references span its speed or load, they say what to expect there; outside of the
span nothing is said of the machine. Below a tenth of the largest load gears rattle and other machines are louder:
recordings there are compared with such alone. Levels rise about in proportion to load and faster with speed; lines
that pass modes of the housing bend that by a few decibels. Source of these numbers: judgement; how strongly a
machine follows them is found from its references.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log

import numpy as np

from diagnostics.machine.machine import Machine
from diagnostics.statistics.change_score import FEWEST, Condition

SPEED_RATIO = 1.05
"""Up to which indicators are compared directly: a line moves by less than the width of most modes."""
LOAD_RATIO = 1.2
"""Up to which a load lies beside those of the references."""
FEWEST_OVER_SPEED = 5
"""References that span a speed: lines between them pass modes that fewer do not show."""
NO_LOAD = 0.1
"""Share of the largest load below which gears are as good as unloaded."""
SLIP_MARGIN = 0.1
"""Share of the references' span of slip that a recording may lie outside."""
LOAD, SLIP = (1.0, 0.2, 0.5), (1.5, 0.2, 0.25)
SPEED = (2.0, 0.5, 0.1)
"""Slope, bend and length of `Condition`: over log load, over the span of slip, over log speed."""


@dataclass(frozen=True, slots=True)
class Comparable:
    """Which references are used (n,) bool, and the conditions of these and, last, of the recording."""

    used: np.ndarray
    conditions: tuple[Condition, ...] = ()


def slip_loads(speed_hz: np.ndarray, fastest_hz: float, slowest_hz: float) -> np.ndarray:
    """Return loads from speeds: 0 at the fastest reference, 1 at the slowest."""
    return np.asarray((fastest_hz - speed_hz) / (fastest_hz - slowest_hz))


def comparable(machine: Machine, speed_hz: float, load: float | None) -> Comparable | None:
    """Return what a recording is compared with; None where the references do not reach to its speed or load.

    Parameters
    ----------
    machine : Machine
    speed_hz : float
        Of the recording.
    load : float or None
        In the unit of the references; not asked for where slip tells it.
    """
    near = np.abs(np.log(machine.speed_hz / speed_hz)) <= log(SPEED_RATIO)
    over_speed = np.count_nonzero(near) < FEWEST and machine.speed_hz.size >= FEWEST_OVER_SPEED
    if over_speed and not _inside(machine.speed_hz, speed_hz, SPEED_RATIO):
        return None
    used = np.ones_like(near) if over_speed else near
    loads = _loads(machine, speed_hz, load)
    if loads is not None and not machine.load_from_slip:  # slip does not tell where no load is
        idle = np.abs(loads) < NO_LOAD * np.abs(loads[:-1]).max()
        used &= idle[:-1] == idle[-1]
    if not used.any() or (loads is not None and not _within(machine, loads[:-1][used], loads[-1])):
        return None
    chosen = np.append(used, True)
    conditions = [Condition(np.log(np.append(machine.speed_hz, speed_hz)[chosen]), *SPEED)] if over_speed else []
    if loads is not None:
        scaled = loads[chosen] if machine.load_from_slip else _log_loads(loads[chosen])
        conditions.append(Condition(scaled, *(SLIP if machine.load_from_slip else LOAD)))
    return Comparable(used, tuple(conditions))


def _loads(machine: Machine, speed_hz: float, load: float | None) -> np.ndarray | None:
    """Return the loads of all references and, last, of the recording; None where they are not known."""
    if machine.load_from_slip:
        fastest, slowest = float(machine.speed_hz.max()), float(machine.speed_hz.min())
        return slip_loads(np.append(machine.speed_hz, speed_hz), fastest, slowest)
    if load is None or not np.isfinite(machine.load).all():
        return None
    return np.append(machine.load, load)


def _within(machine: Machine, references: np.ndarray, load: float) -> bool:
    """Tell whether a load lies in the span of the references' or beside it."""
    if machine.load_from_slip:
        return bool(references.min() - SLIP_MARGIN <= load <= references.max() + SLIP_MARGIN)
    return _inside(np.abs(references), abs(load), LOAD_RATIO)


def _inside(references: np.ndarray, value: float, ratio: float) -> bool:
    return bool(references.min() / ratio <= value <= references.max() * ratio)


def _log_loads(loads: np.ndarray) -> np.ndarray:
    size = np.abs(loads)
    return np.asarray(np.log(size + max(NO_LOAD * float(size.max()), np.finfo(float).tiny)))
