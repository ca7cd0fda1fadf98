"""The audit's network is that of `report`: it finds a burst wherever it stands, and says the same twice."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from diagnostics.audit import signal_detectors
from diagnostics.audit.measured_set import MeasuredSet

GEARBOXES, STEPS = 16, 1024
SPECIMEN, DAMAGED = np.repeat(np.arange(GEARBOXES), 3), np.tile([False, False, True], GEARBOXES)


def bursts() -> MeasuredSet:
    """Three averages of noise a gearbox; a short burst at any angle of the last one."""
    rng = np.random.default_rng(4)
    waves = rng.standard_normal((SPECIMEN.size, STEPS))
    for row in np.flatnonzero(DAMAGED):
        waves[row, rng.integers(STEPS - 24) + np.arange(24)] += 5.0 * np.sin(0.8 * np.arange(24))
    lines = np.fft.rfft(waves)[:, : STEPS // 2].astype(np.complex64) / STEPS
    found = SimpleNamespace(
        waveforms=[[row] for row in lines], labels={"specimen_id": SPECIMEN}, channels=("a",), healthy=~DAMAGED,
        teeth=np.full(SPECIMEN.size, 18),
    )  # fmt: skip
    return cast(MeasuredSet, found)


@pytest.mark.parametrize("referenced", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_it_finds_a_burst_wherever_it_is_and_says_the_same_twice(
    referenced: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("torch")
    monkeypatch.setattr(signal_detectors, "SHOWN", 900)
    # the other healthy record of the gearbox: record 1 for record 0, record 0 for the others
    reference = np.array([1, 0, 0] * GEARBOXES) + 3 * SPECIMEN if referenced else None

    def score() -> np.ndarray:
        detector = signal_detectors.network_detector("network", bursts(), reference, 0)
        assert detector is not None
        assert detector.usable.all()
        assert not detector.many
        learn, places = SPECIMEN < 10, np.arange(SPECIMEN.size)
        return detector.make().fit(places[learn], DAMAGED[None, learn], SPECIMEN[learn]).score(places[~learn])[0]

    first, held = score(), DAMAGED[SPECIMEN >= 10]
    assert np.mean(first[held][:, None] > first[~held]) > 0.9
    assert np.array_equal(first, score())


def test_a_record_without_average_or_reference_is_not_asked_about() -> None:
    pytest.importorskip("torch")
    found = bursts()
    found.waveforms[3] = [np.empty(0, np.complex64)]
    reference = np.where(SPECIMEN == 0, -1, 3)  # the references of all others are record 3, which has no average
    alone = signal_detectors.network_detector("network", found, None, 0)
    beside = signal_detectors.network_detector("network", found, reference, 0)
    assert alone is not None
    assert beside is not None
    assert np.flatnonzero(~alone.usable).tolist() == [3]
    assert not beside.usable.any()
