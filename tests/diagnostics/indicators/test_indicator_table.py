"""All indicators of a set: complete, the same by any number of workers, and refused where records are no good."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from diagnostics.indicators.history import central_moments, dominant_harmonic, moment_over_history
from diagnostics.indicators.own_indicator import GearFacts, OwnIndicator, own_values
from diagnostics.indicators.ranking_table import IndicatorTable, ranking_table
from diagnostics.indicators.record import record_result, record_values
from diagnostics.indicators.registry import ALL, BY_NAME, indicator_columns, taken_of
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.indicators.table import record_table
from diagnostics.records.channel_quantities import RECORDED
from diagnostics.records.gear_train import PAIR, pair_train, with_teeth
from diagnostics.records.recording import Recording, recordings
from diagnostics.records.usable_records import clipped_channels, clipped_share, problem_lines, record_problems
from diagnostics.signal.mesh_band import mesh_basebands
from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from diagnostics.signal.shaft_signals import record_shafts, shaft_signals
from siggen.errors import DatasetError, UsageError


def indicator_table(
    dataset: Any, own: Any = (), settings: IndicatorSettings | None = None, *, workers: int = 1, **choices: Any
) -> IndicatorTable:
    return ranking_table(record_table(dataset, settings, own, workers=workers), dataset, **choices)


@pytest.fixture(scope="module")
def table(small: Any) -> IndicatorTable:
    return indicator_table(small)


READ = "diagnostics.indicators.table.recordings"


@pytest.fixture(scope="module")
def small(make_dataset: Any) -> Any:
    return make_dataset(("train", "test", "test"))


def column(table: IndicatorTable, name: str) -> np.ndarray:
    return table.matrix.values[:, table.matrix.names.index(name)]


def test_every_definition_has_columns_and_every_column_a_definition(table: IndicatorTable) -> None:
    known = indicator_columns(table.settings)
    assert {known[name.split("__")[0]].entry.name for name in table.matrix.names} == {
        entry.name for entry in taken_of(RECORDED.word)
    }
    assert len(BY_NAME) == len(ALL)
    channels = {name.split("__")[1] for name in table.matrix.names}
    assert channels == set(table.channels)


def test_a_record_alone_gives_what_the_table_holds(small: Any, table: IndicatorTable) -> None:
    record = next(recordings(small))
    alone = record_values(record.channels, record.tacho_s, record.fs_hz, (18, 47)).values
    assert set(alone) == {name for name in table.matrix.names if not name.startswith(("na4", "nb4"))}
    for name, value in alone.items():
        np.testing.assert_equal(column(table, name)[0], value)


def test_indicators_with_a_history_are_those_of_the_signals_themselves(small: Any, table: IndicatorTable) -> None:
    averages, residuals, lines = [], [], []
    for record in list(recordings(small))[:3]:  # the healthy, slight and severe record of the first specimen
        grid = angle_grid(record.tacho_s, 18 * 128)
        steps = resample_to_angle(record.channels["bearing_vertical"], record.fs_hz, grid)
        shaft = record_shafts(grid, (18, 47), 128, 6, PAIR[0].gears)[0]
        found = shaft_signals(steps, shaft, 128, 2, 1)
        averages.append(found.average)
        residuals.append(central_moments(found.parts.residual))
        lines.append(found.lines)
    harmonic = dominant_harmonic(lines[0], 18, 5)
    for count in (1, 2, 3):
        envelopes = [
            central_moments(np.abs(mesh_basebands(average, 18, 5, 6)[harmonic - 1])) for average in averages[:count]
        ]
        expected = (
            moment_over_history(residuals[count - 1][0], [second for _, second in residuals[:count]]),
            moment_over_history(residuals[count - 1][0], [residuals[0][1]]),
            moment_over_history(envelopes[-1][0], [second for _, second in envelopes]),
        )
        for name, value in zip(("na4", "na4_star", "nb4"), expected, strict=True):
            assert column(table, f"{name}_pinion__bearing_vertical")[count - 1] == pytest.approx(value)


@pytest.mark.slow
def test_number_of_workers_changes_nothing(small: Any, table: IndicatorTable) -> None:
    again = indicator_table(small, workers=2)
    np.testing.assert_array_equal(again.matrix.values, table.matrix.values)
    assert again.matrix.names == table.matrix.names


WITHOUT_TACHO = IndicatorSettings(speed_range_hz=(25.0, 36.0))


@pytest.mark.slow  # searches the speed of every record
def test_angle_from_the_lines_gives_nearly_the_same_average_or_the_record_is_refused(small: Any) -> None:
    judged = set()
    for record in recordings(small):
        lines, tacho = record_result(record, WITHOUT_TACHO), record_result(record)
        judged |= set() if lines.problems else {record.labels["record_id"]}
        for channel, one in lines.channels.items() if not lines.problems else ():
            name = "average_rms_pinion"
            # a hundredth of a tooth pitch of angle error at mesh harmonic 3 costs 2 % of its amplitude
            assert one.values[name] == pytest.approx(tacho.channels[channel].values[name], rel=0.02)
    # healthy records of these toys hold three mesh lines and nothing of the shafts, which is not certain
    assert {2, 5, 8} <= judged


def test_record_without_lines_is_a_problem_of_that_record(small: Any) -> None:
    record = next(recordings(small))
    noise = np.random.default_rng(1).standard_normal(12_800)
    found = record_result(replace(record, channels={"a": noise}), WITHOUT_TACHO)
    assert problem_lines(found.problems)[0].startswith("1 record (0): no lines of 18/47 teeth stand above the noise")


def test_the_arrow_table_has_labels_values_and_settings(table: IndicatorTable) -> None:
    arrow = table.arrow()
    assert arrow.num_rows == 9
    assert {"specimen_id", "notes", "revolutions_gear", "fm4_pinion__bearing_vertical"} <= set(arrow.column_names)
    assert b"samples_per_tooth" in arrow.schema.metadata[b"diagnostics.indicators"]


def peak(signal: np.ndarray, tacho_s: np.ndarray, gears: GearFacts) -> float:
    return float(np.abs(signal).max()) * gears.teeth_pinion * tacho_s.size


def test_own_indicator_stands_beside_the_others(small: Any) -> None:
    found = indicator_table(small, [OwnIndicator("own_peak", peak), OwnIndicator("other", peak)])
    record = next(recordings(small))
    expected = float(np.abs(record.channels["bearing_horizontal"]).max()) * 18 * record.tacho_s.size
    assert column(found, "own_peak__bearing_horizontal")[0] == pytest.approx(expected)
    assert column(found, "other__bearing_horizontal")[0] == pytest.approx(expected)


def of_loud_records(signal: np.ndarray, tacho_s: np.ndarray, gears: GearFacts) -> float:
    return float(signal[signal.size if tacho_s[0] > 0.015 else 0])


def broken(signal: np.ndarray, tacho_s: np.ndarray, gears: GearFacts) -> float:
    raise ValueError("no\nteeth")


def test_own_indicator_that_fails_on_some_records_is_one_line_and_undefined_there(small: Any) -> None:
    own = [OwnIndicator("fragile", of_loud_records), OwnIndicator("other", peak)]
    failed = (
        r"\n  \d records? \([\d, .]+\), channel bearing_[a-z_, ]+: indicator 'fragile' failed: IndexError: [^\n]*\nMend"
    )
    with pytest.raises(DatasetError, match=failed):
        indicator_table(small, own)
    found = indicator_table(small, own, leave_out=True)
    values = np.stack([column(found, f"fragile__bearing_{axis}") for axis in ("vertical", "horizontal")])
    assert np.isnan(values).any()
    assert np.isfinite(values).any()
    assert np.isfinite(column(found, "other__bearing_vertical")).all()
    assert np.isfinite(column(found, "rms__bearing_vertical")).all()
    assert len(found.problems) == np.isnan(values).sum()


def test_own_indicator_that_fails_on_every_record_stops_with_one_line(small: Any) -> None:
    with pytest.raises(UsageError) as stopped:
        indicator_table(small, [OwnIndicator("other", peak), OwnIndicator("broken", broken)], leave_out=True)
    assert "on all 9 records indicator 'broken' failed: ValueError: no teeth. It is called as" in str(stopped.value)
    assert "\n" not in str(stopped.value)
    with pytest.raises(UsageError, match="came twice"):
        indicator_table(small, [OwnIndicator("same", peak), OwnIndicator("same", peak)])


def test_function_that_other_processes_cannot_find_is_refused_before_any_starts(small: Any) -> None:
    with pytest.raises(UsageError, match=r"'local' cannot go to other processes.*take one worker"):
        indicator_table(small, [OwnIndicator("local", lambda signal, tacho, gears: 1.0)], workers=2)


def test_own_indicator_cannot_change_what_the_next_one_sees(small: Any) -> None:
    def greedy(signal: np.ndarray, tacho_s: np.ndarray, gears: GearFacts) -> float:
        signal[:], tacho_s[:] = 0.0, 0.0
        return 0.0

    record = next(recordings(small))
    alone, _ = own_values([OwnIndicator("other", peak)], record)
    after, _ = own_values([OwnIndicator("greedy", greedy), OwnIndicator("other", peak)], record)
    assert {name: after[name] for name in alone} == pytest.approx(alone, nan_ok=True)


def changed(record: Recording, channel: str = "bearing_vertical", **changes: Any) -> Recording:
    signal = np.array(record.channels[channel])
    if "samples" in changes:
        samples = changes.pop("samples")
        signal[10 : 10 + len(samples)] = samples
    if "clip" in changes:
        limit = changes.pop("clip")
        signal = np.clip(signal, -limit, limit)
    return replace(record, channels={**record.channels, channel: signal}, **changes)


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"samples": [np.nan, np.inf]}, "2 of 12800 samples are not finite"),
        (
            {"train": with_teeth(pair_train((18, 47)), {"pinion": 18, "gear": None})},
            "teeth of pinion and gear: received 18, nan",
        ),
    ],
)
def test_record_that_cannot_be_used_is_left_out_with_its_reason(
    small: Any, changes: dict[str, Any], text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    good = list(recordings(small))
    monkeypatch.setattr(READ, lambda dataset: iter([changed(good[0], **changes), *good[1:]]))
    whole = "train" in changes
    found = indicator_table(small, leave_out=True)
    assert [problem for problem in found.problems if text in problem.text and problem.record_id == 0]
    assert text in found.notes[0]
    assert math.isnan(column(found, "rms__bearing_vertical")[0])
    assert math.isnan(column(found, "rms__bearing_horizontal")[0]) == whole


def test_unusable_record_stops_the_set_unless_it_is_left_out(small: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    good = list(recordings(small))
    broken = [changed(good[0], samples=[np.nan]), *good[1:]]
    monkeypatch.setattr(READ, lambda dataset: iter(broken))
    with pytest.raises(
        DatasetError,
        match=r"(?s)memory_set: problems.*1 record \(0\), channel bearing_vertical.*diagnostics indicators",
    ):
        indicator_table(small)
    found = indicator_table(small, leave_out=True)
    assert math.isnan(column(found, "rms__bearing_vertical")[0])
    assert math.isnan(column(found, "na4_pinion__bearing_vertical")[1])  # its history has a gap
    assert math.isfinite(column(found, "rms__bearing_horizontal")[0])
    assert [problem.record_id for problem in found.problems] == [0]


def test_a_counter_whose_speed_stands_between_two_pulses_is_not_clipped(small: Any) -> None:
    stepped = changed(next(iter(recordings(small))), clip=2.0)
    assert clipped_channels(stepped) == ["bearing_vertical"]
    counted = replace(stepped, quantities={"bearing_vertical": "angular speed"})
    assert not clipped_channels(counted)
    assert not record_problems(counted, 256, needs_tacho=True)


def test_two_samples_at_the_peak_are_no_clipping() -> None:
    signal = np.array([0.0, 1.0, 1.0, 0.0, -1.0, -1.0, -1.0, 0.0])
    assert clipped_share(signal) == pytest.approx(3 / 8)
    assert clipped_share(np.sin(np.arange(100.0))) == 0.0
    # runs of three and more at either end, and of two, which does not count
    assert clipped_share(np.array([2.0, 2, 2, 0, 1, 2, 2, 0, 0, 0, 0])) == pytest.approx(7 / 11)
