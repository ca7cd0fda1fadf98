"""Records of the duration that is asked for can be used, and slightly shorter ones need not be."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
import pytest

from diagnostics.indicators.ranking_table import duration_advice, needed_duration
from diagnostics.records.usable_records import FEWEST_REVOLUTIONS
from tests.diagnostics.column_roles import ListedRoles


def some_set(speeds_hz: list[float], duration_s: float = 1.0, fs_hz: float = 25600.0) -> ListedRoles:
    table = pa.table(
        {"speed_hz": speeds_hz, "teeth_pinion": [18] * len(speeds_hz), "teeth_gear": [47] * len(speeds_hz)}
    )
    labels = lambda columns=None: table.select(columns or table.column_names)  # noqa: E731 - as a set's labels
    found = ListedRoles()
    vars(found).update(labels=labels, fs_hz=fs_hz, duration_s=duration_s)
    return found


@pytest.mark.parametrize("start", np.linspace(0.0, 0.999, 7))
def test_so_long_a_record_holds_two_revolutions_of_both_shafts_wherever_it_starts(start: float) -> None:
    needed_s, speed_hz = needed_duration(some_set([30.0, 20.0]), 512)
    assert speed_hz == 20.0
    pulses = np.ceil(start + np.array([0.0])) + np.arange(20)
    whole = int((pulses <= start + needed_s * speed_hz).sum()) - 1
    assert whole * 18 / 47 >= FEWEST_REVOLUTIONS
    assert needed_s == pytest.approx(7 / 20)  # six pinion revolutions, and one until the first pulse


def test_frames_of_the_spectral_kurtosis_need_their_time_too() -> None:
    assert needed_duration(some_set([2000.0]), 512)[0] == pytest.approx(9 * 256 / 25600)


def test_advice_is_given_to_short_records_only_and_never_fails() -> None:
    assert "last 0.1 s; at its lowest speed, 20 Hz, they have to last 0.35 s" in duration_advice(
        some_set([20.0], 0.1), 512
    )
    assert duration_advice(some_set([20.0], 0.35), 512) == ""
    assert duration_advice(some_set([0.0], 0.1), 512) == ""
    assert duration_advice(some_set([20.0], 0.1, fs_hz=0.0), 512) == ""
