"""Structure: mass, damping and stiffness of one gear stage, assembled from springs and dampers of rank one.

Equations: 8-DOF translation-torsion model of a spur gear stage (reference: standard literature; the kind of model used
in paper A: Influence of Tooth Pitting on TVMS and Vibration Response of a Spur Gear Pair); signs of the mesh vector
derived. Coordinates are deviations from rigid rotation. y is vertical, along the pitch-line velocity of the pinion at
the mesh; x runs along the centre line from pinion to gear; rotations count positive in the running sense of the shaft.
With helical teeth shafts move along their axes too, z_1 and z_2 (`axial_motion`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.axial_motion import axial_approach, axial_bearings, axial_inertias
from siggen.dynamics.structure.gear_stage import Coupling, GearStage
from siggen.dynamics.structure.mesh_vectors import MeshVectors


@dataclass(frozen=True, slots=True)
class Element:
    """A spring and a damper in parallel along one generalised direction v: k v vᵀ and c v vᵀ."""

    direction: Mapping[str, float]
    stiffness: float
    damping: float


MODE = "eta_"
"""How the names of coordinates begin that are modes of a housing."""


@dataclass(frozen=True, slots=True)
class Structure:
    """Linear part of the model without the gear mesh, and where forces act and motions are seen.

    Attributes
    ----------
    coordinates : names of the n degrees of freedom
    mass, damping, stiffness : (n, n)
    meshes : MeshVectors of each mesh, in the order of power
    shaft_lines : rotations that turn together when nothing deforms, from motor to load; a mesh stands between two
    torque_vector : (n,) generalised force per unit motor torque, the balancing load torque included
    motions : place/axis -> (n,), displacement at that place = vector · q
    bearing_forces : place/axis -> two (n,), force on the housing = first · q + second · q̇
    bearing_directions : place/axis -> (n,), 1 N between a shaft and its seat: on the shaft along the axis, and back
    line_speeds : turns of each shaft line per turn of the first; None: meshes follow one another, and tell them
    frame : rotation with which lines of action and coordinates turn; empty where those stand still
    """

    coordinates: tuple[str, ...]
    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    meshes: tuple[MeshVectors, ...]
    shaft_lines: tuple[tuple[str, ...], ...]
    torque_vector: FloatArray
    motions: Mapping[str, FloatArray]
    bearing_forces: Mapping[str, tuple[FloatArray, FloatArray]]
    bearing_directions: Mapping[str, FloatArray]
    line_speeds: tuple[float, ...] | None = None
    frame: str = ""

    @property
    def mesh(self) -> MeshVectors:
        """The first mesh, whose driving gear turns with the motor; the only one of a single stage."""
        return self.meshes[0]

    @property
    def bodies(self) -> list[int]:
        """Numbers of the coordinates that move a body; modes of a housing move many, and gearboxes differ in them."""
        return [i for i, name in enumerate(self.coordinates) if not name.startswith(MODE)]

    @property
    def shaft_readings(self) -> dict[str, tuple[FloatArray, FloatArray]]:
        """What sensors on shafts see, of the shafts that the model has: name -> two (n,), first · q + second · q̇.

        `angle/<shaft>` is the rotation beyond the even one [rad], `torque/<coupling>` what the driving end of a
        coupling passes on [N m]. Nothing but its coupling ties both ends together, so the matrices hold its numbers.
        """
        still = np.zeros(len(self.coordinates))
        found = {
            f"angle/{shaft}": (vector(self.coordinates, {name: 1.0}), still)
            for shaft, name in self._turning.items()
            if name in self.coordinates
        }
        for coupling, ends in self._couplings.items():
            if set(ends) <= set(self.coordinates):
                place = self.coordinates.index(ends[0]), self.coordinates.index(ends[1])
                twist = vector(self.coordinates, dict(zip(ends, (-1.0, 1.0), strict=True)))
                found[f"torque/{coupling}"] = (self.stiffness[place] * twist, self.damping[place] * twist)
        return found

    @property
    def _turning(self) -> dict[str, str]:
        """What turns -> coordinate of its rotation, without planets; gears of a further mesh are called by it."""
        gears = {
            f"{mesh.name}.{gear}" if mesh.name else gear: name
            for mesh in (self.meshes if self.line_speeds is None else ())
            for gear, name in zip(("pinion", "gear"), mesh.turning, strict=True)
        }
        return {"motor": "theta_m", **gears, "load": "theta_l"}

    @property
    def _couplings(self) -> dict[str, tuple[str, str]]:
        """Coupling -> rotations of its driving and of its driven end; none of a planetary set."""
        if self.line_speeds is not None:
            return {}
        first, last = self.meshes[0].turning[0], self.meshes[-1].turning[1]
        return {"input_coupling": ("theta_m", first), "output_coupling": (last, "theta_l")}


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
    result = np.array([entries.get(name, 0.0) for name in coordinates])
    result.setflags(write=False)
    return result


def assemble(coordinates: Sequence[str], elements: Sequence[Element]) -> tuple[FloatArray, FloatArray]:
    """Return (stiffness, damping), each (n, n), as sums of k v vᵀ and c v vᵀ over the elements."""
    n = len(coordinates)
    stiffness, damping = np.zeros((n, n)), np.zeros((n, n))
    for element in elements:
        v = vector(coordinates, element.direction)
        dyad = v[:, None] * v[None, :]
        stiffness += element.stiffness * dyad
        damping += element.damping * dyad
    return stiffness, damping


def eight_dof(stage: GearStage) -> Structure:
    """Return motor, pinion, gear and load: q = [θ_m, x_1, y_1, θ_1, x_2, y_2, θ_2, θ_L] and z_1, z_2 of helical teeth.

    Source: standard literature (8-DOF spur gear model), see the module.
    """
    inertias = {"theta_m": stage.motor_inertia_kg_m2, **_gear_inertias(stage), "theta_l": stage.load_inertia_kg_m2}
    return _grounded(stage, inertias, shafts(stage))


def _gear_inertias(stage: GearStage) -> dict[str, float]:
    pinion, gear = stage.pinion, stage.gear
    return {
        "x_1": pinion.mass_kg,
        "y_1": pinion.mass_kg,
        "theta_1": pinion.inertia_kg_m2,
        "x_2": gear.mass_kg,
        "y_2": gear.mass_kg,
        "theta_2": gear.inertia_kg_m2,
    }


def shafts(stage: GearStage) -> tuple[Element, Element]:
    """Return the couplings between motor and pinion and between gear and load."""
    return (
        Element({"theta_m": 1.0, "theta_1": -1.0}, *_numbers(stage.input_coupling)),
        Element({"theta_2": 1.0, "theta_l": -1.0}, *_numbers(stage.output_coupling)),
    )


def stage_lines(coordinates: Sequence[str]) -> tuple[tuple[str, ...], ...]:
    """Return the shaft lines of a single stage: motor and pinion, gear and load."""
    lines = (("theta_m", "theta_1"), ("theta_2", "theta_l"))
    return tuple(tuple(name for name in line if name in coordinates) for line in lines)


def _numbers(coupling: Coupling) -> tuple[float, float]:
    return coupling.stiffness_nm_per_rad, coupling.damping_nm_s_per_rad


_PLACES = {
    "pinion_bearing/vertical": "y_1",
    "pinion_bearing/horizontal": "x_1",
    "gear_bearing/vertical": "y_2",
    "gear_bearing/horizontal": "x_2",
}


def _supports(stage: GearStage) -> dict[str, Element]:
    """Return place/axis -> the bearing element there."""
    numbers = {}
    for index, rotor in (("1", stage.pinion), ("2", stage.gear)):
        bearing = rotor.bearing
        numbers["x_" + index] = (bearing.stiffness_x_n_per_m, bearing.damping_x_n_s_per_m)
        numbers["y_" + index] = (bearing.stiffness_y_n_per_m, bearing.damping_y_n_s_per_m)
    along = {place: Element({one.coordinate: 1.0}, *one[1:]) for place, one in axial_bearings(stage).items()}
    return {place: Element({name: 1.0}, *numbers[name]) for place, name in _PLACES.items()} | along


def _crossing(stage: GearStage) -> list[Element]:
    """Return what ties x and y of a shaft: k (x y + y x) as springs along both diagonals, one of them negative."""
    found = []
    for index, rotor in (("1", stage.pinion), ("2", stage.gear)):
        half, (x, y) = 0.5 * rotor.bearing.stiffness_xy_n_per_m, (f"x_{index}", f"y_{index}")
        found += [Element({x: 1.0, y: 1.0}, half, 0.0), Element({x: 1.0, y: -1.0}, -half, 0.0)]
    return found


_OTHERS = {"vertical": "horizontal", "horizontal": "vertical", "axial": "axial"}


def _other(place: str) -> str:
    name, axis = place.split("/")
    return f"{name}/{_OTHERS[axis]}"


def _mixed(stage: GearStage, place: str) -> float:
    rotor = stage.pinion if place.startswith("pinion") else stage.gear
    return 0.0 if place.endswith("axial") else rotor.bearing.stiffness_xy_n_per_m


def _grounded(stage: GearStage, inertias: Mapping[str, float], couplings: Sequence[Element]) -> Structure:
    """Assemble grounded bearings, shafts and the gear mesh over the coordinates of `inertias` and along the axes."""
    inertias = {**inertias, **axial_inertias(stage)}
    coordinates = tuple(inertias)
    supports = _supports(stage)
    stiffness, damping = assemble(coordinates, (*supports.values(), *couplings, *_crossing(stage)))
    mass = np.diag(list(inertias.values()))
    for matrix in (mass, damping, stiffness):
        matrix.setflags(write=False)
    directions = {place: vector(coordinates, element.direction) for place, element in supports.items()}
    return Structure(
        coordinates=coordinates,
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        meshes=(
            MeshVectors(
                vector(coordinates, {**_line_of_action(stage), **axial_approach(stage)}),
                sliding_vectors(coordinates, stage, _across_line_of_action(stage)),
                stage.equivalent_mesh_mass_kg,
            ),
        ),
        shaft_lines=stage_lines(coordinates),
        torque_vector=vector(coordinates, {"theta_m": 1.0, "theta_l": -stage.ratio}),
        motions=directions,
        bearing_forces={
            place: (
                directions[place] * element.stiffness + directions[_other(place)] * _mixed(stage, place),
                directions[place] * element.damping,
            )
            for place, element in supports.items()
        },
        bearing_directions=directions,
    )


def _line_of_action(stage: GearStage) -> dict[str, float]:
    """Return p: both gears' motions along the line of action, which runs along (sin α, cos α) from pinion to gear."""
    sine, cosine = np.sin(stage.working_pressure_angle_rad), np.cos(stage.working_pressure_angle_rad)
    return {
        "x_1": sine,
        "y_1": cosine,
        "theta_1": stage.pinion.base_radius_m,
        "x_2": -sine,
        "y_2": -cosine,
        "theta_2": -stage.gear.base_radius_m,
    }


def _across_line_of_action(stage: GearStage) -> dict[str, float]:
    """Return the sliding of the pinion's flank against the gear's by motion of the gears, across the line of action."""
    sine, cosine = np.sin(stage.working_pressure_angle_rad), np.cos(stage.working_pressure_angle_rad)
    return {"x_1": -cosine, "y_1": sine, "x_2": cosine, "y_2": -sine}


def sliding_vectors(coordinates: Sequence[str], stage: GearStage, across: Mapping[str, float]) -> FloatArray:
    """Return r_0, r_1 (2, n): arms s on the pinion, T - s on the gear; `across` is the translation of the gears."""
    still = vector(coordinates, {**across, "theta_2": -stage.line_of_action_m})
    result = np.array([still, vector(coordinates, {"theta_1": 1.0, "theta_2": 1.0})])
    result.setflags(write=False)
    return result
