"""The graph itself: trains that no maker of presets builds, planted faults, and graphs that are not whole."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import cos, pi, sin
from typing import NamedTuple

import numpy as np
import pytest

from siggen.drivetrain.drivetrain import Body, Drivetrain, Mesh, MeshGear, Place, spring
from siggen.drivetrain.gear_stage import (
    Base,
    Bolts,
    Casing,
    GearStage,
    NextStage,
    PlanetaryStage,
    Rotor,
    Shaft,
    cantilever_compliance_m_per_n,
)
from siggen.drivetrain.makers import on_base, planetary_train, train
from siggen.drivetrain.structure import Structure, assembled, on_back_flanks, rigid_rotation
from tests.dynamics.casing_stage import bearing, make_casing, make_stage
from tests.dynamics.planetary_set import planetary_stage
from tests.dynamics.trains import casing_of, stages

ANGLE = np.radians(20.0)


def free_body_moves_nothing(structure: Structure) -> None:
    """The train turns as a whole without any force; torques balance on it."""
    turning = rigid_rotation(structure)
    for mesh in structure.meshes:
        assert abs(mesh.vector @ turning) < 1e-12
    assert abs(structure.torque_vector @ turning) < 1e-12
    assert np.abs(structure.stiffness @ turning).max() < 1e-9 * np.abs(structure.stiffness).max()


def test_a_hundred_meshes_in_a_row_turn_in_the_product_of_their_ratios() -> None:
    rotor = Rotor(0.03, 1.0, 1e-3, bearing(2e8, 1.0))
    idlers = [NextStage(ANGLE, rotor, replace(rotor, base_radius_m=0.04), None, 0.3 * i) for i in range(99)]
    gears = [replace(stage, pinion=replace(rotor, base_radius_m=0.04)) for stage in idlers]
    structure = stages(replace(make_stage(), gear=replace(rotor, base_radius_m=0.04)), gears)
    free_body_moves_nothing(structure)
    # idlers drop out: the last gear turns as if it met the first pinion
    first = make_stage().pinion.base_radius_m
    load = rigid_rotation(structure)[structure.coordinates.index("theta_load")]
    assert load == pytest.approx(first / 0.04, rel=1e-11)


def with_gears(meshes: tuple[Mesh, ...], *bodies: Body) -> Drivetrain:
    """Return bodies that turn about fixed axes, coupled to motor and load at the first and the last of them."""
    ends = Body("m", inertia_kg_m2=1e-2, moves=("theta",)), Body("l", inertia_kg_m2=1e-2, moves=("theta",))
    couplings = (
        spring("input_coupling", Place("m"), Place(bodies[0].name), "turning", 1e4, 1.0),
        spring("output_coupling", Place(bodies[-1].name), Place("l"), "turning", 1e4, 1.0),
    )
    return Drivetrain((ends[0], *bodies, ends[1]), couplings, meshes, "m", "l")


def gear(name: str, h: float, v: float = 0.0) -> Body:
    return Body(name, 1.0, 1e-3, at_m=(h, v, 0.0), moves=("x", "y", "z", "theta"))


def test_a_ring_that_drives_turns_its_planet_its_own_way_and_pushes_along_the_inner_line() -> None:
    """A ring of 60 mm round a gear of 20 mm: the same sense, three times the speed."""
    apart = (0.06 - 0.02) / cos(ANGLE)
    mesh = Mesh("mesh", MeshGear("ring", 0.06, internal=True), MeshGear("gear", 0.02), ANGLE)
    structure = assembled(with_gears((mesh,), gear("ring", 0.0), gear("gear", apart)))
    assert structure.drivetrain.turning["gear"] == pytest.approx(3.0, rel=1e-14)
    free_body_moves_nothing(structure)
    p = dict(zip(structure.coordinates, structure.mesh.vector, strict=True))
    # the same mesh read from its other gear: the line of action is one, seen from both sides
    back = Mesh("mesh", MeshGear("gear", 0.02), MeshGear("ring", 0.06, internal=True), ANGLE, -1.0)
    other = assembled(with_gears((back,), gear("gear", apart), gear("ring", 0.0)))
    q = dict(zip(other.coordinates, other.mesh.vector, strict=True))
    for name in ("x_ring", "y_ring", "theta_ring", "x_gear", "y_gear", "theta_gear"):
        assert abs(p[name]) == pytest.approx(abs(q[name]), abs=1e-15)
    assert p["theta_ring"] == pytest.approx(0.06, rel=1e-12)
    assert p["theta_gear"] == pytest.approx(-0.02, rel=1e-12)


def test_opposed_helices_on_one_shaft_cancel_their_axial_forces() -> None:
    """Gear 2 turns with gear 3, whose hand is the same: as drivers and driven gear they push against each other."""
    slope, a = 0.2, (0.03 + 0.05) / cos(ANGLE)
    meshes = (
        Mesh("first", MeshGear("1", 0.03, slope), MeshGear("2", 0.05), ANGLE),
        Mesh("second", MeshGear("3", 0.05, -slope), MeshGear("4", 0.05), ANGLE, -1.0),
    )
    shaft = (
        spring("torsion", Place("2"), Place("3"), "turning", 1e6, 1.0),
        spring("rod", Place("2"), Place("3"), "axial", 1e8, 1.0),
    )
    graph = with_gears(meshes, gear("1", 0.0), gear("2", a), gear("3", a), gear("4", a + 0.1 / cos(ANGLE)))
    structure = assembled(replace(graph, elements=(*graph.elements, *shaft)))
    free_body_moves_nothing(structure)
    first, second = (dict(zip(structure.coordinates, mesh.vector, strict=True)) for mesh in structure.meshes)
    # equal base radii of gears 2 and 3: equal mesh forces, so that what they push along the shaft is nothing
    assert first["z_2"] + second["z_3"] == pytest.approx(0.0, abs=1e-15)
    assert abs(first["z_2"]) == pytest.approx(np.tan(slope), rel=1e-12)


def test_planets_that_are_unevenly_spread_leave_one_free_motion_and_the_ratio() -> None:
    structure = assembled(planetary_train(replace(planetary_stage(), places_turns=(0.0, 0.31, 0.7))))
    free_body_moves_nothing(structure)
    assert rigid_rotation(structure)[structure.coordinates.index("theta_carrier")] == pytest.approx(1 / 4.25, rel=1e-12)


def test_compound_planets_turn_the_carrier_by_both_of_their_radii() -> None:
    """Each planet has two gears: one in the sun, a smaller one in the ring; ratio 1 + R_p1 R_r/(R_s R_p2)."""
    a, turns = 0.05 / cos(ANGLE), (0.0, 1 / 3, 2 / 3)
    middle = [Body(name, 1.0, 1e-3) for name in ("s", "c", "r")]
    planets = [
        Body(f"p{i}", 0.5, 1e-4, at_m=(a * cos(2.0 * pi * turn), a * sin(2.0 * pi * turn), 0.0), on="c")
        for i, turn in enumerate(turns)
    ]
    meshes = [Mesh(f"sun_{one.name}", MeshGear("s", 0.02), MeshGear(one.name, 0.03), ANGLE) for one in planets]
    ring = MeshGear("r", 0.07, internal=True)
    meshes += [Mesh(f"ring_{one.name}", MeshGear(one.name, 0.02), ring, ANGLE, -1.0) for one in planets]
    held = spring("ring", Place("r"), None, "turning", 1e6, 1.0)
    structure = assembled(Drivetrain((*middle, *planets), (held,), tuple(meshes), "s", "c", "c"))
    free_body_moves_nothing(structure)
    assert structure.drivetrain.turning["c"] == pytest.approx(1.0 / (1.0 + 0.03 * 0.07 / (0.02 * 0.02)), rel=1e-12)


def test_back_flanks_of_a_mesh_are_the_drive_flanks_of_one_that_turns_the_other_way() -> None:
    structure = assembled(train(make_stage()))
    back = on_back_flanks(structure, 0.0).mesh
    p, q = (dict(zip(structure.coordinates, one.vector, strict=True)) for one in (structure.mesh, back))
    apart = q["x_pinion"], q["y_pinion"]
    assert apart == pytest.approx((p["x_pinion"], -p["y_pinion"]), abs=1e-15)  # apart under either torque
    assert q["theta_pinion"] == pytest.approx(-p["theta_pinion"], rel=1e-12)


PLANTED: dict[str, Callable[[PlanetaryStage], PlanetaryStage]] = {
    "sun angle": lambda stage: replace(stage, sun_angle_rad=stage.sun_angle_rad + 1e-6),
    "ring angle": lambda stage: replace(stage, ring_angle_rad=stage.ring_angle_rad + 1e-6),
    "centre distance": lambda stage: replace(stage, centre_distance_m=stage.centre_distance_m * (1.0 + 1e-6)),
    "planet place": lambda stage: replace(stage, places_turns=(1e-6, *stage.places_turns[1:])),
    "planet mass": lambda stage: replace(
        stage, planet=replace(stage.planet, mass_kg=stage.planet.mass_kg * (1 + 1e-6))
    ),
    "pin": lambda stage: replace(
        stage, planet=replace(stage.planet, stiffness_n_per_m=stage.planet.stiffness_n_per_m * (1.0 + 1e-6))
    ),
    "ring held": lambda stage: replace(
        stage, ring=replace(stage.ring, turning_stiffness_nm_per_rad=stage.ring.turning_stiffness_nm_per_rad * 1.000001)
    ),
}


@pytest.mark.parametrize("fault", PLANTED)
def test_a_fault_of_a_millionth_in_a_number_of_the_set_is_seen_by_the_written_out_matrices(fault: str) -> None:
    """The check of `written_out` has teeth: 1e-6 of a number moves an entry by more than its bound, 1e-12."""
    stage = planetary_stage()
    assert difference(assembled(planetary_train(stage)), stage) < 1e-12
    assert difference(assembled(planetary_train(PLANTED[fault](stage))), stage) > 1e-10


def difference(structure: Structure, stage: PlanetaryStage) -> float:
    """Return how far mass, stiffness and approaches are from those written out, relative to roots of diagonals."""
    mass, stiffness, approaches = written_out(structure.coordinates, stage)
    found = [np.abs(structure.meshes[i].vector - row).max() / np.abs(row).max() for i, row in enumerate(approaches)]
    for ours, theirs in ((structure.mass, mass), (structure.stiffness, stiffness)):
        scale = np.sqrt(np.diag(theirs)) + (np.diag(theirs) == 0.0)  # planets turn against no spring
        found.append(np.abs((ours - theirs) / np.outer(scale, scale)).max())
    return float(max(found))


def written_out(names: tuple[str, ...], stage: PlanetaryStage) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
    """Return mass, stiffness and approaches as sums of dyads of rows written by hand, planet after planet."""

    def row(**entries: float) -> np.ndarray:
        return np.array([entries.get(name, 0.0) for name in names])

    a, mass, stiffness = stage.centre_distance_m, np.zeros((len(names),) * 2), np.zeros((len(names),) * 2)

    def add(matrix: np.ndarray, factor: float, own: np.ndarray) -> None:
        matrix += factor * np.outer(own, own)

    for name, inertia in (("motor", stage.motor_inertia_kg_m2), ("load", stage.load_inertia_kg_m2)):
        add(mass, inertia, row(**{f"theta_{name}": 1.0}))
    add(stiffness, stage.input_coupling.stiffness_nm_per_rad, row(theta_motor=1.0, theta_sun=-1.0))
    add(stiffness, stage.output_coupling.stiffness_nm_per_rad, row(theta_carrier=1.0, theta_load=-1.0))
    for name, body in (("sun", stage.sun), ("carrier", stage.carrier), ("ring", stage.ring)):
        add(mass, body.inertia_kg_m2, row(**{f"theta_{name}": 1.0}))
        for axis in "xy":
            add(mass, body.mass_kg, row(**{f"{axis}_{name}": 1.0}))
            add(stiffness, body.stiffness_n_per_m, row(**{f"{axis}_{name}": 1.0}))
    add(stiffness, stage.ring.turning_stiffness_nm_per_rad, row(theta_ring=1.0))
    suns, rings = [], []
    for i, place in enumerate(stage.places_turns, start=1):
        psi = 2.0 * pi * place
        radial = row(x_carrier=cos(psi), y_carrier=sin(psi), **{f"x_planet_{i}": 1.0})
        along = row(x_carrier=-sin(psi), y_carrier=cos(psi), theta_carrier=a, **{f"y_planet_{i}": 1.0})
        turning = row(**{f"theta_planet_{i}": 1.0})
        add(mass, stage.planet.mass_kg, radial)
        add(mass, stage.planet.mass_kg, along)
        add(mass, stage.planet.inertia_kg_m2, turning)
        for axis in "xy":
            add(stiffness, stage.planet.stiffness_n_per_m, row(**{f"{axis}_planet_{i}": 1.0}))
        s, r = stage.sun_angle_rad, stage.ring_angle_rad
        sun = row(x_sun=-sin(psi - s), y_sun=cos(psi - s), theta_sun=stage.sun.base_radius_m)
        ring = row(x_ring=-sin(psi + r), y_ring=cos(psi + r), theta_ring=stage.ring.base_radius_m)
        suns.append(sun - sin(s) * radial - cos(s) * along + stage.planet.base_radius_m * turning)
        rings.append(ring + sin(r) * radial - cos(r) * along - stage.planet.base_radius_m * turning)
    return mass, stiffness, [*suns, *rings]


# ---- a helical pair on bending shafts in a rigid casing on a base, written out by hand ----

HELIX, NAMES = 0.2, ("pinion", "gear")


class Numbers(NamedTuple):
    """What is planted in: a stage with bearings that tie their axes, its shafts, casing and base."""

    stage: GearStage
    shafts: tuple[Shaft, Shaft]
    casing: Casing
    base: Base


def housed() -> Numbers:
    stage = replace(make_stage(), base_helix_rad=HELIX)
    tied = replace(stage.pinion.bearing, stiffness_xy_n_per_m=3e7)
    stage = replace(stage, pinion=replace(stage.pinion, bearing=tied))
    bolts = Bolts(8e7, 1.5e8, 0.04, ((0.09, -0.05), (-0.09, -0.05), (-0.07, 0.04)), 0.4)
    shaft = Shaft(0.1, 0.4, 0.03, 206e9, 0.3, 3e-4)
    casing = make_casing(bolts=bolts, pinion_place_m=(0.045, 0.012))
    return Numbers(stage, (shaft, replace(shaft, gear_share=0.55)), casing, Base(60.0, 2.0, (9.0, 11.0, 14.0), 0.05))


def structure_of(numbers: Numbers) -> Structure:
    carried = train(numbers.stage, housing=casing_of(numbers.stage, numbers.casing), bending=numbers.shafts)
    return assembled(on_base(carried, numbers.base))


def pair_written_out(names: tuple[str, ...], n: Numbers) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return mass, damping, stiffness and the approach."""

    def row(**entries: float) -> np.ndarray:
        return np.array([entries.get(name, 0.0) for name in names])

    stage, casing, base = n.stage, n.casing, n.base
    mass, damping, stiffness = (np.zeros((len(names),) * 2) for _ in range(3))
    inertias = {"theta_motor": stage.motor_inertia_kg_m2, "theta_load": stage.load_inertia_kg_m2}
    inertias |= {"x_casing": casing.mass_kg, "y_casing": casing.mass_kg, "phi_casing": casing.inertia_kg_m2}
    inertias |= {"x_base": base.mass_kg, "y_base": base.mass_kg, "phi_base": base.inertia_kg_m2}
    for coupling, ends in (
        (stage.input_coupling, row(theta_motor=1.0, theta_pinion=-1.0)),
        (stage.output_coupling, row(theta_gear=1.0, theta_load=-1.0)),
    ):
        stiffness += coupling.stiffness_nm_per_rad * np.outer(ends, ends)
        damping += coupling.damping_nm_s_per_rad * np.outer(ends, ends)
    radii = stage.pinion.base_radius_m, stage.gear.base_radius_m
    (h, v), apart = casing.pinion_place_m, sum(radii) / cos(ANGLE)
    for i, rotor, shaft, at in zip(NAMES, (stage.pinion, stage.gear), n.shafts, (h, h - apart), strict=True):
        inertias |= {f"{axis}_{i}": rotor.mass_kg for axis in "xyz"} | {f"theta_{i}": rotor.inertia_kg_m2}
        inertias |= {f"phi_{axis}_{i}": shaft.tilt_inertia_kg_m2 for axis in "xy"}
        b = rotor.bearing
        whole = np.array(
            [[b.stiffness_x_n_per_m, b.stiffness_xy_n_per_m], [b.stiffness_xy_n_per_m, b.stiffness_y_n_per_m]]
        )
        resisting = np.diag([b.damping_x_n_s_per_m, b.damping_y_n_s_per_m])
        for lever in (-shaft.gear_share * shaft.span_m, (1.0 - shaft.gear_share) * shaft.span_m):
            soft = cantilever_compliance_m_per_n(shaft, abs(lever)) * np.eye(2)
            end = np.linalg.inv(np.linalg.inv(0.5 * whole) + soft)
            share = end @ np.linalg.inv(0.5 * whole)
            stretch = np.array(
                [
                    row(**{f"x_{i}": 1.0, f"phi_x_{i}": lever}, x_casing=-1.0, phi_casing=v),
                    row(**{f"y_{i}": 1.0, f"phi_y_{i}": lever}, y_casing=-1.0, phi_casing=-at),
                ]
            )
            stiffness += stretch.T @ end @ stretch
            damping += stretch.T @ share @ (0.5 * resisting) @ share.T @ stretch
        k, c = b.along_axis
        stiffness += k * np.outer(row(**{f"z_{i}": 1.0}), row(**{f"z_{i}": 1.0}))
        damping += c * np.outer(row(**{f"z_{i}": 1.0}), row(**{f"z_{i}": 1.0}))
    bolts = casing.bolts
    for number, (at, up) in enumerate(bolts.places_m):
        part = bolts.loose_share if number == 0 else 1.0
        for k, way in (
            (bolts.shear_stiffness_n_per_m, row(x_casing=1.0, phi_casing=-up, x_base=-1.0, phi_base=up)),
            (bolts.axial_stiffness_n_per_m, row(y_casing=1.0, phi_casing=at, y_base=-1.0, phi_base=-at)),
        ):
            stiffness += part * k * np.outer(way, way)
            share_kg = casing.mass_kg / len(bolts.places_m)
            damping += 2.0 * bolts.damping_ratio * np.sqrt(part * k * share_kg) * np.outer(way, way)
    for name, natural_hz in zip(("x_base", "y_base", "phi_base"), base.natural_hz, strict=True):
        omega, way = 2.0 * pi * natural_hz, row(**{name: 1.0})
        stiffness += inertias[name] * omega**2 * np.outer(way, way)
        damping += 2.0 * base.damping_ratio * inertias[name] * omega * np.outer(way, way)
    slope = np.tan(stage.base_helix_rad)
    approach = row(x_pinion=-sin(ANGLE), y_pinion=cos(ANGLE), theta_pinion=radii[0], z_pinion=-slope)
    approach -= row(x_gear=-sin(ANGLE), y_gear=cos(ANGLE), theta_gear=radii[1], z_gear=-slope)
    # a gear that tilts about its axis moves its pitch point along the shaft
    approach -= slope / cos(ANGLE) * row(phi_x_pinion=radii[0], phi_x_gear=radii[1])
    mass += np.diag([inertias[name] for name in names])
    return mass, damping, stiffness, approach


def distance(structure: Structure, n: Numbers) -> float:
    """Return how far a structure is from the one written out, relative to roots of diagonals."""
    *matrices, approach = pair_written_out(structure.coordinates, n)
    worst = [np.abs(structure.mesh.vector - approach).max() / np.abs(approach).max()]
    for ours, theirs in zip((structure.mass, structure.damping, structure.stiffness), matrices, strict=True):
        scale = np.sqrt(np.diag(theirs))
        worst.append(np.abs((ours - theirs) / np.outer(scale, scale)).max())
    return float(max(worst))


def stretched(value: object, name: str, by: float = 1e-6) -> object:
    """Return numbers of which one is a millionth larger; `name` may lead inwards."""
    first, _, rest = name.partition(".")
    own = getattr(value, first)
    return replace(value, **{first: stretched(own, rest) if rest else own * (1.0 + by)})


PAIR_FAULTS = {
    "stage": (
        "base_helix_rad",
        "pinion.mass_kg",
        "pinion.bearing.stiffness_xy_n_per_m",
        "gear.bearing.stiffness_x_n_per_m",
        "gear.bearing.damping_y_n_s_per_m",
        "gear.bearing.stiffness_z_n_per_m",
        "output_coupling.stiffness_nm_per_rad",
    ),
    "casing": ("mass_kg", "bolts.loose_share", "bolts.damping_ratio"),
    "base": ("inertia_kg_m2", "damping_ratio"),
}


def test_a_helical_pair_on_bending_shafts_in_a_casing_on_a_base_is_that_written_out_by_hand() -> None:
    assert distance(structure_of(housed()), housed()) < 1e-12


@pytest.mark.parametrize(("part", "name"), [(part, name) for part, names in PAIR_FAULTS.items() for name in names])
def test_a_fault_of_a_millionth_in_a_number_of_a_housed_pair_is_seen(part: str, name: str) -> None:
    planted = housed()._replace(**{part: stretched(getattr(housed(), part), name)})
    assert distance(structure_of(planted), housed()) > 1e-9


def test_a_shaft_whose_bearings_stand_a_micrometre_off_is_seen() -> None:
    numbers = housed()
    moved = replace(numbers.shafts[0], gear_share=0.4 + 1e-5)
    assert distance(structure_of(numbers._replace(shafts=(moved, numbers.shafts[1]))), numbers) > 1e-9
    casing = replace(numbers.casing, pinion_place_m=(0.045 + 1e-6, 0.012))
    assert distance(structure_of(numbers._replace(casing=casing)), numbers) > 1e-9


# ---- graphs that are not whole ----


def loop_of_power() -> Drivetrain:
    """Two meshes of different ratios between the same two shafts."""
    a = 0.08 / cos(ANGLE)
    meshes = (
        Mesh("first", MeshGear("1", 0.03), MeshGear("2", 0.05), ANGLE),
        Mesh("second", MeshGear("1", 0.04), MeshGear("2", 0.04), ANGLE),
    )
    return with_gears(meshes, gear("1", 0.0), gear("2", a))


def free_shaft() -> Drivetrain:
    graph = with_gears((), gear("1", 0.0))
    return replace(graph, bodies=(*graph.bodies, gear("flywheel", 0.3)))


def apart() -> Drivetrain:
    mesh = Mesh("mesh", MeshGear("1", 0.03), MeshGear("2", 0.05), ANGLE)
    return with_gears((mesh,), gear("1", 0.0), gear("2", 0.09))


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (free_shaft, r"turn by themselves: m, 1, l; flywheel"),
        (loop_of_power, r"loop of power"),
        (lambda: with_gears((), gear("1", 0.0), gear("1", 0.1)), r"received 1 twice"),
        (lambda: replace(with_gears((), gear("1", 0.0)), load="brake"), r"received brake; its bodies are m, 1, l"),
        (apart, r"mesh of 1 and 2: received axes 90 mm apart; allowed: 85.1342 mm"),
        (lambda: replace(with_gears((), gear("1", 0.0)), elements=()), r"turn by themselves: m; 1; l"),
    ],
)
def test_a_graph_that_is_not_whole_is_told_by_the_names_of_what_is_free(
    made: Callable[[], Drivetrain], said: str
) -> None:
    with pytest.raises(ValueError, match=said):
        assembled(made())
