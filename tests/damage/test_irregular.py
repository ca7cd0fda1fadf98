"""Irregular spalls: the milder outline lies within the severer one; straight edges are the rectangle."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.damage.flank_chords import flank_chords
from siggen.damage.flank_damage import damage_problems, pit_rows
from siggen.damage.heights import flank_heights, initiation_height_m
from siggen.damage.irregular import (
    NEAR,
    STRIPS,
    WAVE_LIMIT,
    IrregularSpall,
    Waves,
    drawn_waves,
    grown_spall,
    stations_across,
)
from siggen.damage.outlines import rectangle
from siggen.damage.part import Damage
from siggen.damage.spalls import FlankSpall
from siggen.mesh import table_options
from siggen.mesh.contact_table import contact_table, kind_row, pits_of_kind, row_faces, table_solver
from siggen.mesh.face_force import face_force, solver_room
from siggen.mesh.mesh_tables import pair_kinds
from siggen.mesh.sections import contact_length_loss, union_area_m2
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions, face_slices
from tests.gears.builders import pair_18_47

PAIR = pair_18_47()
WIDTH = PAIR.face_width_m
ROUNDING_M = 1e-15
"""Of heights of some millimetres."""


def spall(
    length_m: float,
    left_m: float,
    right_m: float,
    waves: tuple[Waves, Waves],
    skews: tuple[float, float] = (0.0, 0.0),
    waviness: float = 0.0,
    depth_m: float = 2e-4,
    milder: IrregularSpall | None = None,
    floor: str = "flat",
    rough: float = 0.0,
) -> IrregularSpall:
    """A spall about x = 2 mm whose readings are heights."""
    face = stations_across(WIDTH, left_m, right_m, milder)
    arcs = tuple(
        2e-3 + side * 0.5 * length_m + skew * (face - 0.5 * WIDTH) + waviness * length_m * wave(face, 2e-3)
        for side, skew, wave in zip((-1.0, 1.0), skews, waves, strict=True)
    )
    depths = depth_m * (1.0 + rough * np.sin(1e4 * face[:-1]))
    return grown_spall("pinion", 0, face, (arcs[0], arcs[1]), depths, 1e-4, floor, milder)


def edges_at(one: IrregularSpall, face_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    face, low, high = np.array(one.stations_m).T
    return np.interp(face_m, face, low), np.interp(face_m, face, high)


@given(
    seed=st.integers(0, 2**32 - 1),
    sizes=st.lists(
        st.tuples(st.floats(0.05e-3, 2e-3), st.floats(0.0, 0.7), st.floats(0.02, 1.0)), min_size=2, max_size=4
    ),
    skews=st.tuples(st.floats(-0.04, 0.04), st.floats(-0.04, 0.04)),
    waviness=st.floats(0.0, 0.2),
)
@settings(max_examples=60, deadline=None)
def test_every_milder_outline_lies_within_the_severer_one(
    seed: int, sizes: list[tuple[float, float, float]], skews: tuple[float, float], waviness: float
) -> None:
    """At any size, in any order of lengths and widths, and with a skew and waviness that differ from state to state."""
    rng = np.random.default_rng(seed)
    waves = drawn_waves(rng), drawn_waves(rng)
    chain: list[IrregularSpall] = []
    for step, (length, left, share) in enumerate(sizes):
        right = min(left + share, 1.0)
        bent = (skews[0] * (1 + step) * length / WIDTH, skews[1] * length / WIDTH)
        milder = chain[-1] if chain else None
        own = waviness / (1 + step)
        chain.append(spall(length, left * WIDTH, right * WIDTH, waves, bent, own, 1e-4 * (4 - step), milder, rough=0.3))
    for mild, severe in pairwise(chain):
        face = np.union1d(
            np.array(mild.stations_m)[:, 0], np.linspace(mild.stations_m[0][0], mild.stations_m[-1][0], 997)
        )
        (low, high), (lowest, highest) = edges_at(mild, face), edges_at(severe, face)
        assert severe.stations_m[0][0] <= face[0]
        assert severe.stations_m[-1][0] >= face[-1]
        assert np.all(lowest <= low + ROUNDING_M)
        assert np.all(highest >= high - ROUNDING_M)
        assert np.all(low <= high)
        assert severe.hides(mild)
        assert not list(severe.own_problems())
        # The same by what the contact loses, at any height.
        height = np.linspace(*severe.outline.height_range_m, 101)
        lost, less = (contact_length_loss([one], WIDTH, height) for one in (severe, mild))
        assert np.all(lost >= less - 1e-12)
    assert chain[-1].hides(chain[0])


@pytest.mark.parametrize("floor", ["flat", "dish"])
@pytest.mark.parametrize("span", [(0.0, 1.0), (0.3, 0.8)])
def test_straight_edges_and_a_smooth_floor_are_the_rectangle(span: tuple[float, float], floor: str) -> None:
    waves = drawn_waves(np.random.default_rng(1)), drawn_waves(np.random.default_rng(2))
    ends = span[0] * WIDTH, span[1] * WIDTH
    one = spall(1e-3, *ends, waves, floor=floor)
    box = FlankSpall("pinion", 0, rectangle((1.5e-3, 2.5e-3), ends), 2e-4, floor)
    assert one.outline.vertices_m == box.outline.vertices_m
    rows, others = pit_rows([one]), pit_rows([box])
    assert np.array_equal(rows[:, :-1], others[:, :-1])
    options = StiffnessOptions(), TableOptions(4e3, edge_radius_m=1e-4), 257
    tables = (contact_table(PAIR, (damage,), *options) for damage in (one, box))
    for found, expected in zip(*tables, strict=True):
        # Equal but for the mean of as many equal radii, which rounds.
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-15)


def test_a_strip_of_its_own_for_every_station_takes_the_same_land_and_area() -> None:
    """Independent of the strips: the outline as one polygon, cut at the heights of its corners."""
    rng = np.random.default_rng(5)
    one = spall(1e-3, 2e-3, 17e-3, (drawn_waves(rng), drawn_waves(rng)), (0.02, -0.01), 0.15, rough=0.0)
    whole = FlankSpall("pinion", 0, one.outline, 2e-4)
    assert len(one.stations_m) > 40
    height = np.linspace(*one.outline.height_range_m, 503)
    assert contact_length_loss([one], WIDTH, height) == pytest.approx(
        contact_length_loss([whole], WIDTH, height), abs=1e-12
    )
    area = union_area_m2(PAIR.pinion, [one], WIDTH)
    assert area == pytest.approx(union_area_m2(PAIR.pinion, [whole], WIDTH), rel=1e-9)
    assert not damage_problems(PAIR, (one,))
    found, expected = (flank_chords(PAIR.pinion, [d], WIDTH, 200) for d in (one, whole))
    assert np.array_equal(found.intervals, expected.intervals)
    assert found.low[:, 0] == pytest.approx(expected.low[:, 0], abs=1e-12)
    assert found.high[:, 0] == pytest.approx(expected.high[:, 0], abs=1e-12)


def test_waves_have_a_mean_square_of_one_and_never_pass_their_limit() -> None:
    """Over 2,000 draws of 7 places 8 lengths apart, which are independent: 14,000 values, standard error 0.01."""
    rng = np.random.default_rng(11)
    face = np.linspace(0.0, 0.1, 7)
    values = np.array([drawn_waves(rng)(face, 2e-3) for _ in range(2000)])
    assert np.mean(values**2) == pytest.approx(1.0, abs=0.04)
    assert np.mean(values) == pytest.approx(0.0, abs=0.04)
    assert np.abs(values).max() <= WAVE_LIMIT
    near = np.array([drawn_waves(rng)(np.array([0.0, 2e-3]), 2e-3) for _ in range(4000)])
    # Cut off at two standard deviations the correlation 1/e falls by less than 0.02.
    assert np.mean(near[:, 0] * near[:, 1]) == pytest.approx(np.exp(-1.0), abs=0.06)


def test_the_sink_rests_on_the_radius_of_its_own_edge() -> None:
    """In the middle of the flat floor r²/(2 (R_e + R_r)); an edge of 0.2 mm against one of 0.1 mm."""
    rng = np.random.default_rng(3)
    one = spall(1e-3, 0.0, WIDTH, (drawn_waves(rng), drawn_waves(rng)))
    rounder = IrregularSpall(one.gear, one.tooth, one.stations_m, one.strip_depths_m, 2e-4)
    box = FlankSpall("pinion", 0, one.outline, 2e-4)
    tables = [
        contact_table(PAIR, (damage,), StiffnessOptions(), TableOptions(4e3, edge_radius_m=radius), 257)
        for damage, radius in ((rounder, 1e-4), (box, 2e-4), (box, 1e-4))
    ]
    assert np.array_equal(tables[0].touch_m, tables[1].touch_m)
    assert tables[2].touch_m.max() > tables[1].touch_m.max()
    for damage, radius in ((rounder, 2e-4), (box, -1.0)):
        chords = flank_chords(PAIR.pinion, [damage], WIDTH, 4)
        assert np.all(chords.low_radius_m[:, 0] == radius)
        assert np.all(chords.high_radius_m[:, 0] == radius)


@pytest.mark.parametrize("skew_mm", [0.2, 0.8])
def test_the_slices_of_a_table_are_enough_for_skewed_edges(skew_mm: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """The 83 of a table against 166: what the spall leaves of the healthy force errs by less than 5e-4 of it.

    Sound faces differ as well, by 8e-4: cells are part of the kernel, and the contact in three dimensions lies between.
    """
    monkeypatch.setattr(table_options, "MOST_SLICES", 200)
    rng = np.random.default_rng(0)
    slope = 1e-3 * skew_mm / WIDTH
    one = spall(1e-3, 0.0, WIDTH, (drawn_waves(rng), drawn_waves(rng)), (slope, slope))
    left = {cells: forces((one,), cells) / forces((), cells) for cells in (1.28, 0.64)}
    assert left[0.64].min() < 0.7
    assert np.max(np.abs(left[1.28] - left[0.64])) < 5e-4


def forces(damage: Damage, cell_widths: float) -> np.ndarray:
    """Return the forces (k,) of a pair 8 µm deep, solved along the path [N]."""
    teeth, options = StiffnessOptions(), TableOptions(4e3, cell_widths=cell_widths)
    row, points = kind_row(PAIR, teeth, options, 257), np.arange(2, 255, 2)
    if damage:
        row = kind_row(PAIR, teeth, options, 257, pits_of_kind(damage, pair_kinds(damage)[1]), row)
    slices = face_slices(PAIR, options)
    faces = row_faces(table_solver(PAIR, teeth, options, np.zeros(slices)), row, points)
    found = []
    for face in faces:
        answer = face_force(face, 8e-6, 0.0, np.zeros(slices), solver_room(slices))
        assert answer.passes > 0
        found.append(answer.force_n)
    return np.array(found)


def test_a_spall_begins_between_the_lowest_point_of_single_contact_and_the_pitch_line() -> None:
    for which in ("pinion", "gear"):
        gear = PAIR.member(which)
        height = initiation_height_m(PAIR, which)
        pitch = float(gear.height_m(np.tan(PAIR.working_pressure_angle_rad)))
        assert flank_heights(gear)[0] < height < pitch
        travel = gear.base_radius_m * float(gear.roll_at_height(height))
        position = travel if which == "pinion" else PAIR.line_of_action_m - travel
        neighbours = [position - PAIR.base_pitch_m, position + PAIR.base_pitch_m]
        assert not any(PAIR.contact_start_m < other < PAIR.contact_end_m for other in neighbours)


def test_edges_that_cross_and_a_negative_radius_are_named() -> None:
    crossed = IrregularSpall("pinion", 0, ((0.0, 1e-3, 2e-3), (1e-2, 2e-3, 1e-3)), (1e-4,), -1e-4)
    problem, radius = crossed.own_problems()
    assert radius.name == "edge_radius_m"
    assert "a lower edge at 2 mm and an upper one at 1 mm, 10 mm across the face" in problem.received
    backwards = IrregularSpall("pinion", 0, ((1e-2, 1e-3, 2e-3), (0.0, 1e-3, 2e-3)), (1e-4, 1e-4), 1e-4)
    assert [problem.allowed for problem in backwards.own_problems()] == [
        "at least two, ascending across the face",
        "one between neighbouring stations",
    ]


@pytest.mark.parametrize(("left_m", "right_m"), [(3e-3, 17e-3), (7e-3, 17e-3), (3e-3, 11e-3), (7e-3, 11e-3)])
def test_stations_reach_from_the_outermost_edges_of_both_with_every_end_of_a_strip_between(left_m, right_m) -> None:
    """The milder one reaches from 5 to 14 mm across the face, and from half to two millimetres in height."""
    milder = IrregularSpall(
        gear="pinion",
        tooth=0,
        stations_m=((5e-3, 5e-4, 2e-3), (14e-3, 5e-4, 2e-3)),
        strip_depths_m=(1e-4,),
        edge_radius_m=1e-4,
    )
    found = stations_across(WIDTH, left_m, right_m, milder)
    low, high = min(left_m, 5e-3), max(right_m, 14e-3)
    assert (found[0], found[-1]) == (low, high)
    ends = WIDTH * np.arange(STRIPS + 1) / STRIPS
    for end in ends[(ends > low) & (ends < high)]:
        assert np.abs(found - end).min() < NEAR * WIDTH
