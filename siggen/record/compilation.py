"""CompilationPart: a piece of a first record that is run for what it leaves in the cache of compiled functions.

The parts share few functions, so processes compile them side by side. Teeth: the contact and the damage of every kind.
Motion: the loop, the background and the sensors, with plain teeth, so that nothing of the other part is compiled twice.
"""

from __future__ import annotations

import contextlib
import gc
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from siggen.gearbox.specimen import Specimen

TEETH, MOTION = "teeth", "motion"
SHORT_S = 0.02
"""Duration of the record of the part motion."""
COLLECTED_EACH = 50_000
"""Objects between two collections, for Python's 700: a tenth less CPU time, for 23 MB more."""


@dataclass(frozen=True, slots=True)
class CompilationPart:
    """One of the parts; a task for workers.

    Attributes
    ----------
    drawn : returns its gearbox: one with damaged teeth, or a plain one
    states : whose teeth are computed
    """

    name: str
    drawn: Callable[[], Specimen]
    states: tuple[int, ...] = ()

    def __str__(self) -> str:
        return f"compiling the {self.name}"


def is_compiled(method: str) -> bool:
    """Return whether numba's cache holds the time loop of an integrator, which is compiled after the teeth."""
    from siggen.compiled import is_cached
    from siggen.motion import exponential_step, pair_motion, product_integration

    loops: dict[str, Any] = {
        "exponential": exponential_step.advance,
        "runge_kutta": pair_motion._advance,
        "product": product_integration._advance,
    }
    return is_cached(loops[method])


def run_part(part: CompilationPart) -> None:
    """Run a part."""
    # what cannot be simulated is told with the number of its record, later
    with _seldom_collected(), contextlib.suppress(Exception):
        (_run_teeth if part.name == TEETH else _run_motion)(part.drawn(), part.states)


@contextlib.contextmanager
def _seldom_collected() -> Iterator[None]:
    """Look for unused objects seldom: a compiler makes millions, of which few become garbage in cycles."""
    before = gc.get_threshold()
    gc.set_threshold(COLLECTED_EACH, *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)


def _run_teeth(specimen: Specimen, states: tuple[int, ...]) -> None:
    from siggen.record.specimen_state import state_teeth
    from siggen.record.teeth import MeshTeeth

    teeth = MeshTeeth(specimen.law, specimen.meshes[0].teeth)
    for state_id in states:
        state_teeth(specimen, teeth, state_id)


def _run_motion(specimen: Specimen, _: tuple[int, ...]) -> None:
    import numpy as np

    from siggen.gearbox.plan import PlannedRecord
    from siggen.mesh.tooth_law import LINEAR
    from siggen.record.friction import mean_force_n
    from siggen.record.instrument import specimen_instrument
    from siggen.record.simulation import simulated
    from siggen.record.specimen_state import specimen_state

    # Tables of the same types without solving any contact: springs, as the law linear has them.
    springs = replace(specimen, law=replace(specimen.law, kind=LINEAR))
    state = specimen_state(springs, 0)
    list(simulated(specimen, specimen_instrument(specimen), state, PlannedRecord(0, 0, 0, 0, 0, "")))
    # what a label of damaged teeth needs besides
    force_n = mean_force_n(state.pair, specimen.points[0])
    state.static.stiffness_n_per_m(force_n * state.pair.pinion.base_radius_m, np.linspace(0.0, 1.0, 2))
