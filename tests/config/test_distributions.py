"""Distributions: inverse cumulative functions within their bounds, rising with the uniform they are fed."""

from __future__ import annotations

import math
from statistics import NormalDist

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.keys.distributions import Choice, LogUniform, Normal, Uniform
from siggen.keys.number import bounds

SHARES = st.floats(0.0, 1.0, exclude_max=True)
SMALL = st.floats(-1e6, 1e6)
SPAN = st.floats(1e-3, 1e6)


@st.composite
def distributions(draw):
    low, span = draw(SMALL), draw(SPAN)
    kind = draw(st.sampled_from(["uniform", "loguniform", "normal"]))
    if kind == "uniform":
        return Uniform(low=low, high=low + span)
    if kind == "loguniform":
        return LogUniform(low=abs(low) + 1e-3, high=abs(low) + 1e-3 + span)
    # the mean up to half a span outside and a standard deviation of a span leave well over 1 % between the bounds
    mean = low + draw(st.floats(-0.5, 1.5)) * span
    return Normal(mean=mean, std=span * draw(st.floats(0.5, 5.0)), low=low, high=low + span)


@given(distributions(), SHARES)
def test_values_stay_within_bounds(distribution, u):
    low, high = distribution.bounds()
    assert low <= distribution.at(u) <= high


def test_loguniform_has_the_geometric_mean_at_half():
    # logarithm and exponential each round by 1e-16
    assert LogUniform(low=0.02, high=0.5).at(0.5) == pytest.approx(math.sqrt(0.02 * 0.5), rel=1e-14)


def test_normal_cut_far_out_is_the_normal():
    normal = Normal(mean=1.0, std=0.02, low=0.0, high=2.0)  # cut 50 standard deviations out
    for u in (0.001, 0.1, 0.5, 0.9, 0.999):
        # the cumulative function rounds by 1e-16, which the slope at 3 standard deviations makes 1e-13 of one
        assert normal.at(u) == pytest.approx(NormalDist(1.0, 0.02).inv_cdf(u), abs=1e-12)


def test_cut_normal_has_the_density_of_the_normal_between_its_bounds():
    normal = Normal(mean=0.4, std=0.1, low=0.2, high=0.5)
    values = np.array([normal.at(u) for u in (np.arange(20_000) + 0.5) / 20_000])
    full = NormalDist(0.4, 0.1)
    share = (full.cdf(0.4) - full.cdf(0.2)) / (full.cdf(0.5) - full.cdf(0.2))
    # evenly spread shares are at most one in 20 000 off
    assert np.mean(values < 0.4) == pytest.approx(share, abs=1e-4)


@given(st.lists(SMALL, min_size=1, max_size=8), SHARES)
def test_choice_takes_one_of_its_values(values, u):
    choice = Choice(values=tuple(values))
    assert choice.at(u) in values
    assert bounds(choice) == (min(values), max(values))
