"""Transducers: sensors whose reading is not a filter's of what the model gives, but made of a whole record."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

from siggen.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class Running:
    """How the gearbox runs in a record, beside its vibration.

    Attributes
    ----------
    fs_hz : sampling rate
    pinion_rad : (n,) prescribed angle of the pinion's shaft at the samples
    turns : what turns -> its turns per turn of the pinion
    torque_nm : of the operating point, on the pinion's shaft
    base_radii_m : what turns -> base radius of the gear that it turns with
    places : channel -> where its sensor is
    line_rad : phase of the electrical line at the first sample, one for all sensors
    readings : channel -> (n,) of those that show something of the model and were read as a whole already
    """

    fs_hz: float
    pinion_rad: FloatArray
    turns: Mapping[str, float]
    torque_nm: float
    base_radii_m: Mapping[str, float]
    places: Mapping[str, str]
    line_rad: float
    readings: Mapping[str, FloatArray] = field(default_factory=dict)

    def shaft_rad(self, shaft: str) -> FloatArray:
        """Return the prescribed angle (n,) of what turns, such as `motor` or `gear`."""
        return self.turns[shaft] * self.pinion_rad

    def base_radius_m(self, channel: str) -> float:
        """Return the base radius of the gear that an encoder's channel turns with."""
        return self.base_radii_m[self.places[channel]]


class Transducer(Protocol):
    """A channel of one gearbox."""

    def reading(self, shown: FloatArray, running: Running) -> FloatArray:
        """Return what the channel reads (n,) of what it shows of the model (n,).

        Raises
        ------
        SolverFailure
            If it cannot read this record; says why.
        """
