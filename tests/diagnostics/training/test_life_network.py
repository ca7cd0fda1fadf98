"""The sequence network of lives: what it learns where averages tell the end, and that it never falls far behind age."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.training.average_rows import STEPS, AveragedRecords, average_rows
from diagnostics.training.lives import remaining_of_age, weibull_lives

torch = pytest.importorskip("torch")

UNITS, TEETH = 30, 20


def errors(*, told: bool) -> tuple[float, float, np.ndarray]:
    """Return errors of network and age, and what the network says, of every fifth gearbox.

    Averages have one line that rises in the last 30 h, or noise alone.
    """
    from diagnostics.training.life_network import LifeSequences, network_quantiles

    rng = np.random.default_rng(20261127)
    lives_h = rng.uniform(30.0, 80.0, UNITS)
    rows = [(unit, age, life - age) for unit, life in enumerate(lives_h) for age in np.arange(0.0, life, 10.0)]
    unit, age_h, rul_h = np.array(rows).T
    lines = np.zeros((unit.size, 1, STEPS // 2), np.complex64)
    lines[:, 0, 3:40] = rng.standard_normal((unit.size, 37)) + 1j * rng.standard_normal((unit.size, 37))
    lines[:, 0, TEETH] = 10.0
    if told:
        lines[:, 0, TEETH + 1] += np.maximum(4.0 * (30.0 - rul_h), 0.0)
    test = unit % 5 == 0
    law = weibull_lives(lives_h[np.arange(UNITS) % 5 > 0], np.empty(0))
    of_age_h = remaining_of_age(age_h, *law)
    seen = average_rows(AveragedRecords(lines, np.full(unit.size, TEETH), ("a",)))
    found = network_quantiles(LifeSequences(seen, unit, age_h, rul_h, of_age_h), 1, ~test, test)
    rmse = (float(np.sqrt(np.mean((one[:, 1] - rul_h[test]) ** 2))) for one in (found, of_age_h[test]))
    return (*rmse, found)  # type: ignore[return-value]


def test_averages_that_tell_the_end_are_learned() -> None:
    network_h, age_h, found = errors(told=True)
    assert network_h < 0.85 * age_h  # nobody can know more than age before the last 30 h
    assert np.all(np.diff(found, axis=1) >= 0.0)


def test_the_same_seed_gives_the_same_quantiles_to_the_last_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("diagnostics.training.life_network.STEPS", 20)
    np.testing.assert_array_equal(errors(told=True)[2], errors(told=True)[2])


@pytest.mark.slow  # trains it once more
def test_averages_that_tell_nothing_leave_about_what_age_tells() -> None:
    network_h, age_h, _ = errors(told=False)
    assert network_h < 1.1 * age_h
