"""The background of one record: forces over time of everything beside the meshing teeth, and what channels see of them.

Levels belong to the gearbox, the courses of noise to the record. Lines keep
their phase against the pinion's angle, so that all states of a gearbox share them.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from functools import partial
from math import pi

import numpy as np

from siggen.arrays import FloatArray
from siggen.drivetrain.comb import Comb
from siggen.drivetrain.drive import Rotation
from siggen.gearbox.background import DrawnBackground, ForeignLevels, MachineLevels, ShaftLevels
from siggen.gearbox.plan import PlannedRecord
from siggen.gearbox.specimen import Specimen
from siggen.names import MACHINES, Names
from siggen.record.background_course import BackgroundCourse, course_at
from siggen.record.bearing_noise import BearingVelocities
from siggen.record.forced_ways import AXES
from siggen.record.rubbing import RubbingForce, SetRubbing
from siggen.sensing.inputs import BACKGROUND, Input
from siggen.sensing.modulation import LevelCourse, shaft_course
from siggen.sensing.noise import ShapedNoise, contact_filter, rising_floor, shape_taps

FOREIGN_LINES = 15
"""Lines of another mesh (measured)."""
MACHINE_TAPS = 8192
"""Of the filter of their noise, whose corner lies below 120 Hz."""


class BackgroundBlocks:
    """All parts of a record's background from sample `first` on, over `length` samples, of its `inputs`.

    `labels` are there from the first block on. Nothing is drawn from the state.
    """

    def __init__(
        self,
        specimen: Specimen,
        record: PlannedRecord,
        rotation: Rotation,
        inputs: Collection[str],
        first: int,
        length: int,
    ) -> None:
        assert specimen.background is not None
        self._of_record = (specimen, record, rotation)
        self._drawn, self._inputs = specimen.background, inputs
        self._next, self._length = first, length
        self._rubbing: RubbingForce | SetRubbing | None = None
        self._bearings: BearingVelocities | None = None
        self._machines: dict[str, MachineNoise] = {}
        self.labels: dict[str, object] = {}

    def take(self, count: int) -> dict[Input, FloatArray]:
        """Return the next values (count,) of every input."""
        course = self._course(count)
        forces, labels = line_forces(self._drawn, course, self._inputs)
        if not self.labels:
            self._begin(course)
        if self._rubbing is not None:
            taken = self._rubbing.take(course)
            forces |= taken if isinstance(taken, dict) else {"mesh": taken}
            labels |= self._rubbing.labels
        if self._bearings is not None:
            forces |= self._bearings.take(course)
            labels |= self._bearings.labels
        forces |= {name: noise.take(course) for name, noise in self._machines.items()}
        if self._drawn.machines is not None:
            labels["machine_force_n_per_sqrt_hz"] = self._drawn.machines.density_n_per_sqrt_hz
        self.labels = self.labels or labels
        self._next += count
        return {Input(BACKGROUND, name): force for name, force in forces.items()}

    def _begin(self, course: BackgroundCourse) -> None:
        drawn, specimen = self._drawn, self._of_record[0]
        if drawn.rubbing is not None:
            of_set = partial(SetRubbing, specimen=specimen)
            self._rubbing = (RubbingForce if specimen.planets is None else of_set)(drawn.rubbing, course, self._length)
        if drawn.bearings:
            self._bearings = BearingVelocities(drawn.bearings, course, specimen)
        if drawn.machines is not None:
            self._machines = machine_noise(drawn.machines, course, specimen.names)

    def _course(self, count: int) -> BackgroundCourse:
        return course_at(*self._of_record, self._next, count)


@dataclass(frozen=True, slots=True)
class MachineNoise:
    """Force of a machine, whose power swells with its shaft and by chance."""

    noise: ShapedNoise
    level: LevelCourse
    shaft: str
    depth: float

    def take(self, course: BackgroundCourse) -> FloatArray:
        """Return the next values (k,) [N]."""
        turning = shaft_course([course.shaft_lines(self.shaft, course.shafts[self.shaft], self.depth)])
        return np.asarray(self.noise.take(course.length) * np.sqrt(turning * self.level.take(course.length)))


def machine_noise(machines: MachineLevels, course: BackgroundCourse, names: Names) -> dict[str, MachineNoise]:
    """Return the noise of both machines beside the gearbox, independent of each other."""

    def shape(frequency_hz: FloatArray) -> FloatArray:
        rising = rising_floor(frequency_hz, machines.low_corner_hz, machines.low_exponent)
        falling = contact_filter(frequency_hz, machines.high_corner_hz, 1.0)
        return machines.density_n_per_sqrt_hz * rising * falling + 1e-30

    taps = shape_taps(shape, MACHINE_TAPS, course.fs_hz)
    memory = machines.level_time_s * course.fs_hz
    return {
        name: MachineNoise(
            ShapedNoise(taps, course.fs_hz, course.of_record(f"background.machines.{name}")),
            LevelCourse(machines.level_std, memory, course.of_record(f"background.machines.{name}.level")),
            names.shafts[place].inner,
            machines.shaft_depth,
        )
        for name, place in MACHINES.items()
    }


def line_forces(
    drawn: DrawnBackground, course: BackgroundCourse, inputs: Collection[str]
) -> tuple[dict[str, FloatArray], dict[str, object]]:
    """Return input -> force (length,) of what follows the angle alone, and labels."""
    forces: dict[str, FloatArray] = {}
    labels: dict[str, object] = {}

    def add(name: str, force: FloatArray) -> None:
        if name in inputs:
            forces[name] = forces[name] + force if name in forces else force

    for shaft, levels in drawn.shafts.items():
        for name, force in _shaft(levels, course, shaft):
            add(name, force)
        labels[f"coupling_force_{shaft}_n"] = levels.coupling_n
    for name, mesh in drawn.foreign.items():
        comb = _foreign(mesh, course, name)
        add(name, comb.force_n(course.turns(comb.order), course.turns(comb.sideband_order), course.top_order))
        labels |= {f"{name}_order": comb.order, f"{name}_force_n": float(comb.amplitude_n[0])}
    return forces, labels


def _shaft(levels: ShaftLevels, course: BackgroundCourse, shaft: str) -> list[tuple[str, FloatArray]]:
    """Return the forces of one coupling along both axes, and of the rotor on its shaft on the base."""
    order = course.shafts[shaft]
    amplitude = levels.coupling_n * 10.0 ** (np.array([0.0, *levels.higher_db]) / 20.0)
    found = []
    for axis in AXES:
        phase = course.phases(f"shafts.{shaft}.{axis}", amplitude.size)
        found.append((f"{shaft}_shaft/{axis}", Comb(order, amplitude, phase).force_n(course.turns(order))))
    moment = levels.rotor_kg_m_s / (2.0 * pi * levels.rated_speed_hz * order)
    speed_rad_s = 2.0 * pi * course.point.speed_hz * order
    outward, start = np.array([moment * speed_rad_s**2]), course.phases(f"shafts.{shaft}.rotor", 1)
    # it turns: a quarter of a turn between the axes
    for axis, lag in zip(AXES, (0.0, 0.5 * pi), strict=True):
        found.append((f"base/{axis}", Comb(order, outward, start - lag).force_n(course.turns(order))))
    return found


def _foreign(mesh: ForeignLevels, course: BackgroundCourse, name: str) -> Comb:
    number = np.arange(1.0, FOREIGN_LINES + 1.0)
    return Comb(
        mesh.order,
        mesh.force_share * course.mesh_force_n * number**-mesh.decay_exponent,
        course.phases(name, FOREIGN_LINES),
        10.0 ** (mesh.sideband_db / 20.0),
        [*course.shafts.values()][1] if mesh.shaft_order is None else mesh.shaft_order,
        2.0 * pi * course.uniform(f"background.{name}.sideband.phase"),
    )
