"""TorqueVariation: torques beside the constant one, and those that speed the train up, without moving it as a whole.

Derived. Body i turns by r_i Θ(t) + θ_i, where Θ is prescribed and θ_i a coordinate; r is the rigid rotation (pinion 1).
With kinetic energy ½ Σ J_i (r_i Ω + θ̇_i)² the equations of the coordinates get the force -M r Ω̇. Since Mᵀr Ω̇ does
work on r, the motor has to supply J Ω̇ with J = rᵀ M r, the inertia of the train seen from the pinion:

    M q̈ + C q̇ + K q + p F = τ T + (e_m J - M r) Ω̇          rᵀ(e_m J - M r) = 0: no rigid drift

Any torque u on a body b does the same with its own share of the rigid acceleration: it acts along e_b - M r (rᵀe_b)/J.
That is, Θ is by definition the whole rigid motion, and what a torque adds to the coordinates is twist alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.drive.drive import Turning
from siggen.dynamics.drive.excitation import InputSource
from siggen.dynamics.drive.slow_variation import SlowVariation
from siggen.dynamics.structure.shaft_lines import driven_and_loaded, rigid_rotation, without_drift
from siggen.dynamics.structure.structure import Structure, vector


@dataclass(frozen=True, slots=True)
class TorqueSettings:
    """How the torque varies, relative to the mean torque; the defaults leave it constant.

    Attributes
    ----------
    slow, slow_rms : slow random part of motor and load together, unit variance and its rms
    load_once, load_phase_rad : load torque at once per revolution of its own shaft
    line_ripple, line_hz, line_phase_rad : motor torque at twice the line frequency
    """

    slow: SlowVariation | None = None
    slow_rms: float = 0.0
    load_once: float = 0.0
    load_phase_rad: float = 0.0
    line_ripple: float = 0.0
    line_hz: float = 50.0
    line_phase_rad: float = 0.0


class TorqueVariation(InputSource):
    """Three inputs: slow torque of motor and load in balance, torque of the load, torque of the motor."""

    def __init__(self, structure: Structure, torque_nm: float, settings: TorqueSettings) -> None:
        motor, load = driven_and_loaded(structure)
        rotation = rigid_rotation(structure)
        self.reduced_inertia_kg_m2 = float(rotation @ structure.mass @ rotation)
        self._vectors = np.stack([structure.torque_vector, *without_drift(structure, _units(structure, load, motor))])
        self._gear_turn = abs(rotation[structure.coordinates.index(load)])
        self._torque_nm = torque_nm
        self._settings = settings

    @property
    def vectors(self) -> FloatArray:
        """The generalised forces (3, n)."""
        return self._vectors

    def inputs(self, turning: Turning) -> FloatArray:
        """Return the inputs (k, 3) [N m]: the first and the last as motor torques, the second on the load's shaft."""
        s = self._settings
        gear_angle = turning.angle_rad * self._gear_turn
        once = -self._torque_nm / self._gear_turn * s.load_once * np.cos(gear_angle + s.load_phase_rad)
        return np.stack([self._slow_nm(turning), once, self._motor_nm(turning)], axis=1)

    def motor_torque_nm(self, turning: Turning) -> FloatArray:
        """Return the whole torque (k,) that the motor delivers, the mean and what speeds the train up included."""
        return self._torque_nm + self._slow_nm(turning) + self._motor_nm(turning)

    def _slow_nm(self, turning: Turning) -> FloatArray:
        s = self._settings
        if s.slow is None:
            return np.zeros_like(turning.time_s)
        return self._torque_nm * s.slow_rms * s.slow.value(turning.time_s)

    def _motor_nm(self, turning: Turning) -> FloatArray:
        s = self._settings
        ripple = np.cos(4.0 * np.pi * s.line_hz * turning.time_s + s.line_phase_rad)
        return self.reduced_inertia_kg_m2 * turning.acceleration_rad_s2 + self._torque_nm * s.line_ripple * ripple


def _units(structure: Structure, *names: str) -> FloatArray:
    """Return a unit torque (names, n) at each of the coordinates."""
    return np.array([vector(structure.coordinates, {name: 1.0}) for name in names])
