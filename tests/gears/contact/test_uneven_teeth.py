"""Teeth softened in a part of the face: limits, slices on springs solved another way, and where the load goes."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import diags
from scipy.sparse.linalg import spsolve

from siggen.mesh.contact_table import kind_row, row_faces, table_solver
from siggen.mesh.face_force import face_force, solver_room
from siggen.mesh.face_slices import FaceSlices, UnevenTeeth
from siggen.mesh.line_kernel import tooth_matrix, unit_tooth
from siggen.mesh.table_options import TableOptions, face_slices
from tests.damage.test_crack import OPTIONS, PAIR, crack
from tests.gears.contact.faces import KAPPA, WIDTH

SLICES, LENGTH, SOUND = 60, 4e-3, np.array([2e-9, 3e-9])
Y = (np.arange(SLICES) + 0.5) / SLICES
FACE = PAIR.face_width_m


def per_unit(added, length=LENGTH, sound=SOUND):
    """T (n, n) times the sound C, from the kernel's generators [m/N]."""
    teeth = UnevenTeeth(sound[:, None], np.asarray(added)[:, None, :])
    kernel = teeth.kernel(unit_tooth(SLICES, WIDTH, length), 0, WIDTH, KAPPA)
    return tooth_matrix(kernel) * KAPPA / WIDTH


def pinion_only(added):
    return np.stack([added, np.zeros(SLICES)])


def test_one_tooth_is_that_of_slices_on_springs_that_hang_together():
    """Finite differences of t s - (g t')' = q on forty times as many slices, by a sparse solver."""
    fine, sound = 40, np.array([5e-9, 0.0])
    y = (np.arange(SLICES * fine) + 0.5) / (SLICES * fine)
    added = 2e-9 * np.maximum(1.0 - y / 0.6, 0.0)
    lost = added / (sound[0] + added)
    kept = 1.0 - lost.mean()
    step = WIDTH / y.size
    hang = kept * (LENGTH / step) ** 2
    middle = 1.0 - lost + hang * np.concatenate([[1.0], np.full(y.size - 2, 2.0), [1.0]])
    springs = diags([-hang, middle, -hang], [-1, 0, 1], shape=(y.size, y.size), format="csc")
    found = per_unit(pinion_only(2e-9 * np.maximum(1.0 - Y / 0.6, 0.0)), sound=sound)
    for load in (np.ones(y.size), 2.0 * y - 1.0, np.where(y < 0.25, 1.0, 0.0)):
        expected = sound[0] * spsolve(springs, load).reshape(SLICES, fine).mean(axis=1)
        # 4.2e-4 at 60 slices, a quarter of it at 120: softness and load are even within one
        own = found @ load.reshape(SLICES, fine).mean(axis=1)
        np.testing.assert_allclose(own, expected, atol=6e-4 * np.abs(expected).max())


def test_two_teeth_give_way_to_an_even_load_as_one_by_one_and_to_a_tilt_nearly_so():
    added = 1.5e-9 * np.maximum(1.0 - Y / 0.7, 0.0)
    alone = per_unit(pinion_only(added), sound=np.array([SOUND[0], 0.0]))
    other = SOUND[1] * tooth_matrix(unit_tooth(SLICES, WIDTH, LENGTH))
    both = per_unit(pinion_only(added))
    np.testing.assert_allclose(both.sum(axis=1), (alone + other).sum(axis=1), rtol=1e-9)
    tilt = 2.0 * Y - 1.0
    # one kernel has n numbers, two have more; the crack's own part is 12 % of this
    assert tilt @ both @ tilt == pytest.approx(tilt @ (alone + other) @ tilt, rel=0.02)
    np.testing.assert_allclose(both, both.T, rtol=1e-12)
    assert np.linalg.eigvalsh(both).min() > 0.0


def slices_of(*damage, point=32) -> FaceSlices:
    options = TableOptions()
    solver = table_solver(PAIR, OPTIONS, options, np.zeros(face_slices(PAIR, options)))
    healthy = kind_row(PAIR, OPTIONS, options, 65)
    return row_faces(solver, kind_row(PAIR, OPTIONS, options, 65, (damage, ()), healthy), np.array([point]))[0]


def answer(slices: FaceSlices):
    loads = np.zeros(slices.face_m.size)
    return face_force(slices, 1e-5, 0.0, loads, solver_room(loads.size), 1e-9), loads


def test_a_crack_from_one_end_moves_the_load_to_the_other():
    sound, whole, part = (answer(slices_of(*one)) for one in ((), (crack(),), (crack(run_m=0.5 * FACE),)))
    for even, _ in (sound, whole):
        assert abs(even.moment_n_m) < 1e-12 * even.force_n * FACE
    assert whole[0].force_n < part[0].force_n < sound[0].force_n
    assert part[0].moment_n_m > 0.005 * part[0].force_n * FACE
    assert part[1][0] < sound[1][0]
    # beyond the run the tooth is hardly softer than a sound one
    assert part[1][-1] > 0.99 * sound[1][-1]


def test_force_and_moment_are_that_of_one_energy():
    slices, step = slices_of(crack(0.4, run_m=0.6 * FACE)), 1e-9
    room, loads = solver_room(slices.face_m.size), np.zeros(slices.face_m.size)
    middle = face_force(slices, 1e-5, 2e-5, loads, room, 1e-9)
    ahead, behind = (face_force(slices, 1e-5 + s, 2e-5, loads, room, 1e-9) for s in (step, -step))
    up, down = (face_force(slices, 1e-5, 2e-5 + s / FACE, loads, room, 1e-9) for s in (step, -step))
    across = (up.force_n - down.force_n) / (2.0 * step / FACE)
    # dM/dd = dF/dθ, within the differences' rounding
    assert (ahead.moment_n_m - behind.moment_n_m) / (2.0 * step) == pytest.approx(across, rel=1e-4)
    assert middle.moment_n_m != 0.0
