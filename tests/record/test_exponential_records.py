from __future__ import annotations

import numpy as np
import pytest

import siggen
from siggen.config import by_reference

TOLERANCE = 1e-3
"""The default of `dynamics.integration_tolerance`."""
PARALLEL = ("dynamics.shafts=null",)


def channel_errors(gearboxes: int, *overrides: str) -> dict[str, list[float]]:
    """Return by state the relative rms difference of all channels from Runge-Kutta with 32 steps per sample."""
    short = ("duration_s=0.1", *overrides)
    fast = siggen.load_config("configs/quickstart.yaml", [*short])
    fine = fast.model_copy(update={"dynamics": by_reference(fast.dynamics, 32)})
    assert fast.dynamics.method == "exponential"
    ids = [first + state for first in range(0, 4 * gearboxes, 4) for state in (0, 3)]
    found: dict[str, list[float]] = {}
    for one, other in zip(siggen.simulate(fine, ids), siggen.simulate(fast, ids), strict=True):
        for name, signal in one.channels.items():
            wanted, got = signal.astype(float), other.channels[name].astype(float)
            error = float(np.sqrt(np.mean((got - wanted) ** 2) / np.mean(wanted**2)))
            found.setdefault(str(one.labels["state"]), []).append(error)
    return found


@pytest.mark.parametrize("overrides", [pytest.param(PARALLEL, marks=pytest.mark.slow), ()], ids=["parallel", "tilting"])
def test_records_meet_the_tolerance_healthy_and_damaged_alike(overrides: tuple[str, ...]) -> None:
    found = channel_errors(1, *overrides)
    assert set(found) == {"healthy", "severe"}
    assert max(max(errors) for errors in found.values()) < TOLERANCE


@pytest.mark.slow
@pytest.mark.parametrize("overrides", [PARALLEL, ()], ids=["parallel", "tilting"])
def test_records_of_many_gearboxes_meet_the_tolerance(overrides: tuple[str, ...]) -> None:
    found = channel_errors(6, *overrides)
    assert max(max(errors) for errors in found.values()) < TOLERANCE


def test_the_tolerance_counts_in_an_identity() -> None:
    fast, tight = (
        siggen.load_config("configs/quickstart.yaml", overrides).identity
        for overrides in (
            [],
            ["dynamics.integration_tolerance=1e-4"],
        )
    )
    assert fast != tight
