"""A gearbox as its states share it: what is drawn for it, how it was made, and what measures it.

States that change nothing share the healthy machine. A state that changes keys has a machine of its own, drawn with the
same uniforms.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from siggen.config import Config
from siggen.dynamics.structure.structure import Structure
from siggen.gearbox.configured import gearbox_config, state_config
from siggen.gearbox.draw import draw_specimen
from siggen.gearbox.specimen import Specimen
from siggen.record.labels import gearbox_labels
from siggen.record.specimen_state import refused_as
from siggen.record.stage_times import stage
from siggen.specimen.instrument import Instrument, specimen_instrument
from siggen.specimen.mesh_teeth import MeshTeeth, all_teeth
from siggen.specimen.structure import structure


@dataclass(frozen=True, slots=True)
class Machine:
    """Configuration of a gearbox, its numbers, its teeth, structure and instrument, and the labels of all records."""

    config: Config
    specimen: Specimen
    teeth: Sequence[MeshTeeth]
    structure: Structure
    instrument: Instrument
    labels: dict[str, object]

    def at_point(self, operating_point_id: int) -> Machine:
        """Return the machine under the load of an operating point; itself where its bearings have one stiffness."""
        specimen = self.specimen.under(self.specimen.points[operating_point_id])
        if specimen is self.specimen:
            return self
        with stage("sensing"):
            return replace(self, specimen=specimen, instrument=specimen_instrument(specimen))


def machines(whole: Config, specimen_id: int) -> Callable[[int], Machine]:
    """Return state -> the machine of a gearbox in that state; the healthy one is kept, and the last changed one."""
    shared = lru_cache(maxsize=1)(lambda: _machine(whole, gearbox_config(whole, specimen_id), specimen_id))
    changed = lru_cache(maxsize=1)(lambda state: _machine(whole, state_config(whole, specimen_id, state), specimen_id))
    return lambda state: changed(state) if whole.changes_of(state) else shared()


def _machine(whole: Config, config: Config, specimen_id: int) -> Machine:
    with refused_as("outside_model"), stage("plan"):
        specimen = draw_specimen(config, specimen_id)
        labels, assembled = gearbox_labels(whole, specimen), structure(specimen)
    with stage("sensing"):
        instrument = specimen_instrument(specimen)
    return Machine(config, specimen, all_teeth(specimen), assembled, instrument, labels)
