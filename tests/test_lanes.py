"""Lanes have the bytes of the scalars that they stand for, whatever stands in them."""

from __future__ import annotations

from math import log, sqrt, tanh

import numpy as np
import pytest
from numba.core.errors import TypingError

from siggen.compiled import entry, njit
from siggen.lanes import (
    LANES,
    aligned,
    any_of,
    as_doubles,
    bits,
    extract,
    gather,
    gather_pairs,
    hyperbolic_tangent,
    insert,
    larger,
    load,
    load_like,
    logarithm,
    magnitude,
    scalar_at,
    select,
    shuffle,
    smaller,
    splat,
    splat_of,
    square_root,
    store,
    truncated,
)  # fmt: skip

_turned = shuffle(1, 0, 3, 2, 5, 4, 7, 6)
_wide = splat_of(2 * LANES)
ODD = (0.0, -0.0, np.nan, np.inf, -np.inf, 5e-324, -5e-324, 1e308, -1e308)
RESULTS = 13


@entry(_nrt=False, error_model="numpy")
def _in_lanes(a, b, table, results):
    for first in range(0, a.size, LANES):
        x, y = load(a, first), load(b, first)
        store(results, first, x + y)
        store(results, a.size + first, x - y * 3.0)
        store(results, 2 * a.size + first, x / y)
        store(results, 3 * a.size + first, square_root(x))
        store(results, 4 * a.size + first, smaller(x, y))
        store(results, 5 * a.size + first, larger(0.5, y))
        store(results, 6 * a.size + first, select((x < y) | (y >= 2.0), x, -1.0))
        store(results, 7 * a.size + first, select((x == y) & (x != 0.0), magnitude(x), y))
        store(results, 8 * a.size + first, _turned(x))
        place = smaller(larger(truncated(larger(smaller(x, 50.0), 0.0)), 1), 40) + 2
        low, high = gather_pairs(table, place)
        store(results, 9 * a.size + first, low + gather(table, place + 3))
        store(results, 10 * a.size + first, high + as_doubles(place))
        store(results, 11 * a.size + first, insert(x * extract(y, 2), 5, scalar_at(a, first)))
        store(results, 12 * a.size + first, splat(0.0) + float(bits(x > y)))


@entry(_nrt=False, error_model="numpy")
def _one_by_one(a, b, table, results):
    n = a.size
    for i in range(n):
        x, y, first = a[i], b[i], i - i % LANES
        results[i], results[n + i], results[2 * n + i] = x + y, x - y * 3.0, x / y
        results[3 * n + i] = sqrt(x)
        results[4 * n + i], results[5 * n + i] = min(x, y), max(0.5, y)
        results[6 * n + i] = x if x < y or y >= 2.0 else -1.0
        results[7 * n + i] = abs(x) if x == y and x != 0.0 else y
        results[8 * n + i] = a[i + 1 if i % 2 == 0 else i - 1]
        place = min(max(int(max(min(x, 50.0), 0.0)), 1), 40) + 2
        results[9 * n + i] = table[place] + table[place + 3]
        results[10 * n + i] = table[place + 1] + place
        results[11 * n + i] = a[first] if i % LANES == 5 else x * b[first + 2]
        chosen = 0
        for lane in range(LANES):
            chosen += 2**lane if a[first + lane] > b[first + lane] else 0
        results[12 * n + i] = chosen


@njit(_nrt=False, error_model="numpy", forceinline=True)
def _law(x, y, table):
    """Return what comes of two values, which are numbers or lanes of them."""
    place = smaller(larger(truncated(larger(smaller(x, 50.0), 0.0)), 1), 40) + 2
    low, high = gather_pairs(table, place)
    found = low - gather(table, place + 3) * as_doubles(place)
    found = found + logarithm(larger(x, 1e-300), x > 0.0) * hyperbolic_tangent(y, (y < 3.0) & (x == x))
    if any_of(magnitude(x) < 2.0):
        found = select(magnitude(x) < 2.0, square_root(magnitude(y)) + high, found)
    return found, select(x != y, 1.0, 0.0)


@entry(_nrt=False, error_model="numpy")
def _law_in_lanes(a, b, table, results):
    for first in range(0, a.size, LANES):
        found, apart = _law(load(a, first), load(b, first), table)
        store(results, first, found)
        store(results, a.size + first, apart)


@entry(_nrt=False, error_model="numpy")
def _law_of_scalars(a, b, table, results):
    for i in range(a.size):
        results[i], results[a.size + i] = _law(a[i], b[i], table)


@entry(_nrt=False, error_model="numpy")
def _law_by_hand(a, b, table, results):
    for i in range(a.size):
        x, y = a[i], b[i]
        place = min(max(int(max(min(x, 50.0), 0.0)), 1), 40) + 2
        found = table[place] - table[place + 3] * place
        turned = tanh(y) if y < 3.0 and x == x else 0.0
        found += (log(max(x, 1e-300)) if x > 0.0 else 0.0) * turned
        results[i] = sqrt(abs(y)) + table[place + 1] if abs(x) < 2.0 else found
        results[a.size + i] = 1.0 if x != y else 0.0


@entry(_nrt=False, error_model="numpy")
def _weighted(table, weights, results):
    """Write weighted sums of the rows of a table over its 16 columns, in two registers."""
    total = _wide(0.0)
    for row in range(weights.size):
        total = total + load_like(table, row * 2 * LANES, total) * scalar_at(weights, row)
    store(results, 0, total)


def _pair(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return numbers of all sizes, among them some that are none, the same at some places."""
    rng = np.random.default_rng(seed)
    a, b = (rng.normal(size=512) * 10.0 ** rng.integers(-12, 12, 512) for _ in range(2))
    for values in (a, b):
        values[rng.integers(0, 512, 90)] = rng.choice(ODD, 90)
    b[::7] = a[::7]
    return a, b


@pytest.mark.parametrize("seed", range(4))
def test_every_operation_has_the_bytes_of_scalars(seed: int) -> None:
    a, b = _pair(seed)
    table = np.random.default_rng(seed).normal(size=64)
    found, expected = np.zeros((2, RESULTS, a.size))
    with np.errstate(all="ignore"):
        _in_lanes(a, b, table, found.reshape(-1))
        _one_by_one(a, b, table, expected.reshape(-1))
    for row in range(RESULTS):
        # What is no number has a sign and a payload without meaning: which operand's it takes is the machine's choice.
        nan = np.isnan(expected[row])
        assert np.array_equal(nan, np.isnan(found[row])), row
        assert found[row][~nan].tobytes() == expected[row][~nan].tobytes(), row


def test_a_law_for_one_value_has_the_bytes_of_lanes() -> None:
    a, b = (np.where(np.isfinite(values), values, 1.0) for values in _pair(5))
    a[: a.size // 4] = 3.0 + np.abs(a[: a.size // 4])  # where no lane takes the branch
    table = np.random.default_rng(6).normal(size=64)
    lanes, scalars, expected = np.zeros((3, 2, a.size))
    _law_in_lanes(a, b, table, lanes.reshape(-1))
    _law_of_scalars(a, b, table, scalars.reshape(-1))
    _law_by_hand(a, b, table, expected.reshape(-1))
    assert lanes.tobytes() == expected.tobytes()
    assert scalars.tobytes() == expected.tobytes()
    assert 50 < (np.abs(a) < 2.0).reshape(-1, LANES).any(axis=1).sum() * LANES < a.size


def test_sums_over_rows_are_those_of_the_written_order() -> None:
    rng = np.random.default_rng(1)
    table, weights, found = aligned(rng.normal(size=(37, 2 * LANES))), rng.normal(size=37), np.zeros(2 * LANES)
    _weighted(table, weights, found)
    expected = np.zeros(2 * LANES)
    for row, weight in zip(table, weights, strict=True):
        expected = expected + row * weight  # a product rounded before it is added, nothing contracted
    assert found.tobytes() == expected.tobytes()
    assert table.ctypes.data % (8 * LANES) == 0


@entry()
def _first(values: np.ndarray) -> float:
    return extract(load(values, 0), 0)


@pytest.mark.parametrize("values", [np.zeros(16, np.float32), np.zeros(16, np.int64), np.zeros((16, 2))[:, 0]])
def test_arrays_of_other_numbers_or_with_gaps_are_refused(values: np.ndarray) -> None:
    with pytest.raises(TypingError):
        _first(values)
