"""What transfer paths, instruments and disturbances cost after the integration, per second of signal and channel."""

from __future__ import annotations

import time
from collections.abc import Iterator
from statistics import median

from benchmarks.row import Row, cost_row
from siggen.checks.loading import load_config
from siggen.planning.plan import planned_record
from siggen.planning.specimen import draw_specimen
from siggen.record.channels import measured_channels
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state
from siggen.specimen.instrument import specimen_instrument

CONFIG = "configs/industrial.yaml"
GOAL_S = 5e-3


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the CPU time of all layers with responses at hand, and of building the responses of a gearbox."""
    config = load_config(CONFIG, ["specimens=1"])
    specimen, record = draw_specimen(config, 0), planned_record(config, 0)
    response, _ = record_response(config, specimen, specimen_state(config, specimen, 0), record)
    rounds = 5 if quick else 25
    build, measure = [], []
    for _ in range(rounds + 1):
        begin = time.process_time()
        instrument = specimen_instrument(config, specimen)
        built = time.process_time()
        measured_channels(config, specimen, record, response, instrument)
        build.append(built - begin)
        measure.append(time.process_time() - built)
    channels = len(config.channels)
    cost = median(measure[1:]) / (channels * config.duration_s)
    what = f"all layers of {channels} channels behind paths, per second and channel, CPU"
    yield cost_row(what, cost, "the signal itself", 1.0, GOAL_S)
    yield cost_row("responses of one channel, once per gearbox", median(build[1:]) / channels, "all layers", cost)
