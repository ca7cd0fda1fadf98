"""Events behind a path stand again where they happened; a tooth that the labels name is found on other gearboxes."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.signal import freqz, zpk2tf

from diagnostics.audit.averaged_lines import whitened
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.audit.signal_detectors import tooth_detector
from diagnostics.signal.innovations import innovations

TEETH, STEPS = 18, 1024
GEARBOXES, RECORDS = 20, 3
SPECIMEN, DAMAGED = np.repeat(np.arange(GEARBOXES), RECORDS), np.tile([False, False, True], GEARBOXES)


def path(rng: np.random.Generator) -> np.ndarray:
    """Return the response (orders,) of five damped modes with antiresonances between; all within the unit circle."""
    angles = (np.arange(10) + rng.uniform(0.2, 0.8, 10)) * 0.3
    roots = rng.uniform(0.85, 0.96, 10) * np.exp(1j * angles)
    zeros, poles = (np.concatenate([part, part.conj()]) for part in (roots[::2], roots[1::2]))
    return np.asarray(freqz(*zpk2tf(zeros, poles, 1.0), worN=STEPS // 2 + 1, include_nyquist=True)[1])


def event(rng: np.random.Generator, angle: int, height: float) -> np.ndarray:
    """Return lines (orders,) of white noise with one short event, behind a path that was drawn."""
    wave = rng.standard_normal(STEPS)
    wave[angle] += height
    return np.asarray(np.fft.rfft(wave) / STEPS * path(rng))


def test_an_event_behind_modes_stands_again_where_it_happened() -> None:
    rng, angles = np.random.default_rng(0), np.random.default_rng(1).integers(0, STEPS, 40)
    lines = np.array([event(rng, int(angle), 8.0) for angle in angles])[:, None]
    waves = np.fft.irfft(innovations(lines, np.full(40, TEETH)), STEPS, axis=-1)[:, 0]
    still_smeared = np.fft.irfft(whitened(lines), STEPS, axis=-1)[:, 0]
    # 8 sigma: the largest of 1024 numbers of noise stays below 4; zero phase spreads it over both sides
    assert (np.abs(waves).argmax(axis=1) == angles).mean() > 0.9
    assert (np.abs(still_smeared).argmax(axis=1) == angles).mean() < 0.75
    flat = np.abs(np.fft.rfft(waves)[:, 9:-9])
    assert np.abs(np.log(flat[:, : STEPS // 4]).mean(axis=1) - np.log(flat[:, STEPS // 4 :]).mean(axis=1)).max() < 0.2


def test_channels_without_lines_stay_as_they_are_and_change_nothing_of_the_others() -> None:
    rng = np.random.default_rng(2)
    lines = np.array([[event(rng, 5, 0.0), np.zeros(STEPS // 2 + 1), np.full(STEPS // 2 + 1, np.nan)]])
    found = innovations(lines, np.array([TEETH]))
    assert np.array_equal(found[:, 1:], lines[:, 1:], equal_nan=True)
    assert np.array_equal(found[:, :1], innovations(lines[:, :1], np.array([TEETH])))
    assert not np.array_equal(found[:, :1], lines[:, :1])


def measured(rng: np.random.Generator) -> tuple[MeasuredSet, np.ndarray]:
    """Return healthy records and one with an event of 6 sigma at a named tooth per gearbox, behind a path each."""
    tooth = rng.integers(0, TEETH, GEARBOXES)
    place = np.round((tooth[SPECIMEN] + 0.75) * STEPS / TEETH).astype(int) % STEPS
    lines = np.array([event(rng, place[row], 6.0 * DAMAGED[row]) for row in range(SPECIMEN.size)])[:, None]
    faulty = np.empty(SPECIMEN.size, dtype=object)
    faulty[:] = [
        [int(tooth[gearbox]), TEETH] if ill else []  # a number that counts from 1 is passed over
        for gearbox, ill in zip(SPECIMEN, DAMAGED, strict=True)
    ]
    labels = {"teeth_pinion": np.full(SPECIMEN.size, TEETH), "faulty_teeth_pinion": faulty}
    return of_labels(labels), innovations(lines, labels["teeth_pinion"])


def of_labels(labels: dict[str, Any]) -> MeasuredSet:
    about = {quantity: {"pinion": f"{quantity}_pinion"} for quantity in ("teeth", "faulty_teeth")}
    return MeasuredSet(labels, (), {}, (), [], [], np.empty((0, 0)), {}, [], about=about)


def test_an_event_at_a_named_tooth_is_found_on_other_gearboxes_and_nothing_without_one() -> None:
    found, lines = measured(np.random.default_rng(3))
    detector = tooth_detector("teeth", found, lines)
    assert detector is not None
    train = SPECIMEN < GEARBOXES // 2
    learn, asked = np.flatnonzero(train), np.flatnonzero(~train)
    score = detector.make().fit(learn, DAMAGED[None, train], SPECIMEN[train]).score(asked)[0]
    held = DAMAGED[~train]
    assert np.mean(score[held][:, None] > score[~held]) > 0.9
    nothing = tooth_detector("teeth", of_labels({"teeth_pinion": np.array([18])}), lines)
    assert nothing is None
