"""A loose foot under a box of plates: the pencil of all coordinates, rigid bodies, statics, solid finite elements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import block_diag, cho_factor, cho_solve, eigh

from siggen.drivetrain.box import Axis
from siggen.drivetrain.box_energy import box_energy
from siggen.drivetrain.housing_modes import HousingModes, PlatePlace, WallMotion, bolt_motions, housing_modes, motion_at
from siggen.drivetrain.loose_foot import LoosenedModes, loosened, springs
from tests.dynamics.housing.boxes import IRON, box_motions, iron_box
from tests.dynamics.housing.rigid_body import rigid_box_hz
from tests.reference.housing.solid_box import solid_box

BOX = iron_box()
STIFFNESS = np.array(BOX.bolts[-1].stiffness_n_per_m)


@pytest.fixture(scope="module")
def sound() -> HousingModes:
    return housing_modes(BOX, 10_000.0)


class Joint:
    """Both halves in one pencil, the loose foot's springs taken off; solved by LAPACK."""

    def __init__(self, sound: HousingModes, share: float) -> None:
        energies = [box_energy(BOX, half)[0] for half in sound.halves]
        foot = bolt_motions(sound.halves, BOX.bolts[-1])
        rows = np.array([np.concatenate(foot[f"back/{axis}"]) for axis in "xyz"])
        self.mass = block_diag(*(one.mass for one in energies))
        self.stiffness = block_diag(*(one.stiffness for one in energies))
        self.stiffness -= rows.T @ np.diag((1.0 - share) * STIFFNESS) @ rows

    def frequency_hz(self, count: int) -> np.ndarray:
        squared = eigh(self.stiffness, self.mass, eigvals_only=True, subset_by_index=(0, count - 1))
        return np.sqrt(squared) / (2.0 * np.pi)

    def static(self, outputs: list[WallMotion], inputs: list[WallMotion]) -> np.ndarray:
        left, right = (np.array([np.concatenate(motion) for motion in side]) for side in (outputs, inputs))
        return left @ cho_solve(cho_factor(self.stiffness), right.T)

    def accelerance(self, output: WallMotion, force: WallMotion, hz: np.ndarray) -> np.ndarray:
        """Return it by a direct solution at each frequency, undamped."""
        row, load = np.concatenate(output), np.concatenate(force)
        omegas = 2.0 * np.pi * hz
        return np.array([-w * w * row @ np.linalg.solve(self.stiffness - w * w * self.mass, load) for w in omegas])


def seen(modes: HousingModes | LoosenedModes) -> list[WallMotion]:
    place = PlatePlace("lid", 0.6 * BOX.size_m[0], 0.3 * BOX.size_m[2], Axis.Y)
    motions = box_motions(BOX, modes.halves)
    return [motions["gear/front/y"], motions["pinion/back/x"], motion_at(modes.halves, place)]


@pytest.mark.parametrize("share", [1e-6, 0.05, 0.5])
def test_frequencies_are_those_of_the_pencil_of_both_halves(sound: HousingModes, share: float) -> None:
    found = loosened(sound, BOX, share).frequency_hz
    off = found / Joint(sound, share).frequency_hz(found.size) - 1.0
    # Ritz: never below, but for rounding of the stiff pencil
    assert off.min() > -1e-9
    # of 145 modes up to 10 kHz; what the foot's forces move beyond them is right up to (ω/ω_145)⁴ of its share
    assert off[: found.size // 2].max() < 1e-5
    assert off.max() < 2e-4


@pytest.mark.parametrize("share", [0.02, 0.3])
def test_a_very_stiff_box_is_a_rigid_body_on_unequal_bolts(share: float) -> None:
    stiff = iron_box(material=replace(IRON, youngs_modulus_pa=1e4 * IRON.youngs_modulus_pa))
    found = loosened(housing_modes(stiff, 3000.0), stiff, share).frequency_hz[:6]
    # 1 %: the inertia that stands for shear of thick plates also counts in a rotation, as in the sound box
    np.testing.assert_allclose(found, rigid_box_hz(stiff, share), rtol=0.01)
    assert np.abs(rigid_box_hz(stiff, share) / rigid_box_hz(stiff) - 1.0).max() > 0.1


def test_a_foot_that_carries_nothing_leaves_a_weight_to_three_by_their_places(sound: HousingModes) -> None:
    """Three vertical forces follow from equilibrium alone: Σ R = 1, Σ R x = x_F, Σ R z = z_F."""
    share = 1e-6
    modes = loosened(sound, BOX, share)
    feet = [one for one in springs(BOX, modes.halves, share) if one.axis == Axis.Y]
    force = box_motions(BOX, modes.halves)["gear/front/y"]
    moved = modes.static_flexibility([one.motion for one in feet], [force])[:, 0]
    carried = moved * [one.stiffness_n_per_m for one in feet]
    places = np.array([(1.0, bolt.x_m, z) for bolt in BOX.bolts for z in (bolt.z_m, BOX.size_m[2] - bolt.z_m)])
    seat = BOX.seats["gear"]
    by_hand = np.linalg.solve(places[:3].T, [1.0, seat.x_m, -seat.overhang_m])
    # 1e-5: the millionth of a spring that is left; forces along x and z lie in the floor and have no part in these
    np.testing.assert_allclose(carried, [*by_hand, 0.0], atol=1e-5)


@pytest.mark.parametrize("share", [1e-3, 0.3])
def test_it_gives_way_at_rest_as_the_pencil_does_and_forces_and_motions_stay_reciprocal(
    sound: HousingModes, share: float
) -> None:
    modes, joint = loosened(sound, BOX, share), Joint(sound, share)
    sides = [*seen(modes), *modes.foot]
    static = modes.static_flexibility(sides, sides)
    np.testing.assert_allclose(static, joint.static(sides, sides), rtol=1e-7, atol=1e-9 * np.abs(static).max())
    np.testing.assert_allclose(static, static.T, rtol=1e-9, atol=1e-12 * np.abs(static).max())


def test_accelerance_is_that_of_a_direct_solution(sound: HousingModes) -> None:
    modes, hz = loosened(sound, BOX, 0.05), np.linspace(60.0, 5000.0, 60)
    gear, _, lid = seen(modes)
    found = modes.accelerance([lid, gear], [gear], hz, np.zeros(modes.frequency_hz.size))[:, 0]
    for own, output in zip(found, (lid, gear), strict=True):
        expected = Joint(sound, 0.05).accelerance(output, gear, hz)
        # 1 %: up to half of the last mode's frequency the others are quasi-static to (1/2)² of their share; undamped
        # lines near a mode enlarge what frequencies differ
        assert np.sqrt(np.mean(np.abs(own - expected) ** 2)) < 0.01 * np.sqrt(np.mean(np.abs(expected) ** 2))


def test_modes_fall_as_those_of_solid_finite_elements(sound: HousingModes) -> None:
    share, count = 0.05, 12
    tight, loose = (solid_box(BOX, 0.016, count, left).frequency_hz for left in (1.0, share))
    found = loosened(sound, BOX, share).frequency_hz[:count] / sound.frequency_hz[:count]
    assert found.min() < 0.8
    # 1.2 %: each mode of plates lies within 3 % of the solid's; near ones, such as 580 and 584 Hz, share what they lose
    np.testing.assert_allclose(found, loose / tight, atol=0.012)
