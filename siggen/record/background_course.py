"""Course: what the background forces of one record follow, and where their numbers come from."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from math import pi

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.drivetrain.comb import harmonic_sum, turns_of
from siggen.drivetrain.drive import Rotation
from siggen.gearbox.plan import PlannedRecord
from siggen.gearbox.specimen import OperatingPoint, Specimen
from siggen.gears.gear_pair import GearPair
from siggen.motion.motion import TRANSIENT_CAP_S
from siggen.names import Side
from siggen.record.friction import asperity_share, composite_roughness_m
from siggen.seeding import Stream, named_generator, named_uniforms
from siggen.sensing.modulation import SHAFT_LINES, shaft_phasors


@dataclass(frozen=True, slots=True)
class BackgroundCourse:
    """Pinion angle (length,) at the samples of a record and of the history before it, and draws by name.

    Or at a part of them, `history` samples from its first one to that of the record. `turns` gives exp(i order Θ)
    (length,), each order once. `shafts` are the turns of every shaft per turn of the pinion, by its name in sections.
    `asperity_share` is that of the mean load at the pitch point of `pair`, whose pinion has the angle; `roughness_m` is
    the rms roughness of both its flanks together. `uniform` gives uniforms of the gearbox, `of_gearbox` and `of_record`
    generators.
    """

    angle_rad: FloatArray
    turns: Callable[[float], ComplexArray]
    shafts: Mapping[str, float]
    fs_hz: float
    history: int
    pair: GearPair
    point: OperatingPoint
    asperity_share: float
    roughness_m: float
    uniform: Callable[[str], float]
    of_gearbox: Callable[[str], np.random.Generator]
    of_record: Callable[[str], np.random.Generator]

    @property
    def length(self) -> int:
        """Samples of the record and of the history before it."""
        return int(self.angle_rad.size)

    @property
    def gears(self) -> dict[Side, float]:
        """Turns of both gears of the pair per turn of its pinion."""
        return {Side.DRIVER: 1.0, Side.DRIVEN: self.pair.pinion.teeth / self.pair.gear.teeth}

    @property
    def mesh_force_n(self) -> float:
        """Mean force of the teeth along the line of action."""
        return self.point.torque_nm / self.pair.pinion.base_radius_m

    @property
    def top_order(self) -> float:
        """Highest order that the band carries at the nominal speed, less 5 % for its variation."""
        return 0.95 * 0.5 * self.fs_hz / self.point.speed_hz

    def phases(self, name: str, count: int) -> FloatArray:
        """Return phases (count,) of the gearbox."""
        return 2.0 * pi * self.of_gearbox(f"background.{name}.phases").random(count)

    def shaft_lines(self, shaft: str, order: float, depth: float, turn: float = 0.0) -> FloatArray:
        """Return the modulation (length,) by a shaft, the same for all its sources but for a part of a turn."""
        later = 2.0 * pi * turn * np.arange(1.0, SHAFT_LINES + 1.0)
        phase_rad = self.phases(f"modulation.{shaft}", SHAFT_LINES) + later
        return harmonic_sum(self.turns(order), shaft_phasors(depth, phase_rad))


def turning(angle_rad: FloatArray) -> Callable[[float], ComplexArray]:
    """Return what gives exp(i order Θ) (k,) of angles (k,), each order once."""
    return cache(lambda order: turns_of(angle_rad, order))


def course_at(
    specimen: Specimen, record: PlannedRecord, rotation: Rotation, first: int, count: int
) -> BackgroundCourse:
    """Return the course of one record over `count` samples from sample `first`, below 0 in the history."""
    pair, point, fs_hz = specimen.pair, specimen.points[record.operating_point_id], specimen.sampling.fs_hz
    # a fast length may reach further back than any force is followed; there the shaft stands still
    time_s = np.maximum((np.arange(count) + first) / fs_hz, -TRANSIENT_CAP_S)
    angle_rad = rotation.angle_rad(time_s)
    planets, turns = specimen.planets, specimen.shaft_turns
    of_mesh = point if planets is None else planets.of_one_mesh(point)
    orders = turns if planets is None else (turns[0], planets.teeth.carrier_turns)
    return BackgroundCourse(
        angle_rad,
        turning(angle_rad),
        {shaft.inner: float(order) for shaft, order in zip(specimen.names.shafts, orders, strict=True)},
        fs_hz,
        -first,
        pair,
        point,
        asperity_share(specimen.law.friction, pair, of_mesh),
        composite_roughness_m(specimen.law.friction)[0],
        named_uniforms(specimen.seed, Stream.BACKGROUND, record.specimen_id),
        lambda name: named_generator(specimen.seed, Stream.BACKGROUND, record.specimen_id, name=name),
        lambda name: named_generator(specimen.seed, Stream.BACKGROUND_NOISE, *record.noise_owner, name=name),
    )
