"""What all records of one specimen and state share: its teeth, their tables, its structure, its labels."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

from siggen.config import Config
from siggen.dynamics.structure.structure import Structure
from siggen.errors import SolverFailure
from siggen.gearbox.specimen import PlanetaryGears
from siggen.gears.damage.part import Parts
from siggen.gears.damage.tooth_damage import Damage, on_teeth
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.mesh_stiffness import StiffnessOptions
from siggen.gears.stiffness.mesh_tables import TABLE_POINTS
from siggen.planning.specimen import Specimen
from siggen.record.labels import damage_labels
from siggen.record.planetary_state import with_ring_labels
from siggen.record.stage_labels import stage_labels
from siggen.seeding import Stage as Consumer
from siggen.seeding import named_uniforms
from siggen.specimen.back_flanks import with_back_flanks, with_static_back
from siggen.specimen.clocking import clocked_pitches
from siggen.specimen.contact import ToothTables, largest_force_n, tooth_tables
from siggen.specimen.errors import SpecimenErrors, error_labels, lead_of
from siggen.specimen.flank_waves import wave_labels
from siggen.specimen.lost_mass import MeshPlace
from siggen.specimen.made_gears import MadeGears
from siggen.specimen.motion import MeshBehind, SpecimenMesh
from siggen.specimen.planetary_meshes import made_meshes, with_planets
from siggen.specimen.static_mesh import StaticMesh, static_mesh


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
    """Gears of one specimen in one state, with their damage, errors and tables."""

    pair: GearPair
    options: StiffnessOptions
    damage: Damage
    errors: SpecimenErrors | None
    tables: ToothTables
    labels: dict[str, object]
    parts: Parts


def state_teeth(config: Config, specimen: Specimen, state_id: int, made: MadeGears) -> StateTeeth:
    """Return the teeth of one specimen in one state.

    Raises
    ------
    SolverFailure
        If what was drawn cannot be built (named in the reason).
    """
    pair = made.pair
    options = made.options
    with refused_as("impossible_damage"):
        parts = made.damage(state_id)
        damage = on_teeth(parts)
        errors = made.errors(state_id)
        tables = tooth_tables(
            specimen.law, pair, damage, options, TABLE_POINTS,
            largest_force_n(config.operating_points, pair), lead_of(errors),
        )  # fmt: skip
        labels = damage_labels(config.states[state_id], pair, parts, options, tables.sink_depth_m)
    return StateTeeth(pair, options, damage, errors, tables, labels, parts)


def specimen_state(config: Config, specimen: Specimen, state_id: int, made: MadeGears | None = None) -> SpecimenState:
    """Return gears, damage, tables and structure of one specimen in one state; `made` if other states made them.

    Raises
    ------
    SolverFailure
        If what was drawn cannot be built (named in the reason).
    """
    made = made or MadeGears(config, specimen)
    with refused_as("outside_model"):
        assembled = made.structure
    if specimen.planets is not None:
        return _planetary_state(config, made, specimen.planets, state_id, assembled)
    first = _mesh_state(made, state_id, assembled)
    if not specimen.behind:
        return first
    return _with_stages(config, specimen, first, tuple(_mesh_state(one, state_id, assembled) for one in made.stages))


def _planetary_state(
    config: Config, made: MadeGears, planets: PlanetaryGears, state_id: int, assembled: Structure
) -> SpecimenState:
    """Return the state of a planetary set: that of the sun with its first planet, with all meshes behind it."""
    states = [_mesh_state(one, state_id, assembled) for one in made_meshes(made, config)]
    suns, ring = states[: len(states) // 2], states[len(states) // 2]
    mesh = with_planets(planets, [one.mesh for one in states])
    labels = with_ring_labels(config, [one.labels for one in suns], ring.labels)
    return replace(suns[0], mesh=mesh, labels=labels, ring=ring)


def _with_stages(
    config: Config, specimen: Specimen, first: SpecimenState, behind: tuple[SpecimenState, ...]
) -> SpecimenState:
    """Return the state of the first mesh with those behind it; how their teeth stand is drawn for the gearbox."""
    uniform = named_uniforms(config.seed, Consumer.GEARS, specimen.specimen_id)
    names = [mesh.inner for mesh in specimen.behind]
    clockings = clocked_pitches([first.pair, *(one.pair for one in behind)], specimen, uniform)
    meshes = tuple(
        MeshBehind(one.mesh, float(turning), turned)
        for one, turning, turned in zip(behind, specimen.shaft_turns[1:-1], clockings, strict=True)
    )
    labels = stage_labels(first.labels, dict(zip(names, (one.labels for one in behind), strict=True)))
    return replace(first, mesh=replace(first.mesh, behind=meshes, back=None), labels=labels, behind=behind)


def _mesh_state(made: MadeGears, state_id: int, assembled: Structure) -> SpecimenState:
    """Return the state of one mesh of a gearbox."""
    config, specimen = made.config, made.specimen
    teeth = state_teeth(config, specimen, state_id, made)
    pair, tables = teeth.pair, teeth.tables
    with refused_as("outside_model"):
        missing = made.missing(state_id)
        labels = {**teeth.labels, **error_labels(config, teeth.errors), **wave_labels(made.waves(state_id))}
        loads = largest_force_n(config.operating_points, pair), lead_of(teeth.errors)
        static = static_mesh(specimen.law, pair, tables, TABLE_POINTS, teeth.parts)
        static = with_static_back(static, specimen.law, teeth.options, *loads, teeth.parts)
        mesh = SpecimenMesh(
            pair, assembled, tables.tables, missing, tables.coupling_m_per_n, tables.contact,
            made.shares(state_id), sham=config.states[state_id].sham,
        )  # fmt: skip
        if specimen.planets is None:  # which carries no torque below 0
            before = made.missing_before_chips(state_id)
            mesh = with_back_flanks(mesh, specimen.law, teeth.options, *loads, before, teeth.parts)
    return SpecimenState(pair, teeth.options, teeth.damage, mesh, labels, static, teeth.parts)


@contextmanager
def refused_as(status: str) -> Iterator[None]:
    """Turn a refusal of what was drawn, which names the model's limit, into a status of the record."""
    try:
        yield
    except ValueError as error:
        raise SolverFailure(status, str(error)) from error
