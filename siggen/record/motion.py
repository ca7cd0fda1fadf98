"""The motion of a drawn specimen at an operating point: its structure under the mesh law that it is configured with."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import cos
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from siggen.drivetrain.structure import Structure, frame_turns, on_back_flanks
from siggen.gearbox.specimen import OperatingPoint, PlanetaryGears
from siggen.gears.back_flanks import pitches_ahead
from siggen.gears.face_shares import FaceShares
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import CORNER_REACH_PITCHES, MissingMaterial, MissingTables, missing_material
from siggen.gears.planetary import ring_begins_pitches
from siggen.mesh.contact_table import ContactTable
from siggen.mesh.lubrication import effective_modulus
from siggen.mesh.mesh_force import mean_mesh_stiffness
from siggen.mesh.mesh_tables import MeshTables
from siggen.mesh.pair_internals import PairContact
from siggen.mesh.pair_law import MeshConstants, PairLaw, pair_law
from siggen.mesh.tooth_law import EXPONENTIAL, MIXED_EHL, ToothLaw
from siggen.motion.exponential_motion import ExponentialMotion
from siggen.motion.linear_motion import LinearMotion
from siggen.motion.motion import Motion
from siggen.motion.pair_motion import MeanState, PairMesh, PairMotion
from siggen.record.contact import tip_relief
from siggen.record.drive import RecordDrive
from siggen.record.friction import composite_roughness_m, light_force_n, lubricated_mesh, specimen_friction


class TeethUnderTorque(Protocol):
    """Teeth that miss material, some of it by a torque that flattens waves."""

    def under(self, torque_nm: float) -> MissingMaterial:
        """Return the missing material in contact under a torque at the gear in front."""


class MeshBehind(NamedTuple):
    """One mesh of a gearbox, its pinion's turns per turn of the first one, and base pitches turned when that has none.

    `turned_pitches` says how the teeth of its shafts stand to those in front; `torque_share`: torque at its pinion over
    that at the first shaft, None where it carries all power.
    """

    mesh: SpecimenMesh
    turning: float = 1.0
    turned_pitches: float = 0.0
    torque_share: float | None = None

    def at(self, point: OperatingPoint) -> OperatingPoint:
        """Return an operating point of the first pinion as its own pinion has it."""
        if self.torque_share is not None:
            return OperatingPoint(point.speed_hz * self.turning, point.torque_nm * self.torque_share)
        return point if self.turning == 1.0 else point.turned(self.turning)


@dataclass(frozen=True, slots=True)
class SpecimenMesh:
    """What all records of one specimen and state share: structure and tables of its teeth.

    `shares`: of the load of slices of helical teeth.
    `sham`: in what has kinds of pairs of its own nothing is removed, so that no pair is a damaged one.
    `behind` are the further meshes, which carry no torque below 0. `turning`: turns of its first gear against the frame
    of its structure per turn of the first shaft; `torque_share` as of `MeshBehind`.
    `back` makes the same of the back flanks, which carry torques below 0: `pair` has the gear in front there.
    """

    pair: GearPair
    structure: Structure
    tables: MeshTables
    missing: TeethUnderTorque
    coupling_m_per_n: NDArray[np.float64] | None = None
    contact: ContactTable | None = None
    shares: FaceShares | None = None
    sham: bool = False
    back: Callable[[], SpecimenMesh] | None = None
    behind: tuple[MeshBehind, ...] = ()
    turning: float = 1.0
    torque_share: float | None = None

    @property
    def every(self) -> tuple[MeshBehind, ...]:
        """All meshes in the order of power, itself first."""
        return (MeshBehind(self, self.turning, torque_share=self.torque_share), *self.behind)

    def on(self, structure: Structure) -> SpecimenMesh:
        """Return the same teeth on another structure."""
        back = self.back
        if back is None:
            return replace(self, structure=structure)
        behind = on_back_flanks(structure, pitches_ahead(self.pair))
        return replace(self, structure=structure, back=lambda: replace(back(), structure=behind))

    def carrying(self, point: OperatingPoint) -> tuple[SpecimenMesh, OperatingPoint]:
        """Return the flanks that carry the torque of a point, and the point as the gear in front of their pair has it.

        Without torque neither do for long, and drive flanks stand for both.
        """
        if self.back is None or point.torque_nm >= 0.0:
            return self, point
        back = self.back()
        ratio = back.pair.pinion.teeth / back.pair.gear.teeth
        return back, OperatingPoint(point.speed_hz / ratio, -point.torque_nm * ratio)


def teeth_missing(
    law: ToothLaw, pair: GearPair, points: int, reach_pitches: float = CORNER_REACH_PITCHES
) -> MissingMaterial:
    """Return the missing material of the teeth of a pair; corners are followed for a reach."""
    return missing_material(pair, tip_relief(law, pair), points=points, reach_pitches=reach_pitches)


def specimen_motion(
    law: ToothLaw,
    mesh: SpecimenMesh,
    point: OperatingPoint,
    step_s: float,
    driven: RecordDrive | None = None,
    *,
    stride: int = 1,
) -> Motion:
    """Return the motion, made for steps of `step_s` seconds; with friction the load holds the mean speed.

    The exponential integrator takes `stride` of them, 1 or 2, at once.

    What is `driven` by more than a constant torque takes its inputs; None: constant speed and torque.
    """
    excitation = None if driven is None else driven.excitation
    mesh, front = mesh.carrying(point)
    vectors = None if excitation is None else excitation.vectors
    if not law.across_the_face:
        return LinearMotion(
            mesh.structure,
            mesh.tables,
            torque_nm=point.torque_nm,
            mesh_damping_ratio=law.damping_ratio,
            backlash_m=law.backlash_m,
            step_s=step_s,
            integrator=law.method,
            input_vectors=vectors,
        )
    kind = ExponentialMotion if law.method == EXPONENTIAL else PairMotion
    more: dict[str, Any] = {"stride": stride} if kind is ExponentialMotion else {}
    return kind(
        mesh.structure,
        [_pair_mesh(law, one, number, front) for number, one in enumerate(mesh.every)],
        mean=MeanState(point.torque_nm, point.speed_hz * (1.0 - frame_turns(mesh.structure))),
        step_s=step_s,
        input_vectors=vectors,
        speed_input=-1 if driven is None else driven.speed_input,
        **more,
    )


def _pair_mesh(law: ToothLaw, one: MeshBehind, number: int, front: OperatingPoint) -> PairMesh:
    """Return the law of a mesh at an operating point as the gear in front of the first one has it."""
    mesh, own = one.mesh, one.at(front)
    return PairMesh(
        _law(law, mesh, own, mesh.structure.meshes[number].mass_kg),
        mean_mesh_stiffness(mesh.tables),
        light_force_n(mesh.pair),
        _contact(law, mesh.pair, own),
        one.turned_pitches,
    )


def _contact(law: ToothLaw, pair: GearPair, point: OperatingPoint) -> PairContact:
    modulus = effective_modulus(pair.youngs_modulus_pa, pair.poisson_ratio)
    if law.friction.model != MIXED_EHL:
        return PairContact(modulus, pair.face_width_m)
    oil = lubricated_mesh(law.friction, pair, point)
    return PairContact(modulus, pair.face_width_m, oil, composite_roughness_m(law.friction))


def _law(law: ToothLaw, mesh: SpecimenMesh, point: OperatingPoint, mass_kg: float) -> PairLaw:
    return pair_law(
        mesh.tables,
        mesh.missing.under(point.torque_nm),
        MeshConstants(mesh.pair.line_of_action_m, mass_kg, law.backlash_m, _spread(mesh)),
        damping_ratio=law.damping,
        friction=specimen_friction(law.friction, mesh.pair, point, rough_pits=law.across_the_face),
        contact=mesh.contact,
        coupling_m_per_n=mesh.coupling_m_per_n,
    )


def _spread(mesh: SpecimenMesh) -> NDArray[np.float64] | None:
    """Return how the load of a helical pair lies about the pitch point; None for spur teeth."""
    if mesh.shares is None:
        return None
    points = mesh.tables.pair_stiffness_n_per_m.shape[1]
    along = np.linspace(mesh.tables.start_m, mesh.tables.end_m, points)
    return mesh.shares.about(mesh.pair.pitch_point_m, along)


# The 2N meshes of a drawn planetary set in motion: the sun with each planet, then each planet with the ring.
#
# A pin that stands ahead of its place by e along the tangent opens both meshes of its planet by e cos α (derived: as
# far as the planet's own motion does, see `siggen.drivetrain.makers`).


@dataclass(frozen=True, slots=True)
class LateTeeth:
    """Teeth whose planet stands back from its mate by `late_m`; it drives the ring, and the sun drives it."""

    teeth: TeethUnderTorque
    late_m: float
    drives: bool

    def under(self, torque_nm: float) -> MissingMaterial:
        """Return the missing material in contact under a torque at the gear in front of the pair."""
        found = self.teeth.under(torque_nm)
        if self.drives:
            return replace(found, pinion=self._back(found.pinion))
        return replace(found, gear=self._back(found.gear))

    def _back(self, teeth: MissingTables) -> MissingTables:
        return replace(teeth, offset_m=teeth.offset_m + self.late_m)


def with_planets(planets: PlanetaryGears, meshes: Sequence[SpecimenMesh]) -> SpecimenMesh:
    """Return the mesh of the sun with its first planet, and behind it all others, as their pins stand."""
    pair, inner, teeth, errors = planets.pair, planets.ring, planets.teeth, planets.pin_errors_m
    count, against = len(errors), 1.0 - 1.0 / (1.0 + teeth.ring / teeth.sun)
    moved = [_moved(one, errors[i % count], drives=i >= count) for i, one in enumerate(meshes)]
    lag, share = ring_begins_pitches(pair, inner), teeth.planet / teeth.sun
    behind = (
        *(
            MeshBehind(one, against, float(begins), 1.0 / count)
            for one, begins in zip(moved[1:count], teeth.sun_begins[1:], strict=True)
        ),
        *(
            MeshBehind(one, against / share, lag + float(begins), share / count)
            for one, begins in zip(moved[count:], teeth.ring_begins, strict=True)
        ),
    )
    return replace(moved[0], back=None, behind=behind, turning=against, torque_share=1.0 / count)


def _moved(mesh: SpecimenMesh, error_m: float, *, drives: bool) -> SpecimenMesh:
    late_m = error_m * cos(mesh.pair.working_pressure_angle_rad)
    return mesh if late_m == 0.0 else replace(mesh, missing=LateTeeth(mesh.missing, late_m, drives))
