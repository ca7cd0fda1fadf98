"""Gaps of a bad contact: as long as said together, none over another, anywhere in the record."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.sensing.dropout import dropout_gaps, silence


@pytest.mark.parametrize("share", [0.0, 1e-3, 0.3, 0.99])
def test_gaps_lose_the_share_once_and_nothing_else(share: float) -> None:
    for seed in range(50):
        gaps = dropout_gaps(10_000, 5000.0, share, np.random.default_rng(seed))
        lost = np.zeros(10_000, dtype=int)
        for start, stop in gaps:
            assert 0 < stop - start <= 250
            lost[start:stop] += 1
        assert lost.sum() == round(share * 10_000)
        assert lost.max(initial=0) <= 1


def test_every_place_is_lost_as_often() -> None:
    lost = np.ones(2000)
    for seed in range(400):
        whole = np.ones(2000)
        silence(whole, 0, dropout_gaps(2000, 1000.0, 0.1, np.random.default_rng(seed)))
        lost += (1.0 - whole) / 400
    tenths = (lost - 1.0).reshape(10, -1).mean(axis=1)
    # a tenth of 200 samples holds about one gap: 0.1 within 5 standard errors of 0.01; the ends a little less
    assert np.abs(tenths - 0.1).max() < 0.05


def test_blocks_lose_what_the_whole_loses() -> None:
    gaps = dropout_gaps(1000, 1000.0, 0.4, np.random.default_rng(1))
    whole, blocks = np.ones(1000), np.ones(1000)
    silence(whole, 0, gaps)
    for first in range(0, 1000, 64):
        silence(blocks[first : first + 64], first, gaps)
    np.testing.assert_array_equal(whole, blocks)
