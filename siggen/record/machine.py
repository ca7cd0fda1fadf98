"""A gearbox as its states share it: what is drawn for it, how it was made, and what measures it.

States that change nothing share the healthy machine. A state that changes keys has a machine of its own, drawn with the
same uniforms.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial

from siggen.dynamics.structure.structure import Structure
from siggen.gearbox.specimen import Specimen
from siggen.record.labels import gearbox_labels
from siggen.record.specimen_state import refused_as
from siggen.record.stage_times import stage
from siggen.specimen.instrument import Instrument, specimen_instrument
from siggen.specimen.mesh_teeth import MeshTeeth, all_teeth
from siggen.specimen.structure import structure


@dataclass(frozen=True, slots=True)
class RecordedMachine:
    """A gearbox, its teeth, structure and instrument, and the labels of all records."""

    specimen: Specimen
    teeth: Sequence[MeshTeeth]
    structure: Structure
    instrument: Instrument
    labels: dict[str, object]

    def at_point(self, operating_point_id: int) -> RecordedMachine:
        """Return the machine under the load of an operating point; itself where its bearings have one stiffness."""
        specimen = self.specimen.under(self.specimen.points[operating_point_id])
        if specimen is self.specimen:
            return self
        with stage("sensing"):
            return replace(self, specimen=specimen, instrument=specimen_instrument(specimen))


def machines(gearbox: Specimen) -> Callable[[int | None], RecordedMachine]:
    """Return state -> the machine of a gearbox in that state; that of states that change nothing (None) is kept."""
    shared = lru_cache(maxsize=1)(lambda: _machine(lambda: gearbox))
    changed = lru_cache(maxsize=1)(lambda state: _machine(partial(gearbox.in_state, state)))
    return lambda state: shared() if state is None or gearbox.states[state].changed is None else changed(state)


def _machine(drawn: Callable[[], Specimen]) -> RecordedMachine:
    with refused_as("outside_model"), stage("plan"):
        specimen = drawn()
        labels, assembled = gearbox_labels(specimen), structure(specimen)
    with stage("sensing"):
        instrument = specimen_instrument(specimen)
    return RecordedMachine(specimen, all_teeth(specimen), assembled, instrument, labels)
