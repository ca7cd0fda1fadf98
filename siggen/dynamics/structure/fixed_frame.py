"""What a sensor at rest sees of a body whose coordinates turn with a carrier.

Equations: standard literature (accelerations in a turning frame). A ring that moves as a whole passes a force at the
angle β before the sensor on as 1 and cos β, sin β of it: the first terms of its transfer as a Fourier series in the
angle. No window: planets are heard from everywhere, as far as the ring moves.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray


def fixed_accelerations(
    place_m: FloatArray, speed_m_s: FloatArray, acceleration_m_s2: FloatArray, angle_rad: FloatArray, turning_hz: float
) -> FloatArray:
    """Return the acceleration along the fixed axes (2, k) of a point that moves in a turning frame [m/s²].

    Parameters
    ----------
    place_m, speed_m_s, acceleration_m_s2 : (2, k)
        Along the axes of a frame that turns evenly, and their rates as the frame sees them.
    angle_rad : (k,)
        Of the frame's x axis against the fixed one.
    turning_hz : float
        Of the frame.
    """
    omega = 2.0 * np.pi * turning_hz
    x = acceleration_m_s2[0] - 2.0 * omega * speed_m_s[1] - omega**2 * place_m[0]
    y = acceleration_m_s2[1] + 2.0 * omega * speed_m_s[0] - omega**2 * place_m[1]
    cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
    return np.stack([cosine * x - sine * y, sine * x + cosine * y])
