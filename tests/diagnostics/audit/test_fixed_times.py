"""What stands at one phase, place or lag in damaged records is told by one column; what comes by chance by none."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from diagnostics.audit.fixed_times import (
    component_columns,
    echo_codes,
    echo_columns,
    locked_columns,
    parity_bits,
    parity_product,
    phase_codes,
    phase_product,
)

FS_HZ, SAMPLES, RECORDS, STEP = 12800.0, 12_800, 40, 2.0**-7
DAMAGED = np.arange(RECORDS) % 2 == 1
TIME_S = np.arange(SAMPLES) / FS_HZ
BY_CHANCE = 0.80
"""AUC of one column of 40 records that 18 columns exceed in 1 of 100 sets: 0.5 + 3.3 times its scatter of 0.092."""

Records = list[np.ndarray]


def drawn(seed: int) -> Records:
    """Return coloured noise and a hum of any phase, as records have it, in codes."""
    found = []
    for record in range(RECORDS):
        rng = np.random.default_rng([seed, record])
        noise = np.convolve(rng.normal(0.0, 3.0, SAMPLES), [0.5, 1.0, 0.5], "same")
        found.append(coded(noise + 0.4 * np.sin(2 * np.pi * (50.0 * TIME_S + rng.uniform()))))
    return found


def coded(signal: np.ndarray) -> np.ndarray:
    return np.round(signal / STEP) * STEP


def auc(columns: dict[str, np.ndarray]) -> tuple[float, str]:
    """Return how well the best column tells damaged records, and which it is."""
    told = {}
    for name, values in columns.items():
        wins = 0.5 + 0.5 * np.sign(values[DAMAGED][:, None] - values[~DAMAGED]).mean()
        told[name] = max(wins, 1.0 - wins)
    best = max(told, key=lambda name: told[name])
    return told[best], best


def locked(records: Records) -> dict[str, np.ndarray]:
    return locked_columns([{"a": phase_codes(x)} for x in records])


def alike(records: Records) -> dict[str, np.ndarray]:
    return component_columns({"phases": phase_product([phase_codes(x) for x in records])})


def low_bits(records: Records) -> dict[str, np.ndarray]:
    return component_columns({"low bits": parity_product([parity_bits(x.astype(np.float32)) for x in records])})


def echoed(records: Records) -> dict[str, np.ndarray]:
    return echo_columns([{"a": echo_codes(x, FS_HZ, (34.0, 13.0))} for x in records], FS_HZ)


def mains(signal: np.ndarray, seed: int) -> np.ndarray:
    """A trigger that waits for the mains, to within 15 degrees."""
    late = 0.04 * np.random.default_rng(seed).normal()
    return signal + 2.0 * np.sin(2 * np.pi * (50.0 * TIME_S + late))


def waveform(signal: np.ndarray, seed: int) -> np.ndarray:
    """Noise of one seed, 20 dB below the record."""
    del seed
    return signal + 0.1 * signal.std() * np.random.default_rng(99).normal(size=SAMPLES)


def marked(signal: np.ndarray, seed: int) -> np.ndarray:
    del seed
    codes, rng = np.round(signal / STEP), np.random.default_rng(98)
    places = rng.choice(SAMPLES, SAMPLES // 12, replace=False)
    codes[places] = 2 * (codes[places] // 2) + rng.integers(2, size=places.size)
    return codes * STEP


def late(signal: np.ndarray, seed: int) -> np.ndarray:
    del seed
    return signal + 0.12 * np.concatenate([np.zeros(900), signal[:-900]])


@pytest.mark.parametrize(
    ("change", "columns", "basis"),
    [
        (mains, locked, "phase of a at 0.003"),
        (waveform, alike, "component 1 of phases"),
        (marked, low_bits, "component 1 of low bits"),
        (late, echoed, "echo of a after 70.31 ms"),
    ],
)
def test_one_column_tells_what_is_alike_in_damaged_records(
    change: Callable[[np.ndarray, int], np.ndarray],
    columns: Callable[[Records], dict[str, np.ndarray]],
    basis: str,
) -> None:
    clean = drawn(1)
    changed = [coded(change(x, k)) if DAMAGED[k] else x for k, x in enumerate(clean)]
    found, best = auc(columns(changed))
    assert best.startswith(basis)
    assert found > 0.9
    assert auc(columns(clean))[0] < BY_CHANCE


def test_periods_of_the_shafts_and_the_ringing_of_housings_are_no_echo() -> None:
    turn = round(FS_HZ / 34.0)
    codes = echo_codes(drawn(2)[0], FS_HZ, (34.0, 13.0))
    first = int(0.02 * FS_HZ)
    assert codes.size == SAMPLES // 2 - first
    assert not codes[[turn - first, 3 * turn - first]].any()
    assert np.count_nonzero(codes) > codes.size // 2


def test_records_too_short_for_a_spectrum_give_no_columns() -> None:
    short = [x[:6] for x in drawn(3)]
    assert [locked(short), low_bits(short), echoed(short)] == [{}, {}, {}]
