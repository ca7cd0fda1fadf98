"""One plate of the box alone, and plates that meet at edges."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from siggen.drivetrain.box import SIDES, Axis, Box, Rib, Strip, plane_axes
from siggen.drivetrain.box_energy import Energies, add_even_plate, box_energy, sheet
from siggen.drivetrain.box_functions import VALUE
from tests.dynamics.housing.boxes import IRON, halves_of, iron_box


def supported_lid_hz(thickness_m: float, odd: bool) -> np.ndarray:
    """Natural frequencies of the lid of the iron box alone, simply supported."""
    half = halves_of(iron_box())[int(odd)]
    size = (half.shared.coordinates, half.shared.coordinates)
    energies = Energies(np.zeros(size), np.zeros(size))
    add_even_plate(half, "lid", IRON, sheet(IRON, thickness_m), energies)
    own = half.component("lid", Axis.Y)
    kinds = [np.array(half.lines[axis].names.kind)[f] for axis, f in ((Axis.X, own.first), (Axis.Z, own.second))]
    free = own.coordinate[(kinds[0] != VALUE) & (kinds[1] != VALUE)]
    values = eigh(*(matrix[np.ix_(free, free)] for matrix in energies), eigvals_only=True)
    return np.sqrt(values) / (2.0 * np.pi)


def wave_numbers() -> np.ndarray:
    """Of the nine lowest modes of the simply supported lid, 320 x 140 mm."""
    m, n = np.meshgrid(np.arange(1, 12), np.arange(1, 8))
    return np.sort(np.pi * np.hypot(m / 0.32, n / 0.14), axis=None)[:9]


def test_a_thin_supported_plate_has_the_frequencies_of_the_textbook() -> None:
    thin = sheet(IRON, 1e-4)
    found = np.sort(np.concatenate([supported_lid_hz(1e-4, odd) for odd in (False, True)]))[:9]
    exact = wave_numbers() ** 2 * np.sqrt(thin.bending / thin.mass) / (2.0 * np.pi)
    # 1 %: corners of the box cannot twist, those of a supported plate do. Energies bound frequencies from above.
    np.testing.assert_allclose(found, exact, rtol=0.01)
    assert (found > exact * (1.0 - 1e-9)).all()


def test_a_thick_supported_plate_is_mindlins_to_first_order() -> None:
    h, k, nu, kappa = 0.012, wave_numbers(), IRON.poisson_ratio, 5.0 / 6.0
    shear = kappa * IRON.youngs_modulus_pa / (2.0 * (1.0 + nu)) * h
    plate, rotary = sheet(IRON, h), IRON.density_kg_m3 * h**3 / 12.0
    # Mindlin: (B k² + G' - J ω²)(G' k² - m ω²) = G'² k², lower root.
    a, c = rotary * plate.mass, plate.bending * shear * k**4
    b = plate.mass * (plate.bending * k**2 + shear) + rotary * shear * k**2
    exact = np.sqrt((b - np.sqrt(b * b - 4.0 * a * c)) / (2.0 * a)) / (2.0 * np.pi)
    found = np.sort(np.concatenate([supported_lid_hz(h, odd) for odd in (False, True)]))[:9]
    # k h reaches 0.75 here, and thin plates would lie 9 % high; second order is (k h)^4 x 0.02.
    np.testing.assert_allclose(found, exact, rtol=0.01)


@pytest.mark.parametrize("odd", [False, True])
def test_a_free_box_moves_and_turns_without_energy(odd: bool) -> None:
    box = iron_box(bolts=())
    energies, _ = box_energy(box, halves_of(box)[int(odd)])
    values = eigh(*energies, eigvals_only=True)
    # 1e-9 of the lowest elastic mode is what rounding of stiffnesses of 1e12 N/m leaves.
    assert np.abs(values[:3]).max() < 1e-9 * values[3]


def translation_kg(box: Box) -> float:
    """Twice the kinetic energy of a housing that moves along x at 1 m/s."""
    half = halves_of(box)[0]
    energies, _ = box_energy(box, half)
    moved = np.zeros(half.shared.coordinates)
    for plate in ("floor", "lid", "gear_end", "pinion_end", "front"):
        own = half.component(plate, Axis.X)
        kinds = [
            np.array(half.lines[axis].names.kind)[f]
            for axis, f in zip(plane_axes(SIDES[plate][0]), (own.first, own.second), strict=True)
        ]
        moved[own.coordinate[(kinds[0] == VALUE) & (kinds[1] == VALUE)]] = 1.0
    return float(moved @ energies.mass @ moved)


STRIPS = (Strip("lid", (0.0, 0.32), (0.0, 0.02), 0.014), Strip("gear_end", (0.0, 0.03), (0.02, 0.12), 0.02),
          Strip("front", (0.0, 0.05), (0.0, 0.24), 0.012))  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "tolerance"),
    [
        ({}, 1e-9),
        ({"strips": STRIPS}, 1e-9),
        ({"ribs": (Rib(0.11, (0.006, 0.07), 0.008, 0.03),)}, 1e-9),
        # Points of a boss lie in another boss or not: 64 of them.
        ({"seats": {n: replace(s, boss_radius_m=0.06) for n, s in iron_box().seats.items()}}, 0.01),
    ],
    ids=["bosses", "strips", "ribs", "bosses that meet"],
)
def test_kinetic_energy_of_a_translation_is_that_of_the_mass(changes: dict, tolerance: float) -> None:
    box = iron_box(**changes)
    assert translation_kg(box) == pytest.approx(box.mass_kg, rel=tolerance)
    assert box.mass_kg != pytest.approx(iron_box(seats={}).mass_kg, rel=1e-3)


def test_ribs_stiffen_the_wall_by_what_a_bar_on_a_plate_does() -> None:
    box = iron_box(seats={})
    ribbed = replace(box, ribs=(Rib(0.16, (0.0, 0.24), 0.008, 0.02),))
    half = halves_of(box)[0]
    bent = []
    for one in (box, ribbed):
        energies, _ = box_energy(one, half)
        own = half.component("front", Axis.Z)
        # Cylindrical bending between the first bubbles: curvature along y alone, w = f(y) at every x.
        names_x, names_y = half.lines[0].names, half.lines[1].names
        across = [names_x.find(VALUE, end, -1) for end in (0, 1)]
        bubble = names_y.order.index(1)
        chosen = own.coordinate[np.isin(own.first, across) & (own.second == bubble)]
        moved = np.zeros(half.shared.coordinates)
        moved[chosen] = 1.0
        bent.append(moved @ energies.stiffness @ moved)
    curved = half.integrals[1][2, 2, bubble, bubble]
    inner, outer = 0.004, 0.024
    bar = IRON.youngs_modulus_pa * 0.008 * (outer**3 - inner**3) / 3.0
    # Two walls; the bar stands on the middle surface's strain: E b (z_2³ - z_1³)/3 by two points of Gauss's rule.
    assert bent[1] - bent[0] == pytest.approx(2.0 * bar * curved, rel=1e-6)


def test_plates_share_displacement_and_rotation_at_an_edge() -> None:
    box = iron_box()
    rng = np.random.default_rng(0)
    x = np.linspace(0.0, 0.32, 9)
    for half in halves_of(box):
        moved = rng.standard_normal(half.shared.coordinates)
        on_lid = half.tables("lid", (x, np.zeros_like(x)))
        on_front = half.tables("front", (x, np.full_like(x, 0.24)))
        for axis in Axis:
            np.testing.assert_allclose(half.rows(on_lid, axis) @ moved, half.rows(on_front, axis) @ moved, atol=1e-9)
        turned = half.rows(on_lid, Axis.Y, (0, 1)) @ moved, half.rows(on_front, Axis.Z, (0, 1)) @ moved
        np.testing.assert_allclose(turned[0], -turned[1], atol=1e-7)
