"""Quantity: what a channel holds, in words and as names and units of columns."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Quantity:
    """What a kind of sensor measures.

    Attributes
    ----------
    word : such as "acceleration", for cards, axes and messages
    stem : how the names of its signal columns begin
    unit : as metadata and tables have it, such as "m/s^2"
    suffix : the unit as names end with it, such as "m_s2"
    measurement : what is measured by it, in lists of measurements; the word unless it says otherwise
    """

    word: str
    stem: str
    unit: str
    suffix: str
    measurement: str = ""

    def column(self, channel: str) -> str:
        """Return the name of the column that holds a channel's signal."""
        return f"{self.stem}_{channel}_{self.suffix}"

    @property
    def shown_unit(self) -> str:
        """The unit as pages and pictures show it."""
        return self.unit.replace("^2", "²").replace("^3", "³").replace("um", "µm")


ACCELERATION = Quantity("acceleration", "accel", "m/s^2", "m_s2", "vibration")
STILL_M_S2 = 1e-3
"""Acceleration (rms) that no error is relative to less of: about what a good piezoelectric accelerometer itself makes
over 10 kHz (from memory: 0.3 to 3e-3 m/s²). Perfect gears at 0 N m stand still, and rounding is no error of theirs."""
