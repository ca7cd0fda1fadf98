"""Rubbing of a planetary set: each of its meshes by itself, and how all of them push as the carrier turns.

Derived: what the mesh of a planet at the angle β in space does to a sensor at rest is a + b cos β + c sin β
(`siggen.specimen.background.mesh_directions`), so all noises n_i together are three inputs, Σ n, Σ n cos β, Σ n sin β:
planets pass. Sun, planets and ring turn against the carrier here. Roughness that gears replay is each mesh's own.
"""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np

from siggen.arrays import FloatArray
from siggen.gearbox.background import RubbingLevels
from siggen.gearbox.specimen import OperatingPoint, Specimen
from siggen.record.background_course import BackgroundCourse, turning
from siggen.record.rubbing import RubbingForce
from siggen.specimen.background import AXES, EVEN, SET_MESHES


class SetRubbing:
    """The forces of one record from the first sample of `course` on, over `length` samples, and their labels."""

    def __init__(self, rubbing: RubbingLevels, course: BackgroundCourse, length: int, specimen: Specimen) -> None:
        planets = specimen.planets
        assert planets is not None
        teeth = planets.teeth
        self._carrier = float(teeth.carrier_turns)
        self._places = 2.0 * pi * np.array([float(place) for place in teeth.places])
        of_sun = planets.of_one_mesh(course.point)
        share = teeth.planet / teeth.sun
        of_planet = OperatingPoint(of_sun.speed_hz / share, of_sun.torque_nm * share)
        meshes = (planets.pair, of_sun, 1.0), (planets.ring, of_planet, 1.0 / share)
        self._meshes = dict(zip(SET_MESHES, meshes, strict=True))
        self._forces = {
            mesh: [RubbingForce(rubbing, self._own(course, mesh, i), length) for i in range(len(teeth.places))]
            for mesh in SET_MESHES
        }
        every = [force for forces in self._forces.values() for force in forces]
        self.labels = dict(every[0].labels)
        if rubbing.bursts is not None:
            self.labels["burst_count"] = sum(force.burst_count for force in every)

    def take(self, course: BackgroundCourse) -> dict[str, FloatArray]:
        """Return the next forces (k,) [N] by input of the background."""
        found: dict[str, FloatArray] = {}
        frame = self._carrier * course.angle_rad
        for mesh, forces in self._forces.items():
            noises = np.array([force.take(self._own(course, mesh, i)) for i, force in enumerate(forces)])
            angle = frame + self._places[:, None]
            found[f"{mesh}/{EVEN}"] = noises.sum(axis=0)
            for axis, wave in zip(AXES, (np.cos(angle), np.sin(angle)), strict=True):
                found[f"{mesh}/{axis}"] = (noises * wave).sum(axis=0)
        return found

    def _own(self, course: BackgroundCourse, mesh: str, planet: int) -> BackgroundCourse:
        """Return a course as one mesh has it: its driving gear turns against the carrier."""
        pair, point, turns = self._meshes[mesh]
        angle_rad = course.angle_rad * ((1.0 - self._carrier) * turns)
        return replace(
            course,
            angle_rad=angle_rad,
            turns=turning(angle_rad),
            shafts={},
            pair=pair,
            point=point,
            of_record=lambda name: course.of_record(f"{name}.{mesh}.{planet}"),
            of_gearbox=lambda name: course.of_gearbox(f"{name}.{mesh}.{planet}"),
        )
