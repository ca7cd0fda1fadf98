"""Makers of drivetrains: a train of pairs, a planetary set, what carries their bearings, and a base below.

A train on the ground has x from the first pinion to its gear, in a housing from the gear to its pinion. y is along the
pitch-line velocity of the first pinion. Gears are numbered in the order of power; an idler is one body in two meshes.
z runs so that flanks of a right-handed first pinion are ahead at larger z.

A planetary set is told in its carrier's frame, in which lines of action stand still; supports that are alike in all
directions do so too (reference: Lin & Parker 1999; directions derived). Planets move along the radius (x) and along the
tangent (y) against their pins, so that free rotation moves no translation. What turning adds to the inertia, 2 Ω_c m in
the speeds and Ω_c² m in the places, is left out: beside a spring k at a frequency ω it counts as 2 Ω_c/ω, below 1 %
above 200 Ω_c.

A shaft that bends (derived): seen from the gear, either end is a cantilever that carries its bearing's force alone. So
it is two springs in parallel, each of them half of the bearings in series with its cantilever, at the distances of both
bearings from the gear. Nothing is condensed away but the shaft's mass, which belongs to the gear's. Of a shaft with two
gears at its thirds the mean motion is held by bearings and bending in series, and so is their difference, which does
not load the seats as a whole. A damper sees its own spring's share of the motion.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import cos, pi, sin, sqrt
from typing import Any

import numpy as np

from siggen.arrays import FloatArray
from siggen.drivetrain.drivetrain import (
    BASE,
    PLANE,
    ROCKING,
    ROUND,
    TURNING,
    Body,
    Drivetrain,
    Element,
    Mesh,
    MeshGear,
    Modes,
    Place,
    Way,
    spring,
)
from siggen.drivetrain.gear_stage import (
    PLACES,
    Base,
    Bearing,
    Casing,
    CommonShaft,
    Coupling,
    GearStage,
    NextStage,
    PlanetaryBody,
    PlanetaryStage,
    Point,
    Rotor,
    Shaft,
    cantilever_compliance_m_per_n,
)
from siggen.names import PAIR, Names

TORSIONAL_DAMPING = 0.005
"""Of a steel shaft between two gears, as a share of the critical one (assumed)."""
GROUND = Body(BASE, moves=())
RING_TURNING = "ring/turning"
"""What keeps the ring from turning: a moment [N m] among the forces on a housing."""
CENTRAL = {"sun_bearing": "sun", "carrier_bearing": "carrier", "ring": "ring"}
"""Place of a sensor or of a bearing of a planetary set -> body there."""
SEATS_OF_SET = (*(f"{place}/{along}" for place in CENTRAL for along in PLANE), RING_TURNING)
"""Place/direction of what presses on a housing: sun, carrier and ring along both, and the ring's moment."""


@dataclass(frozen=True, slots=True)
class Housing:
    """What carries bearings: a rigid body, or modes.

    Attributes
    ----------
    body : Body or Modes
    bolts : elements between the body and `BASE`; modes have their own springs
    seats : bearing -> place of its seat
    seen : place/direction -> way of a sensor
    entries : name -> way of a force of another machine
    """

    body: Body | Modes
    bolts: tuple[Element, ...]
    seats: Mapping[str, Place]
    seen: Mapping[str, Way]
    entries: Mapping[str, Way]

    def seat(self, bearing: str, along: str) -> Place | None:
        """Return where a bearing stands; None where nothing moves along that direction."""
        place = self.seats[bearing]
        known = not isinstance(self.body, Modes) or f"{place.at}/{along}" in self.body.shapes
        return place if known else None


def rigid_housing(casing: Casing, places_m: Mapping[str, Point]) -> Housing:
    """Return a rigid casing on bolts, c = 2 ζ √(k m_c/bolts) each; a force beside its bearings acts in its middle.

    Parameters
    ----------
    casing : Casing
    places_m : bearings of every shaft -> where it stands

    Raises
    ------
    ValueError
        If the bolts leave it free to turn.
    """
    bolts = casing.bolts
    if len(set(bolts.places_m)) < 2:
        raise ValueError(
            f"bolts: received {len(set(bolts.places_m))} distinct places; allowed are at least 2, "
            "since about a single one the casing would turn freely"
        )
    stiffness = np.array([bolts.shear_stiffness_n_per_m, bolts.axial_stiffness_n_per_m])
    share, left = casing.mass_kg / len(bolts.places_m), (bolts.loose_share, *(1.0 for _ in bolts.places_m[1:]))
    elements = []
    for (h, v), part in zip(bolts.places_m, left, strict=True):
        ends = (1.0, Place("casing", (h, v, 0.0))), (-1.0, Place(BASE, (h, v, 0.0)))
        damping = 2.0 * bolts.damping_ratio * np.sqrt(part * stiffness * share)
        elements.append(Element("bolt", ends, PLANE, np.diag(part * stiffness), np.diag(damping)))
    seats = {bearing: Place("casing", (h, v, 0.0)) for bearing, (h, v) in places_m.items()}
    sensors = {f"casing_{place}": Place("casing", (h, v, 0.0)) for place, (h, v) in casing.sensor_places_m.items()}
    return Housing(
        Body("casing", casing.mass_kg, casing.inertia_kg_m2, moves=("x", "y", ROCKING)),
        tuple(elements),
        seats,
        _ways({**seats, **sensors}, PLANE),
        _ways({"auxiliary_drive": Place("casing")}, PLANE),
    )


def housing_of_modes(modes: Modes, seen: Sequence[str], entries: Sequence[str]) -> Housing:
    """Return modes as a housing; `seen` and `entries` are names of their ways."""
    bearings = dict.fromkeys(name.split("/")[0] for name in modes.seats)
    shown, pressed = ({name: Way(Place(modes.name, name), "") for name in names} for names in (seen, entries))
    return Housing(modes, (), {name: Place(modes.name, name) for name in bearings}, shown, pressed)


def _ways(places: Mapping[str, Place], along: Sequence[str]) -> dict[str, Way]:
    return {f"{name}/{direction}": Way(place, direction) for name, place in places.items() for direction in along}


def on_base(drivetrain: Drivetrain, base: Base) -> Drivetrain:
    """Return a drivetrain whose bolts stand on a base that moves on its mounts instead of on the ground.

    Far above its mounts a force F on the base moves it by F/(m ω²); with heavy, stiff mounts it is the ground.
    """
    moving = Body(BASE, base.mass_kg, base.inertia_kg_m2, moves=("x", "y", ROCKING))
    inertias, omegas = (base.mass_kg, base.mass_kg, base.inertia_kg_m2), (2.0 * pi * f for f in base.natural_hz)
    mounts = [
        spring("mount", Place(BASE), None, along, inertia * omega**2, 2.0 * base.damping_ratio * inertia * omega)
        for along, inertia, omega in zip((*PLANE, TURNING), inertias, omegas, strict=True)
    ]
    others = tuple(body for body in drivetrain.bodies if body.name != BASE)
    return replace(drivetrain, bodies=(*others, moving), elements=(*drivetrain.elements, *mounts))


def _drivetrain(
    bodies: Sequence[Body], elements: Sequence[Element], meshes: Sequence[Mesh], housing: Housing | None, **more: Any
) -> Drivetrain:
    """Return bodies from motor to load with what carries their bearings; on the ground without a housing."""
    numbers = {"meshes": tuple(meshes), "driver": bodies[0].name, "load": bodies[-1].name, **more}
    if housing is None:
        return Drivetrain(tuple(bodies), tuple(elements), **numbers)
    carried = (*bodies, housing.body, GROUND), (*elements, *housing.bolts)
    return Drivetrain(*carried, seen=housing.seen, entries=housing.entries, **numbers)


# ---- trains of pairs ----


def train(
    first: GearStage,
    behind: Sequence[NextStage] = (),
    housing: Housing | None = None,
    bending: tuple[Shaft, Shaft] | None = None,
    names: Names = PAIR,
) -> Drivetrain:
    """Return motor, shafts with their gears, load, and what carries the bearings.

    Parameters
    ----------
    first : GearStage
    behind : further meshes
    housing : Housing, None for bearings on the ground
    bending : shafts of a single stage in a housing, which bend and let their gears tilt
    names : of gears, shafts and meshes
    """
    hand = 1.0 if housing is None else -1.0
    tilts, along = ("phi_x", "phi_y") if bending else (), ("z",) if first.base_helix_rad else ()
    moves = ("x", "y", ROUND, *tilts, *along)
    inertias = [one.tilt_inertia_kg_m2 for one in bending] if bending else []
    shafts, sense, count = _shafts(first, behind, names), hand, 0
    places = shaft_places_m([first, *behind], hand, _start(shafts[0].name, housing))
    standing: list[list[Body]] = []
    for shaft, (h, v) in zip(shafts, places, strict=True):
        own = []
        for name, rotor in shaft.rotors.items():
            tilting = inertias[count] if inertias else 0.0
            count += 1
            own.append(Body(name, rotor.mass_kg, rotor.inertia_kg_m2, tilting, (h, v, 0.0), moves, sense))
        standing.append(own)
        sense = -sense
    ends = standing[0][0], standing[-1][0]
    motor = Body("motor", inertia_kg_m2=first.motor_inertia_kg_m2, moves=(ROUND,), sense=ends[0].sense)
    load = Body("load", inertia_kg_m2=first.load_inertia_kg_m2, moves=(ROUND,), sense=ends[1].sense)
    elements = [
        _coupled("input_coupling", motor, ends[0], first.input_coupling),
        _coupled("output_coupling", ends[1], load, first.output_coupling),
    ]
    for shaft, own, bent in zip(shafts, standing, bending or [None] * len(shafts), strict=True):
        elements += _held(shaft, own, housing, bent)
    meshes = []
    stages: list[GearStage | NextStage] = [first, *behind]
    for mesh, stage, (driving, driven) in zip(names.meshes, stages, pairwise(standing), strict=True):
        helix = 0.0 if isinstance(stage, NextStage) else stage.base_helix_rad
        driver, radius_m = MeshGear(driving[-1].name, stage.pinion.base_radius_m, helix), stage.gear.base_radius_m
        angle, sense = stage.working_pressure_angle_rad, driving[-1].sense
        meshes.append(Mesh(mesh.word, driver, MeshGear(driven[0].name, radius_m), angle, sense))
    bodies = motor, *(body for own in standing for body in own), load
    return _drivetrain(bodies, elements, meshes, housing, hand=hand)


@dataclass(slots=True)
class _HeldShaft:
    """What its bearings are called and their numbers, its gears by name, and the shaft itself between two of them."""

    name: str
    bearing: Bearing
    rotors: dict[str, Rotor]
    common: CommonShaft | None = None


def _shafts(first: GearStage, behind: Sequence[NextStage], names: Names) -> list[_HeldShaft]:
    """Return the shafts in the order of power."""
    meshes, bearings = names.meshes, [shaft.bearing for shaft in names.shafts]
    shafts = [_HeldShaft(bearings[0], first.pinion.bearing, {meshes[0].driver.body: first.pinion})]
    stages: tuple[GearStage | NextStage, ...] = (first, *behind)
    for mesh, bearing, stage in zip(meshes, bearings[1:], stages, strict=True):
        if isinstance(stage, NextStage) and stage.shaft is not None:
            shafts[-1].rotors[mesh.driver.body] = stage.pinion
            shafts[-1].common = stage.shaft
        shafts.append(_HeldShaft(bearing, stage.gear.bearing, {mesh.driven.body: stage.gear}))
    return shafts


def shaft_places_m(stages: Sequence[GearStage | NextStage], hand: float, start_m: Point = (0.0, 0.0)) -> list[Point]:
    """Return where every shaft stands; `hand`: 1 where x runs from the first pinion to its gear, -1 where back."""
    places = [start_m]
    for stage in stages:
        direction = stage.direction_rad if isinstance(stage, NextStage) else 0.0
        centre_m = (stage.pinion.base_radius_m + stage.gear.base_radius_m) / cos(stage.working_pressure_angle_rad)
        h, v = places[-1]
        places.append((h + hand * centre_m * cos(direction), v + centre_m * sin(direction)))
    return places


def _start(bearing: str, housing: Housing | None) -> Point:
    place = None if housing is None else housing.seats[bearing].at
    return (0.0, 0.0) if place is None or isinstance(place, str) else place[:2]


def _coupled(name: str, first: Body, second: Body, coupling: Coupling) -> Element:
    numbers = coupling.stiffness_nm_per_rad, coupling.damping_nm_s_per_rad
    # a coupling is at rest while both turn alike in the running sense of their shaft
    return spring(name, Place(first.name), Place(second.name), TURNING, *numbers)


def _held(shaft: _HeldShaft, gears: Sequence[Body], housing: Housing | None, bent: Shaft | None) -> Iterator[Element]:
    """Yield what holds a shaft in its bearings, and what bends and twists between its gears."""
    bearing, name, (x, y, z) = shaft.bearing, shaft.name, gears[0].at_m
    stiffness = np.array(
        [
            [bearing.stiffness_x_n_per_m, bearing.stiffness_xy_n_per_m],
            [bearing.stiffness_xy_n_per_m, bearing.stiffness_y_n_per_m],
        ]
    )
    damping = np.diag([bearing.damping_x_n_s_per_m, bearing.damping_y_n_s_per_m])
    seat = () if housing is None else ((-1.0, housing.seats[name]),)
    if bent is not None:
        for lever_m in bent.levers_m.values():
            ends = (1.0, Place(gears[0].name, (x, y, z + lever_m))), *seat
            half = Element(name, ends, PLANE, 0.5 * stiffness, 0.5 * damping, bearing=True)
            yield _in_series(half, cantilever_compliance_m_per_n(bent, abs(lever_m)))
    else:
        mean = tuple((1.0 / len(gears), Place(gear.name)) for gear in gears)
        whole = Element(name, (*mean, *seat), PLANE, stiffness, damping, bearing=True)
        own, other = (0.0, 0.0) if shaft.common is None else shaft.common.bending_m_per_n[0].tolist()
        yield _in_series(whole, 0.5 * (own + other))
        if shaft.common is not None:
            apart, lever = ((1.0, mean[0][1]), (-1.0, mean[1][1])), 0.25 / (PLACES[1] - PLACES[0]) ** 2
            yield _in_series(Element("bending", apart, PLANE, lever * stiffness, lever * damping), 2.0 * (own - other))
            yield _twisted(gears, shaft.common)
    if "z" in gears[0].moves:
        seated = None if housing is None else housing.seat(name, "axial")
        yield spring(name, Place(gears[0].name), seated, "axial", *bearing.along_axis, bearing=True)


def _in_series(element: Element, give_m_per_n: float) -> Element:
    """Return an element in series with what gives way along both of its directions alike: P k and P c Pᵀ.

    P = (1 + give k)^-1 is the share of the motion that the element's own spring sees.
    """
    if give_m_per_n == 0.0:
        return element
    (a, b), (_, d) = np.eye(2) + give_m_per_n * element.stiffness
    share = np.array([[d, -b], [-b, a]]) / (a * d - b * b)
    return replace(element, stiffness=share @ element.stiffness, damping=share @ element.damping @ share)


def _twisted(gears: Sequence[Body], shaft: CommonShaft) -> Element:
    """Return the torsion of a shaft between its two gears."""
    stiffness, (first, second) = shaft.torsional_stiffness_nm_per_rad, gears
    one, other = first.inertia_kg_m2, second.inertia_kg_m2
    damping = 2.0 * TORSIONAL_DAMPING * sqrt(stiffness * one * other / (one + other))
    return spring("torsion", Place(first.name), Place(second.name), TURNING, stiffness, damping)


# ---- planetary sets ----


def planetary_train(stage: PlanetaryStage, housing: Housing | None = None) -> Drivetrain:
    """Return motor, sun, carrier, planets, ring and load; meshes: sun with each planet, then each planet with the ring.

    A `housing` holds sun, carrier and ring, at the moment at which the frame's axes are its own; without one they stand
    on the ground, whatever the frame's angle. All rotations count from x to y, as the sun drives.
    """
    a, angles = stage.centre_distance_m, [2.0 * pi * place for place in stage.places_turns]
    motor = Body("motor", inertia_kg_m2=stage.motor_inertia_kg_m2, moves=(ROUND,))
    load = Body("load", inertia_kg_m2=stage.load_inertia_kg_m2, moves=(ROUND,))
    central = {"sun": stage.sun, "carrier": stage.carrier, "ring": stage.ring}
    sun, carrier, ring = (Body(name, one.mass_kg, one.inertia_kg_m2) for name, one in central.items())
    planet = stage.planet
    places = [(a * cos(angle), a * sin(angle), 0.0) for angle in angles]
    planets = [
        Body(f"planet_{i}", planet.mass_kg, planet.inertia_kg_m2, at_m=place, axes_rad=angle, on="carrier")
        for i, (place, angle) in enumerate(zip(places, angles, strict=True), start=1)
    ]
    elements = [
        _coupled("input_coupling", motor, sun, stage.input_coupling),
        _coupled("output_coupling", carrier, load, stage.output_coupling),
        *supports_of_set(stage, housing),
    ]
    for one in planets:
        pin = (1.0, Place(one.name)), (-1.0, Place("carrier", one.at_m))
        elements.append(Element("pin", pin, PLANE, *_alike(planet)))
    sun_gear = MeshGear("sun", stage.sun.base_radius_m)
    ring_gear = MeshGear("ring", stage.ring.base_radius_m, internal=True)
    gears = [(i, MeshGear(one.name, planet.base_radius_m)) for i, one in enumerate(planets, start=1)]
    meshes = [Mesh(f"sun_{i}", sun_gear, gear, stage.sun_angle_rad) for i, gear in gears]
    meshes += [Mesh(f"ring_{i}", gear, ring_gear, stage.ring_angle_rad, -1.0) for i, gear in gears]
    bodies = motor, sun, carrier, *planets, ring, load
    return _drivetrain(bodies, elements, meshes, housing, frame="carrier")


def supports_of_set(stage: PlanetaryStage, housing: Housing | None) -> Iterator[Element]:
    """Yield what holds sun, carrier and ring, in the order of `SEATS_OF_SET`."""
    bodies = {"sun": stage.sun, "carrier": stage.carrier, "ring": stage.ring}
    for place, name in CENTRAL.items():
        seat = () if housing is None else ((-1.0, housing.seats[place]),)
        yield Element(place, ((1.0, Place(name)), *seat), PLANE, *_alike(bodies[name]), bearing=True)
    held = stage.ring.turning_stiffness_nm_per_rad, stage.ring.turning_damping_nm_s_per_rad
    seated = None if housing is None else housing.seats["ring"]
    yield spring("ring", Place("ring"), seated, TURNING, *held, bearing=True)


def _alike(body: PlanetaryBody) -> tuple[FloatArray, FloatArray]:
    """Return stiffness and damping (2, 2) of a support that is alike in all directions."""
    return body.stiffness_n_per_m * np.eye(2), body.damping_n_s_per_m * np.eye(2)
