"""Outlook: continuations of a life follow the law that the life itself followed."""

from __future__ import annotations

from bisect import bisect_right

import numpy as np
import pytest
from scipy.stats import kstest, weibull_min

from siggen.life.growth import STEP
from siggen.life.outline import sizes_m, through
from siggen.life.outlook import Chances, Now, failing_times, through_share
from siggen.life.pitting import PittingCourse
from tests.life.wearing import course

RNG = 20261127
TEETH = 56


def now(share: list[float], hazard: float, time: float = 3.3e6) -> Now:
    """Return a gearbox of pits on teeth of their own, whose new pits come at a rate."""
    count, own = len(share), np.array(share)
    return Now(
        time, own, np.full(count, 0.62e-6), np.zeros(count), np.arange(count), np.ones(count),
        np.full(TEETH, hazard), np.ones(TEETH), np.full(TEETH, 0.5), np.ones((TEETH, 1)),
    )  # fmt: skip


def test_without_scatter_a_small_pit_fails_when_its_exponential_does() -> None:
    law = Chances(2.5, 0.0, 0.62e-6, 0.0, 0.0, 1e-7)
    ends = failing_times(now([1e-9], 1e-40), law, 3, np.random.default_rng(RNG))
    np.testing.assert_allclose(ends, 3.3e6 + np.log(100.0) / 0.62e-6, rtol=1e-12)


def test_where_the_first_pit_is_the_end_lives_are_weibull() -> None:
    law = Chances(2.5, 0.0, 1e-2, 0.0, 0.0, 0.51)  # from 50 to 51 % of a flank within some 3 turns
    ends = failing_times(now([], 6.9e6**-2.5 / TEETH, 0.0), law, 2000, np.random.default_rng(RNG))
    # of right draws one test in a thousand fails; the seed is fixed
    assert kstest(ends, weibull_min(2.5, scale=6.9e6).cdf).pvalue > 1e-3


@pytest.mark.parametrize("unit", range(6))
def test_a_pit_leaves_no_land_from_the_very_share_that_an_outlook_takes(unit: int) -> None:
    one = course(unit)
    flank = one.wearing.flanks[0]
    for pit in one.pits[:5]:
        share = through_share(pit.shape, flank.area_m2)
        # 1e-6: twenty times what the end of an outline is off in area where it takes that of the face
        for factor, expected in ((1.0 - 1e-6, False), (1.0 + 1e-6, True)):
            size = sizes_m([pit.shape], [factor * share * flank.area_m2], flank.face_m)[0]
            assert through([pit.shape.edges(size)], [pit.shape.arc_m], flank.face_m) is expected


def test_a_life_ends_anywhere_among_its_continuations_from_its_first_pit_and_from_a_large_one() -> None:
    young, old = [], []
    for unit in range(60):
        one = course(unit)
        young.append(rank(one, one.ends.first_pit))
        times = np.arange(one.ends.first_pit, one.ends.functional, 0.2 * STEP)
        # the first time at which a pit is large: it knows nothing of what comes later
        large = bisect_right(times, 0.15, key=lambda time: one.shares(time).max())
        old += [rank(one, times[large])] if large < times.size else []
    # of right draws one test in a thousand fails; the seeds are fixed
    assert kstest(young, "uniform").pvalue > 1e-3
    assert kstest(old, "uniform").pvalue > 1e-3


def rank(one: PittingCourse, time: float) -> float:
    """Return which share of continuations from a damage time end before the life itself does."""
    return float((one.outlook(time, 60) < one.ends.functional).mean())
