"""CageCourse: how far the cage has turned when its shaft stands at an angle, with slip and a random walk.

Balls slip a little, so the cage lags by a share of its order, and by a little more or less from ball to ball: its angle
takes a random step each time a ball passes a place of the outer race (reference: standard literature; shares from
memory). Phases of lines are lost by it, in proportion to the square of their number.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.bearings.ball_bearing import BallBearing


@dataclass(frozen=True, slots=True)
class CageCourse:
    """Angle of a cage by the angle of its shaft.

    Parameters
    ----------
    order : float, turns of the cage per turn of the shaft, slip included
    start_rad : float, of the cage where the shaft stands at 0
    first_rad : float, angle of the shaft at which the walk begins
    step_rad : float, turn of the shaft from step to step of the walk
    walked_rad : (steps + 1,) the walk at each step, from 0; between them it runs straight
    """

    order: float
    start_rad: float
    first_rad: float
    step_rad: float
    walked_rad: FloatArray

    def angle_rad(self, shaft_rad: FloatArray) -> FloatArray:
        """Return the angle (k,) of the cage where the shaft stands at (k,) [rad].

        Raises
        ------
        ValueError
            If the shaft turns further than the walk covers.
        """
        place = (shaft_rad - self.first_rad) / self.step_rad
        if place.size and not (place.min() >= 0.0 and place.max() <= self.walked_rad.size - 1):
            raise ValueError(
                f"shaft_rad: received {shaft_rad.min()} to {shaft_rad.max()}; allowed are {self.first_rad} to "
                f"{self.first_rad + self.step_rad * (self.walked_rad.size - 1)}"
            )
        walked = np.interp(place, np.arange(self.walked_rad.size), self.walked_rad)
        return np.asarray(self.start_rad + self.order * shaft_rad + walked)


def cage_course(
    bearing: BallBearing, rng: np.random.Generator, slip: float, walk: float, ends_rad: tuple[float, float]
) -> CageCourse:
    """Return a course that covers a shaft that turns forward between two angles; a later end leaves it as it was.

    Parameters
    ----------
    slip : share by which the cage lags
    walk : standard deviation of a step, as a share of the angle between two balls
    """
    order = bearing.cage_order * (1.0 - slip)
    step_rad = bearing.spacing_rad / order
    start = 2.0 * np.pi * rng.random()
    steps = ceil((ends_rad[1] - ends_rad[0]) / step_rad) + 1
    walked = np.cumsum(walk * bearing.spacing_rad * rng.standard_normal(steps))
    return CageCourse(order, float(start), ends_rad[0], step_rad, np.concatenate([[0.0], walked]))
