"""What a plan says about torques that change their sign within a record."""

from __future__ import annotations

import pytest

from siggen.checks.notes import reversal_notes
from tests.config.minimal import design


def reversals(**torque) -> list[str]:
    return list(reversal_notes(design(variation={"torque": torque}).possible))


@pytest.mark.parametrize(
    "torque",
    [{"load_once": 1.0}, {"line_ripple": 0.99}, {"load_once": 0.6, "line_ripple": 0.6}, {"random_rms": 0.1}],
)
def test_torques_that_stay_positive_are_not_remarked(torque):
    # Load and motor each see their own pulsation alone.
    assert reversals(**torque) == []


def test_a_load_that_drives_is_remarked_with_its_least_torque():
    (note,) = reversals(load_once=1.5)
    assert note == (
        "load torque falls to -50 % of its mean: the load then drives, and "
        "teeth may lose contact or touch on the other flank"
    )


def test_the_largest_draw_decides_and_rare_random_values_count():
    often = [0.1, 1.2]
    (note,) = reversals(line_ripple=often)
    assert note.startswith("motor torque falls to -20 % of its mean: the motor then brakes")
    # Four standard deviations of 5 % beside a pulsation of 90 %.
    assert reversals(load_once=0.9) == []
    (note,) = reversals(load_once=0.9, random_rms=0.05)
    assert note.startswith("load torque falls to -10 % of its mean")
    assert len(reversals(load_once=2.0, line_ripple=2.0)) == 2
