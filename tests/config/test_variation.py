"""Section `variation` and forces of the shafts: defaults that say nothing, ranges, the band at the highest speed."""

from __future__ import annotations

import pytest

from siggen.checks.loading import load_config
from siggen.config import parse
from siggen.errors import ConfigError
from tests.config.minimal import config, design, minimal
from tests.simulated import label_names

RANDOM = {"speed": {"random_rms": 0.003}}


def paths(**changes) -> list[str]:
    return [problem.path for problem in parse(minimal(**changes)).problems]


def physical(**changes) -> list[str]:
    with pytest.raises(ConfigError) as caught:
        load_config(minimal(**changes))
    return [str(problem) for problem in caught.value.problems]


def test_an_empty_section_is_none_at_all():
    assert not config(variation={}).variation.active
    assert config(variation={"speed": {}, "torque": {"load_once": 0.0}}).identity == config().identity
    assert config(variation=RANDOM).identity != config().identity


def test_labels_of_the_variation_are_there_with_it_and_only_then():
    added = set(label_names(design(variation=RANDOM))) - set(label_names(design()))
    assert added == {"speed_std_hz", "mean_torque_nm", "torque_std_nm"}
    assert set(label_names(design())) <= set(label_names(design(variation=RANDOM)))
    assert label_names(design(dynamics__unbalance={"grade_mm_s": 6.3})) == label_names(design())


@pytest.mark.parametrize(
    ("key", "value"),
    [("start_ratio", 0.0), ("end_ratio", -1.0), ("random_rms", 0.2), ("ripple_once", 0.5), ("slip", 1.0)],
)  # fmt: skip
def test_speeds_that_might_stop_or_turn_back_are_refused_by_name(key, value):
    assert paths(variation={"speed": {key: value}}) == [f"variation.speed.{key}"]


def test_mesh_harmonics_must_fit_the_band_at_the_highest_speed_of_a_run_up():
    assert paths(variation={"speed": {"end_ratio": 4.0}}) == []
    assert paths(variation={"speed": {"end_ratio": 7.0}}) == ["fs_hz"]
    assert paths(variation={"speed": {"end_ratio": 6.79, "random_rms": 0.0}}) == []
    assert paths(variation={"speed": {"end_ratio": 6.79, "random_rms": 0.005}}) == ["fs_hz"]


def test_a_run_down_that_the_load_would_drive_is_refused_by_name():
    (said,) = physical(variation={"speed": {"end_ratio": 0.1}}, operating_points__0__torque_nm=0.1)
    assert said.startswith("variation.speed.end_ratio: received -0.9 of 30 Hz in 1 s")
    assert "raise end_ratio, duration_s or the torque" in said
    # Light torque that rattles is allowed, and so is the same torque without run-down.
    light = minimal(variation={"torque": {"load_once": 2.0}}, operating_points__0__torque_nm=0.1)
    assert load_config(light).config.variation.active


def test_a_motor_that_its_slip_would_stall_is_refused_by_name():
    (said,) = physical(variation={"speed": {"slip": 0.1}}, dynamics={"rated_torque_nm": 6.0})
    assert said.startswith("variation.speed.slip: received 0.1 at 6 N m, which is 100% at 60 N m")
