"""Flank waves drawn from a configuration, and the lines that they make in records."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.gearbox import flank_waves
from siggen.gearbox.design import SetDesign
from siggen.gearbox.flank_waves import CLAMPING, SpecimenWaves
from tests.simulated import label_names, simulate


class Fixed(NamedTuple):
    """In place of a distribution: one number."""

    value: float

    def at(self, _: float) -> float:
        return self.value


SHORT = ["specimens=20", "operating_points=[{speed_hz: 30.0, torque_nm: 30.0}]"]


def made(waves: str = "on", *overrides: str) -> SetDesign:
    section = f"manufacture={{accuracy_class: 6, tolerance_share: 0, flank_waves: {waves}}}"
    return load_config("tests/configs/casing.yaml", [*SHORT, section, *overrides])


def waves_of(config: SetDesign, specimen: int, state: int) -> SpecimenWaves | None:
    teeth = config.gearbox(specimen).meshes[0].teeth
    return teeth.waves(teeth.drawn_for(state))


def record(config: SetDesign) -> SimulatedRecord:
    found = simulate(config, [0])[0]
    assert isinstance(found, SimulatedRecord), found
    return found


def test_all_states_share_their_waves_and_gearboxes_do_not() -> None:
    config = made()
    first, second, other = (waves_of(config, *owner) for owner in ((0, 0), (0, 1), (1, 0)))
    assert first is not None
    assert second is not None
    assert other is not None
    np.testing.assert_array_equal(first.gear.own_m, second.gear.own_m)
    np.testing.assert_array_equal(first.pinion.waves, second.pinion.waves)
    assert not np.array_equal(first.pinion.common_m, other.pinion.common_m)
    assert waves_of(made("off"), 0, 0) is None


def test_ghosts_are_as_many_as_poisson_says_and_fall_with_their_number(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in (("GHOSTS", 2.0), ("GHOST_UM", Fixed(0.1)), ("LAG_OVER_FACE_RAD", Fixed(0.0))):
        monkeypatch.setattr(flank_waves, name, value)
    # fewer waves than are drawn, too: those are not larger than what is drawn
    monkeypatch.setattr(flank_waves, "ORDER_OVER_TEETH", flank_waves.LogUniform(low=1.0, high=15.0))
    config = made()
    pair = config.gearbox(0).pair
    found = [waves_of(config, specimen, 0) for specimen in range(150)]
    counts = [drawn.ghosts["gear"] for drawn in found if drawn is not None]
    # 150 of mean and variance 2: 0.12
    assert abs(np.mean(counts) - 2.0) < 0.4
    for drawn in found:
        assert drawn is not None
        count, waves = drawn.ghosts["gear"], drawn.gear
        assert tuple(waves.waves[count:]) == CLAMPING
        expected = 0.1e-6 * np.minimum(2.3 * pair.gear.teeth / waves.waves[:count], 1.0)
        np.testing.assert_allclose(waves.amplitude_m[:count], expected)


def test_a_ghost_is_a_line_of_the_record_at_its_order(monkeypatch: pytest.MonkeyPatch) -> None:
    sizes = {"GHOST_UM": 0.3, "CLAMPING_UM": 0.0, "COMMON_UM": 0.0, "OWN_UM": 0.0}
    for name, size in sizes.items():
        monkeypatch.setattr(flank_waves, name, Fixed(size))
    found = []
    for ghosts in (0.0, 4.0):
        monkeypatch.setattr(flank_waves, "GHOSTS", ghosts)
        found.append(record(made("on", "duration_s=0.5", "fs_hz=51200.0")))
    silent, loud = found
    assert set(loud.labels) == set(label_names(made()))
    orders = loud.labels["ghost_orders_pinion"]
    assert isinstance(orders, list)
    assert orders
    channel = next(iter(loud.channels))
    turn = 2.0 * np.pi * 30.0 * np.arange(25600) / 51200.0

    def line(found: SimulatedRecord, order: float) -> float:
        return float(2.0 * np.abs((found.channels[channel] * np.exp(-1j * order * turn)).mean()))

    for order in orders:
        beside = max(line(loud, order - 0.4), line(loud, order + 0.6))
        assert line(loud, order) > 3.0 * max(line(silent, order), beside)
