"""What all channels see of the background of one record, by itself."""

from __future__ import annotations

from collections.abc import Iterator

from siggen.config import Config
from siggen.dynamics.time.response_stream import Piece
from siggen.planning.plan import PlannedRecord
from siggen.planning.specimen import Specimen
from siggen.record.block_inputs import BlockInputs
from siggen.sensing.inputs import FORCE, MOTION, SHAFT
from siggen.specimen.instrument import Instrument


class _Standstill:
    """A response without samples, of all that the channels of an instrument show."""

    before = 0

    def __init__(self, instrument: Instrument) -> None:
        shown = {one for channel in instrument.channels for one in channel.seen}
        self.motions, self.places, self.readings = (
            tuple(sorted(one.name for one in shown if one.kind == kind)) for kind in (MOTION, FORCE, SHAFT)
        )

    def pieces(self) -> Iterator[Piece]:
        return iter(())


def layers(config: Config, specimen: Specimen, record: PlannedRecord, instrument: Instrument) -> None:
    """Compute the background; motions and forces are transformed too, a quarter of all transforms."""
    for _ in BlockInputs(config, specimen, record, _Standstill(instrument), instrument).seen():
        pass
