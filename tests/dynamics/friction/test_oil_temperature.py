"""Oil takes the temperature at which its box gives off what its gears, bearings and seals lose."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import pytest

from siggen import load_config
from siggen.gearbox.specimen import OperatingPoint
from siggen.gearbox.sump import Sump, at_work
from siggen.mesh.oil import MINERAL_OILS
from siggen.mesh.oil_temperature import HEAT_TRANSFER_W_PER_M2_K, HOTTEST_SUMP_C, MeshAtWork, loss_w, sump_c
from tests.dynamics.friction.mesh_loss import mesh_power_loss
from tests.simulated import simulate

OIL = MINERAL_OILS["ISO VG 220"]


@pytest.fixture(scope="module")
def sump() -> Sump:
    found = load_config("quickstart").gearbox(0).oil_c
    assert isinstance(found, Sump)
    return found


def _oil_c(sump: Sump, speed_hz: float, torque_nm: float, **changed: float) -> float:
    return replace(sump, **{"warm_share": 1.0, **changed})(OperatingPoint(speed_hz, torque_nm))


def test_at_rest_and_in_a_boundless_box_it_is_that_of_the_air(sump: Sump) -> None:
    assert _oil_c(sump, 0.0, 60.0) == sump.air_c
    assert _oil_c(sump, 37.0, 60.0, area_m2=1e9) == pytest.approx(sump.air_c, abs=1e-5)
    assert _oil_c(sump, 37.0, 60.0, warm_share=0.0) == sump.air_c


@pytest.mark.parametrize(("speed_hz", "torque_nm"), [(5.0, 40.0), (37.0, 60.0), (30.0, 6.0), (30.0, 0.0)])
def test_what_is_lost_leaves_through_the_walls(sump: Sump, speed_hz: float, torque_nm: float) -> None:
    warm_c = _oil_c(sump, speed_hz, torque_nm)
    assert sump.air_c < warm_c < HOTTEST_SUMP_C
    lost_w = loss_w(*at_work(sump.gearbox, OperatingPoint(speed_hz, torque_nm)), OIL, warm_c)
    given_off_w = HEAT_TRANSFER_W_PER_M2_K * sump.area_m2 * (warm_c - sump.air_c)
    assert lost_w == pytest.approx(given_off_w, rel=1e-5)  # the root is found to 1e-6 K
    half_c = _oil_c(sump, speed_hz, torque_nm, warm_share=0.5)
    assert half_c == pytest.approx(0.5 * (sump.air_c + warm_c))


def test_it_rises_with_speed_and_torque_until_a_cooler_holds_it(sump: Sump) -> None:
    by_speed = [_oil_c(sump, speed_hz, 40.0) for speed_hz in (2.0, 5.0, 10.0, 20.0, 40.0)]
    by_torque = [_oil_c(sump, 30.0, torque_nm) for torque_nm in (0.0, 6.0, 20.0, 60.0)]
    assert by_speed == sorted(by_speed)
    assert by_torque == sorted(by_torque)
    assert _oil_c(sump, 400.0, 60.0) == HOTTEST_SUMP_C
    assert sump_c(lambda _: 1e9, 20.0, 0.2, 0.25) == pytest.approx(20.0 + 0.25 * (HOTTEST_SUMP_C - 20.0))


def test_gears_lose_what_sliding_with_their_coefficient_takes(sump: Sump) -> None:
    pair, force_n = sump.gearbox.pair, 40.0 / sump.gearbox.pair.pinion.base_radius_m
    mesh = MeshAtWork(pair, 5.0, force_n, 0.4e-6)
    viscosity = OIL.viscosity_pa_s(50.0)
    by_quadrature = mesh_power_loss(pair, mesh.coefficient(viscosity), 40.0, 2.0 * pi * 5.0)
    assert mesh.loss_w(viscosity) == pytest.approx(by_quadrature, rel=1e-4)  # that of its cells
    assert mesh.coefficient(viscosity) == pytest.approx(0.044, rel=0.02)  # of the table of methods.md, three digits


def test_planets_and_trains_warm_their_oil_too() -> None:
    for preset in ("planetary", "two_stage"):
        found = load_config(preset, overrides=["dynamics.friction.oil_temperature_c=null"]).gearbox(0)
        assert isinstance(found.oil_c, Sump)
        assert found.oil_c.air_c < found.law.friction.oil_temperature_c < HOTTEST_SUMP_C


def test_a_record_says_how_warm_its_oil_was_and_a_given_number_holds() -> None:
    short = ["duration_s=0.1", "specimens=1"]
    design = load_config("quickstart", overrides=short)
    record = simulate(design, [0])[0]
    assert record.labels["oil_temperature_c"] == design.gearbox(0).law.friction.oil_temperature_c
    given = load_config("quickstart", overrides=[*short, "dynamics.friction.oil_temperature_c=50"])
    assert given.gearbox(0).oil_c is None
    assert simulate(given, [0])[0].labels["oil_temperature_c"] == 50.0
