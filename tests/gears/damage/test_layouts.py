"""Positions of layers and clusters: order, nesting, limits, distribution."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.gears.damage.layouts import clustered_centres, layered_centres


def test_layers_go_upwards_and_centre_outwards():
    height, face = layered_centres(2, 5, 1e-3, 0.4e-3, 1.9e-3, 10e-3)
    assert height * 1e3 == pytest.approx([1.9] * 5 + [2.3] * 5)
    assert face * 1e3 == pytest.approx([10, 11, 9, 12, 8] * 2)
    assert layered_centres(1, 4, 1e-3, 0.4e-3, 1.9e-3, 10e-3, between=True)[1] * 1e3 == pytest.approx(
        [10.5, 9.5, 11.5, 8.5]
    )


@given(st.integers(1, 5), st.integers(1, 12), st.integers(0, 3), st.integers(0, 5), st.booleans())
def test_fewer_pits_and_layers_are_a_subset_of_more(layers, per_layer, more_layers, more_pits, between):
    def places(n_layers, n_pits):
        centres = layered_centres(n_layers, n_pits, 0.7e-3, 0.3e-3, 1.5e-3, 9e-3, between=between)
        return list(zip(*(c.tolist() for c in centres), strict=True))

    few, many = places(layers, per_layer), places(layers + more_layers, per_layer + more_pits)
    assert len(set(few)) == layers * per_layer
    assert set(few) <= set(many)
    assert places(layers, per_layer) == places(layers + more_layers, per_layer)[: len(few)]


@given(st.integers(1, 30), st.integers(0, 30))
def test_a_smaller_cluster_is_the_beginning_of_a_larger_one(count, more):
    def cluster(n):
        rng = np.random.default_rng(7)
        return clustered_centres(rng, n, 2e-3, 0.5e-3, 0.0, 20e-3, height_low_m=1e-3, height_high_m=4e-3)

    for small, large in zip(cluster(count), cluster(count + more), strict=True):
        assert np.array_equal(small, large[:count])


def test_clusters_keep_their_limits_and_have_the_cut_normal_and_uniform_distributions():
    rng = np.random.default_rng(11)
    height, face = clustered_centres(rng, 20000, 2e-3, 0.5e-3, 3e-3, 9e-3, height_low_m=1.5e-3, height_high_m=4e-3)
    assert height.min() >= 1.5e-3
    assert height.max() <= 4e-3
    from scipy.stats import kstest, truncnorm, uniform

    # Kolmogorov-Smirnov at a fixed seed: a wrong distribution would give p below 1e-10.
    assert kstest(height, truncnorm(-1.0, 4.0, 2e-3, 0.5e-3).cdf).pvalue > 0.01
    assert kstest(face, uniform(3e-3, 6e-3).cdf).pvalue > 0.01


def test_a_cluster_far_from_its_limits_stays_inside_them():
    height, face = clustered_centres(np.random.default_rng(1), 50, 9e-3, 0.1e-3, 0.0, 1e-3, height_high_m=5e-3)
    assert np.all(height <= 5e-3)
    assert np.all((face >= 0.0) & (face <= 1e-3))


def test_layouts_without_pits_or_room_are_refused():
    rng = np.random.default_rng(0)
    with pytest.raises(ValueError, match="at least 1"):
        layered_centres(0, 3, 1e-3, 1e-3, 1e-3, 1e-3)
    with pytest.raises(ValueError, match="at least 1"):
        clustered_centres(rng, 0, 1e-3, 1e-3, 0.0, 1e-3)
    with pytest.raises(ValueError, match="low at most high"):
        clustered_centres(rng, 1, 1e-3, 1e-3, 2e-3, 1e-3)
    with pytest.raises(ValueError, match="spread"):
        clustered_centres(rng, 1, 1e-3, -1e-3, 0.0, 1e-3)
