"""RigNumbers: masses, supports and sizes that follow from a rig's gears, torque and shafts.

Steel discs and shafts by geometry, bearings by their catalogue. What follows from nothing that is known scales with the
gearbox of `bench`: `ASSUMED`.
"""

from __future__ import annotations

from math import ceil, cos, pi, radians, sqrt
from typing import NamedTuple

from siggen.config.consistency import SAMPLES_PER_PERIOD, SIDEBANDS, carried_mesh_harmonics
from siggen.drivetrain.gear_stage import STEEL_DENSITY_KG_M3
from siggen.errors import UsageError
from siggen.rig.rig import Pair, Rig
from siggen.rig.shafts import ShaftSize, shafts

MESH_HARMONICS, SPEED_MARGIN = 10, 1.02
"""Carried where no sampling rate is given, at a speed that varies so much."""
RUNNING_IN_UM = 2.0
"""Relief by running in alone, C_ay of ISO 6336-1 for steel of 1500 N/mm²; the other end is the deflection."""
BENCH_CENTRE_MM = 97.5
BENCH_TORQUE_NM = (60.0, 156.7)
BENCH_FORCE_N = 2365.0
ASSUMED = "scaled from the gearbox of bench, by size or torque"


class RotorNumbers(NamedTuple):
    """Of one gear with its shaft: mass [kg], inertia [kg m²], both bearings [N/m]."""

    shaft: ShaftSize
    mass_kg: float
    inertia_kg_m2: float
    bearing_n_per_m: float


class RigNumbers(NamedTuple):
    """What `rig_text` writes; stiffnesses and dampings of couplings belong to input and output.

    `load_share` is the largest tooth force over that of bench, `scale` the same of the centre distance;
    `mesh_harmonics` are what the sampling rate carries, ten at most.
    """

    rotors: tuple[RotorNumbers, RotorNumbers]
    motor_inertia_kg_m2: float
    load_inertia_kg_m2: float
    coupling_nm_per_rad: Pair
    coupling_nm_s_per_rad: Pair
    scale: float
    load_share: float
    tip_relief_um: Pair
    fs_hz: float
    mesh_harmonics: int
    duration_s: float


def rig_numbers(rig: Rig) -> RigNumbers:
    """Return the numbers of a rig at its largest torque."""
    ratio = rig.teeth[1] / rig.teeth[0]
    torque = (rig.torque_nm[1], rig.torque_nm[1] * ratio)
    base_mm = 0.5 * rig.module_mm * rig.teeth[0] * cos(radians(rig.pressure_angle_deg))
    force_n = 1e3 * torque[0] / base_mm
    first, second = shafts(rig)
    rotors = _rotor(rig, 0, first, force_n), _rotor(rig, 1, second, force_n)
    motor, load = 4e-3 * torque[0] / BENCH_TORQUE_NM[0], 1e-2 * torque[1] / BENCH_TORQUE_NM[1]
    stiffness = 6300.0 * torque[0] / BENCH_TORQUE_NM[0], 2100.0 * torque[1] / BENCH_TORQUE_NM[1]
    inertias = (motor, rotors[0].inertia_kg_m2), (load, rotors[1].inertia_kg_m2)
    damping = tuple(0.1 * sqrt(k * a * b / (a + b)) for k, (a, b) in zip(stiffness, inertias, strict=True))
    scale = 0.5 * rig.module_mm * sum(rig.teeth) / BENCH_CENTRE_MM
    relief = sorted((RUNNING_IN_UM, force_n / rig.face_width_mm / single_stiffness_n_um_mm(rig.teeth)))
    return RigNumbers(
        rotors,
        motor,
        load,
        stiffness,
        (damping[0], damping[1]),
        scale,
        force_n / BENCH_FORCE_N,
        (relief[0], relief[1]),
        *_sampling(rig),
    )


def _sampling(rig: Rig) -> tuple[float, int, float]:
    """Return rate, mesh harmonics that it carries, and duration in whole samples.

    Raises
    ------
    UsageError
        If the rate that was given carries no mesh line.
    """
    rate = rig.fs_hz or sampling_rate_hz(rig)
    carried = carried_mesh_harmonics(rate, rig.teeth[0], rig.speed_hz[1] * SPEED_MARGIN)
    if carried < 1:
        needed = SAMPLES_PER_PERIOD * (rig.teeth[0] + SIDEBANDS) * rig.speed_hz[1] * SPEED_MARGIN
        raise UsageError(
            f"--fs: received {rate:g}; allowed: at least {needed:.0f} Hz, for the first mesh line with its sidebands "
            f"at {rig.speed_hz[1]:g} Hz"
        )
    return rate, min(carried, MESH_HARMONICS), ceil(duration_s(rig) * rate * (1.0 - 1e-9)) / rate


def single_stiffness_n_um_mm(teeth: tuple[int, int]) -> float:
    """Return c' of a spur pair, C_M 0.8, C_R 1, C_B 0.975 (ISO 6336-1, method B, without profile shift)."""
    return 0.8 * 0.975 / (0.04723 + 0.15551 / teeth[0] + 0.25791 / teeth[1])


def sampling_rate_hz(rig: Rig) -> float:
    """Return the least of 25.6, 51.2, ... kHz that carries ten mesh harmonics with their sidebands [Hz]."""
    needed = SAMPLES_PER_PERIOD * (MESH_HARMONICS * rig.teeth[0] + SIDEBANDS) * rig.speed_hz[1] * SPEED_MARGIN
    rate = 25_600.0
    while rate < needed:
        rate *= 2.0
    return rate


def duration_s(rig: Rig, longest_s: float = 10.0) -> float:
    """Return the time of one hunting period and a turn more, and of ten turns of the gear, at most `longest_s` [s].

    At the lowest speed; 2 % are left for its variation, and 1 s is the least.
    """
    turns = max(rig.hunting_turns + 1, 10.0 * rig.teeth[1] / rig.teeth[0])
    return min(max(ceil(10.0 * 1.02 * turns / rig.speed_hz[0]) / 10.0, 1.0), longest_s)


def _rotor(rig: Rig, i: int, shaft: ShaftSize, force_n: float) -> RotorNumbers:
    pitch_mm, thick_mm = rig.module_mm * rig.teeth[i], shaft.diameter_mm
    disc, rod = (
        STEEL_DENSITY_KG_M3 * 0.25 * pi * 1e-9 * area * length
        for area, length in (
            (pitch_mm**2 - thick_mm**2, rig.face_width_mm),
            (thick_mm**2, rig.design.length_factor * shaft.span_mm),
        )
    )
    inertia = 0.125e-6 * (disc * (pitch_mm**2 + thick_mm**2) + rod * thick_mm**2)
    return RotorNumbers(shaft, disc + rod, inertia, 2.0 * shaft.bearing.stiffness_n_per_m(0.5 * force_n))
