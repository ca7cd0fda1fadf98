"""Shafts that cannot be: refused with key, value and what is allowed."""

from __future__ import annotations

import pytest

from siggen.checks.loading import load_config
from siggen.errors import ConfigError
from tests.config.minimal import minimal


def with_shafts(model: str = "casing", **pinion: float) -> dict[str, object]:
    return minimal(dynamics={"model": model, "shafts": {"pinion": pinion}, "mesh": {"contact": "face"}})


@pytest.mark.parametrize(
    ("pinion", "key", "words"),
    [
        ({"bearing_span_mm": 0.0}, "bearing_span_mm", "above 0"),
        ({"bearing_span_mm": 15.0}, "bearing_span_mm", "bearings beside the gear"),
        ({"gear_position": 1.0}, "gear_position", "below 1"),
        ({"gear_position": 0.01}, "bearing_span_mm", "bearings beside the gear"),
        ({"diameter_mm": 200.0}, "diameter_mm", "root diameter of the pinion"),
    ],
)
def test_impossible_shafts_are_refused_by_key(pinion: dict[str, float], key: str, words: str) -> None:
    with pytest.raises(ConfigError) as refused:
        load_config(with_shafts(**pinion))
    assert f"dynamics.shafts.pinion.{key}" in str(refused.value)
    assert words in str(refused.value)


def test_models_without_a_casing_have_no_shafts_that_bend() -> None:
    with pytest.raises(ConfigError, match=r"dynamics\.shafts"):
        load_config(with_shafts(model="8dof"))


def test_no_section_and_the_default_have_the_same_identity() -> None:
    assert load_config(minimal()).identity == load_config(minimal(dynamics={"shafts": None})).identity
    assert load_config(with_shafts()).identity != load_config(minimal()).identity


def test_a_contact_that_feels_no_tilt_is_refused() -> None:
    with pytest.raises(ConfigError, match="no other contact feels a tilt"):
        load_config(minimal(dynamics={"model": "casing", "shafts": {}}))
