"""Structure: mass, damping and stiffness of a drivetrain, and where its forces act and its motions are seen.

Derived. Every mass, spring and damper of the graph counts once, as a dyad of its row. Springs k on seats of a housing
that give way by R beyond its modes lie in series with that: K = (k^-1 + R)^-1. A damper c sees its own spring's share
of the motion, C = K k^-1 c k^-1 K (exact for slow motion). A housing's modes of frequency ω stretch their springs ω² by
η less what the base takes along at rest.

A mesh with α, s = 1 where the driver turns from x to y, else -1, σ = -1 for a ring that drives, else 1, and the unit
vector e from the driver's axis to the pitch point pushes along N = (cos α s z×e + σ sin α e, -s tan β_b), with the
slope of flanks of a right-handed driver. Approaches and forces are those of the transverse plane, 1/cos β_b and cos β_b
times those along the normal, so that power is one number. Flanks slide across N; at s from the foot of the line of
action on the driver's base circle by r_0 + s r_1. Tilted gears feel slices at s_0 + w tan β_b, farther from the pitch
point the farther they are from the middle of the face: a tilt counts 1 + tan² β_b there. Back flanks are those of a
driver that turns the other way; their places count from the base point of the driven gear.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import cos, hypot, pi, sin, tan
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.drivetrain.drivetrain import (
    BASE,
    MODE,
    PLANE,
    ROUND,
    TURNING,
    Body,
    Drivetrain,
    Element,
    Mesh,
    Modes,
    Place,
    Vector,
)
from siggen.drivetrain.stiff_pencil import solve_lower, solve_upper, squares, upper_root


class Flanks(NamedTuple):
    """Flanks that a mesh has its vectors for: those that carry its torque.

    `side`: 1 for drive flanks, -1 for back flanks; `ahead_pitches`: by how many base pitches a pair of them is farther
    on its path than drive flanks are on theirs.
    """

    side: float = 1.0
    ahead_pitches: float = 0.0


DRIVE_FLANKS = Flanks()
MISPLACED = 1e-5
"""Share of a centre distance by which axes may stand off: rows at the pitch point err by as much."""
COUPLINGS = ("input_coupling", "output_coupling")


@dataclass(frozen=True, slots=True)
class MeshVectors:
    """One mesh over the n coordinates of a structure.

    Attributes
    ----------
    vector : (n,) p, approach along the line of action = pᵀ q; a positive mesh force acts as -p
    sliding : (2, n) r_0, r_1: sliding speed of the flanks at s along the line of action = (r_0 + s r_1)ᵀ q̇ plus that of
        the rigid rotation; a friction force F acts as -(r_0 + s r_1) F
    mass_kg : J_1 J_2 / (J_1 R_b2² + J_2 R_b1²) of its two gears
    turning : coordinates of the rotations of its driving and of its driven gear
    friction_tilt : (n,) t_x: a friction force F at the distance ζ from the middle of the face acts as -t_x ζ F too
    tilt : (n,) t, tilt of the driving gear's flanks against the driven one's in the plane of action = tᵀ q; None where
        gears stay parallel. A moment of the mesh across the face acts as -t
    flanks : Flanks
    name : what its quantities are called by; empty for the only mesh
    """

    vector: FloatArray
    sliding: FloatArray
    mass_kg: float
    turning: tuple[str, str]
    friction_tilt: FloatArray
    tilt: FloatArray | None = None
    flanks: Flanks = DRIVE_FLANKS
    name: str = ""


@dataclass(frozen=True, slots=True)
class Structure:
    """Linear part of the model without the gear mesh, and where forces act and motions are seen.

    Attributes
    ----------
    drivetrain : Drivetrain it was assembled from
    coordinates : names of the n degrees of freedom
    mass, damping, stiffness : (n, n)
    meshes : MeshVectors of each mesh, in the order of power
    lines : (lines, n) rotations that springs alone let turn together, as far as they turn per turn of the driver
    torque_vector : (n,) generalised force per unit torque at the driver, the balancing load torque included
    motions : place/direction -> (n,), displacement at that place = vector · q; on the ground of shafts in bearings
    bearing_forces : place/direction -> two (n,), force on the housing = first · q + second · q̇
    bearing_directions : place/direction -> (n,), 1 N between a shaft and its seat: on the shaft, and back
    """

    drivetrain: Drivetrain
    coordinates: tuple[str, ...]
    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    meshes: tuple[MeshVectors, ...]
    lines: FloatArray
    torque_vector: FloatArray
    motions: Mapping[str, FloatArray]
    bearing_forces: Mapping[str, tuple[FloatArray, FloatArray]]
    bearing_directions: Mapping[str, FloatArray]

    @property
    def mesh(self) -> MeshVectors:
        """The first mesh, whose driving gear turns with the motor; the only one of a single stage."""
        return self.meshes[0]

    @property
    def frame(self) -> str:
        """Rotation with which lines of action and coordinates turn; empty where those stand still."""
        return f"{ROUND}_{self.drivetrain.frame}" if self.drivetrain.frame else ""

    @property
    def bodies(self) -> list[int]:
        """Numbers of the coordinates that move a body; modes of a housing move many, and gearboxes differ in them."""
        return [i for i, name in enumerate(self.coordinates) if not name.startswith(MODE)]

    @property
    def shaft_readings(self) -> dict[str, tuple[FloatArray, FloatArray]]:
        """What sensors on shafts see, of the shafts that the model has: name -> two (n,), first · q + second · q̇.

        `angle/<shaft>` is the rotation beyond the even one [rad], `torque/<coupling>` what the driving end of a
        coupling passes on [N m].
        """
        machine, still = self.drivetrain, np.zeros(len(self.coordinates))
        # planets are no shafts that a sensor reaches
        gears = () if machine.frame else machine.meshes
        turning = (machine.driver, machine.load, *(gear.body for mesh in gears for gear in (mesh.driver, mesh.driven)))
        readings = {f"angle/{name}": (machine.vector({f"{ROUND}_{name}": 1.0}), still) for name in turning}
        for element in machine.elements if gears else ():
            if element.name in COUPLINGS:
                twist = machine.rigid(element.ends[0][1].body).sense * machine.stretch(element)[0]
                numbers = float(element.stiffness[0, 0]), float(element.damping[0, 0])
                readings[f"torque/{element.name}"] = (numbers[0] * twist, numbers[1] * twist)
        return readings


def vector(coordinates: Sequence[str], entries: Mapping[str, float]) -> FloatArray:
    """Return the (n,) vector with the named entries and zeros elsewhere, read-only.

    Raises
    ------
    ValueError
        If an entry names no coordinate.
    """
    unknown = set(entries) - set(coordinates)
    if unknown:
        raise ValueError(f"received coordinates {sorted(unknown)}; allowed are {', '.join(coordinates)}")
    return _fixed(np.array([entries.get(name, 0.0) for name in coordinates]))


def assembled(drivetrain: Drivetrain) -> Structure:
    """Return the structure of a drivetrain.

    Raises
    ------
    ValueError
        As `Drivetrain.turning`.
    """
    turning, springs = drivetrain.turning, _springs(drivetrain)
    mass, damping, stiffness = _matrices(drivetrain, springs)
    pushing, braking = squares(springs.stiffness, springs.rows), squares(springs.damping, springs.rows)
    forces, directions = {}, {}
    for name, own in springs.bearings.items():
        shares = np.diag(springs.plain)[own]
        forces[name] = _fixed(np.add.reduce(pushing[own])), _fixed(np.add.reduce(braking[own]))
        # both ends of a shaft share a force between shaft and seat as their springs do
        directions[name] = _fixed(np.add.reduce(springs.rows[own] * (shares / shares.sum())[:, None]))
    shafts = {name: row for name, row in directions.items() if not name.endswith(TURNING)}
    torque = {f"{ROUND}_{drivetrain.driver}": 1.0, f"{ROUND}_{drivetrain.load}": -1.0 / turning[drivetrain.load]}
    lines = [drivetrain.vector({f"{ROUND}_{name}": turning[name] for name in line}) for line in drivetrain.lines]
    return Structure(
        drivetrain=drivetrain,
        coordinates=drivetrain.coordinates,
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        meshes=tuple(mesh_vectors(drivetrain, mesh) for mesh in drivetrain.meshes),
        lines=_fixed(np.array(lines)),
        torque_vector=_fixed(drivetrain.vector(torque)),
        motions={name: _fixed(drivetrain.way(way)) for name, way in drivetrain.seen.items()} or shafts,
        bearing_forces=forces,
        bearing_directions=directions,
    )


def matrices(drivetrain: Drivetrain) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return mass, damping and stiffness (n, n) of bodies on their elements, which need not turn."""
    return _matrices(drivetrain, _springs(drivetrain))


def _matrices(drivetrain: Drivetrain, springs: _Springs) -> tuple[FloatArray, FloatArray, FloatArray]:
    mass = np.zeros((len(drivetrain.coordinates),) * 2)
    for inertia, row in _masses(drivetrain):
        mass += inertia * np.outer(row, row)
    damping, stiffness = (_both_sides(one, springs.rows) for one in (springs.damping, springs.stiffness))
    return _fixed(mass), _fixed(0.5 * (damping + damping.T)), _fixed(0.5 * (stiffness + stiffness.T))


def on_back_flanks(structure: Structure, ahead_pitches: float) -> Structure:
    """Return the structure with the vectors of the back flanks of its first mesh; `ahead_pitches`: see `Flanks`."""
    first, flanks = structure.drivetrain.meshes[0], Flanks(-1.0, ahead_pitches)
    return replace(structure, meshes=(mesh_vectors(structure.drivetrain, first, flanks),))


def mesh_vectors(drivetrain: Drivetrain, mesh: Mesh, flanks: Flanks = DRIVE_FLANKS) -> MeshVectors:
    """Return what a mesh feels and pushes on drive or on back flanks.

    Raises
    ------
    ValueError
        If the axes stand where its base circles do not meet at its pressure angle.
    """
    driver, driven = (drivetrain.rigid(gear.body) for gear in (mesh.driver, mesh.driven))
    sense, angle = flanks.side * mesh.sense, mesh.pressure_angle_rad
    apart, inner = (-1.0 if gear.internal else 1.0 for gear in (mesh.driver, mesh.driven))
    across_m = tuple(inner * (b - a) for a, b in zip(driver.at_m, driven.at_m, strict=True))[:2]
    centre_m = hypot(*across_m)
    e = tuple(part / centre_m for part in across_m)
    along, out = sense * cos(angle), apart * sin(angle)
    n = out * e[0] - along * e[1], out * e[1] + along * e[0]
    t = -sense * n[1], sense * n[0]
    slope = drivetrain.hand * sense * tan(mesh.driver.base_helix_rad)
    radii = mesh.driver.base_radius_m, mesh.driven.base_radius_m
    fitting_m = abs(apart * radii[0] + inner * radii[1]) / cos(angle)
    if abs(centre_m - fitting_m) > MISPLACED * centre_m:
        raise ValueError(
            f"mesh of {driver.name} and {driven.name}: received axes {1e3 * centre_m:.6g} mm apart; "
            f"allowed: {1e3 * fitting_m:.6g} mm, where their base circles meet at the pressure angle"
        )
    x, y, z = driver.at_m
    pitch = x + e[0] * radii[0] / cos(angle), y + e[1] * radii[0] / cos(angle), z
    before_m = apart * radii[0] * tan(angle)
    foot = pitch[0] - before_m * n[0], pitch[1] - before_m * n[1]
    line_m = apart * (radii[0] + inner * apart * radii[1]) * tan(angle)

    def between(along: Vector, at: Vector) -> FloatArray:
        return drivetrain.row(Place(driver.name, at), along) - drivetrain.row(Place(driven.name, at), along)

    def per_height(along: Vector) -> FloatArray:
        return between(along, (pitch[0], pitch[1], z + 1.0)) - between(along, pitch)

    across = t[0], t[1], 0.0
    still = between(across, (foot[0], foot[1], z))
    rolling = between(across, (foot[0] + n[0], foot[1] + n[1], z)) - still
    if flanks.side < 0.0:
        still, rolling = still + line_m * rolling, -rolling
    tilts = any("phi_x" in body.moves for body in (driver, driven))
    return MeshVectors(
        vector=_fixed(between((n[0], n[1], -slope), pitch)),
        sliding=_fixed(np.array([still, rolling])),
        mass_kg=1.0 / (radii[0] ** 2 / driver.inertia_kg_m2 + radii[1] ** 2 / driven.inertia_kg_m2),
        turning=(f"{ROUND}_{driver.name}", f"{ROUND}_{driven.name}"),
        tilt=_fixed((1.0 + slope**2) * per_height((n[0], n[1], 0.0))) if tilts else None,
        friction_tilt=_fixed(per_height(across)),
        flanks=flanks,
        name=mesh.name,
    )


class _Springs(NamedTuple):
    """All elements as rows (M, n), with matrices (M, M), and of each bearing place/direction -> its rows.

    `plain` are the springs before their seats give way.
    """

    rows: FloatArray
    plain: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    bearings: dict[str, list[int]]


def _springs(drivetrain: Drivetrain) -> _Springs:
    elements = drivetrain.elements
    named = [(element, along) for element in elements for along in element.along]
    rows = [drivetrain.stretch(element) for element in elements]
    stiff, damped = [element.stiffness for element in elements], [element.damping for element in elements]
    bearings: dict[str, list[int]] = {}
    for number, (element, along) in enumerate(named):
        if element.bearing:
            bearings.setdefault(f"{element.name}/{along}", []).append(number)
    for body in drivetrain.bodies:
        if isinstance(body, Modes):
            omega = 2.0 * pi * body.frequency_hz
            rows.append(_against_base(drivetrain, body))
            stiff.append(np.diag(omega * omega))
            damped.append(np.diag(2.0 * body.damping_ratio * omega))
    plain, slow = _blocks(stiff), _blocks(damped)
    stiffness, damping = plain.copy(), slow.copy()
    for body in drivetrain.bodies:
        if isinstance(body, Modes):
            held = [(i, _seat(body, *one)) for i, one in enumerate(named)]
            seated = [(i, seat) for i, seat in held if seat is not None]
            own = np.ix_([i for i, _ in seated], [i for i, _ in seated])
            give, seats = _inverse(plain[own]), [seat for _, seat in seated]
            stiffness[own] = _inverse(give + body.give_m_per_n[np.ix_(seats, seats)])
            damping[own] = _both_sides(_both_sides(slow[own], give), stiffness[own])
    return _Springs(np.concatenate(rows), plain, stiffness, damping, bearings)


def _seat(body: Modes, element: Element, along: str) -> int | None:
    """Return the number of the seat of a housing on which an element stands along a direction."""
    places = [f"{place.at}/{along}" for _, place in element.ends if place.body == body.name]
    return body.seats.index(places[0]) if element.bearing and places else None


def _against_base(drivetrain: Drivetrain, body: Modes) -> FloatArray:
    """Return (r, n): by how much each mode stretches its spring."""
    rows = np.array([drivetrain.vector({name: 1.0}) for name in body.coordinates])
    for share, along in zip(body.base.T, (*PLANE, TURNING), strict=True):
        rows -= np.outer(share, drivetrain.row(Place(BASE), along))
    return rows


def _masses(drivetrain: Drivetrain) -> list[tuple[float, FloatArray]]:
    """Return masses [kg] and moments of inertia [kg m^2] with their rows; modes have a modal mass of 1."""
    found = []
    for body in drivetrain.bodies:
        if isinstance(body, Modes):
            found += [(1.0, drivetrain.vector({name: 1.0})) for name in body.coordinates]
            continue
        axes = {"x": (cos(body.axes_rad), sin(body.axes_rad), 0.0), "y": (-sin(body.axes_rad), cos(body.axes_rad), 0.0)}
        for move, inertia in body.inertias().items():
            moved = drivetrain.row(Place(body.name), axes[move]) if body.on and move in axes else None
            own = drivetrain.vector({f"{move}_{body.name}": 1.0})
            found.append((inertia, own if moved is None else moved))
    return found


def _blocks(matrices: Sequence[FloatArray]) -> FloatArray:
    size = sum(map(len, matrices))
    result, first = np.zeros((size, size)), 0
    for matrix in matrices:
        result[first : first + len(matrix), first : first + len(matrix)] = matrix
        first += len(matrix)
    return result


def _both_sides(middle: FloatArray, outer: FloatArray) -> FloatArray:
    return squares(np.ascontiguousarray(outer), squares(np.ascontiguousarray(middle), np.ascontiguousarray(outer)))


def _inverse(matrix: FloatArray) -> FloatArray:
    """Return the inverse of a small positive definite matrix; a library's last bits depend on the processor."""
    root = upper_root(matrix)
    inverse = solve_upper(root, solve_lower(root, np.eye(len(matrix))))
    return np.asarray(0.5 * (inverse + inverse.T))


def _fixed(array: FloatArray) -> FloatArray:
    array.setflags(write=False)
    return array


# How the shafts of a structure turn when nothing deforms. Rotations count in the running sense of their shaft.


def rigid_rotation(structure: Structure) -> FloatArray:
    """Return r (n,): how far each coordinate turns per turn of the driver."""
    return np.asarray(structure.lines.sum(axis=0))


def driven_and_loaded(structure: Structure) -> tuple[str, str]:
    """Return the coordinates at which motor and load act."""
    machine = structure.drivetrain
    return f"{ROUND}_{machine.driver}", f"{ROUND}_{machine.load}"


def without_drift(structure: Structure, forces: FloatArray) -> FloatArray:
    """Return generalised forces (k, n) less what moves the train as a whole, f - M r (rᵀf)/(rᵀMr).

    How the train turns as a whole is prescribed: the drive gives what other forces would take from that.
    """
    rotation = rigid_rotation(structure)
    moved = structure.mass @ rotation
    return np.asarray(forces - np.outer(forces @ rotation, moved) / float(rotation @ moved))


def frame_turns(structure: Structure) -> float:
    """Return the turns of the frame in space per turn of the driver; 0 where it stands still."""
    if not structure.frame:
        return 0.0
    return float(rigid_rotation(structure)[structure.coordinates.index(structure.frame)])


def rolling(structure: Structure) -> FloatArray:
    """Return (n,): how far each coordinate turns per turn of the driver, both against the frame."""
    turning = rigid_rotation(structure)
    if not structure.frame:
        return turning
    # what does not turn in space, such as a ring, turns back against the frame
    against = np.array([name.startswith("theta") for name in structure.coordinates])
    frame = frame_turns(structure)
    return np.asarray((turning - frame * against) / (1.0 - frame))


# Rotations that no spring opposes, and equilibrium without them.
#
# Derived. Only rotations can be free: all shafts turning in the ratio of the base radii, and, without any mesh
# stiffness, either shaft line by itself. They follow from the mesh vector, whatever the other springs are: an
# eigenvalue that is small beside those of stiff bearings would not tell them from a soft coupling.

FREE_SHARE = 1e-13
"""Strain energy over the sum of its absolute terms below which a rotation deforms nothing: rounding leaves 1e-16; the
1 Hz spring that holds the load has 1e-6, or 1e-12 beside couplings a million times stiffer than steel shafts."""

UNBALANCED_SHARE = 1e-9
"""Share of a force's absolute work on a free rotation above which no equilibrium exists."""


def free_rotations(structure: Structure, stiffness: FloatArray) -> FloatArray:
    """Return the free rotations (n, r), r from 0 to the number of shaft lines, of a structure.

    `stiffness` (n, n) is that of the structure with its mesh.
    """
    lines = np.ascontiguousarray(structure.lines.T)
    energy = lines.T @ stiffness @ lines
    scale = np.abs(lines).T @ np.abs(stiffness) @ np.abs(lines)
    values, vectors = np.linalg.eigh(energy / max(scale.max(), np.finfo(float).tiny))
    return np.asarray(lines @ vectors[:, values < FREE_SHARE])


def static_solution(structure: Structure, stiffness: FloatArray, force: FloatArray) -> FloatArray:
    """Return the displacement (n,) under a balanced force (n,) without any free rotation in it (orthogonal in M).

    Parameters
    ----------
    structure : Structure
    stiffness : (n, n)
        Of the structure with its mesh.
    force : (n,)

    Raises
    ------
    ValueError
        If the force does work on a free rotation: then no equilibrium exists.
    """
    free = free_rotations(structure, stiffness)
    work = np.abs(free.T @ force)
    if (work > UNBALANCED_SHARE * (np.abs(free).T @ np.abs(force))).any():
        raise ValueError(
            f"static load: received an unbalanced force {force}; allowed are torques that balance the load"
        )
    # Rows and columns scaled to unit diagonal, so that springs of any stiffness are solved with the same accuracy.
    scale = 1.0 / np.sqrt(np.diag(stiffness))
    held = (structure.mass @ free) * scale[:, None]
    held /= np.sqrt((held**2).sum(axis=0))
    bordered = np.block([[stiffness * scale[:, None] * scale, held], [held.T, np.zeros((held.shape[1],) * 2)]])
    right = np.concatenate([force * scale, np.zeros(held.shape[1])])
    return np.linalg.solve(bordered, right)[: force.size] * scale


def elastic_basis(structure: Structure, stiffness: FloatArray) -> FloatArray:
    """Return a basis (n, n - r), orthonormal in M, of the motions that are orthogonal in M to the free rotations."""
    root = np.linalg.cholesky(structure.mass)
    free = root.T @ free_rotations(structure, stiffness)
    complete, _ = np.linalg.qr(free, mode="complete")
    return np.linalg.solve(root.T, complete[:, free.shape[1] :])


# The load held softly at its mean speed, for responses to small forces, which would turn the shafts away (derived).
#
# A spring and a damper on the rotation of the load make T_L = T_0 z_2/z_1 + D θ̇_L + K θ_L: the mean of θ̇_L is then
# zero and θ_L settles at a constant angle. At 1 Hz it is far below every mode of the gearbox.

LOCK_HZ = 1.0
"""Natural frequency of the whole inertia on the spring."""
LOCK_DAMPING_RATIO = 0.95
"""Just below critical: the state matrix keeps distinct eigenvalues."""


def locked_load(structure: Structure) -> Structure:
    """Return the structure with spring and damper on the rotation at which the load acts."""
    load = structure.coordinates.index(driven_and_loaded(structure)[1])
    rotation = rigid_rotation(structure)
    inertia = float(rotation @ structure.mass @ rotation) / rotation[load] ** 2
    omega = 2.0 * np.pi * LOCK_HZ
    stiffness, damping = structure.stiffness.copy(), structure.damping.copy()
    stiffness[load, load] += inertia * omega**2
    damping[load, load] += 2.0 * LOCK_DAMPING_RATIO * inertia * omega
    for matrix in (stiffness, damping):
        matrix.setflags(write=False)
    return replace(structure, stiffness=stiffness, damping=damping)


# What a sensor at rest sees of bodies whose coordinates turn with a carrier.
#
# Derived: a body at (x, y) of a frame at the angle φ is at x cos φ - y sin φ, x sin φ + y cos φ in space. A ring that
# moves as a whole passes a force at the angle β before the sensor on as 1 and cos β, sin β of it: the first terms of
# its transfer as a Fourier series in the angle. No window: planets are heard from everywhere, as far as the ring
# moves.


def in_space(
    drivetrain: Drivetrain, states: FloatArray, static_deflection: FloatArray, angle_rad: FloatArray
) -> FloatArray:
    """Return states (k, 2n) with the places of central bodies along fixed axes, static deflections included.

    Parameters
    ----------
    drivetrain : Drivetrain
    states : (k, 2n)
        About the static deflection.
    static_deflection : (n,)
    angle_rad : (k,)
        Of the frame's x axis against the fixed one.

    Rates are those in the frame along fixed axes, as supports feel them: accelerations are taken from places.
    """
    seen, n = states.copy(), static_deflection.size
    cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
    for x, y in _places(drivetrain):
        along, across = states[:, x] + static_deflection[x], states[:, y] + static_deflection[y]
        seen[:, x] = cosine * along - sine * across
        seen[:, y] = sine * along + cosine * across
        along, across = states[:, n + x], states[:, n + y]
        seen[:, n + x] = cosine * along - sine * across
        seen[:, n + y] = sine * along + cosine * across
    return seen


def at_rest_beside(drivetrain: Drivetrain, static_deflection: FloatArray) -> FloatArray:
    """Return the static deflection (n,) without what `in_space` puts into states."""
    rest = static_deflection.copy()
    rest[[row for places in _places(drivetrain) for row in places]] = 0.0
    return rest


def _places(drivetrain: Drivetrain) -> list[tuple[int, int]]:
    """Return the numbers of x and y of the bodies on the common axis, whose axes are those of the frame."""
    bodies = [body for body in drivetrain.bodies if isinstance(body, Body) and body.goes_round and not body.on]
    index = drivetrain.index
    return [(index[f"x_{body.name}"], index[f"y_{body.name}"]) for body in bodies if "x" in body.moves]
