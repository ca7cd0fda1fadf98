from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from siggen.drivetrain.drive import Drive


@given(speed=st.floats(1.0, 200.0), start=st.floats(-300.0, 300.0), duration=st.floats(0.01, 10.0))
def test_tacho_marks_are_the_whole_revolutions_in_the_record(speed: float, start: float, duration: float) -> None:
    drive = Drive(speed, start)
    marks = drive.tacho_s(duration)
    turns = drive.angle_rad(marks) / (2.0 * np.pi)
    assert np.abs(turns - np.round(turns)).max(initial=0.0) < 1e-9
    assert (marks >= 0.0).all()
    assert (marks < duration).all()
    # Marks are neighbours, and no further one would fit: the count differs from the turns by less than one.
    assert np.abs(np.diff(marks) * speed - 1.0).max(initial=0.0) < 1e-9
    assert abs(len(marks) - speed * duration) < 1.0 + 1e-9


def test_a_mark_at_the_first_sample_counts_and_one_at_the_end_does_not() -> None:
    np.testing.assert_allclose(Drive(30.0, 0.0).tacho_s(0.1), [0.0, 1.0 / 30.0, 2.0 / 30.0], atol=1e-15)
