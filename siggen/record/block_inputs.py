"""BlockInputs: what reaches the channels of a record, filtered block after block (overlap-save, `block_filter`)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.dynamics.drive.drive import Rotation
from siggen.dynamics.time.response_stream import ResponsePieces
from siggen.gearbox.specimen import Specimen
from siggen.planning.plan import PlannedRecord
from siggen.record.background import BackgroundBlocks
from siggen.record.motion_blocks import MotionBlocks, delivered
from siggen.sensing.block_filter import AHEAD, TOGETHER
from siggen.sensing.inputs import Input
from siggen.specimen.instrument import Instrument


class BlockInputs:
    """Inputs of one record, and what its channels see of them."""

    def __init__(
        self,
        specimen: Specimen,
        record: PlannedRecord,
        rotation: Rotation,
        response: ResponsePieces,
        instrument: Instrument,
    ) -> None:
        self._samples, self._grid = specimen.sampling.samples, instrument.blocks.grid
        back = self._grid.back
        _refuse_undelivered(instrument, delivered(response))
        self._motions = MotionBlocks(response, back)
        self._background: BackgroundBlocks | None = None
        self._filters = instrument.blocks.filters
        if specimen.background is not None:
            length = back + self._samples + AHEAD
            self._background = BackgroundBlocks(specimen, record, rotation, instrument.acting, -back, length)
        self._plain = {c.name: next(iter(c.seen)) for c in instrument.channels if c.is_plain}
        felt = dict.fromkeys(one for filters in self._filters.values() for one in filters)
        seen = tuple(dict.fromkeys([*felt, *self._plain.values()]))
        self._felt, self._values = tuple(felt), np.zeros((len(seen), self._grid.length))
        self._buffers = dict(zip(seen, self._values, strict=True))

    @property
    def labels(self) -> dict[str, object]:
        """Labels of the background, complete when the first block was taken."""
        return {} if self._background is None else self._background.labels

    def seen(self) -> Iterator[dict[str, FloatArray]]:
        """Yield channel -> its quantity (k,) before its gain, block after block."""
        block, back = self._grid.block, self._grid.back
        for first in range(0, self._samples, block):
            count = min(block, self._samples - first)
            self._shift(count, 0 if first == 0 else back + AHEAD)
            yield self._filtered(slice(back, back + count))

    def _shift(self, count: int, kept: int) -> None:
        """Move every input on, so that the next block of `count` samples and what filters see around it is there."""
        new = count if kept else self._grid.back + count + AHEAD
        taken = {**self._motions.take(new), **({} if self._background is None else self._background.take(new))}
        for one, buffer in self._buffers.items():
            buffer[:kept] = buffer[self._grid.block : self._grid.block + kept].copy()
            buffer[kept:] = 0.0
            if one in taken:
                buffer[kept : kept + new] = taken[one]

    def _filtered(self, valid: slice) -> dict[str, FloatArray]:
        bins = self._grid.length // 2 + 1
        totals: dict[str, ComplexArray] = {
            n: np.zeros(bins, complex) for n, filters in self._filters.items() if filters
        }
        product = np.empty(bins, complex)
        for one, spectrum in zip(self._felt, self._spectra(), strict=True):
            for name, filters in self._filters.items():
                if one in filters:
                    np.multiply(filters[one], spectrum, out=product)
                    totals[name] += product
        found = {name: np.fft.irfft(total, self._grid.length)[valid] for name, total in totals.items()}
        for name, one in self._plain.items():
            shown = self._buffers[one][valid] + self._motions.offsets[one]
            found[name] = found[name] + shown if name in found else shown
        return found

    def _spectra(self) -> Iterator[ComplexArray]:
        """Yield the spectrum of every input that a filter sees; others are shown as they are."""
        for k in range(0, len(self._felt), TOGETHER):
            yield from np.fft.rfft(self._values[k : min(k + TOGETHER, len(self._felt))])


def _refuse_undelivered(instrument: Instrument, delivered: tuple[Input, ...]) -> None:
    """Raise where a sensor shows what the model does not give: its channel would be nothing, in silence."""
    for channel in instrument.channels:
        for one in channel.seen:
            if one not in delivered:
                given = ", ".join(f"{kind} {name}" for kind, name in delivered)
                raise ValueError(
                    f"sensor {channel.drawn.sensor}: shows {one.kind} {one.name}, which the model does not give "
                    f"(it gives {given})"
                )
