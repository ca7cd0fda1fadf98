"""The stator current of an induction motor whose rotor turns unevenly, at a line frequency that does not change.

Active current follows torque, and torque follows slip with the lag of the leakage flux (reference: standard literature
on induction machines, linearised at small slip):

    τ dI_t/dt + I_t = I_n s/s_n,   τ = 1/(2π f_L s_k),   s = 1 - p Ω/(2π f_L)

Each phase carries the magnetising current, a quarter period behind, and the active one. A slow ripple of the speed thus
moves the active current by its slip. A fast one moves it by p s_k/s_n times its angle: the phase modulation by the
rotor's angle that is known from theories of torque ripple in stator currents (derived; reference from memory: Blödt,
IEEE Trans. Ind. Electron. 55 (2008)).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry

MEMORY = 16.0
"""Time constants over which the lag forgets how it began: 1e-7 is left."""


@dataclass(frozen=True, slots=True)
class InductionMotor:
    """Numbers of a motor; currents are amplitudes of a phase.

    Attributes
    ----------
    pole_pairs : p
    rated_torque_nm, rated_slip, rated_active_a : torque, slip s_n and active current I_n at rated load
    breakdown_slip : s_k
    magnetising_a : whatever the load
    """

    pole_pairs: int
    rated_torque_nm: float
    rated_slip: float
    rated_active_a: float
    breakdown_slip: float
    magnetising_a: float

    def line_hz(self, speed_hz: float, torque_nm: float) -> float:
        """Return the line frequency at which the motor turns so fast under a torque."""
        return self.pole_pairs * speed_hz / (1.0 - self.slip(torque_nm))

    def slip(self, torque_nm: float) -> float:
        """Return the slip under a torque."""
        return self.rated_slip * torque_nm / self.rated_torque_nm


def active_current(motor: InductionMotor, uneven_rad: FloatArray, fs_hz: float, line_hz: float) -> FloatArray:
    """Return what an uneven rotation (n,) [rad] adds to the active current of steady load (n,) [A].

    Before the record the rotation goes on as its mirror image about the first sample.
    """
    tau = 1.0 / (2.0 * np.pi * line_hz * motor.breakdown_slip)
    before = min(int(np.ceil(MEMORY * tau * fs_hz)), uneven_rad.size - 1)
    mirrored = 2.0 * uneven_rad[0] - uneven_rad[before:0:-1]
    course = np.concatenate([mirrored, uneven_rad])
    speed = (course - lagging(course, 1.0 / (tau * fs_hz))) / tau
    per_speed = -motor.pole_pairs * motor.rated_active_a / (2.0 * np.pi * line_hz * motor.rated_slip)
    return np.asarray(per_speed * speed[mirrored.size :])


@entry(cache=True)
def lagging(course: FloatArray, step: float) -> FloatArray:
    """Return what lags (n,) behind a course (n,) that is straight between samples, `step` samples over time constants.

    Exact for such a course (derived); it begins without a lag.
    """
    kept = np.exp(-step)
    last = 1.0 - (1.0 - kept) / step
    result = np.empty(course.size)
    result[0] = course[0]
    for i in range(1, course.size):
        result[i] = kept * result[i - 1] + (1.0 - kept - last) * course[i - 1] + last * course[i]
    return result


def phase_current(motor: InductionMotor, active_a: FloatArray, line_rad: FloatArray, phase_rad: float) -> FloatArray:
    """Return the current of one phase (n,) [A].

    Parameters
    ----------
    active_a : (n,)
    line_rad : (n,) phase angle of the line
    phase_rad : by which this phase is behind
    """
    angle = line_rad - phase_rad
    return np.asarray(motor.magnetising_a * np.sin(angle) + active_a * np.cos(angle))
