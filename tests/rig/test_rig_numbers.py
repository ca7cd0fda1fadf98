"""What follows from the few numbers of a machine, against its gears' geometry and a catalogue's bearing."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.rig.bearings import BORES_MM, bearing_from, bearing_like
from siggen.rig.rig import Rig
from siggen.rig.rig_numbers import rig_numbers

RIG = Rig(teeth=(25, 56), module_mm=2.0, face_width_mm=20.0, speed_hz=(15.0, 25.0), torque_nm=(20.0, 20.0))


def test_the_stiffness_of_a_bearing_is_the_slope_of_its_deflection() -> None:
    """The force is the slope's integral: delta grows with F^(2/3), so k = 1.5 F/delta; a 6205 has some 1e8 N/m."""
    forces = np.linspace(1e-3, 800.0, 200_001)
    slopes = np.array([bearing_like(25.0).stiffness_n_per_m(force) for force in forces])
    deflection_m = np.trapezoid(1.0 / slopes, forces)
    assert 800.0 / deflection_m * 1.5 == pytest.approx(slopes[-1], rel=1e-3)  # the step near 0 limits the integral
    assert 0.7e8 < slopes[-1] < 1.3e8


def test_masses_and_inertias_are_those_of_the_discs_and_shafts() -> None:
    pinion, gear = rig_numbers(RIG).rotors
    disc = 7850.0 * np.pi / 4 * (0.112**2 - (1e-3 * gear.shaft.diameter_mm) ** 2) * 0.02
    length_m = 1e-3 * RIG.design.length_factor * gear.shaft.span_mm
    shaft = 7850.0 * np.pi / 4 * (1e-3 * gear.shaft.diameter_mm) ** 2 * length_m
    assert gear.mass_kg == pytest.approx(disc + shaft, rel=1e-12)
    assert pinion.inertia_kg_m2 < gear.inertia_kg_m2
    scaled = rig_numbers(Rig((25, 56), 4.0, 40.0, (15.0, 25.0), (160.0, 160.0), bores_mm=(40.0, 60.0)))
    half = rig_numbers(Rig((25, 56), 2.0, 20.0, (15.0, 25.0), (20.0, 20.0), bores_mm=(20.0, 30.0)))
    # Of the same shape, twice as large: masses grow with the cube, inertias with the fifth power.
    assert scaled.rotors[1].mass_kg == pytest.approx(8.0 * half.rotors[1].mass_kg)
    assert scaled.rotors[1].inertia_kg_m2 == pytest.approx(32.0 * half.rotors[1].inertia_kg_m2)


def test_a_record_holds_the_hunting_period_and_the_rate_carries_ten_harmonics() -> None:
    numbers = rig_numbers(RIG)
    assert numbers.duration_s * 15.0 / 1.02 >= 56 + 1
    assert 0.4 * numbers.fs_hz >= 10 * 25 * 25.0


def test_bearings_are_those_of_the_catalogue_and_rollers_stiffer_than_balls() -> None:
    bearing = bearing_from(31.0)
    assert (bearing.bore_mm, bearing.outer_mm, bearing.width_mm) == (35.0, 72.0, 17.0)  # 6207
    forces = np.linspace(1e-3, 8000.0, 200_001)
    slopes = np.array([bearing._replace(rollers=True).stiffness_n_per_m(force) for force in forces])
    assert 8000.0 / np.trapezoid(1.0 / slopes, forces) / 0.9 == pytest.approx(slopes[-1], rel=1e-3)  # delta ~ F^0.9
    assert 2.0 < slopes[-1] / bearing.stiffness_n_per_m(8000.0) < 5.0


def test_shafts_bear_the_torque_that_they_are_made_for_and_carry_seats_of_the_catalogue() -> None:
    for shaft, ratio in zip((rotor.shaft for rotor in rig_numbers(RIG).rotors), (1.0, 56 / 25), strict=True):
        assert {shaft.diameter_mm, shaft.bearing.bore_mm} <= set(BORES_MM)
        stress_n_mm2 = 16e3 * ratio * RIG.design.torque_factor * 20.0 / (np.pi * shaft.bearing.bore_mm**3)
        assert stress_n_mm2 < RIG.design.shear_n_per_mm2
        assert shaft.bearing.bore_mm < shaft.diameter_mm < 2.0 * 25 * ratio - 5.0


def test_balls_of_the_catalogue_bear_what_makers_print() -> None:
    """Static ratings (kN, from memory): ISO 76, C_0 = 13.8 Z D², within 5 % with balls of 0.3 of the height."""
    for bore_mm, rating_kn in ((25.0, 7.8), (30.0, 11.2), (35.0, 15.3)):
        bearing = bearing_from(bore_mm)
        assert 13.8e-3 * bearing.balls * bearing.ball_mm**2 == pytest.approx(rating_kn, rel=0.05)
    for bore_mm, series, ball_mm in ((30.0, 60, 7.144), (35.0, 60, 7.938), (30.0, 63, 12.303), (35.0, 63, 13.494)):
        assert bearing_from(bore_mm, series).ball_mm == pytest.approx(ball_mm, rel=0.03)  # from memory
