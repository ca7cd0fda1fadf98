"""Drivetrain: bodies, elements between places on them, and meshes, as one graph for every machine.

Derived. Everything is one function, `Drivetrain.row`: how far a place moves along a direction per unit of every
coordinate. A mass is m row rowᵀ, an element k stretch stretchᵀ with the difference of the rows of its ends, a mesh the
row of the driver less that of the driven gear at the pitch point, a sensor a row, a force on a place a row again. No
part knows what kind of machine it is in.

Axes: x horizontal and y vertical in the plane of the gears, z along the shafts, rotations from x to y. Coordinates are
deviations from rigid rotation. A tilt φ_x is what a body moves along x per distance along z. SI units.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import cos, sin
from typing import NamedTuple, TypeAlias

import numpy as np

from siggen.arrays import FloatArray

Vector: TypeAlias = tuple[float, float, float]
DIRECTIONS: Mapping[str, Vector] = {
    "horizontal": (1.0, 0.0, 0.0),
    "vertical": (0.0, 1.0, 0.0),
    "axial": (0.0, 0.0, 1.0),
}
TURNING = "turning"
PLANE = ("horizontal", "vertical")
ROUND, ROCKING = "theta", "phi"
"""Names of rotations: of a body that goes round, and of one that stands."""
MODE = "eta_"
"""How the names of coordinates begin that are modes of a housing."""
BASE = "base"
"""What housings stand on: a body that does not move until it is given moves."""
SMALL = 1e-9
"""Share of its largest entry below which an equation between rotations says nothing: rounding leaves 1e-15."""


class Place(NamedTuple):
    """A place on a body: a point [m], the name of a place that modes know, or the middle of the body itself."""

    body: str
    at: Vector | str | None = None


class Way(NamedTuple):
    """A direction at a place: what a sensor there sees, or where a force presses. Modes may know a way by its name."""

    place: Place
    along: str
    factor: float = 1.0


@dataclass(frozen=True, slots=True)
class Body:
    """A rigid body.

    Attributes
    ----------
    moves : of x, y, z, phi_x, phi_y (tilts), and theta or phi; a body without moves is the ground
    sense : 1 where theta counts from x to y, -1 where back; theta counts in the running sense of its shaft
    axes_rad : how far the body's own x and y are turned from those of the graph
    on : the body that carries it round; its x and y are then relative to its own place there
    """

    name: str
    mass_kg: float = 0.0
    inertia_kg_m2: float = 0.0
    tilt_inertia_kg_m2: float = 0.0
    at_m: Vector = (0.0, 0.0, 0.0)
    moves: tuple[str, ...] = ("x", "y", ROUND)
    sense: float = 1.0
    axes_rad: float = 0.0
    on: str = ""

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of its coordinates."""
        return tuple(f"{move}_{self.name}" for move in self.moves)

    @property
    def goes_round(self) -> bool:
        """Whether it turns on and on."""
        return ROUND in self.moves

    def inertias(self) -> dict[str, float]:
        """Return move -> mass [kg] or moment of inertia [kg m^2]."""
        tilts = dict.fromkeys(("phi_x", "phi_y"), self.tilt_inertia_kg_m2)
        turns = dict.fromkeys((ROUND, ROCKING), self.inertia_kg_m2)
        every = {**dict.fromkeys("xyz", self.mass_kg), **turns, **tilts}
        return {move: every[move] for move in self.moves}


@dataclass(frozen=True, slots=True)
class Modes:
    """A housing as its r lowest modes, of modal mass 1.

    Attributes
    ----------
    frequency_hz, damping_ratio : (r,)
    shapes : place/direction, or the name of a way -> (r,) [kg^-1/2]
    seats : place/direction of every bearing
    give_m_per_n : (seats, seats) what seats give way beyond these modes, in series with what stands on them
    base : (r, 3) how far each mode moves at rest with x, y and the turning of what it is bolted to, `BASE`
    """

    name: str
    frequency_hz: FloatArray
    damping_ratio: FloatArray
    shapes: Mapping[str, FloatArray]
    seats: tuple[str, ...]
    give_m_per_n: FloatArray
    base: FloatArray

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of its coordinates."""
        return tuple(f"{MODE}{number + 1}" for number in range(len(self.frequency_hz)))


@dataclass(frozen=True, slots=True)
class Element:
    """A spring and a damper in parallel between places, along one direction or several at once.

    Attributes
    ----------
    name : what its force is called by, with the direction
    ends : what the places count, 1 and -1 of a plain spring; without a second end it stands on the ground
    along : directions (m)
    stiffness, damping : (m, m); a bearing that is stiffer along a slanted load ties its directions
    bearing : whether it holds a shaft; elements of one name are the bearings of one shaft
    """

    name: str
    ends: tuple[tuple[float, Place], ...]
    along: tuple[str, ...]
    stiffness: FloatArray
    damping: FloatArray
    bearing: bool = False


def spring(
    name: str,
    first: Place,
    second: Place | None,
    along: str,
    stiffness: float,
    damping: float,
    *,
    bearing: bool = False,
) -> Element:
    """Return a spring with its damper along one direction between two places, or between a place and the ground."""
    ends = ((1.0, first),) if second is None else ((1.0, first), (-1.0, second))
    return Element(name, ends, (along,), np.array([[stiffness]]), np.array([[damping]]), bearing)


@dataclass(frozen=True, slots=True)
class MeshGear:
    """Teeth on a body; `internal`: a ring. A positive helix is that of a right-handed external gear."""

    body: str
    base_radius_m: float
    base_helix_rad: float = 0.0
    internal: bool = False


@dataclass(frozen=True, slots=True)
class Mesh:
    """A gear that drives another one; `sense`: 1 where the driver turns from x to y against the frame, else -1."""

    name: str
    driver: MeshGear
    driven: MeshGear
    pressure_angle_rad: float
    sense: float = 1.0


@dataclass(frozen=True)
class Drivetrain:
    """The graph.

    Attributes
    ----------
    driver, load : bodies at which torque comes and goes
    frame : body with whose turning all x and y turn; empty where they stand still
    hand : 1 where x, y and z are right-handed, -1 where left-handed
    seen : name -> way of a sensor
    entries : name -> way of a force of another machine
    """

    bodies: tuple[Body | Modes, ...]
    elements: tuple[Element, ...]
    meshes: tuple[Mesh, ...] = ()
    driver: str = ""
    load: str = ""
    frame: str = ""
    hand: float = 1.0
    seen: Mapping[str, Way] = field(default_factory=dict)
    entries: Mapping[str, Way] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse names that clash or stand for nothing."""
        clashing = [name for name, count in Counter(body.name for body in self.bodies).items() if count > 1]
        clashing += [name for name, count in Counter(mesh.name for mesh in self.meshes).items() if count > 1]
        if clashing:
            raise ValueError(f"drivetrain: received {', '.join(clashing)} twice; allowed is each name once")
        named = [name for name in (self.driver, self.load, self.frame) if name]
        named += [place.body for element in self.elements for _, place in element.ends]
        named += [gear.body for mesh in self.meshes for gear in (mesh.driver, mesh.driven)]
        if unknown := sorted({*named} - {*self.body}):
            raise ValueError(f"drivetrain: received {', '.join(unknown)}; its bodies are {', '.join(self.body)}")

    @cached_property
    def body(self) -> dict[str, Body | Modes]:
        """Bodies by name."""
        return {body.name: body for body in self.bodies}

    def rigid(self, name: str) -> Body:
        """Return a rigid body by its name."""
        body = self.body[name]
        assert isinstance(body, Body)
        return body

    @cached_property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the n coordinates."""
        return tuple(name for body in self.bodies for name in body.coordinates)

    @cached_property
    def index(self) -> dict[str, int]:
        """Number of each coordinate."""
        return {name: number for number, name in enumerate(self.coordinates)}

    def vector(self, entries: Mapping[str, float]) -> FloatArray:
        """Return (n,) with the named entries and zeros elsewhere."""
        result = np.zeros(len(self.coordinates))
        for name, value in entries.items():
            result[self.index[name]] = value
        return result

    def row(self, place: Place, along: str | Vector = TURNING) -> FloatArray:
        """Return (n,): the motion of a place along a direction, or how far its body turns from x to y."""
        body = self.body[place.body]
        if isinstance(body, Modes):
            shape = body.shapes[f"{place.at}/{along}" if along else str(place.at)]
            return self.vector(dict(zip(body.coordinates, shape.tolist(), strict=True)))
        return self.vector(self._moved(body, place.at, along))

    def _moved(self, body: Body, at: Vector | str | None, along: str | Vector) -> dict[str, float]:
        if along == TURNING:
            moved = {ROUND: body.sense, ROCKING: 1.0}
            return {f"{move}_{body.name}": share for move, share in moved.items() if move in body.moves}
        d_x, d_y, d_z = DIRECTIONS[along] if isinstance(along, str) else along
        place = body.at_m if at is None else at
        assert not isinstance(place, str)
        x, y, z = (end - middle for end, middle in zip(place, body.at_m, strict=True))
        cosine, sine = cos(body.axes_rad), sin(body.axes_rad)
        d_1, d_2 = cosine * d_x + sine * d_y, cosine * d_y - sine * d_x
        turned = x * d_y - y * d_x
        moved = {
            "x": d_1,
            "y": d_2,
            "z": d_z,
            ROUND: body.sense * turned,
            ROCKING: turned,
            "phi_x": z * d_1 - (cosine * x + sine * y) * d_z,
            "phi_y": z * d_2 - (cosine * y - sine * x) * d_z,
        }
        row = {f"{move}_{body.name}": moved[move] for move in body.moves}
        return row | (self._moved(self.rigid(body.on), body.at_m, (d_x, d_y, 0.0)) if body.on else {})

    def way(self, way: Way) -> FloatArray:
        """Return the row (n,) of a way."""
        return way.factor * self.row(way.place, way.along)

    def stretch(self, element: Element) -> FloatArray:
        """Return (m, n): how far an element is stretched along each of its directions."""
        ends = [[share * self.row(place, along) for share, place in element.ends] for along in element.along]
        return np.array([np.add.reduce(rows) for rows in ends])

    @cached_property
    def held(self) -> dict[str, tuple[str, ...]]:
        """What the bearings of a shaft are called -> bodies on it, in the order of the elements."""
        return {
            element.name: tuple(place.body for share, place in element.ends if share > 0.0)
            for element in self.elements
            if element.bearing and element.along == PLANE
        }

    @cached_property
    def turning(self) -> dict[str, float]:
        """How far theta of each body turns per theta of the driver, with flanks that roll and springs at rest.

        Raises
        ------
        ValueError
            If not everything turns together, or nothing can.
        """
        rounds = [body.name for body in self.bodies if isinstance(body, Body) and body.goes_round]
        free = _solutions(self._rolling(rounds))
        if len(free) == 0:
            raise ValueError("drivetrain: received a loop of power, in which nothing can turn; allowed is a tree")
        if len(free) > 1:
            alone = "; ".join(", ".join(n for n, turns in zip(rounds, own, strict=True) if turns) for own in free)
            raise ValueError(f"drivetrain: received parts that turn by themselves: {alone}; allowed is one whole")
        turns = dict(zip(rounds, free[0].tolist(), strict=True))
        if not turns[self.driver] or not turns[self.load]:
            raise ValueError(f"drivetrain: received {self.driver} and {self.load} that do not turn with each other")
        return {name: turn / turns[self.driver] for name, turn in turns.items()}

    def _rolling(self, rounds: list[str]) -> FloatArray:
        """Return equations (e, rounds) between the rotations."""
        rows = []
        for element in self.elements:
            if TURNING in element.along:
                ends = [(share, place.body) for share, place in element.ends if place.body in rounds]
                rows.append({name: share * self.rigid(name).sense for share, name in ends})
        for mesh in self.meshes:
            inner = -1.0 if mesh.driver.internal or mesh.driven.internal else 1.0
            radii = mesh.driver.base_radius_m, inner * mesh.driven.base_radius_m
            both = zip((mesh.driver.body, mesh.driven.body), radii, strict=True)
            row = {name: radius * self.rigid(name).sense for name, radius in both}
            if self.frame:
                row[self.frame] = -sum(radii) * self.rigid(self.frame).sense
            rows.append(row)
        return np.array([[row.get(name, 0.0) for name in rounds] for row in rows]).reshape(-1, len(rounds))

    @cached_property
    def lines(self) -> tuple[tuple[str, ...], ...]:
        """Bodies that turn together by springs alone, those that turn at all."""
        line_of = {name: {name} for name in self.turning}
        for element in self.elements:
            ends = [place.body for _, place in element.ends if place.body in line_of]
            if TURNING in element.along and len(ends) > 1:
                joined = line_of[ends[0]] | line_of[ends[1]]
                line_of |= dict.fromkeys(joined, joined)
        lines = dict.fromkeys(tuple(name for name in self.turning if name in line) for line in line_of.values())
        return tuple(line for line in lines if self.turning[line[0]])


def _solutions(equations: FloatArray) -> list[FloatArray]:
    """Return a basis of what solves homogeneous equations (e, n): elimination, in one order on any processor."""
    left, pivots, row = equations.copy(), [], 0
    left /= np.abs(left).max(axis=1, initial=np.finfo(float).tiny)[:, None]
    for column in range(left.shape[1]):
        largest = row + int(np.argmax(np.abs(left[row:, column]))) if row < len(left) else row
        if row == len(left) or abs(left[largest, column]) < SMALL:
            continue
        left[[row, largest]] = left[[largest, row]]
        left[row] /= left[row, column]
        for other in range(len(left)):
            if other != row:
                left[other] -= left[other, column] * left[row]
        pivots.append(column)
        row += 1
    basis = []
    for free in (column for column in range(left.shape[1]) if column not in pivots):
        solution = np.zeros(left.shape[1])
        solution[free] = 1.0
        solution[pivots] = -left[: len(pivots), free]
        basis.append(solution)
    return basis
