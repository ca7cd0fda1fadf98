"""What all records of one specimen and state share: its teeth, their tables, its structure, its labels."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import lru_cache, partial

from siggen.columns.labels import EACH
from siggen.damage.part import Damage, Parts, on_teeth
from siggen.drivetrain.structure import Structure
from siggen.errors import SolverFailure
from siggen.gearbox.specimen import PlanetaryGears, Specimen
from siggen.gearbox.teeth import SpecimenErrors, lead_of
from siggen.gears.gear_pair import GearPair
from siggen.mesh.mesh_stiffness import StiffnessOptions
from siggen.mesh.mesh_tables import TABLE_POINTS
from siggen.record.back_flanks import with_back_flanks, with_static_back
from siggen.record.clocking import clocked_pitches
from siggen.record.contact import ToothTables, tooth_tables
from siggen.record.drive import MeshPlace
from siggen.record.instrument import Instrument, specimen_instrument
from siggen.record.labels import (
    damage_labels,
    gearbox_labels,
    ring_and_planet_labels,
    stage_labels,
    tooth_labels,
    with_ring_labels,
)
from siggen.record.motion import MeshBehind, SpecimenMesh, with_planets
from siggen.record.stage_times import stage
from siggen.record.static_mesh import StaticMesh, static_mesh
from siggen.record.structure import structure
from siggen.record.teeth import MeshTeeth, all_teeth
from siggen.seeding import Stream, named_uniforms


@dataclass(frozen=True, slots=True)
class SpecimenState:
    """Everything that all records of one specimen and state share; built once for them.

    `behind` are the same of the further meshes, whose labels are in `labels` already; `ring` that of the first planet
    in the ring of a planetary set.
    """

    pair: GearPair
    options: StiffnessOptions
    damage: Damage
    mesh: SpecimenMesh
    labels: dict[str, object]
    static: StaticMesh
    parts: Parts = ()
    behind: tuple[SpecimenState, ...] = ()
    ring: SpecimenState | None = None

    @property
    def at_rest(self) -> tuple[StaticMesh, ...]:
        """Return the static mesh, and behind it that of the ring where there is one."""
        return (self.static,) if self.ring is None else (self.static, self.ring.static)

    @property
    def parts_behind(self) -> list[tuple[GearPair, Parts, MeshPlace]]:
        """Pair and parts of the further meshes, and where those are."""
        if not self.behind:  # other planets have no damage of their own
            return []
        both = zip(self.behind, self.mesh.behind, strict=True)
        return [
            (own.pair, own.parts, MeshPlace(number, mesh.turning, mesh.turned_pitches))
            for number, (own, mesh) in enumerate(both, start=1)
        ]


@dataclass(frozen=True, slots=True)
class StateTeeth:
    """Gears of one mesh in one state, with their damage, errors and tables."""

    pair: GearPair
    options: StiffnessOptions
    damage: Damage
    errors: SpecimenErrors | None
    tables: ToothTables
    labels: dict[str, object]
    parts: Parts


def state_teeth(specimen: Specimen, teeth: MeshTeeth, state_id: int) -> StateTeeth:
    """Return the teeth of one mesh in one state.

    Raises
    ------
    SolverFailure
        If what was drawn cannot be built (named in the reason).
    """
    pair, options = teeth.pair, teeth.options
    with refused_as("impossible_damage"):
        parts = teeth.damage(state_id)
        damage = on_teeth(parts)
        errors = teeth.errors(state_id)
        lead = lead_of(errors)
        tables = tooth_tables(specimen.law, pair, damage, options, TABLE_POINTS, teeth.teeth.largest_force_n, lead)
        labels = damage_labels(specimen.states[state_id], pair, parts, options, tables.sink_depth_m)
    return StateTeeth(pair, options, damage, errors, tables, labels, parts)


def specimen_state(
    specimen: Specimen, state_id: int, shared: tuple[Sequence[MeshTeeth], Structure] | None = None
) -> SpecimenState:
    """Return gears, damage, tables and structure of one specimen in one state.

    `shared` are teeth of all meshes and the structure, where other states have made them.

    Raises
    ------
    SolverFailure
        If what was drawn cannot be built (named in the reason).
    """
    with refused_as("outside_model"):
        teeth, assembled = shared or (all_teeth(specimen), structure(specimen))
    states = [_mesh_state(specimen, one, state_id, assembled) for one in teeth]
    if specimen.planets is not None:
        return _planetary_state(specimen.planets, states, teeth, state_id)
    return _with_stages(specimen, states) if specimen.behind else states[0]


def _planetary_state(
    planets: PlanetaryGears, states: Sequence[SpecimenState], teeth: Sequence[MeshTeeth], state_id: int
) -> SpecimenState:
    """Return the state of a planetary set: that of the sun with its first planet, with all meshes behind it."""
    count = len(states) // 2
    first, ring = states[0], states[count]
    made = ring_and_planet_labels(teeth[:count], teeth[count], state_id, EACH)
    mesh = with_planets(planets, [one.mesh for one in states])
    return replace(first, mesh=mesh, labels={**with_ring_labels(first.labels, ring.labels), **made}, ring=ring)


def _with_stages(specimen: Specimen, states: Sequence[SpecimenState]) -> SpecimenState:
    """Return the state of the first mesh with those behind it; how their teeth stand is drawn for the gearbox."""
    first, *behind = states
    uniform = named_uniforms(specimen.seed, Stream.GEARS, specimen.specimen_id)
    names = [mesh.inner for mesh in specimen.behind]
    clockings = clocked_pitches([one.pair for one in states], specimen, uniform)
    meshes = tuple(
        MeshBehind(one.mesh, float(turning), turned)
        for one, turning, turned in zip(behind, specimen.shaft_turns[1:-1], clockings, strict=True)
    )
    labels = stage_labels(first.labels, dict(zip(names, (one.labels for one in behind), strict=True)))
    return replace(first, mesh=replace(first.mesh, behind=meshes, back=None), labels=labels, behind=tuple(behind))


def static_state(specimen: Specimen, teeth: MeshTeeth, state_id: int) -> tuple[StateTeeth, StaticMesh]:
    """Return the teeth of one mesh in one state, and the mesh at rest.

    Raises
    ------
    SolverFailure
        If what was drawn cannot be built (named in the reason).
    """
    of_state, law = state_teeth(specimen, teeth, state_id), specimen.law
    with refused_as("outside_model"):
        static = static_mesh(law, of_state.pair, of_state.tables, TABLE_POINTS, of_state.parts)
        loads = teeth.teeth.largest_force_n, lead_of(of_state.errors)
        return of_state, with_static_back(static, law, of_state.options, *loads, of_state.parts)


def _mesh_state(specimen: Specimen, teeth: MeshTeeth, state_id: int, assembled: Structure) -> SpecimenState:
    """Return the state of one mesh of a gearbox."""
    of_state, static = static_state(specimen, teeth, state_id)
    pair, tables, parts = of_state.pair, of_state.tables, of_state.parts
    with refused_as("outside_model"):
        labels = {**of_state.labels, **tooth_labels(teeth, state_id)}
        mesh = SpecimenMesh(
            pair, assembled, tables.tables, teeth.missing(state_id), tables.coupling_m_per_n, tables.contact,
            teeth.shares(state_id), sham=specimen.states[state_id].sham,
        )  # fmt: skip
        if specimen.planets is None:  # which carries no torque below 0
            loads = teeth.teeth.largest_force_n, lead_of(of_state.errors)
            before = teeth.missing_before_chips(state_id)
            mesh = with_back_flanks(mesh, specimen.law, of_state.options, *loads, before, parts)
    return SpecimenState(pair, of_state.options, of_state.damage, mesh, labels, static, parts)


@contextmanager
def refused_as(status: str) -> Iterator[None]:
    """Turn a refusal of what was drawn, which names the model's limit, into a status of the record."""
    try:
        yield
    except ValueError as error:
        raise SolverFailure(status, str(error)) from error


# A gearbox as its states share it: what is drawn for it, how it was made, and what measures it.
#
# States that change nothing share the healthy machine. A state that changes keys has a machine of its own, drawn with
# the same uniforms.


@dataclass(frozen=True, slots=True)
class RecordedMachine:
    """A gearbox, its teeth, structure and instrument, and the labels of all records."""

    specimen: Specimen
    teeth: Sequence[MeshTeeth]
    structure: Structure
    instrument: Instrument
    labels: dict[str, object]

    def at_point(self, operating_point_id: int) -> RecordedMachine:
        """Return the machine at an operating point; its instrument stays where its bearings have one stiffness."""
        specimen = self.specimen.under(self.specimen.points[operating_point_id])
        if specimen.bearing_point == self.specimen.bearing_point:
            return self if specimen is self.specimen else replace(self, specimen=specimen)
        with stage("sensing"):
            return replace(self, specimen=specimen, instrument=specimen_instrument(specimen))

    def renewed(self, renewal: int) -> RecordedMachine:
        """Return the machine with other sensors at the same places."""
        specimen = replace(self.specimen, channels=self.specimen.renewed(renewal))
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
