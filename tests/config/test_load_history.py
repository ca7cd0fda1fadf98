"""History of load: what its blocks become."""

from __future__ import annotations

import pytest

from siggen.checks.loading import load_config
from siggen.gearbox import life
from tests.config.minimal import minimal

HISTORY = [[1.0, 60.0, 30.0], [0.5, 0.0, 0.0], [1.5, 42.0, 20.0]]
LIFE = {
    "reference_torque_nm": 60.0,
    "scale": 0.03,
    "interval_h": 1.2,
    "most": 6,
    "history": HISTORY,
}


def test_blocks_wear_and_turn_as_they_say_and_begin_again_after_the_last(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(life, "TORQUE_EXPONENT", 10.0)
    clock = load_config(minimal(states={}, life=LIFE, duration_s=0.05)).life(0).clock
    first, last = 3600.0 * 30.0, 3600.0 * 1.5 * 20.0 * 0.7**10
    assert clock.time(1.25) == pytest.approx(first / 0.03, rel=1e-12)  # standstill wears nothing
    assert clock.time(7.0) == pytest.approx((3 * first + 2 * last) / 0.03, rel=1e-12)  # two rounds, and an hour
    assert clock.turns(4.0) == pytest.approx(3600.0 * (2 * 30.0 + 1.5 * 20.0), rel=1e-12)
    for time in (0.3 * first / 0.03, (first + 0.5 * last) / 0.03, 2.6 * (first + last) / 0.03):
        assert clock.time(clock.age_h(time)) == pytest.approx(time, rel=1e-12)
