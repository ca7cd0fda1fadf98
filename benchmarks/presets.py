"""What a record of every shipped preset costs, split by stage: tables, loop, filters, layers, sensing, writing."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

from benchmarks.layers import layers
from benchmarks.row import Row, duration_text
from benchmarks.shipped import ROOT, shipped
from siggen.columns.record import Record, record_batch, record_schema
from siggen.config import Config
from siggen.dataset.shard import table_draft
from siggen.dataset.storage import LocalFolder
from siggen.dynamics.time.exponential_motion import ExponentialMotion
from siggen.dynamics.time.linear_motion import LinearMotion
from siggen.dynamics.time.pair_motion import PairMotion
from siggen.planning.plan import planned_record, record_ids_of
from siggen.planning.specimen import draw_specimen
from siggen.record.channels import measured_channels
from siggen.record.simulation import record_response, simulate_specimen
from siggen.record.specimen_state import specimen_state
from siggen.specimen.instrument import specimen_instrument
from siggen.specimen.made_gears import MadeGears

PRESETS = ("quickstart", "bench", "industrial", "paper_b", "linear_pits")
GOALS_S = {"quickstart": 0.06, "bench": 0.06, "industrial": 0.045}
STATES = 4
"""Records of a gearbox: one of each of these states, from the first to the last."""

T = TypeVar("T")


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield one row per preset: CPU time per second of signal as a sum, and its parts."""
    for name in PRESETS:
        file = ROOT / "configs" / f"{name}.yaml"
        config = shipped(file)
        _costs(shipped(file, "duration_s=0.05"), 0)  # compiles
        found = [_costs(config, gearbox) for gearbox in range(1, 2 if quick else 4)]
        mean = {stage: sum(cost[stage] for cost in found) / len(found) for stage in found[0]}
        yield _row(name, config, mean)


def _row(name: str, config: Config, cost: Mapping[str, float]) -> Row:
    channels, total = len(config.channels), sum(cost.values())
    goal = GOALS_S.get(name)
    parts = ", ".join(f"{stage} {1e3 * value:.1f}" for stage, value in cost.items())
    return Row(
        f"{name}: a record of {channels} channels, CPU per s of signal",
        duration_text(total),
        f"of it in ms: {parts}",
        goal="" if goal is None else f"<= {duration_text(goal)}",
        met=None if goal is None else total <= goal,
    )


def _costs(config: Config, gearbox: int) -> dict[str, float]:
    """Return the CPU time of every stage per second of signal, over some records of one gearbox."""
    ids = record_ids_of(config, gearbox)
    of_state = len(ids) // len(config.states)
    chosen = sorted({round(k * (len(config.states) - 1) / (STATES - 1)) for k in range(STATES)})
    planned = [planned_record(config, ids[state * of_state]) for state in chosen]
    specimen = draw_specimen(config, gearbox)
    build, instrument = _timed(lambda: specimen_instrument(config, specimen))
    made = MadeGears(config, specimen)
    tables, states = _timed(lambda: {s: specimen_state(config, specimen, s, made) for s in chosen})
    with _loop_time() as loop:
        motion, responses = _timed(
            lambda: [record_response(config, specimen, states[p.state_id], p)[0] for p in planned]
        )
    seen_of_background, _ = _timed(lambda: [layers(config, specimen, p, instrument) for p in planned])
    seen, _ = _timed(
        lambda: [measured_channels(config, specimen, p, r, instrument) for p, r in zip(planned, responses, strict=True)]
    )
    ready = simulate_specimen(config, [p.record_id for p in planned[:1]])
    records = [record for record in ready if isinstance(record, Record)]
    writing, _ = _timed(lambda: _written(config, records))
    per_record = {
        "tables": tables / len(chosen) / of_state,
        "loop": loop[0] / len(planned),
        "inputs and filters": (motion - loop[0]) / len(planned),
        "layers": seen_of_background / len(planned),
        "sensing": (seen - seen_of_background) / len(planned) + build / len(ids),
        "writing": writing / max(len(records), 1),
    }
    return {stage: value / config.duration_s for stage, value in per_record.items()}


@contextmanager
def _loop_time() -> Iterator[list[float]]:
    """Give a list whose only value is the CPU time spent in the time loops of all motions so far."""
    spent = [0.0]
    kinds: Sequence[Any] = (ExponentialMotion, PairMotion, LinearMotion)
    plain = [kind.__dict__["advance"] for kind in kinds]

    def timed(advance: Callable[..., Any]) -> Callable[..., Any]:
        def advanced(*arguments: Any) -> Any:
            begin = time.process_time()
            try:
                return advance(*arguments)
            finally:
                spent[0] += time.process_time() - begin

        return advanced

    for kind, advance in zip(kinds, plain, strict=True):
        kind.advance = timed(advance)
    try:
        yield spent
    finally:
        for kind, advance in zip(kinds, plain, strict=True):
            kind.advance = advance


def _written(config: Config, records: Sequence[Record]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        draft = table_draft(LocalFolder(Path(folder)), "data.parquet", record_schema(config), len(records))
        with draft as data:
            data.add(record_batch(config, records))
            data.finish()


def _timed(function: Callable[[], T]) -> tuple[float, T]:
    begin = time.process_time()
    result = function()
    return time.process_time() - begin, result
