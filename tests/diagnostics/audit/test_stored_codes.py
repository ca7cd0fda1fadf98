"""Codes that come at random have one law at any level; a converter that avoids or prefers some breaks it."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.audit.stored_codes import FEWEST_STEPS, code_law

STEP, SAMPLES = 2.0**-7, 20_000
LEVELS = (0.3, 3.0, 30.0)


def stored(codes: np.ndarray) -> dict[str, np.ndarray]:
    return {"a": (codes * STEP).astype(np.float32)}


def drawn(level: float, seed: int) -> np.ndarray:
    return np.round(np.random.default_rng(seed).normal(0.0, level, SAMPLES) / STEP)


def numbers(name: str, level: float, change: object = None) -> np.ndarray:
    """Return a number of twelve records."""
    assert change is None or callable(change)
    every = (drawn(level, seed) for seed in range(12))
    return np.array([code_law(stored(change(codes) if change else codes))[f"{name} of a"] for codes in every])


@pytest.mark.parametrize("level", LEVELS)
def test_unevenness_of_codes_at_random_is_that_of_counting_at_any_level(level: float) -> None:
    found = numbers("unevenness", level)
    # the mean of twelve, by their own scatter; four standard errors are exceeded once in 15,000
    assert abs(found.mean() - 1.0) < 4.0 * found.std(ddof=1) / np.sqrt(found.size)


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("unevenness modulo 16", lambda codes: codes + (codes % 16 == 5)),
        ("unevenness modulo 2", lambda codes: codes + (codes % 2 == 1) * (np.arange(SAMPLES) % 2)),
        ("zeros", lambda codes: np.where(np.abs(codes) < 4, 0.0, codes)),
        ("odd ones of large codes", lambda codes: np.where(np.abs(codes) > codes.std(), codes // 2 * 2, codes)),
        ("runs that stand twice", lambda codes: np.concatenate([codes[:-300], codes[100:400]])),
        ("low bits beside the next", lambda codes: codes // 2 * 2 + np.arange(SAMPLES) // 4 % 2),
    ],
)
def test_a_broken_law_lies_outside_of_all_records_that_keep_it(name: str, change: object) -> None:
    kept, broken = numbers(name, 3.0), numbers(name, 3.0, change)
    assert broken.min() > kept.max() or broken.max() < kept.min()


def test_quiet_signals_and_such_without_steps_tell_nothing() -> None:
    quiet = np.round(np.random.default_rng(0).normal(0.0, FEWEST_STEPS / 4.0, SAMPLES))
    smooth = {"a": np.random.default_rng(0).normal(size=SAMPLES).astype(np.float32)}
    for found in (code_law(stored(quiet)), code_law(smooth)):
        assert set(found.values()) == {0.0}
