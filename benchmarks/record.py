"""Where the time of a record of the quickstart goes, and that it does not depend on how many came before."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from statistics import median
from typing import TypeVar

from benchmarks.row import Row, cost_row
from benchmarks.shipped import PAPER_A, QUICKSTART, shipped
from siggen.checks.loading import load_config
from siggen.columns.record import Record
from siggen.config import Config, read_yaml
from siggen.dataset.chunk import Chunk, ChunkSimulation
from siggen.planning.plan import planned_record, record_ids_of
from siggen.planning.specimen import draw_operating_point, draw_specimen
from siggen.record.channels import measured_channels
from siggen.record.simulation import record_response, simulate_specimen
from siggen.record.specimen_state import specimen_state
from siggen.specimen.made_gears import MadeGears

SERIES_RECORDS = 64

T = TypeVar("T")


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield CPU times per record: as a whole beside real time, in parts, and early beside late."""
    config = shipped(QUICKSTART)
    _stages(config, 0)  # compiles
    specimens = range(1, 3 if quick else 9)
    stages = [_stages(config, specimen) for specimen in specimens]
    cost = {name: median(stage[name] for stage in stages) for name in stages[0]}
    yield cost_row("a record of the quickstart, CPU", cost["record"], "real time of the signal", config.duration_s)
    for name in list(cost)[1:]:
        yield cost_row(f"of it: {name}", cost[name], "whole record", cost["record"])
    yield _series_row(repeats=1 if quick else 3)


def _stages(config: Config, specimen_id: int) -> dict[str, float]:
    """Return the CPU time per record [s] of one specimen, as a whole and of each stage by itself."""
    ids = record_ids_of(config, specimen_id)
    chunk = Chunk("train-00000", ids)
    planned = [planned_record(config, i) for i in ids]
    specimen = draw_specimen(config, specimen_id)
    points = {p.operating_point_id for p in planned}
    whole, _ = _timed(lambda: ChunkSimulation(config, simulate_specimen)(chunk))
    draw, _ = _timed(
        lambda: (draw_specimen(config, specimen_id), [draw_operating_point(config, specimen_id, p) for p in points])
    )
    _forget_teeth()
    made = MadeGears(config, specimen)
    tables, states = _timed(lambda: [specimen_state(config, specimen, i, made) for i in range(len(config.states))])
    response, responses = _timed(lambda: [record_response(config, specimen, states[p.state_id], p)[0] for p in planned])
    sensing, _ = _timed(
        lambda: [measured_channels(config, specimen, p, r) for p, r in zip(planned, responses, strict=True)]
    )
    ready = [result for result in simulate_specimen(config, ids) if isinstance(result, Record)]
    arrow, _ = _timed(lambda: ChunkSimulation(config, lambda _config, _ids: ready)(chunk))
    costs = {
        "record": whole,
        "drawing": draw,
        "damage, its labels and stiffness tables": tables,
        "response": response,
        "sensing": sensing,
        "checks and Arrow": arrow,
    }
    return {name: cost / len(ids) for name, cost in costs.items()}


def _forget_teeth() -> None:
    """Empty the caches of teeth and damage, which the whole record has filled."""
    for name, module in list(sys.modules.items()):
        if name.startswith(("siggen.gears", "siggen.specimen")):
            for value in list(vars(module).values()):
                if callable(forget := getattr(value, "cache_clear", None)):
                    forget()


def _timed(function: Callable[[], T]) -> tuple[float, T]:
    start = time.process_time()
    result = function()
    return time.process_time() - start, result


def _series_row(repeats: int) -> Row:
    """Return the row of the last eight of a series of records beside the first eight.

    All gearboxes of the series have the supports, damping, speed and torque of paper A, so that they take equally many
    steps; pits, start angles and noise still differ.
    """
    raw, constant = dict(read_yaml(QUICKSTART)), read_yaml(PAPER_A)
    raw["dynamics"], point = constant["dynamics"], constant["operating_points"][0]
    raw["operating_points"] = [point, {**point, "torque_nm": 40.0}]
    config = load_config(raw, [f"specimens={SERIES_RECORDS // 8}"])
    first, last = [], []
    for _ in range(repeats):
        costs = [
            _timed(partial(simulate_specimen, config, record_ids_of(config, s)))[0] for s in range(config.specimens)
        ]
        first.append(costs[0] / 8)
        last.append(costs[-1] / 8)
    what = f"records {SERIES_RECORDS - 7} to {SERIES_RECORDS} of a series, per record"
    return cost_row(what, median(last), "records 1 to 8 of it", median(first))
