"""The background of one record: forces over time of everything beside the meshing teeth, and what channels see of them.

Levels belong to the gearbox (or to the record, `background.redraw`), the courses of noise to the record. Lines keep
their phase against the pinion's angle, so that all states of a gearbox share them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.config import Background, Config, Floor, ForeignMesh, ShaftLines, constant, draw
from siggen.dynamics.drive.comb import Comb, turns_of
from siggen.planning.plan import PlannedRecord
from siggen.planning.specimen import Specimen
from siggen.record.background_course import Course, record_course
from siggen.record.force_floor import floor_spectra
from siggen.record.rubbing import rubbing_force
from siggen.specimen.background import AXES, SpecimenBackground
from siggen.specimen.instrument import Instrument


@dataclass(frozen=True, slots=True)
class RecordBackground:
    """Channel -> spectrum (k,) of its acceleration before the sensor, and the labels of all parts."""

    spectra: Mapping[str, ComplexArray]
    labels: Mapping[str, object]


def record_background(
    config: Config, specimen: Specimen, record: PlannedRecord, instrument: Instrument
) -> RecordBackground | None:
    """Return the background of one record; None without the section. Nothing is drawn from the state."""
    background = instrument.background
    if background is None or config.background is None:
        return None
    course = record_course(config, specimen, record, instrument.length)
    section = with_levels(config.background, background.section, course)
    forces, labels = _forces(section, course, background)
    floor: dict[str, ComplexArray] = {}
    if section.floor is not None:
        floor = floor_spectra(section.floor, course)
        labels |= floor_labels(config.background.floor, section.floor)
    return RecordBackground(_seen(background, forces, floor), labels)


def _seen(
    background: SpecimenBackground, forces: dict[str, FloatArray], floor: dict[str, ComplexArray]
) -> dict[str, ComplexArray]:
    """Return channel -> spectrum (k,), input after input; `forces` and `floor` are used up, since they are large."""
    totals = {name: np.zeros(way.shape[1], dtype=np.complex128) for name, way in background.responses.items()}
    for name in list(dict.fromkeys([*forces, *floor])):
        spectrum = np.fft.rfft(forces.pop(name)) if name in forces else floor.pop(name)
        if name in floor:
            spectrum += floor.pop(name)
        row = background.inputs.index(name)
        for channel, way in background.responses.items():
            totals[channel] += way[row] * spectrum
    return totals


def with_levels(section: Background, drawn: Background, course: Course) -> Background:
    """Return what was drawn for the gearbox, its noise drawn anew if levels belong to the record."""
    if section.redraw == "gearbox":
        return drawn
    levels = draw(section, course.level, "background")
    return drawn.model_copy(update={"rubbing": levels.rubbing, "floor": levels.floor})


def floor_labels(asked: Floor | None, floor: Floor) -> dict[str, object]:
    """Return the labels of a drawn floor; one that was `asked` to have random levels says how large they are."""
    random = asked is not None and asked.level_std != 0.0
    return {
        "floor_force_n_per_sqrt_hz": constant(floor.density_n_per_sqrt_hz),
        "machine_force_n_per_sqrt_hz": constant(floor.machines_n_per_sqrt_hz),
        **({"floor_level_std": constant(floor.level_std)} if random else {}),
    }


def _forces(
    section: Background, course: Course, background: SpecimenBackground
) -> tuple[dict[str, FloatArray], dict[str, object]]:
    """Return input -> force (length,), and labels."""
    forces: dict[str, FloatArray] = {}
    labels: dict[str, object] = {}
    if section.rubbing is not None:
        force, labels = rubbing_force(section, course, section.rubbing)
        if "mesh" in background.inputs:
            forces["mesh"] = force
    lines, found = line_forces(section, course, background)
    return {**forces, **lines}, {**labels, **found}


def line_forces(
    section: Background, course: Course, background: SpecimenBackground
) -> tuple[dict[str, FloatArray], dict[str, object]]:
    """Return input -> force (length,) of what follows the angle alone, and labels."""
    forces: dict[str, FloatArray] = {}
    labels: dict[str, object] = {}

    def add(name: str, force: FloatArray) -> None:
        if name in background.inputs:
            forces[name] = forces[name] + force if name in forces else force

    for shaft, drawn in background.shafts.items():
        for name, force in _shaft(drawn, course, shaft):
            add(name, force)
        labels[f"coupling_force_{shaft}_n"] = _coupling_force_n(drawn)
    for name, mesh in (("second_stage", section.second_stage), ("auxiliary_drive", section.auxiliary_drive)):
        if mesh is not None:
            comb = _foreign(mesh, course, name)
            own = mesh.shaft_order is not None
            beside = turns_of(course.angle_rad, comb.sideband_order) if own else course.turns["gear"]
            add(name, comb.force_n(turns_of(course.angle_rad, comb.order), beside, course.top_order))
            labels |= {f"{name}_order": comb.order, f"{name}_force_n": float(comb.amplitude_n[0])}
    return forces, labels


def _coupling_force_n(drawn: ShaftLines) -> float:
    return constant(drawn.coupling_stiffness_n_per_um) * constant(drawn.offset_um)


def _shaft(drawn: ShaftLines, course: Course, shaft: str) -> list[tuple[str, FloatArray]]:
    """Return the forces of one coupling along both axes, and of the rotor on its shaft on the base."""
    order = course.orders[shaft]
    decibels = [0.0, *(constant(level) for level in (drawn.second_db, drawn.third_db, drawn.fourth_db))]
    amplitude = _coupling_force_n(drawn) * 10.0 ** (np.array(decibels) / 20.0)
    found = []
    for axis in AXES:
        phase = course.phases(f"shafts.{shaft}.{axis}", amplitude.size)
        found.append((f"{shaft}_shaft/{axis}", Comb(order, amplitude, phase).force_n(course.turns[shaft])))
    rated_rad_s = 2.0 * pi * constant(drawn.rated_speed_hz) * order
    speed_rad_s = 2.0 * pi * course.point.speed_hz * order
    moment = constant(drawn.rotor_mass_kg) * 1e-3 * constant(drawn.rotor_grade_mm_s) / rated_rad_s
    outward, start = np.array([moment * speed_rad_s**2]), course.phases(f"shafts.{shaft}.rotor", 1)
    # it turns: a quarter of a turn between the axes
    for axis, lag in zip(AXES, (0.0, 0.5 * pi), strict=True):
        found.append((f"base/{axis}", Comb(order, outward, start - lag).force_n(course.turns[shaft])))
    return found


def _foreign(mesh: ForeignMesh, course: Course, name: str) -> Comb:
    number = np.arange(1.0, mesh.harmonics + 1.0)
    amplitude = constant(mesh.force_share) * course.mesh_force_n * number ** -constant(mesh.decay_exponent)
    shaft = course.orders["gear"] if mesh.shaft_order is None else constant(mesh.shaft_order)
    return Comb(
        constant(mesh.order),
        amplitude,
        course.phases(name, mesh.harmonics),
        10.0 ** (constant(mesh.sideband_db) / 20.0),
        shaft,
        2.0 * pi * course.uniform(f"background.{name}.sideband.phase"),
    )
