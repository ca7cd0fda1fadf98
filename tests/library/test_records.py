"""Three lines from nothing to a figure: gearboxes of a drawing or a set, their records, spectra and figures."""

from __future__ import annotations

from dataclasses import FrozenInstanceError
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

import siggen
from siggen.columns.record import SimulatedRecord
from siggen.errors import UsageError
from tests.simulated import simulate

mpl.use("Agg")


@pytest.fixture(scope="module")
def gearbox() -> siggen.Gearbox:
    return siggen.single_stage(teeth=(23, 61), module_mm=2.5)


@pytest.fixture(scope="module")
def record(gearbox: siggen.Gearbox) -> siggen.Record:
    return siggen.run(gearbox, speed_hz=25, torque_nm=40, duration_s=0.5, truth=["mesh_force_n"])


def test_three_lines_give_a_record_in_si_with_its_time_axis(gearbox: siggen.Gearbox, record: siggen.Record) -> None:
    assert tuple(record.channels) == gearbox.channels
    assert set(record.units.values()) == {"m/s²"}
    (samples,) = {values.shape for values in record.channels.values()}
    assert samples == record.time_s.shape == (12_800,)
    assert record.fs_hz == 25_600.0
    assert record.time_s[1] == pytest.approx(1.0 / record.fs_hz)
    assert np.diff(record.tacho_s).mean() == pytest.approx(1.0 / 25.0, rel=0.01)
    assert record.truth["mesh_force_n"].mean() == pytest.approx(
        40.0 / (0.5 * 23 * 2.5e-3 * np.cos(np.radians(20))), rel=0.05
    )
    assert {record.labels["teeth_pinion"], record.labels["teeth_gear"]} == {23, 61}
    assert all(np.std(values) > 0.1 for values in record.channels.values())


def test_the_same_arguments_give_the_same_record_and_other_numbers_others(gearbox: siggen.Gearbox) -> None:
    short = {"speed_hz": 25.0, "torque_nm": 40.0, "duration_s": 0.05}
    first, again = (siggen.run(one, **short) for one in (gearbox, siggen.single_stage((23, 61), 2.5)))
    assert all(np.array_equal(first.channels[name], again.channels[name]) for name in first.channels)
    others = siggen.run(siggen.single_stage((23, 61), 2.5, number=1), **short), siggen.run(gearbox, **short, repeat=1)
    for other in others:
        assert not any(np.array_equal(first.channels[name], other.channels[name]) for name in first.channels)


def test_a_gearbox_that_is_drawn_from_a_set_gives_the_records_of_the_set() -> None:
    """All of them, at each of its points, repeats included; one alone by the set's columns."""
    points = [{"speed_hz": speed_hz, "torque_nm": 40.0} for speed_hz in (20.0, 30.0)]
    raw = {"extends": "quickstart", "duration_s": 0.06, "operating_points": points, "repeats": 2}
    config = siggen.load_config(raw)
    third = siggen.draw(config, 3)
    severe = [case for case in third.cases if case.state == "severe"]
    assert len(third.cases) == config.records_per_specimen
    ids = [3 * config.records_per_specimen + third.cases.index(case) for case in severe]
    for own, of_set in zip(siggen.runs(third, severe), simulate(config, ids), strict=True):
        assert isinstance(of_set, SimulatedRecord)
        assert own.labels == of_set.labels
        for name, values in of_set.channels.items():
            assert own.channels[name].astype(np.float32).tobytes() == values.tobytes()
    place = of_set.planned
    alone = siggen.run(third, "severe", point=place.operating_point_id, repeat=place.repeat)
    assert (place.operating_point_id, place.repeat) == (1, 1)
    assert all(np.array_equal(alone.channels[name], values) for name, values in own.channels.items())
    assert [one.name for one in third.states] == list(config.state_names)
    assert (own.speed_hz, own.torque_nm) == (third.points[1].speed_hz, third.points[1].torque_nm)


def test_runs_give_what_run_gives_one_by_one(gearbox: siggen.Gearbox) -> None:
    points = siggen.Point(25.0, 40.0), siggen.Point(20.0, 10.0)
    cases = [siggen.Case("healthy", points[0]), siggen.Case("healthy", points[0], 1), siggen.Case("healthy", points[1])]
    for case, found in zip(cases, siggen.runs(gearbox, cases, duration_s=0.06), strict=True):
        alone = siggen.run(
            gearbox, case.state, case.point.speed_hz, case.point.torque_nm, duration_s=0.06, repeat=case.repeat
        )
        assert all(np.array_equal(found.channels[name], alone.channels[name]) for name in alone.channels)


def made_record(tacho_s: np.ndarray, signal: np.ndarray, fs_hz: float) -> siggen.Record:
    lines = (siggen.LineOrders("", 23.0, {"pinion": 1.0, "gear": 23 / 61}),)
    return siggen.Record("healthy", 25.0, 40.0, fs_hz, {"lid": signal}, {"lid": "m/s²"}, {}, tacho_s, lines=lines)


@pytest.mark.parametrize("swing", [0.0, 0.03])
def test_a_tone_in_step_with_the_teeth_is_one_line_whatever_the_speed_does(swing: float) -> None:
    """Known: an amplitude of 2 at 23 orders, of 0.5 a shaft order above it, at a speed that swings by 3 %."""
    fs_hz, seconds = 25_600.0, 2.0
    time_s = np.arange(round(fs_hz * seconds)) / fs_hz

    def turns(at_s: np.ndarray) -> np.ndarray:
        return 25.0 * at_s + swing * 25.0 / (2 * np.pi) * (1.0 - np.cos(2 * np.pi * at_s))

    fine_s = np.linspace(0.0, seconds, 2_000_001)
    pulses = np.interp(np.arange(1, int(turns(fine_s)[-1])), turns(fine_s), fine_s)
    angle = 2 * np.pi * turns(time_s)
    spectrum = made_record(pulses, 2.0 * np.sin(23 * angle) + 0.5 * np.sin(24 * angle), fs_hz).spectrum()
    for order, amplitude in ((23.0, 2.0), (24.0, 0.5)):
        near = np.abs(spectrum.order - order) < 0.1
        assert spectrum.amplitude[near].max() == pytest.approx(amplitude, rel=0.04)  # a line between two bins
    between = np.abs(spectrum.order - 23.5) < 0.3
    assert spectrum.amplitude[between].max() < 0.02
    assert spectrum.speed_hz == pytest.approx(25.0, rel=1e-3)


def test_figures_return_their_axes_and_mark_mesh_lines_and_sidebands(record: siggen.Record, tmp_path: Path) -> None:
    axes = record.plot()
    assert len(axes) == len(record.channels)
    assert record.plot(*record.channels, ax=axes) is axes
    assert [len(one.lines) for one in axes] == [2, 2]
    axis = record.plot("sensor_1_vertical")
    assert axis.get_xlabel() == "time [s]"
    assert "[m/s²]" in axis.get_ylabel()
    shown = record.spectrum("sensor_2_horizontal").plot(around=1)
    labels = shown.get_legend_handles_labels()[1]
    assert labels == ["sensor_2_horizontal", "mesh", "sidebands of pinion", "sidebands of gear"]
    marked = shown.lines[1].get_xdata()
    assert np.allclose(marked, 23 + np.delete(np.arange(-5, 6), 5))
    shown.figure.savefig(tmp_path / "spectrum.png")


def test_what_is_shown_of_them_is_one_line_and_nothing_can_be_changed(
    gearbox: siggen.Gearbox, record: siggen.Record
) -> None:
    for one in (gearbox, record, record.spectrum()):
        assert repr(one).startswith(f"{type(one).__name__}(")
        assert "\n" not in repr(one)
        assert len(repr(one)) < 160
    with pytest.raises(FrozenInstanceError):
        record.fs_hz = 1.0  # type: ignore[misc]


BAD_DRAWINGS = [
    ({"teeth": (5, 6)}, r"teeth=\(5, 6\), pinion: received interference.*allowed: contact above the base circle"),
    ({"teeth": 23}, r"teeth: received 23; allowed: 2 whole numbers"),
    ({"teeth": (3, 61)}, "teeth: received 3,61; allowed: 5 to 1000"),
    ({"module_mm": "2"}, "module_mm: received '2'; allowed: a number above 0"),
    ({"module_mm": 100}, "module_mm: received 100; allowed: 0.3 to 50 mm"),
    ({"rated_nm": 1e5}, r"rated_nm: received 100000.0; allowed: above 0 up to \d+"),
    ({"number": -1}, "number: received -1; allowed: 0, 1, 2"),
]
BAD_RUNS = [
    ({"state": "healty"}, "state: received 'healty'; allowed: healthy; did you mean 'healthy'"),
    ({"speed_hz": 0}, "speed_hz: received 0; allowed: above 0 up to 1000"),
    ({"speed_hz": None}, "speed_hz: received nothing; allowed: a number in Hz"),
    ({"torque_nm": 4000}, r"torque_nm: received 4000; allowed: -\d+ to \d+, where flank or root"),
    (
        {"duration_s": 1 / 25_600},
        r"duration_s: received 3.90625e-05 \(1 samples at 25600 Hz\); allowed: at least 0.04",
    ),
    ({"fs_hz": 100}, "fs_hz: received 100; allowed: 1991 to 1e7 Hz, for the first mesh line"),
    ({"truth": ["mesh_force"]}, "truth.0: received 'mesh_force'; allowed: all, or .*nearest: mesh_force_n"),
    ({"truth": 3}, "truth: received 3; allowed: names such as mesh_force_n, or all"),
    ({"speed_hz": None, "torque_nm": None, "point": 1}, "speed_hz: received nothing; allowed: a number in Hz"),
    ({"repeat": -1}, "repeat: received -1; allowed: 0, 1, 2"),
    ({"speed_hz": -25}, "speed_hz: received -25; allowed: above 0 up to 1000"),
    ({"speed_hz": "25"}, "speed_hz: received '25'; allowed: above 0 up to 1000"),
]


@pytest.mark.parametrize(("change", "said"), BAD_DRAWINGS, ids=lambda one: str(one)[:30])
def test_a_drawing_that_cannot_be_is_refused_by_its_argument(change: dict[str, object], said: str) -> None:
    given: dict[str, object] = {"teeth": (23, 61), "module_mm": 2.5, **change}
    with pytest.raises(UsageError, match=said) as refused:
        siggen.single_stage(**given)  # type: ignore[arg-type]
    assert "pydantic" not in str(refused.getrepr(style="short"))


@pytest.mark.parametrize(("change", "said"), BAD_RUNS, ids=lambda one: str(one)[:30])
def test_a_run_that_cannot_be_is_refused_by_its_argument(
    gearbox: siggen.Gearbox, change: dict[str, object], said: str
) -> None:
    given: dict[str, object] = {"speed_hz": 25, "torque_nm": 40, "duration_s": 0.1, **change}
    with pytest.raises(UsageError, match=said):
        siggen.run(gearbox, **given)  # type: ignore[arg-type]


def test_what_is_no_gearbox_no_case_and_no_configuration_is_refused(gearbox: siggen.Gearbox) -> None:
    with pytest.raises(UsageError, match="gearbox: received 'bench'; allowed: what single_stage, machine, planetary"):
        siggen.run("bench", speed_hz=25, torque_nm=40)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="cases: received 'healthy'; allowed: objects of Case"):
        next(siggen.runs(gearbox, ["healthy"]))  # type: ignore[list-item]
    with pytest.raises(UsageError, match=r"design: received 'bench'; allowed: what siggen\.load_config"):
        siggen.draw("bench")  # type: ignore[arg-type]


def test_channels_and_harmonics_that_are_not_there_are_refused(record: siggen.Record) -> None:
    with pytest.raises(UsageError, match="channels: received 'lid'; allowed: sensor_1_vertical, sensor_2_hor"):
        record.plot("lid")
    with pytest.raises(UsageError, match="around: received 70; allowed: 1 to 6"):
        record.spectrum().plot(around=70)


def test_a_motor_slips_by_the_torque_of_its_gearbox_at_any_torque_that_is_asked_for() -> None:
    points = [{"speed_hz": 20.0, "torque_nm": torque} for torque in (10.0, 60.0)]
    raw = {"extends": "quickstart", "duration_s": 0.3, "operating_points": points}
    gearbox = siggen.draw(siggen.load_config({**raw, "variation": {"speed": {"slip": 0.05}, "torque": {}}}))
    of_set = siggen.run(gearbox, point=0)
    asked = siggen.run(gearbox, speed_hz=20.0, torque_nm=10.0)
    expected = 20.0 * (1.0 - 0.05 * 10.0 / 60.0)
    for found in (of_set, asked):
        assert 1.0 / np.diff(found.tacho_s).mean() == pytest.approx(expected, rel=2e-3)
    weak = siggen.draw(siggen.load_config({**raw, "variation": {"speed": {"slip": 0.2}, "torque": {}}}))
    with pytest.raises(UsageError, match=r"torque_nm: received 200, a slip of 67%; allowed: below 150, at which the"):
        siggen.run(weak, speed_hz=20.0, torque_nm=200.0)
