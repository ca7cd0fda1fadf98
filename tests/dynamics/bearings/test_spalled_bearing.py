"""What a spall takes from the balls of a loaded bearing, against a ball-by-ball computation that shares no code."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from siggen.damage.bearing_spall import RollingSpall, SpalledBearing, cage_course, mean_zone
from siggen.drivetrain.bearings import BallBearing
from siggen.drivetrain.drive import Drive

BALLS, BALL_M, PITCH_M = 9, 7.94e-3, 39.04e-3
TURNS, POINTS = 20, 256_000  # 3200 points from ball to ball where four pass a turn: what folds back falls on lines
ANGLE = 2.0 * math.pi * TURNS * np.arange(POINTS) / POINTS
LOAD = np.array([300.0, -500.0])


def bearing_of(balls: int = BALLS) -> BallBearing:
    return BallBearing(balls, BALL_M, PITCH_M, 0.0, 8e-6)


def spalled(
    element: str, *, slip: float = 0.0, walk: float = 0.0, load: np.ndarray = LOAD, balls: int = BALLS, **changed: float
) -> SpalledBearing:
    numbers = {"length_m": 1.5e-3, "depth_m": 0.1e-3, "place_rad": 0.2} | changed
    spall = RollingSpall("pinion_bearing", element, bearing=bearing_of(balls), **numbers)
    cage = cage_course(spall.bearing, np.random.default_rng(5), slip, walk, (0.0, 2.0 * math.pi * (TURNS + 1)))
    return SpalledBearing(spall, mean_zone(spall, load), cage, 1.0, np.eye(2), {})


def force_of(source: SpalledBearing) -> np.ndarray:
    """Return the inputs (k, 2) over the turns."""
    drive = Drive(1.0, 0.0)
    return source.inputs(drive.turning(ANGLE / (2.0 * math.pi)))


def orders_and_lines(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    lines = np.abs(np.fft.rfft(values)) * 2.0 / values.size
    return np.arange(lines.size) / TURNS, lines


def ball_by_ball(source: SpalledBearing, slip: float) -> np.ndarray:
    """Return the lost force (k, 2) from every ball by itself, by numbers of the source and none of its methods."""
    spall, zone = source.spall, source.zone
    moved, gap = zone.deflection_m, 8e-6
    order = 0.5 * (1.0 - BALL_M / PITCH_M) * (1.0 - slip)
    stiffness = math.sqrt(BALL_M * 1e3) * (1e3 / 4.4e-4) ** 1.5
    radius = {"outer": 0.5 * (PITCH_M + BALL_M), "inner": 0.5 * (PITCH_M - BALL_M)}
    total = np.zeros((POINTS, 2))
    for ball in range(BALLS):
        place = source.cage.start_rad + order * ANGLE + 2.0 * math.pi * ball / BALLS
        if spall.element == "ball":
            if ball > 0:
                continue
            spin = spall.place_rad + order * ANGLE * (PITCH_M + BALL_M) / BALL_M
            half_turns = np.round(spin / math.pi)
            apart = 0.5 * BALL_M * np.abs(np.arcsin(np.sin(spin)))
            inside = half_turns % 2 == 1
        else:
            middle = spall.place_rad + (ANGLE if spall.element == "inner" else 0.0)
            apart = radius[spall.element] * np.abs(np.angle(np.exp(1j * (place - middle))))
            inside = np.full(POINTS, spall.element == "inner")
        from_edge = np.maximum(0.5 * spall.length_m - apart, 0.0)
        bent = np.where(inside, 2.0 / BALL_M + 1.0 / radius["inner"], 2.0 / BALL_M - 1.0 / radius["outer"])
        sunk = np.minimum((1.0 - np.sqrt(1.0 - (from_edge * bent) ** 2)) / bent, spall.depth_m)
        squeezed = np.maximum(moved * np.cos(place) - 0.5 * gap, 0.0)
        lost = stiffness * (squeezed**1.5 - np.maximum(squeezed - sunk, 0.0) ** 1.5)
        toward = place + math.atan2(LOAD[1], LOAD[0])
        total += lost[:, None] * np.stack([np.cos(toward), np.sin(toward)], axis=1)
    return total


@pytest.mark.parametrize("element", ["outer", "inner", "ball"])
@pytest.mark.parametrize("depth_m", [3e-6, 0.1e-3])
def test_the_lost_load_is_that_of_all_balls_one_by_one(element: str, depth_m: float) -> None:
    source = spalled(element, slip=0.015, depth_m=depth_m)
    expected = ball_by_ball(source, 0.015)
    assert np.abs(expected).max() > 50.0
    # angles of 800 rad in doubles, times a slope of 1e10 N/rad at most where the ball leaves the edge
    np.testing.assert_allclose(force_of(source), expected, atol=1e-5)


def test_an_outer_race_under_constant_load_has_lines_at_whole_multiples_of_the_ball_pass_alone() -> None:
    # a bearing whose balls pass a whole number of times in the turns: κ = 1/5, FTF 0.4, BPFO 4
    bearing = BallBearing(10, 8e-3, 40e-3, 0.0, 8e-6)
    spall = RollingSpall("pinion_bearing", "outer", 1.5e-3, 0.1e-3, bearing, 0.2)
    cage = cage_course(bearing, np.random.default_rng(5), 0.0, 0.0, (0.0, 2.0 * math.pi * (TURNS + 1)))
    source = SpalledBearing(spall, mean_zone(spall, LOAD), cage, 1.0, np.eye(2), {})
    orders, lines = orders_and_lines(force_of(source)[:, 0])
    of_balls = np.abs(orders / 4.0 - np.rint(orders / 4.0)) < 1e-9
    assert lines[~of_balls].max() < 1e-9 * lines.max()
    # the first lines by quadrature of one passage, from ball to ball, in the angle of the cage
    middle, size = 0.2 + source.zone.direction_rad, 2.0 * math.pi / 10
    near = size * (np.arange(400_000) / 400_000 - 0.5)
    apart = bearing.outer_radius_m * near
    squeezed = np.maximum(source.zone.deflection_m * np.cos(0.2 + near) - 4e-6, 0.0)
    bent = 2.0 / 8e-3 - 1.0 / bearing.outer_radius_m
    edge = np.maximum(0.75e-3 - np.abs(apart), 0.0)
    left = np.maximum(squeezed - np.minimum((1.0 - np.sqrt(1.0 - (edge * bent) ** 2)) / bent, 1e-4), 0.0)
    pulse = math.sqrt(8.0) * (1e3 / 4.4e-4) ** 1.5 * (squeezed**1.5 - left**1.5) * np.cos(middle + near)
    for h in (1, 2, 5, 9):
        wanted = 2.0 * abs((pulse * np.exp(2j * math.pi * h * near / size)).mean())
        assert lines[4 * h * TURNS] == pytest.approx(wanted, rel=1e-4)  # both have points 2e-5 of a turn apart


@pytest.mark.parametrize(
    ("element", "carrier", "sideband"),
    [("outer", "outer_order", 0.0), ("inner", "inner_order", 1.0), ("ball", "twice_spin", "cage_order")],
)
def test_lines_stand_where_the_element_says_and_their_sidebands_by_its_way_through_the_zone(
    element: str, carrier: str, sideband: float | str
) -> None:
    bearing, slip = bearing_of(), 0.0137
    slow = bearing.cage_order * (1.0 - slip)
    orders = {
        "outer_order": BALLS * slow, "inner_order": BALLS * (1.0 - slow),
        "twice_spin": 2.0 * bearing.spin_order * (1.0 - slip), "cage_order": slow,
    }  # fmt: skip
    step = orders[sideband] if isinstance(sideband, str) else sideband
    lost, _ = spalled(element, slip=slip).lost_n(ANGLE)
    order, lines = orders_and_lines(lost * np.hanning(POINTS))
    floor = np.median(lines[order < 12.0])
    for line in (orders[carrier], 2.0 * orders[carrier]):
        for beside in {0.0, step, -step}:
            near = np.abs(order - line - beside) < 1.0 / TURNS
            assert lines[near].max() > 100.0 * floor, (line, beside)
    if element == "outer":  # steady: nothing beside a line
        apart = np.abs(order / orders[carrier] - np.rint(order / orders[carrier])) * orders[carrier] > 8.0 / TURNS
        assert lines[apart].max() < 1e-3 * lines.max()  # what the window leaks eight of its widths away: -68 dB


def test_a_random_walk_of_the_cage_widens_lines_the_more_the_higher_they_are() -> None:
    sharp, wide = (orders_and_lines(spalled("outer", walk=walk).lost_n(ANGLE)[0])[1] ** 2 for walk in (0.0, 0.02))
    for h, least in ((1, 0.9), (12, 0.0)):
        at = round(h * bearing_of().outer_order * TURNS)
        near = slice(at - 2, at + 3)
        kept = wide[near].sum() / sharp[near].sum()
        assert kept > least
        # a phase that walks by σ = 2π h 0.02 a ball keeps exp(-σ² N/3) of a line over N balls, to the first order
        assert kept < 1.05 if h == 1 else kept < 0.5


def test_an_outer_race_pushes_only_where_its_spall_reaches_into_the_zone() -> None:
    half = bearing_of().half_zone_rad(spalled("outer").zone.deflection_m)
    assert 0.9 < half < 0.5 * math.pi
    reach = 0.75e-3 / bearing_of().outer_radius_m
    for place, pushes in ((0.0, True), (half + 0.9 * reach, True), (half + 1.01 * reach, False), (math.pi, False)):
        source = spalled("outer", place_rad=place)
        assert source.ever_pushes == pushes, place
        assert force_of(source).any() == pushes, place


def test_turning_the_other_way_mirrors_the_force_about_the_load() -> None:
    forward = spalled("inner", place_rad=0.3)
    backward = replace(forward, order=-1.0)
    (lost, toward), (mirrored, back) = forward.lost_n(ANGLE), backward.lost_n(ANGLE)
    np.testing.assert_array_equal(lost, mirrored)
    direction = forward.zone.direction_rad
    np.testing.assert_allclose(toward - direction, -(back - direction), atol=1e-12)
