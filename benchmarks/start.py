"""Start: by how much records of random gearboxes far from the presets change with an earlier start, and their labels.

The gearboxes are those of `anywhere`, every second one spalled. A record starts EARLIER decay times of its slowest mode
before it does; its steps stay. The change is the rms difference of the worst motion over the whole record, relative to
its rms. A record whose teeth part at any time rattles: it is counted, and its samples are not compared.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from benchmarks.anywhere import FEW, GEARBOXES, TOLERANCE, drawn_case, worst_error
from benchmarks.random_gearbox import random_config
from benchmarks.row import Row
from siggen.errors import SolverFailure
from siggen.gearbox.design import SetDesign
from siggen.record.specimen_state import refused_as
from siggen.record.step_choice import LEVELS, stepped_motion

EARLIER = 9.0
LABELLED = 0.1
"""Share of records that may have a label above the tolerance."""


@dataclass(frozen=True, slots=True)
class Started:
    """A record: its label and whether that is of levels, its change with an earlier start, and whether teeth part."""

    label: float
    of_levels: bool
    change: float
    rattles: bool


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield how many records change without a label that says so, and how many have such a label."""
    yield from rows_of(list(started(FEW if quick else GEARBOXES)))


def rows_of(found: list[Started]) -> Iterator[Row]:
    """Yield the rows of what was found."""
    steady = [one for one in found if not one.rattles]
    silent = [one.change for one in steady if one.label <= TOLERANCE]
    above = sum(change > TOLERANCE for change in silent)
    yield Row(
        f"{len(steady)} records without rattle, {len(silent)} with a label within {TOLERANCE:g}: change by the start",
        f"median {np.median(silent):.1e}, worst {max(silent):.1e}, {above} above {TOLERANCE:g}",
        goal="0", met=above == 0,
    )  # fmt: skip
    told = len(steady) - len(silent)
    yield Row(
        f"{len(steady)} records without rattle: label above {TOLERANCE:g}", f"{told}, {told / len(steady):.1%}",
        goal=f"<= {LABELLED:.0%}", met=told <= LABELLED * len(steady),
    )  # fmt: skip
    rattling = [one for one in found if one.rattles]
    changed = [one for one in rattling if one.change > TOLERANCE]
    untold = sum(one.label <= TOLERANCE and not one.of_levels for one in changed)
    yield Row(
        f"{len(rattling)} records that rattle, {len(changed)} of them change by more than {TOLERANCE:g}",
        f"{sum(one.of_levels for one in rattling)} labels are of levels, {untold} changes without a label",
    )


def started(count: int) -> Iterator[Started]:
    """Yield records until so many do not rattle; gearboxes that the model refuses are passed over."""
    number = 0
    while count > 0:
        config = random_config(number)
        try:
            found = None if config is None else _started(config, number % 2)
        except SolverFailure:
            found = None
        number += 1
        if found is not None:
            count -= not found.rattles
            yield found


def _started(config: SetDesign, state_id: int) -> Started | None:
    case = drawn_case(config, state_id)
    with refused_as("outside_model"):
        stepped = stepped_motion(case.specimen.sampling, case.specimen.law, case.state.mesh, case.point, case.driven)
        motion, steps = stepped.motion, stepped.grid.per_sample
        before_s = motion.transient_s + EARLIER * motion.decay_s
        own, earlier = (case.response(motion, steps, settle_s) for settle_s in (0.0, before_s))
    if stepped.error is None or {own.status, earlier.status} != {"ok"}:
        return None
    rattles = max(own.contact_loss_share, earlier.contact_loss_share) > 0.0
    return Started(stepped.error, stepped.error_of == LEVELS, worst_error(own, earlier), rattles)
