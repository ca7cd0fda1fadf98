"""Numbers on which every value depends; they are stored with every table."""

from __future__ import annotations

from dataclasses import dataclass

from diagnostics.signal.order_bands import ORDER_BANDS, band_name
from diagnostics.signal.order_domain import SAMPLES_PER_TOOTH
from diagnostics.signal.shaft_lines import LINE_ORDERS
from diagnostics.signal.shaft_signals import SHAFT_ORDERS, SIDEBANDS
from diagnostics.signal.spectral_kurtosis import FRAME_SAMPLES


@dataclass(frozen=True, slots=True)
class IndicatorSettings:
    """Numbers on which every value depends.

    Attributes
    ----------
    mesh_harmonics : int
        Mesh harmonics 1 ... of which lines and sidebands are taken; also the sum in FM0.
    sidebands : int
        Sidebands on each side whose relative amplitude is an indicator.
    ratio_sidebands : int
        Sidebands on each side in the sideband ratio.
    samples_per_tooth : int
        Angle steps per mesh period.
    shaft_orders, difference_sidebands : int
        What the difference signal leaves out besides all mesh harmonics.
    modulation_harmonics : int
        Mesh harmonics 1 ... that are demodulated.
    frame_samples : int
        Frame of the spectral kurtosis.
    speed_range_hz : (float, float), optional
        Where given, angles come from the mesh lines within this range of pinion speed, not from the pulses.
    """

    mesh_harmonics: int = 5
    sidebands: int = 6
    ratio_sidebands: int = 3
    samples_per_tooth: int = SAMPLES_PER_TOOTH
    shaft_orders: int = SHAFT_ORDERS
    difference_sidebands: int = SIDEBANDS
    modulation_harmonics: int = 3
    frame_samples: int = FRAME_SAMPLES
    speed_range_hz: tuple[float, float] | None = None

    def choices(self, field: str) -> tuple[int | str, ...]:
        """Return the values that a field of a column's template takes; shafts are those of the gearbox."""
        return {
            "harmonic": tuple(range(1, self.mesh_harmonics + 1)),
            "harmonics": (self.mesh_harmonics,),
            "demodulated_harmonic": tuple(range(1, self.modulation_harmonics + 1)),
            "side": ("lower", "upper"),
            "sideband": tuple(range(1, self.sidebands + 1)),
            "ratio_sidebands": (self.ratio_sidebands,),
            "shaft_order": LINE_ORDERS,
            "band": tuple(band_name(*band) for band in ORDER_BANDS),
        }[field]
