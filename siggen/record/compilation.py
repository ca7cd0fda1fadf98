"""CompilationPart: a piece of a first record that is run for what it leaves in the cache of compiled functions.

The parts share few functions, so processes compile them side by side. Teeth: the contact and the damage of every kind.
Motion: the loop, the background and the sensors, with plain teeth, so that nothing of the other part is compiled twice.
"""

from __future__ import annotations

import contextlib
import gc
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from siggen.config import Config

TEETH, MOTION = "teeth", "motion"
SHORT_S = 0.02
"""Duration of the record of the part motion."""
COLLECTED_EACH = 50_000
"""Objects between two collections, for Python's 700: a tenth less CPU time, for 23 MB more."""


@dataclass(frozen=True, slots=True)
class CompilationPart:
    """One of the parts for one configuration; a task for engines."""

    config: Config
    name: str

    def __str__(self) -> str:
        return f"compiling the {self.name}"


def to_compile(config: Config) -> tuple[CompilationPart, ...]:
    """Return the parts, largest first; none where a record of such a configuration was compiled on this machine."""
    return () if is_compiled(config) else (CompilationPart(config, TEETH), CompilationPart(config, MOTION))


def is_compiled(config: Config) -> bool:
    """Return whether numba's cache holds the time loop of a configuration, which is compiled after its teeth."""
    from siggen.compiled import is_cached
    from siggen.dynamics.time import exponential_step, pair_motion, product_integration

    loops: dict[str, Any] = {
        "exponential": exponential_step.advance,
        "runge_kutta": pair_motion._advance,
        "product": product_integration._advance,
    }
    return is_cached(loops[config.dynamics.method])


def run_part(part: CompilationPart) -> None:
    """Run a part."""
    # what cannot be simulated is told with the number of its record, later
    with _seldom_collected(), contextlib.suppress(Exception):
        if part.name == TEETH:
            _run_teeth(part.config)
        else:
            _run_motion(part.config)


@contextlib.contextmanager
def _seldom_collected() -> Iterator[None]:
    """Look for unused objects seldom: a compiler makes millions, of which few become garbage in cycles."""
    before = gc.get_threshold()
    gc.set_threshold(COLLECTED_EACH, *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)


def _run_teeth(config: Config) -> None:
    from siggen.gearbox.configured import gearbox_config
    from siggen.gearbox.draw import draw_specimen
    from siggen.record.specimen_state import state_teeth
    from siggen.specimen.mesh_teeth import MeshTeeth

    specimen, own = draw_specimen(config, 0), gearbox_config(config, 0)
    teeth = MeshTeeth(specimen.law, specimen.meshes[0].teeth)
    for state_id in _damaged(own):
        state_teeth(specimen, teeth, state_id)


def _damaged(config: Config) -> Sequence[int]:
    """Return the last state of every kind of damage, shams removing nothing; the first state where there is none."""
    kinds = {type(one): i for i, state in enumerate(config.states) if not state.sham for one in state.damages}
    return tuple(kinds.values()) or (0,)


def _run_motion(config: Config) -> None:
    import numpy as np

    from siggen.dynamics.mesh.tooth_law import LINEAR
    from siggen.gearbox.configured import gearbox_config
    from siggen.gearbox.draw import draw_specimen
    from siggen.planning.plan import planned_record
    from siggen.record.simulation import simulated
    from siggen.record.specimen_state import specimen_state
    from siggen.specimen.friction import mean_force_n
    from siggen.specimen.instrument import specimen_instrument

    states = tuple(state.model_copy(update={"damage": None}) for state in config.states[:1])
    parallel = config.dynamics.model_copy(update={"shafts": None})
    short = config.model_copy(update={"dynamics": parallel, "states": states, "duration_s": SHORT_S})
    own, specimen = gearbox_config(short, 0), draw_specimen(short, 0)
    # Tables of the same types without solving any contact: springs, as the law linear has them.
    springs = replace(specimen, law=replace(specimen.law, kind=LINEAR))
    state = specimen_state(springs, 0)
    simulated(specimen, specimen_instrument(specimen), state, planned_record(own, 0))
    # what a label of damaged teeth needs besides
    force_n = mean_force_n(state.pair, specimen.points[0])
    state.static.stiffness_n_per_m(force_n * state.pair.pinion.base_radius_m, np.linspace(0.0, 1.0, 2))
