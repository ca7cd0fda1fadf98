"""StreamedInternals: what no sensor sees of a record, kept as float32 while its pieces pass by."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.checks.quantity_names import acceleration_name, angle_name, bearing_force_name
from siggen.dynamics.time.response_stream import Piece, ResponsePieces, ResponseStream
from siggen.gearbox.specimen import Specimen
from siggen.record.quantities import (
    TRANSMISSION_ERROR,
    approach_name,
    pinion_angle_rad,
    transmission_error_m,
)


class StreamedInternals:
    """`pieces` of a `stream` that holds its internals; the stream's states are forgotten block after block.

    What is kept is what the configuration asks for, 0.1 MB per second and quantity at 25.6 kHz.
    """

    def __init__(self, specimen: Specimen, stream: ResponseStream, pieces: ResponsePieces) -> None:
        self.motions, self.places, self.before = pieces.motions, pieces.places, pieces.before
        self.readings = pieces.readings
        self._specimen, self._stream, self._pieces = specimen, stream, pieces
        self._accelerations = tuple(acceleration_name(motion) for motion in self.motions)
        self._forces = tuple(bearing_force_name(place) for place in self.places)
        self._inner = stream.run.motion.internal_names
        self._angle, self._approach = angle_name(specimen.names), approach_name(specimen)
        last = (TRANSMISSION_ERROR,) if self._approach in self._inner else ()
        names = (self._angle, *self._accelerations, *self._forces, *self._inner, *last)
        self._kept = {
            name: np.empty(stream.samples, dtype=np.float32) for name in dict.fromkeys(names) if specimen.stores(name)
        }

    @property
    def contact_loss_share(self) -> float:
        """Share of the record in which no teeth touched, once all pieces were taken."""
        return self._stream.contact_loss_share

    def pieces(self) -> Iterator[Piece]:
        """Yield all pieces in order."""
        heard, seen = -self.before, 0
        for piece in self._pieces.pieces():
            self._keep(heard, dict(zip(self._accelerations, piece.acceleration_m_s2, strict=True)))
            if self.places:
                self._keep(heard, dict(zip(self._forces, piece.bearing_force_n, strict=True)))
            heard += piece.acceleration_m_s2.shape[1]
            for block in self._stream.inner:
                self._keep_inner(seen, block)
                seen += len(block)
            self._stream.inner.clear()
            yield piece

    def quantities(self) -> dict[str, NDArray[np.float32]]:
        """Return name -> (n,), once all pieces were taken."""
        return self._kept

    def _keep_inner(self, first: int, block: FloatArray) -> None:
        """Keep the internals (k, names) at the samples from `first` on, and what follows from them."""
        named = dict(zip(self._inner, block.T, strict=True))
        angle = pinion_angle_rad(self._stream.run.drive, self._stream.run.fs_hz, first, len(block))
        self._keep(first, {self._angle: angle, **named})
        if self._approach in named:
            self._keep(first, {TRANSMISSION_ERROR: transmission_error_m(named[self._approach], self._specimen)})

    def _keep(self, first: int, named: Mapping[str, FloatArray]) -> None:
        """Keep what belongs to the record of values (k,) at the samples from `first` on."""
        for name, values in named.items():
            if name in self._kept:
                kept, behind = self._kept[name], values[max(-first, 0) :]
                start = max(first, 0)
                kept[start : start + behind.size] = behind[: max(kept.size - start, 0)]
