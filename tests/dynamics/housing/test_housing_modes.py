"""A whole housing: limits, reciprocity, residuals, what cancels and what infinite plates do."""

from dataclasses import replace

import numpy as np
import pytest

from siggen.drivetrain.box import Axis, Box, Thicknesses
from siggen.drivetrain.box_energy import sheet
from siggen.drivetrain.housing_modes import (
    HousingModes,
    PlatePlace,
    TableModes,
    bolt_motions,
    housing_modes,
    motion_at,
    table_motion,
)
from tests.dynamics.housing.boxes import BOLTS, IRON, STEEL, box_motions, iron_box
from tests.dynamics.housing.rigid_body import rigid_box_hz
from tests.dynamics.housing.timoshenko_beam import free_bending_hz
from tests.reference.housing.third_octaves import bands_db, centres_hz, distance, lines_hz


@pytest.fixture(scope="module")
def iron() -> HousingModes:
    return housing_modes(iron_box())


def damped(modes: HousingModes, ratio: float = 0.02) -> np.ndarray:
    return np.full(modes.frequency_hz.size, ratio)


def lid(box: Box, modes: HousingModes, shares: tuple[float, float] = (0.6, 0.3)):
    return motion_at(modes.halves, PlatePlace("lid", shares[0] * box.size_m[0], shares[1] * box.size_m[2], Axis.Y))


def test_a_very_stiff_box_is_a_rigid_body_on_its_bolts() -> None:
    stiff = iron_box(material=replace(IRON, youngs_modulus_pa=1e4 * IRON.youngs_modulus_pa))
    found = housing_modes(stiff, 3000.0).frequency_hz[:6]
    # 1 %: the inertia that stands for shear of thick plates also counts in a rotation.
    np.testing.assert_allclose(found, rigid_box_hz(stiff), rtol=0.01)


def test_a_closed_square_tube_bends_like_a_timoshenko_beam() -> None:
    tube = Box((1.19, 0.09, 0.09), STEEL, Thicknesses(0.01, 0.01, 0.01, 0.01), {}, _soft_bolts())
    found = housing_modes(tube, 2000.0, waves=14.0).frequency_hz
    assert found[5] < 20.0
    expected = free_bending_hz(1.19, 0.09, 0.01, STEEL)
    # 3 %: the section gives way in its plane, which a beam does not.
    assert found[6] == pytest.approx(expected, rel=0.03)
    assert found[7] == pytest.approx(found[6], rel=1e-3)  # both planes of the square alike


def _soft_bolts():
    return tuple(replace(bolt, x_m=x, z_m=0.02, patch_m=0.02, stiffness_n_per_m=(1e3, 1e3, 1e3)) for bolt, x in
                 zip(BOLTS, (0.2, 0.99), strict=True))  # fmt: skip


def test_forces_and_motions_are_reciprocal(iron: HousingModes) -> None:
    box = iron_box()
    sides = [box_motions(box, iron.halves)["gear/front/y"], lid(box, iron)]
    found = iron.accelerance(sides, sides, np.geomspace(50.0, 5000.0, 40), damped(iron))
    np.testing.assert_allclose(found[0, 1], found[1, 0], rtol=1e-8)


def test_the_residual_stands_for_all_higher_modes(iron: HousingModes) -> None:
    box = iron_box()
    few = housing_modes(box, 2000.0)
    for name in ("gear/front/x", "gear/front/y"):
        both = [(box_motions(box, found.halves)[name], lid(box, found)) for found in (iron, few)]
        frequency = np.linspace(50.0, 700.0, 50)
        full, short = (
            found.accelerance(sides, sides, frequency, damped(found))
            for found, sides in zip((iron, few), both, strict=True)
        )
        # At a third of the last kept mode the dropped ones are quasi-static to (1/3)² of their share.
        assert np.abs(full - short).max() < 0.02 * np.abs(full).max()
    static = few.static_flexibility(both[1], both[1])
    np.testing.assert_allclose(static, iron.static_flexibility(both[0], both[0]), rtol=1e-9)
    slow = few.accelerance(both[1], both[1], np.array([0.5]), np.zeros(few.frequency_hz.size))
    np.testing.assert_allclose(slow[:, :, 0].real / -((2 * np.pi * 0.5) ** 2), static, rtol=1e-4)


def test_a_mode_of_a_table_that_is_not_kept_gives_way_like_its_spring() -> None:
    table = TableModes(np.array([100.0, 300.0]))
    seat, lid_side = table_motion(np.array([0.5, 0.2])), table_motion(np.array([0.1, -0.4]))
    found = table.flexibility_beyond(1, [lid_side], [seat])
    # A modal mass of 1 kg on a spring of ω² moves by φ/ω² under a force φ.
    assert found[0, 0] == pytest.approx(-0.4 * 0.2 / (2.0 * np.pi * 300.0) ** 2, rel=1e-12)


def test_the_lid_has_the_mean_conductance_of_an_infinite_plate() -> None:
    box = iron_box()
    modes = housing_modes(box, 14000.0, waves=13.0)
    frequency = np.linspace(2000.0, 9000.0, 3000)
    rng = np.random.default_rng(5)
    own = sheet(IRON, 0.007)
    found = []
    for shares in rng.uniform(0.15, 0.85, (8, 2)):
        place = lid(box, modes, (float(shares[0]), float(shares[1])))
        mobility = modes.accelerance([place], [place], frequency, damped(modes))[0, 0] / (2j * np.pi * frequency)
        found.append(mobility.real.mean())
    assert 0.7 < np.mean(found) * 8.0 * np.sqrt(own.bending * own.mass) < 1.4


def test_finer_shapes_change_third_octaves_little() -> None:
    box, frequency, levels = iron_box(), lines_hz(centres_hz(50.0, 5000.0)), []
    for waves in (8.5, 15.0):
        found = housing_modes(box, 9000.0, waves)
        sides = [box_motions(box, found.halves)["gear/front/y"], lid(box, found)]
        levels.append(bands_db(found.accelerance(sides, sides, frequency, damped(found))))
    apart = distance(*levels)
    assert apart.within_6_db >= 0.95
    assert apart.median < 0.5


def test_a_larger_box_has_lower_modes_in_proportion() -> None:
    box, scale = iron_box(), 2.5
    seats = {
        name: replace(seat, **{key: scale * getattr(seat, key) for key in seat.__slots__})
        for name, seat in box.seats.items()
    }
    bolts = tuple(
        replace(
            bolt, x_m=scale * bolt.x_m, z_m=scale * bolt.z_m, patch_m=scale * bolt.patch_m,
            stiffness_n_per_m=tuple(scale * k for k in bolt.stiffness_n_per_m),
        )
        for bolt in box.bolts
    )  # fmt: skip
    thickness = Thicknesses(*(scale * getattr(box.thickness, key) for key in box.thickness.__slots__))
    large = replace(box, size_m=tuple(scale * s for s in box.size_m), seats=seats, bolts=bolts, thickness=thickness)
    small_modes, large_modes = housing_modes(box, 2500.0), housing_modes(large, 1000.0)
    np.testing.assert_allclose(large_modes.frequency_hz * scale, small_modes.frequency_hz, rtol=1e-8)
    shapes = [np.abs(found.shapes([lid(one, found)])) for one, found in ((box, small_modes), (large, large_modes))]
    np.testing.assert_allclose(shapes[1] * scale**1.5, shapes[0], rtol=1e-4, atol=1e-6)


def test_bolts_carry_the_weight_of_a_static_force(iron: HousingModes) -> None:
    box = iron_box()
    sides = [
        motion for bolt in box.bolts for name, motion in bolt_motions(iron.halves, bolt).items() if name[-1] == "y"
    ]
    force = box_motions(box, iron.halves)["gear/front/y"]
    pressed = 1.5e8 * iron.static_flexibility(sides, [force])[:, 0]
    assert pressed.sum() == pytest.approx(1.0, rel=1e-6)


def test_a_place_beyond_the_plate_is_refused(iron: HousingModes) -> None:
    with pytest.raises(ValueError, match="lid"):
        motion_at(iron.halves, PlatePlace("lid", 0.4, 0.05, Axis.Y))


def test_a_box_is_refused_by_name() -> None:
    box = iron_box()
    with pytest.raises(ValueError, match="seat gear"):
        replace(box, seats={"gear": replace(box.seats["gear"], x_m=0.01)})
    with pytest.raises(ValueError, match="free"):
        housing_modes(iron_box(bolts=()))


def test_walls_opposite_each_other_move_as_their_half_says(iron: HousingModes) -> None:
    box = iron_box()
    motions = box_motions(box, iron.halves)
    front, back = iron.shapes([motions["gear/front/x"], motions["gear/back/x"]])
    assert np.allclose(np.abs(front), np.abs(back))
    assert 0.3 < (np.sign(front) == np.sign(back)).mean() < 0.7
