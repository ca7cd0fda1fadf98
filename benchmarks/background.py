"""What each layer of the background costs, per second of signal and channel, and building its responses."""

from __future__ import annotations

import time
from collections.abc import Iterator
from statistics import median

import numpy as np

from benchmarks.row import Row, cost_row
from siggen.checks.loading import load_config
from siggen.config import Config
from siggen.planning.plan import PlannedRecord, planned_record
from siggen.planning.specimen import Specimen, draw_specimen
from siggen.record.background import record_background
from siggen.record.background_blocks import BackgroundBlocks
from siggen.sensing.block_filter import AHEAD
from siggen.specimen.instrument import Instrument, specimen_instrument

CONFIG = "configs/bench.yaml"
GOAL_S = 1e-2
LAYERS = ("rubbing", "floor", "shafts", "second_stage", "auxiliary_drive")
GEARBOXES = 5


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the CPU time of all layers together and of each alone on its base; medians over gearboxes."""
    whole = load_config(CONFIG, ["specimens=20"])
    rounds = 3 if quick else 9
    cost, build = _costs(whole, rounds)
    yield cost_row("background, all layers, per second and channel, CPU", cost, "the signal itself", 1.0, GOAL_S)
    for layer in LAYERS:
        others = [f"background.{name}=null" for name in LAYERS if name != layer]
        alone, _ = _costs(load_config(CONFIG, ["specimens=20", *others]), rounds)
        yield cost_row(f"background, {layer} alone", alone, "all layers", cost)
    yield cost_row("responses of one channel, background included, once per gearbox", build, "all layers", cost)


def _costs(config: Config, rounds: int) -> tuple[float, float]:
    """Return the CPU time of a record per second and channel, and of the responses per channel."""
    records, responses = [], []
    channels = len(config.channels)
    for specimen_id in range(GEARBOXES):
        specimen = draw_specimen(config, specimen_id)
        planned = planned_record(config, specimen_id * config.records_per_specimen)
        begin = time.process_time()
        instrument = specimen_instrument(config, specimen)
        responses.append((time.process_time() - begin) / channels)
        for _ in range(rounds):
            begin = time.process_time()
            _make(config, specimen, planned, instrument)
            records.append((time.process_time() - begin) / (channels * config.duration_s))
    return median(records), median(responses)


def _make(config: Config, specimen: Specimen, record: PlannedRecord, instrument: Instrument) -> None:
    """Make what channels see of the background of one record, at once or in blocks, as the configuration says."""
    blocks, background = instrument.blocks, instrument.background
    if blocks is None or background is None:
        record_background(config, specimen, record, instrument)
        return
    grid = blocks.grid
    inputs = BackgroundBlocks(config, specimen, record, background, -grid.back, grid.back + config.samples + AHEAD)
    for first in range(0, config.samples, grid.block):
        count = min(grid.block, config.samples - first)
        taken = inputs.take(count if first else grid.back + count + AHEAD)
        spectra = {one: np.fft.rfft(values, grid.length) for one, values in taken.items()}
        for filters in blocks.filters.values():
            total = np.zeros(grid.length // 2 + 1, complex)
            for one, spectrum in spectra.items():
                if one in filters:
                    total += filters[one] * spectrum
            np.fft.irfft(total, grid.length)
