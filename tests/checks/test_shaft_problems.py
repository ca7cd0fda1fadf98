"""Shafts that cannot be: refused with key, value and what is allowed."""

from __future__ import annotations

import pytest

from siggen.checks.loading import load_config
from siggen.checks.shaft_notes import shaft_notes
from siggen.columns.record import RecordFailure
from siggen.errors import ConfigError
from siggen.record.simulation import simulate
from tests.config.minimal import minimal


def with_shafts(model: str = "casing", **pinion: float) -> dict[str, object]:
    return minimal(dynamics={"model": model, "shafts": {"pinion": pinion}, "mesh": {"contact": "face"}})


@pytest.mark.parametrize(
    ("pinion", "key", "words"),
    [
        ({"bearing_span_mm": 0.0}, "bearing_span_mm", "above 0"),
        ({"bearing_span_mm": 1e6}, "bearing_span_mm", "2000"),
        ({"diameter_mm": 3.0}, "diameter_mm", "at least 5"),
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


def test_plan_says_what_limits_shafts_and_misalignment() -> None:
    assert shaft_notes(load_config(minimal())) == ()
    told = shaft_notes(load_config(with_shafts()))
    assert any("outside_model" in note for note in told)
    assert not any("too hard" in note for note in told)  # teeth give way across the face
    misaligned = load_config(minimal(manufacture={"accuracy_class": 6, "lead_misalignment_um": 5.0}))
    assert [note for note in shaft_notes(misaligned) if "several times too hard" in note]


def test_the_linear_law_has_no_contact_across_the_face() -> None:
    with pytest.raises(ConfigError, match=r"dynamics\.mesh\.contact"):
        load_config(minimal(dynamics={"model": "8dof", "mesh": {"law": "linear", "contact": "face"}}))


@pytest.mark.parametrize(
    ("pinion", "reason"),
    [
        ({"diameter_mm": 20.0, "bearing_span_mm": 200.0, "gear_position": 0.3}, "the flanks tilt by"),
        ({"diameter_mm": 10.0, "gear_position": 0.3}, "the flanks tilt by"),
        ({"diameter_mm": 5.0, "bearing_span_mm": 400.0}, "a gear moves by"),
    ],
)
def test_shafts_that_are_too_soft_end_a_record_with_a_reason(pinion: dict[str, float], reason: str) -> None:
    config = load_config(with_shafts(**pinion) | {"fs_hz": 25600.0, "duration_s": 0.05})
    (failure,) = simulate(config, [0])
    assert isinstance(failure, RecordFailure)
    assert failure.status == "outside_model"
    assert reason in failure.reason
    assert "dynamics.shafts" in failure.reason
