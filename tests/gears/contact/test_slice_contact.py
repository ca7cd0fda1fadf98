from __future__ import annotations

from math import atan, cos, hypot, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.gears.contact.slice_contact import (
    SliceSprings,
    grouped_sinks,
    sink_depths,
    slice_force,
    slice_springs,
)
from tests.gears.builders import pair_18_47

RADIUS = 6.68e-3
SINKS = st.lists(st.floats(0.0, 1e-4), min_size=1, max_size=12)
SHARES = st.floats(0.0, 1.0)


def springs(sinks: list[float], shares: list[float]) -> SliceSprings:
    return slice_springs(np.array(shares), np.array(sinks), 3.5e9, 1.0 / 2e8)


@pytest.mark.parametrize(("length_mm", "sink_um"), [(0.5, 4.7), (0.8, 12), (1.0, 19), (1.5, 42), (2.0, 75), (3.0, 168)])
def test_the_deepest_sink_into_a_pit(length_mm: float, sink_um: float) -> None:
    sink = sink_depths(np.array(0.5e-3 * length_mm), np.array(1.0), np.array(RADIUS), 0.0)
    assert sink == pytest.approx((length_mm * 1e-3) ** 2 / (8.0 * RADIUS), rel=1e-12)
    # Published to two or three digits.
    assert sink * 1e6 == pytest.approx(sink_um, rel=0.02)


def test_the_sink_is_limited_by_the_floor_and_leaves_the_outline_smoothly() -> None:
    edge = np.linspace(0.0, 0.75e-3, 1001)
    sink = sink_depths(edge, np.array(10e-6), np.array(RADIUS), 0.0)
    assert sink[0] == 0.0
    assert sink[1] < 1e-4 * 10e-6
    assert sink.max() == 10e-6
    assert (np.diff(sink) >= 0.0).all()


def test_a_rounded_edge_carries_earlier_than_a_sharp_one() -> None:
    # Derived: flank x²/(2 R_e) over an edge (x - r)²/(2 R_r) that falls away inside the pit, least gap over x.
    distance, rounding = 0.5e-3, 0.2e-3
    x = np.linspace(0.0, distance, 200_001)
    least = np.min(x**2 / (2.0 * RADIUS) + (distance - x) ** 2 / (2.0 * rounding))
    assert sink_depths(np.array(distance), np.array(1.0), np.array(RADIUS), rounding) == pytest.approx(least, rel=1e-8)


@pytest.mark.parametrize("length", [0.8e-3, 1.5e-3])
@pytest.mark.parametrize("share", [-0.8, -0.4, 0.0, 0.4, 0.8])
def test_the_sink_against_exact_involutes(length: float, share: float) -> None:
    pair = pair_18_47(module_m=3e-3)
    base_1, base_2, line = pair.pinion.base_radius_m, pair.gear.base_radius_m, pair.line_of_action_m
    centre = 0.5 * pair.pitch_point_m**2 / base_1
    contact = sqrt(2.0 * (centre + share * 0.5 * length) * base_1)
    roll_1, roll_2 = contact / base_1, (line - contact) / base_2
    gaps = []
    for sign in (-1.0, 1.0):
        # Edge of the pit on the pinion's involute, its angle and radius seen from the gear's centre.
        roll = sqrt(2.0 * (centre + sign * 0.5 * length) / base_1)
        angle = pi - roll_1 + roll
        x = base_1 * (cos(angle) + roll * sin(angle)) + base_1 + base_2
        y = base_1 * (sin(angle) - roll * cos(angle)) - line
        mate = sqrt((hypot(x, y) / base_2) ** 2 - 1.0)
        gaps.append(base_2 * ((mate - roll_2 - atan(mate)) - np.arctan2(y, x)))
    edge = 0.5 * length * (1.0 - abs(share))
    radius = contact * (line - contact) / line
    # Published: 5 % over a pit of 1.5 mm, from the change of the radius along the pit.
    assert sink_depths(np.array(edge), np.array(1.0), np.array(radius), 0.0) == pytest.approx(min(gaps), rel=0.05)


@settings(deadline=None)
@given(sinks=SINKS, share=SHARES, depth=st.floats(-1e-5, 2e-4), data=st.data())
def test_the_force_against_bisection(sinks: list[float], share: float, depth: float, data: st.DataObject) -> None:
    shares = [data.draw(SHARES) for _ in sinks]
    system = springs(sinks, shares)
    low, high = 0.0, 2e8 * max(depth, 0.0) + 1.0
    for _ in range(200):
        middle = 0.5 * (low + high)
        carried = np.sum(
            system.stiffness_n_per_m * np.maximum(depth - system.compliance_m_per_n * middle - system.gap_m, 0.0)
        )
        low, high = (middle, high) if carried > middle else (low, middle)
    force = slice_force(system, depth)
    # 40 kN at the most, and K C up to 17 times the rounding of the sums.
    assert force == pytest.approx(low, rel=1e-10, abs=1e-7)
    parts = system.stiffness_n_per_m * np.maximum(depth - system.compliance_m_per_n * force - system.gap_m, 0.0)
    assert parts.sum() == pytest.approx(force, rel=1e-10, abs=1e-7)
    assert (parts >= 0.0).all()


@settings(deadline=None)
@given(sinks=SINKS, depth=st.floats(0.0, 2e-4), step=st.floats(1e-7, 1e-5), data=st.data())
def test_the_force_grows_with_the_approach_never_faster_than_the_whole_face(
    sinks: list[float], depth: float, step: float, data: st.DataObject
) -> None:
    system = springs(sinks, [data.draw(SHARES) for _ in sinks])
    stiffness = 1.0 / (1.0 / 3.5e9 + 1.0 / 2e8)
    rise = slice_force(system, depth + step) - slice_force(system, depth)
    # Rounding of forces of up to 4e4 N.
    assert -1e-7 <= rise <= stiffness * step + 1e-7
    later = slice_force(system, depth + 2.0 * step) - slice_force(system, depth + step)
    assert later >= rise - 1e-7


def test_without_pits_the_face_is_one_spring() -> None:
    system = springs([0.0] * 20, [0.0] * 20)
    assert system.gap_m.tolist() == [0.0]
    assert system.stiffness_n_per_m.tolist() == [3.5e9]


def test_lands_beside_a_deep_pit_carry_without_delay() -> None:
    half = springs([1e-4] * 10 + [0.0] * 10, [1.0] * 10 + [0.0] * 10)
    softer = 1.0 / (1.0 / 1.75e9 + 1.0 / 2e8)
    assert slice_force(half, 1e-6) == pytest.approx(softer * 1e-6, rel=1e-12)


def test_a_pit_through_the_face_delays_the_whole_force() -> None:
    through = springs([12e-6] * 20, [1.0] * 20)
    assert slice_force(through, 12e-6) == 0.0
    whole = 1.0 / (1.0 / 3.5e9 + 1.0 / 2e8)
    assert slice_force(through, 15e-6) == pytest.approx(whole * 3e-6, rel=1e-9)


@settings(deadline=None)
@given(sinks=SINKS, data=st.data())
def test_grouped_sinks_keep_the_mean_and_ascend(sinks: list[float], data: st.DataObject) -> None:
    covered = np.array([[data.draw(SHARES) for _ in sinks]])
    groups = grouped_sinks(covered, np.array([sinks]), 8)[0]
    assert (np.diff(groups) >= 0.0).all()
    if covered.sum() > 1e-6:
        weights = np.diff(np.square(np.linspace(0.0, 1.0, 9)))
        mean = float((covered * sinks).sum() / covered.sum())
        assert (groups * weights).sum() == pytest.approx(mean, rel=1e-9, abs=1e-15)
    else:
        assert groups.max() <= 1e-4 + 1e-15
