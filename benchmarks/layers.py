"""What all channels see of the background of one record, by itself."""

from __future__ import annotations

from collections.abc import Iterator

from siggen.config import Config
from siggen.dynamics.time.response_stream import Piece
from siggen.planning.plan import PlannedRecord
from siggen.planning.specimen import Specimen
from siggen.record.block_inputs import BlockInputs
from siggen.specimen.instrument import Instrument


class _Standstill:
    """A response without motions."""

    motions: tuple[str, ...] = ()
    places: tuple[str, ...] = ()
    readings: tuple[str, ...] = ()
    before = 0

    def pieces(self) -> Iterator[Piece]:
        return iter(())


def layers(config: Config, specimen: Specimen, record: PlannedRecord, instrument: Instrument) -> None:
    """Compute the background; motions and forces are transformed too, a quarter of all transforms."""
    for _ in BlockInputs(config, specimen, record, _Standstill(), instrument).seen():
        pass
