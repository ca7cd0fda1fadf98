"""1/f noise of the electronics."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field

from siggen.arrays import FloatArray
from siggen.keys.number import Number, Within, at
from siggen.keys.usual import Usual
from siggen.noise.source import Draws, NoisePart, NoisyChannel, Source
from siggen.sensing.noise import PinkStream

PINK_HZ = 100.0
"""Where the density is given, about where it meets the white noise of accelerometers (assumed)."""


class PinkNoise(Source):
    """Noise whose power falls as 1/f, as it is stored."""

    key: ClassVar[str] = "pink_noise"
    about: ClassVar[str] = "of the electronics; "
    meaning: ClassVar[str] = "density of the 1/f noise at 100 Hz, in"
    broad: ClassVar[bool] = True
    per: ClassVar[tuple[str, str]] = ("_per_sqrt_hz", "/sqrt(Hz)")

    density_m_s2_per_sqrt_hz: Annotated[Number, Within(least=0), Usual(1e-07, 0.01)] = Field(
        description="one-sided density at 100 Hz"
    )

    def part(self, channel: NoisyChannel, draws: Draws) -> NoisePart:
        """Return its noise behind the coupling."""
        rng = draws.record(self.key)
        density = at(self.density_m_s2_per_sqrt_hz, draws.level("pink_noise.density_m_s2_per_sqrt_hz", rng))
        rng.random()  # the noise of sets begins behind this number
        return _PinkPart(density, PinkStream(density, PINK_HZ, channel.coupling_hz, channel.fs_hz, rng))


class _PinkPart:
    def __init__(self, density: float, stream: PinkStream) -> None:
        self.label, self._stream = density, stream

    def take(self, first: int, angle_rad: FloatArray) -> FloatArray:  # noqa: ARG002
        return self._stream.take(angle_rad.size)
