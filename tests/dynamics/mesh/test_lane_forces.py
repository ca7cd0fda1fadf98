"""The pair law in lanes writes what the law of one pair after the other does; steps of both may follow each other."""

from __future__ import annotations

from math import radians
from typing import Any

import numpy as np
import pytest

from siggen.damage.outlines import rectangle
from siggen.damage.spalls import FlankSpall
from siggen.gears.face_shares import FaceShares
from siggen.gears.missing_material import missing_material
from siggen.lanes import LANES
from siggen.mesh.asperities import asperity_table
from siggen.mesh.body_coupling import body_coupling
from siggen.mesh.contact_table import contact_table
from siggen.mesh.friction import composite_friction
from siggen.mesh.lane_forces import NOT_HERE, lane_table, write_lane_forces
from siggen.mesh.node_forces import write_node_forces
from siggen.mesh.pair_columns import (
    NODE_APPROACH,
    NODE_NORMAL,
    NODE_RATE,
    NODE_ROWS,
    NODE_SLIDING_0,
    NODE_SLIDING_1,
    NODE_TILT,
    NODE_TILT_RATE,
    PAIR,
    SPRUNG,
    STIFFNESS,
)
from siggen.mesh.pair_law import MeshConstants, PairLaw, pair_law
from siggen.mesh.pair_springs import pair_table
from siggen.mesh.springs import EXACT_CHANGE
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions, face_slices
from siggen.mesh.tooth_law import DampingLaw
from siggen.motion.exponential_scheme import NODES
from siggen.record.contact import whole_face
from tests.dynamics.lubricated import RANGE, mesh
from tests.dynamics.pair_runs import RELIEF, gear_pair, law
from tests.gears.geometry.test_helical import helical_pair

TEETH, POINTS, STEPS = StiffnessOptions(), 513, 3000
GAUSS = 0.5 * (np.polynomial.legendre.leggauss(NODES)[0] + 1.0)
WEIGHTS = 0.5 * np.polynomial.legendre.leggauss(NODES)[1]
COUPLING_M_PER_N = 2e-9
"""That of `quickstart`, 0.44 of a pair's own compliance, which is here the same."""
HALF_FACE_M = 10e-3
SETTLED, LIGHT_N = {2: 1e-4, 3: 3e-4}, 100.0
"""Of the force, or of a light one, what so many pairs that share a gear body may be off by (`SMOOTH_CHANGE`).

Of two 8e-5 was seen. Of three 2.1e-4 in one of 3,000 steps: a light touch, where the tangent is cut to be convex and
Newton's method ends linearly; all others are below 1e-4.
"""


def spalled(seed: int, *, tilts: bool, coupled: bool = True, **other: Any) -> PairLaw:
    """Return the law of a gear pair with a drawn spall on every third tooth, misaligned where gears tilt."""
    rng, pair = np.random.default_rng(seed), gear_pair()
    height = float(pair.pinion.height_m(np.array([pair.pitch_point_m / pair.pinion.base_radius_m]))[0])
    damage = []
    for tooth in range(0, 18, 3):
        along = height + rng.uniform(-0.8e-3, 0.8e-3) + np.array([-1.0, 1.0]) * rng.uniform(2e-4, 6e-4)
        outline = rectangle(tuple(along), (-1e-3, rng.uniform(5e-3, 25e-3)))
        damage.append(FlankSpall("pinion", tooth, outline, rng.uniform(2e-5, 3e-4), "flat"))
    options = TableOptions(3000.0, tilts=tilts)
    slices = face_slices(pair, options)
    lead = 2e-6 * ((np.arange(slices) + 0.5) / slices - 0.5)
    return law(
        missing_material(pair, RELIEF),
        whole_face(pair, tuple(damage), TEETH, POINTS),
        contact=contact_table(pair, tuple(damage), TEETH, options, POINTS, lead),
        friction=composite_friction(asperity_table(mesh(), [0.3e-6, 2e-6], RANGE, 2e4), 0.11),
        coupling_m_per_n=np.full((1, POINTS), COUPLING_M_PER_N) if coupled else None,
        **other,
    )


def drawn_node(rng: np.random.Generator) -> np.ndarray:
    """Return what the mesh sees at the nodes of a step: mostly loaded, now and then apart or on the back flank."""
    node = np.zeros((NODE_ROWS, LANES))
    at = np.linspace(-1.0, 1.0, NODES)
    level = rng.choice([12e-6, 4e-6, 0.0, -100e-6], p=[0.7, 0.15, 0.1, 0.05])
    for row, middle, spread in (
        (NODE_APPROACH, level + rng.normal(0.0, 4e-6), 1e-6), (NODE_RATE, rng.normal(0.0, 0.02), 5e-3),
        (NODE_SLIDING_0, rng.normal(0.0, 0.02), 1e-2), (NODE_SLIDING_1, rng.normal(0.0, 1.0), 1.0),
        (NODE_TILT, rng.normal(0.0, 1e-4), 1e-5), (NODE_TILT_RATE, rng.normal(0.0, 0.1), 1e-2),
    ):  # fmt: skip
        node[row, :NODES] = middle + rng.normal(0.0, spread) * at
    return node


def helical(*, coupled: bool, tilts: bool) -> PairLaw:
    """Return the law of helical teeth with a spall, of which three pairs touch now and then; slices rub both ways."""
    pair = helical_pair(15.0)
    middle = float(pair.pinion.height_m(np.array([pair.pitch_point_m / pair.pinion.base_radius_m]))[0])
    damage = (FlankSpall("pinion", 2, rectangle((middle - 4e-4, middle + 4e-4), (-1e-3, 12e-3)), 5e-5, "flat"),)
    options = TableOptions(6000.0, tilts=tilts, relief=RELIEF)
    start, end = pair.engagement_start_m, pair.engagement_end_m
    along, shift = np.linspace(start, end, POINTS), np.linspace(-1.0, 1.0, 21) * HALF_FACE_M * np.tan(radians(14.0))
    even = np.full((2, shift.size), 1.0 / shift.size)
    shares = FaceShares(start, end, shift, even, even)
    return pair_law(
        whole_face(pair, damage, TEETH, POINTS),
        missing_material(pair, RELIEF),
        MeshConstants(pair.line_of_action_m, 0.2124, 80e-6, shares.about(pair.pitch_point_m, along)),
        damping_ratio=0.07,
        friction=composite_friction(asperity_table(mesh(), [0.3e-6, 2e-6], RANGE, 2e4), 0.11),
        contact=contact_table(pair, damage, TEETH, options, POINTS),
        coupling_m_per_n=body_coupling(pair, StiffnessOptions(coupling="body"), along) if coupled else None,
    )


LAWS = {
    "two coupled pairs, tilting": lambda: spalled(3, tilts=True),
    "two coupled pairs": lambda: spalled(3, tilts=False),
    "two pairs, tilting": lambda: spalled(3, tilts=True, coupled=False),
    "dampers by asperity share": lambda: spalled(
        3, tilts=True, coupled=False, damping_ratio=DampingLaw(0.04, 0.02, 0.05)
    ),
    "three coupled pairs, tilting": lambda: helical(coupled=True, tilts=True),
    "three pairs": lambda: helical(coupled=False, tilts=False),
}


@pytest.mark.parametrize("name", LAWS)
def test_forces_in_lanes_are_those_of_one_pair_after_the_other(name: str) -> None:
    chosen, rng = LAWS[name](), np.random.default_rng(5)
    coupled, slots = "coupled" in name, 3 if "three" in name else 2
    assert chosen.slots == slots
    reference, pairs = (np.concatenate([pair_table(chosen)] * NODES) for _ in range(2))
    table, pitches, taken, alike, other = lane_table(chosen, GAUSS, WEIGHTS), 3.0, 0, set(), 0
    for _ in range(STEPS):
        step = 0.015 * 0.5 ** rng.integers(0, 4)
        expected = drawn_node(rng)
        node = expected.copy()
        said = write_node_forces(chosen, GAUSS, WEIGHTS, pitches, pitches + step, reference, expected, EXACT_CHANGE)
        found = write_lane_forces(chosen, pitches, pitches + step, pairs, table, node)
        taken += found != NOT_HERE
        if found == NOT_HERE:
            found = write_node_forces(chosen, GAUSS, WEIGHTS, pitches, pitches + step, pairs, node, EXACT_CHANGE)
        alike.add(said)
        other += found != said
        rows, kept = slice(NODE_NORMAL, NODE_ROWS), np.ix_(range(2 * slots, 3 * slots), (SPRUNG, STIFFNESS, PAIR))
        if coupled:
            force = expected[NODE_NORMAL, :NODES]
            off = np.abs(node[NODE_NORMAL, :NODES] - force).max()
            assert off <= SETTLED[slots] * max(np.abs(force).max(), LIGHT_N)
        elif slots == 2:  # to the bit
            assert node[rows, :NODES].tobytes() == expected[rows, :NODES].tobytes()
            assert pairs[kept].tobytes() == reference[kept].tobytes()
        else:  # sums in another order
            size = np.abs(expected[rows, :NODES]).max(axis=1, keepdims=True)
            assert (np.abs(node[rows, :NODES] - expected[rows, :NODES]) <= 1e-13 * size).all()
        pitches += step if rng.random() < 0.9 else 0.0  # a step that is taken again
    assert other <= (2e-3 * STEPS if coupled else 0)  # a flank that carries less than a newton
    assert 0.8 * STEPS < taken < STEPS  # the others met a back flank, or a pair that enters or leaves
    assert {0, 1, 3, 4} < alike  # no pair, either one, both; and steps in which that changes
    assert slots == 2 or 13 in alike  # three of them
    assert min(alike) < 0
