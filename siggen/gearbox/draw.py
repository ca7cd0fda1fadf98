"""One gearbox of the set: its numbers, and the speeds and torques at which it is measured."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from math import radians

from siggen.config import Config, Dynamics, GearsSection, Planetary, RotorSection
from siggen.config.config import rated_nm
from siggen.config.machine import Stage, turned
from siggen.config.planetary import RING, set_of
from siggen.gearbox.background import drawn_background
from siggen.gearbox.channels import drawn_channels, renewed_channels
from siggen.gearbox.configured import gearbox_config, gearbox_life, state_config
from siggen.gearbox.drive import drawn_unbalance, drawn_variation
from siggen.gearbox.drivetrain import drawn_dynamics, drawn_gears
from siggen.gearbox.housing import drawn_housing, walls_m2
from siggen.gearbox.labels import gearbox_labels, state_labels
from siggen.gearbox.specimen import DrawnState, OperatingPoint, PairTrain, PlanetaryGears, Specimen, ToothMesh
from siggen.gearbox.sump import Sump
from siggen.gearbox.teeth import Drawing, draw_teeth, gear_pair, mesh_seed, on_one_body, stiffness_options, tooth_law
from siggen.gearbox.train import (
    ball_bearings,
    bending_shafts,
    gear_stage,
    next_stages,
    planetary_stage,
    planetary_teeth,
    ring_outer_radius_m,
)
from siggen.gears.gear_pair import idler_later_rad
from siggen.gears.planetary import ring_round
from siggen.keys.drawing import draw
from siggen.keys.number import at, constant
from siggen.motion.response import Sampling
from siggen.seeding import Stream, named_generator, named_uniforms


def draw_specimen(config: Config, specimen_id: int) -> Specimen:
    """Return a specimen; depends on the seed, the sections it is drawn from and its index alone.

    Noise of the sensors belongs to records and is left as it is. Bearings that follow the load stand at the first
    operating point; `Specimen.under` puts them at that of a record.

    Raises
    ------
    ValueError
        If the ring of a planetary set cannot be made round its planets.
    """
    return _drawn(config, gearbox_config(config, specimen_id), specimen_id)


def _in_state(config: Config, specimen_id: int, state_id: int) -> Specimen:
    return _drawn(config, state_config(config, specimen_id, state_id), specimen_id)


def _drawn(config: Config, own: Config, specimen_id: int) -> Specimen:
    """Return a specimen of a set by its own configuration."""
    gears = named_uniforms(config.seed, Stream.GEARS, specimen_id)
    supports = named_uniforms(config.seed, Stream.SUPPORTS, specimen_id)
    first, stages, of_machine = drawn_gears(own, specimen_id)
    stiffness, dynamics = draw(own.stiffness, gears, "stiffness"), drawn_dynamics(own, specimen_id, of_machine)
    section = None if own.planetary is None else draw(own.planetary, supports, "planetary")
    drawing, rotors = partial(draw_teeth, own, specimen_id, stiffness_options(stiffness)), _rotors(dynamics)
    planets = None
    if section is None:
        meshes = tuple(_meshes(first, rotors, stages, own, drawing))
    else:
        planets = _planets(own, section, first, dynamics, specimen_id, drawing)
        meshes = ToothMesh("", planets.meshes[0]), ToothMesh(RING, planets.meshes[len(planets.pin_errors_m)])
    balls, law = ball_bearings(dynamics), tooth_law(dynamics)
    sensor = named_uniforms(config.seed, Stream.SENSOR, specimen_id)
    sensors = tuple(one.drawn(sensor) for one in own.sensors)
    points = tuple(draw_operating_point(own, specimen_id, number) for number in range(len(own.operating_points)))
    housing = drawn_housing(own, specimen_id, dynamics, meshes[0].pair, sensors)
    found = Specimen(
        specimen_id,
        seed=own.seed,
        names=own.names,
        sampling=Sampling(own.fs_hz, own.duration_s, own.samples),
        states=tuple(_state(config, own, specimen_id, number) for number in range(len(own.states))),
        meshes=meshes,
        law=law,
        train=_train(dynamics, stages, meshes) if planets is None else None,
        planets=planets,
        housing=housing,
        unbalance=drawn_unbalance(dynamics, own.names, supports),
        background=drawn_background(own, specimen_id),
        channels=tuple(drawn_channels(own, specimen_id, sensors)),
        renewed=partial(renewed_channels, own, specimen_id),
        points=points,
        rated_nm=rated_nm(own.dynamics, own.operating_points),
        damages=config.damages,
        labels=gearbox_labels(config, specimen_id, meshes[0].pair, law.friction.oil, sensors),
        life=None if config.life is None else gearbox_life(config, specimen_id),
        stored=None if own.internals is None else own.internals.quantities,
        bearing_point=points[0] if balls else None,
    )
    if dynamics.friction.oil_temperature_c is not None:
        return found
    ring_m = None if planets is None else ring_outer_radius_m(planets.ring)
    area_m2 = walls_m2(housing, [mesh.pair for mesh in meshes], ring_m)
    return replace(found, oil_c=Sump.drawn(found, area_m2, supports)).under(points[0])


def _state(config: Config, own: Config, specimen_id: int, number: int) -> DrawnState:
    state = own.states[number]
    changed = partial(_in_state, config, specimen_id, number) if own.changes_of(number) else None
    return DrawnState(state.name, state.fault, state.severity, state.sham, state_labels(own, number), changed)


def _rotors(dynamics: Dynamics) -> tuple[RotorSection, RotorSection]:
    return dynamics.pinion, dynamics.gear


def _meshes(
    gears: GearsSection, rotors: Sequence[RotorSection], stages: tuple[Stage, ...], own: Config, drawing: Drawing
) -> Iterator[ToothMesh]:
    """Yield the meshes of a train; the axis of an idler is that which it has in the mesh in front."""
    first = own.names.first.word
    front = drawing(gear_pair(gears), rotors, mesh_seed(own.seed, first) if first else own.seed, "", 1.0)
    yield ToothMesh("", front)
    for stage, turning in zip(stages, turned(gears, stages), strict=False):
        pair, of_stage = gear_pair(stage.gears), mesh_seed(own.seed, stage.name)
        teeth = drawing(pair, (RotorSection(), RotorSection()), of_stage, stage.name, float(turning))
        front = on_one_body(teeth, front, idler_later_rad(front.pair, pair)) if stage.idler else teeth
        yield ToothMesh(stage.name, front, stage.idler, radians(constant(stage.direction_deg)))


def _train(dynamics: Dynamics, stages: tuple[Stage, ...], meshes: tuple[ToothMesh, ...]) -> PairTrain:
    pair = meshes[0].pair
    first = gear_stage(dynamics, pair)
    behind, bending = tuple(next_stages(dynamics, stages, meshes)), bending_shafts(dynamics, first, pair)
    return PairTrain(first, behind, bending, ball_bearings(dynamics))


def _planets(
    config: Config, section: Planetary, gears: GearsSection, dynamics: Dynamics, specimen_id: int, drawing: Drawing
) -> PlanetaryGears:
    teeth, pair = set_of(gears, section), gear_pair(gears)
    ring = ring_round(pair, teeth.ring)
    rng = named_generator(config.seed, Stream.GEARS, specimen_id, name="planetary.pin_error_um")
    errors = 1e-6 * constant(section.pin_error_um) * rng.standard_normal(len(section.positions_deg))
    stage = planetary_stage(section, dynamics, pair, ring, teeth)
    meshes = planetary_teeth(drawing, _rotors(dynamics), config.seed, teeth, pair, ring)
    return PlanetaryGears(teeth, pair, ring, stage, tuple(errors.tolist()), meshes)


def draw_operating_point(own: Config, specimen_id: int, operating_point_id: int) -> OperatingPoint:
    """Return an operating point of a specimen by its own configuration; the same for all of its states."""
    uniform = named_uniforms(own.seed, Stream.OPERATING_POINT, specimen_id, operating_point_id)
    ranges = own.operating_points[operating_point_id]
    return OperatingPoint(
        speed_hz=at(ranges.speed_hz, uniform("speed_hz")),
        torque_nm=at(ranges.torque_nm, uniform("torque_nm")),
        variation=drawn_variation(own.variation, uniform),
    )
