"""A trial: a short record of every state of the first gearboxes, and what of them is lost."""

from __future__ import annotations

from unittest.mock import patch

import pytest
from numba.core.event import trigger_event

from siggen.checks.loading import load_config
from siggen.gearbox.plan import planned_record
from siggen.sets.record_cost import START_S, RecordTime, SetCost, set_cost, timed
from siggen.sets.trial import RECORDS, TURNS, StateTrial, trial
from tests.config.mill import mill
from tests.config.minimal import by_name, design
from tests.config.staged import SPALL
from tests.dataset.fake_set import fake_config, fake_physics, simulate_none, simulate_with_failures


def test_a_trial_says_which_states_lose_records_and_why() -> None:
    told: list[tuple[int, int]] = []
    with fake_physics(
        simulate_with_failures
    ):  # record 3 is gearbox 0 in slight, 8 and 10 gearbox 1 in slight, moderate
        found = trial(fake_config(), 2, lambda done, total: told.append((done, total))).states
    assert [(state.state, state.tried) for state in found] == [("healthy", 2), ("slight", 2), ("moderate", 2)]
    # gearboxes take the operating points in turn: gearbox 0 runs records 0, 2, 4, gearbox 1 runs 7, 9, 11
    assert [state.lost for state in found] == [0, 0, 0]
    with fake_physics(simulate_none):
        found = trial(fake_config(), 99).states
    assert [(state.lost, state.tried) for state in found] == [(5, 5)] * 3
    assert found[0].reason == "diverged (always)"
    assert told == [(i, 6) for i in range(7)]


def test_the_interval_is_wilsons() -> None:
    """Of 10 records 0, 1 and 5: values of the literature (Brown, Cai, DasGupta 2001, formula 4)."""
    assert StateTrial("a", 10, 0).interval == pytest.approx((0.0, 0.2775), abs=1e-4)
    assert StateTrial("a", 10, 1).interval == pytest.approx((0.0179, 0.4042), abs=1e-4)
    assert StateTrial("a", 10, 5).interval == pytest.approx((0.2366, 0.7634), abs=1e-4)


def test_records_of_a_trial_are_short_and_those_of_the_set() -> None:
    whole = design(duration_s=2.0)
    short = whole.shortened(TURNS)
    assert 8 <= short.duration_s * whole.config.operating_points[0].speed_hz < 8.01
    assert planned_record(short, 3) == planned_record(whole, 3)
    assert design(duration_s=0.1).shortened(TURNS).duration_s == 0.1


@pytest.mark.parametrize(("gear", "turns"), [("ida", 1.0), ("eva", 18 / 47), ("karl", 18 / 47 * 17 / 52)])
def test_records_of_a_trial_hold_the_turns_of_the_slowest_gear_with_damage(gear: str, turns: float) -> None:
    states = {"healthy": {}, "severe": {"damage": {**SPALL, "gear": gear, "teeth": 1}}}
    short = load_config(mill(duration_s=10.0, states=states)).shortened(TURNS)
    assert 8 <= turns * short.duration_s * 30.0 < 8.01


def test_a_sample_takes_gearboxes_where_states_are_few_and_states_where_they_are_many() -> None:
    with fake_physics():
        assert [one.tried for one in trial(fake_config()).states] == [1, 1, 1]
        states = [{"name": f"state_{i}"} for i in range(12)]
        found = trial(fake_config(states=by_name(states))).states
    assert [one.tried for one in found] == [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1]
    assert sum(one.tried for one in found) == RECORDS
    assert found[1].interval == (0.0, 1.0)


def test_a_set_costs_by_its_gearboxes_damaged_states_and_seconds_of_signal() -> None:
    """Known: the first record loads 5 s of code, so the gearbox after it tells; 1.9 s of work are 1 s of signal."""
    times = [
        RecordTime(6.0, 3.0, damaged=True),
        RecordTime(1.0, 1.9, damaged=False),
        RecordTime(0.5, 1.9, damaged=True),
    ]
    cost = set_cost(times, 1, 1.0)
    assert cost == SetCost(gearbox_s=1.0, damage_s=0.5, record_s=START_S, signal_s=1.0)
    assert cost.hours(10, 20, 30, 2.0) * 3600 == pytest.approx(10 * 1.0 + 20 * 0.5 + 30 * (START_S + 2.0))
    alone = set_cost(times[:1], 0, 1.0)
    assert (alone.gearbox_s, alone.damage_s, alone.signal_s) == (6.0, 6.0, pytest.approx(3.0 / (1.0 + START_S)))


def test_what_numba_compiles_or_loads_costs_no_record_anything() -> None:
    now_s = 0.0

    def simulate():
        nonlocal now_s
        for compiled_s in (30.0, 0.0):
            now_s += 1.0
            with trigger_event("numba:compiler_lock"):
                now_s += compiled_s
                with trigger_event("numba:compiler_lock"):  # of what the function calls
                    now_s += compiled_s
            now_s += 0.5
            yield object()

    times: list[RecordTime] = []
    with patch("time.thread_time", lambda: now_s):
        assert len(list(timed(simulate(), times))) == 2
    assert times == [RecordTime(0.0, 1.5, damaged=False)] * 2


@pytest.mark.parametrize(
    ("loss", "share", "length_mm", "through", "found"),
    [  # area under the curve in bench, alone and beside a healthy record of the same gearbox:
        (0.015, 0.021, 0.5, False, "hardly"),  # small pits, 0.53 and 0.68
        (0.041, 0.07, 1.0, False, "beside a healthy record"),  # 40 % of the face, 0.59 and 1.00
        (0.204, 0.14, 1.2, False, "yes"),  # 80 % of the face, 0.99
        (1.0, 0.02, 0.13, True, "beside a healthy record"),  # whole face, 0.1 mm, 0.61 and 1.00
        (1.0, 0.04, 0.25, True, "yes"),  # whole face, 0.2 mm, 0.84
        (0.0, 0.0, 0.0, False, ""),  # no pits and no spall
    ],
)
def test_what_is_found_follows_stiffness_and_length_as_in_bench(
    loss: float, share: float, length_mm: float, through: bool, found: str
) -> None:
    tried = StateTrial("a", 3, 0, "", loss, share, length_mm, through)
    assert tried.found == found
