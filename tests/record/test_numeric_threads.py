"""A record is a function of configuration and index: numeric threads and addresses of arrays change no bit of it."""

from __future__ import annotations

import functools
import gc

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.gearbox.plan import planned_record
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state
from tests.sensing.test_measurement import measured
from tests.simulated import simulate

THREADS = (1, 3)
"""Linear algebra libraries split work by their number; for two most results still agree."""

SHORT = ["duration_s=0.02", "specimens=1"]
CONFIGS = {
    "tests/configs/linear_pits.yaml": [*SHORT, "internals.quantities=[all]"],  # product integration
    "configs/bench.yaml": SHORT,  # tooth pairs across the face, 47 teeth with errors and waves, coupling
}


@pytest.mark.parametrize(
    "name", ["configs/bench.yaml", pytest.param("tests/configs/linear_pits.yaml", marks=pytest.mark.slow)]
)
def test_a_record_has_the_same_bits_for_any_number_of_numeric_threads(name: str) -> None:
    threadpoolctl = pytest.importorskip("threadpoolctl")
    config = load_config(name, CONFIGS[name])
    record_id = config.records_per_specimen - 1
    found = []
    for threads in THREADS:
        _forget()
        with threadpoolctl.threadpool_limits(threads):
            found.append((_motion(config, record_id), _stored(config, record_id)))
    assert all(other == found[0] for other in found[1:])


def test_sums_over_a_record_do_not_depend_on_its_address() -> None:
    samples = 20_001
    values = np.random.default_rng(5).standard_normal(samples)
    labels = set()
    for shift in range(9):
        memory = np.empty(samples + 9)
        shifted = memory[shift : shift + samples]
        shifted[:] = values
        stored = measured(shifted, 1, gain=1.1, limit=3.0, bits=16, noise_floor=0.1)
        labels.add((stored.snr_db, stored.clipped_share, float(np.std(shifted)), float(np.mean(shifted))))
    assert len(labels) == 1


def _forget() -> None:
    """Forget what functions keep, so that every count of threads computes everything itself."""
    for kept in gc.get_objects():
        # type(): isinstance asks proxies of other packages for their class, which some warn about
        if type(kept) is functools._lru_cache_wrapper and str(kept.__module__).startswith("siggen"):
            kept.cache_clear()


def _motion(config, record_id: int) -> dict[str, bytes]:
    """Return the clean response in double precision, which the float32 of a stored signal may hide a difference of."""
    specimen, planned = config.gearbox(0), planned_record(config, record_id)
    response, _ = record_response(specimen, specimen_state(specimen, planned.state_id), planned)
    return {name: values.tobytes() for name, values in response.acceleration_m_s2.items()}


def _stored(config, record_id: int) -> tuple[dict[str, bytes], str]:
    (record,) = simulate(config, [record_id])
    assert isinstance(record, SimulatedRecord)
    series = {**record.channels, **(record.internals or {})}
    return {name: values.tobytes() for name, values in series.items()}, repr(sorted(record.labels.items()))
