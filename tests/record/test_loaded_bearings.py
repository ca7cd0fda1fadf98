"""Bearings that follow load and clearance as a user meets them: in records, changed states, plans and messages."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.checks.notes import shaft_notes
from siggen.drivetrain.structure import on_back_flanks
from siggen.errors import ConfigError
from siggen.gearbox.background_numbers import BearingNumbers
from siggen.gearbox.design import SetDesign
from siggen.gearbox.specimen import OperatingPoint
from siggen.record.bearing_spalls import mean_force_n
from siggen.record.structure import BEARINGS, shaft_load_n, specimen_bearings, structure
from tests.config.minimal import by_name, config, minimal
from tests.record.fixed_numbers import fix
from tests.simulated import simulate

CLEARANCE = "dynamics.pinion.bearing.geometry.clearance_um"
STIFFNESS = "dynamics.gear.bearing.stiffness_n_per_m"
LOOSE = {"name": "loose", "fault": "clearance", "severity": "slight", "changes": {CLEARANCE: {"times": 4.0}}}


def raw(clearance_um: float = 10.0, **changes: Any) -> dict[str, Any]:
    short = {
        "fs_hz": 25600.0,
        "duration_s": 0.1,
        "states": by_name([{"name": "healthy"}, LOOSE]),
        "dynamics__model": "8dof",
    }
    bearings = {
        "dynamics__pinion__bearing__geometry__clearance_um": clearance_um,
        "dynamics__gear__bearing__geometry": {},
    }
    return minimal(**{**short, **bearings, **changes})


def made(clearance_um: float = 10.0, **changes: Any) -> SetDesign:
    return load_config(raw(clearance_um, **changes))


def signal(chosen: SetDesign, record: int) -> np.ndarray:
    (found,) = simulate(chosen, [record])
    return np.asarray(found.channels["bearing_vertical"], dtype=float)


@pytest.mark.parametrize("model", ["8dof", "casing"])
@pytest.mark.parametrize("torque_nm", [60.0, -60.0])
def test_the_load_of_a_bearing_is_what_the_flanks_that_touch_press_and_its_weight(model: str, torque_nm: float) -> None:
    chosen = made(dynamics__model=model)
    specimen, pair = chosen.gearbox(0), chosen.gearbox(0).pair
    seen = structure(specimen)
    if torque_nm < 0.0:
        seen = on_back_flanks(seen, 0.0)
    for which in ("pinion", "gear"):
        size = mean_force_n(specimen, seen, OperatingPoint(30.0, abs(torque_nm)), f"{which}_bearing")
        found = shaft_load_n(pair, which, torque_nm, 2.0, housed=specimen.housed)
        np.testing.assert_allclose(found, size - [0.0, 2.0 * 9.81], rtol=1e-9)


def test_a_shaft_moves_by_a_little_more_load_as_its_balls_do() -> None:
    """The structure's tangent against two static solutions of the law ball by ball."""
    chosen = made(20.0)
    specimen = chosen.gearbox(0)
    point = chosen.drawn_points(0)[0]
    more = OperatingPoint(point.speed_hz, 1.02 * point.torque_nm)
    before, after = (specimen_bearings(specimen.under(one))["pinion"] for one in (point, more))
    moved = after.moved_m * after.direction - before.moved_m * before.direction
    names = structure(specimen).coordinates
    rows = [names.index("x_pinion"), names.index("y_pinion")]
    tangent = structure(specimen).stiffness[np.ix_(rows, rows)]
    by_structure = np.linalg.solve(tangent, BEARINGS * (after.force_n - before.force_n))
    # the spring has the mean stiffness over the cage's angles, the way is a mean of ways: 9 balls differ by 1 %
    np.testing.assert_allclose(by_structure, moved, rtol=0.02)


def test_a_shaft_that_hardly_bends_stands_on_its_bearings_as_without_shafts() -> None:
    """Both ends together carry the same, mixed terms too, through what the housing gives way."""
    stout = {"bearing_span_mm": 60.0, "diameter_mm": 38.0}
    plain = {"dynamics__model": "casing", "housing__kind": "rigid"}
    with_shafts = made(**plain, dynamics__shafts={"driver": stout, "driven": stout})
    short, without = (structure(one.gearbox(0)) for one in (with_shafts, made(**plain)))
    kept = [short.coordinates.index(name) for name in without.coordinates]
    for name, (force, _) in without.bearing_forces.items():
        size = np.abs(force).max()
        np.testing.assert_allclose(short.bearing_forces[name][0][kept], force, atol=0.12 * size)  # the shaft's bending
    mixed = abs(without.bearing_forces["pinion_bearing/vertical"][0] @ without.bearing_directions[
        "pinion_bearing/horizontal"
    ])  # fmt: skip
    assert mixed > 1e7
    for one in (short, without):
        np.testing.assert_allclose(one.stiffness, one.stiffness.T, rtol=1e-12, atol=1e-3)
        assert np.linalg.eigvalsh(one.stiffness).min() > -1e-3  # the rotation of all shafts is free


def test_more_clearance_as_a_change_is_the_gearbox_that_has_it_and_moves_its_records() -> None:
    changed, own = made(), made(40.0, states={"healthy": {}, "loose": {}})
    np.testing.assert_array_equal(signal(changed, 1), signal(own, 1))
    healthy = signal(made(states={"healthy": {}, "loose": {}}), 1)
    assert np.std(signal(changed, 1) - healthy) > 0.1 * np.std(healthy)


def test_a_record_depends_on_its_own_load_alone() -> None:
    points = [{"speed_hz": 30.0, "torque_nm": torque} for torque in (20.0, 60.0)]
    base = {"states": {"healthy": {}}, "background__bearings": {}}
    both = made(operating_points=points, **base)
    stiffness = [
        specimen_bearings(both.gearbox(0).under(both.drawn_points(0)[n]))["pinion"].along_n_per_m for n in (0, 1)
    ]
    assert stiffness[1] / stiffness[0] == pytest.approx(3.0 ** (1.0 / 3.0), rel=0.05)  # softer still by the clearance
    together = [r.channels["bearing_vertical"] for r in simulate(both, [0, 1])]
    alone = [simulate(both, [n])[0].channels["bearing_vertical"] for n in (1, 0)][::-1]
    for first, second in zip(together, alone, strict=True):
        assert first.tobytes() == second.tobytes()


def test_a_stiffness_in_newtons_per_metre_stays_what_it_is() -> None:
    plain = config(states={"healthy": {}})
    specimen = replace(SetDesign(plain).gearbox(0), oil_c=None)  # its oil warms with the torque
    assert specimen.under(OperatingPoint(1.0, 999.0)) is specimen
    assert specimen_bearings(specimen) == {}


def test_plan_says_the_stiffness_of_every_bearing_load_and_changed_state() -> None:
    notes = [note for note in shaft_notes(made().possible) if note.startswith("both bearings")]
    assert len(notes) == 3
    assert "state loose" in notes[2]
    assert "clearance 40 um" in notes[2]


def test_plan_says_which_given_stiffness_a_bearing_replaces_and_which_it_does_not() -> None:
    given = {"dynamics__gear__bearing__stiffness_n_per_m": 1e8}
    (note,) = (note for note in shaft_notes(made(**given).possible) if "not used" in note)
    assert note.startswith(f"{STIFFNESS}: not used")
    assert "dynamics.gear.bearing.geometry: null" in note
    without = made(**given, dynamics__gear__bearing__geometry=None).possible
    assert not [note for note in shaft_notes(without) if "not used" in note]


@pytest.mark.parametrize(
    ("path", "change"),
    [
        ("dynamics.pinion.bearing.geometry.clearance_um", {"clearance_um": -200.0}),
        ("states.loose.changes.dynamics.pinion.bearing.geometry.clearance_um", {
            "states": by_name([{"name": "healthy"}, {**LOOSE, "changes": {CLEARANCE: {"add": -130.0}}}])
        }),
        ("dynamics.gear.bearing.geometry.ball_diameter_mm", {
            "dynamics__gear__bearing__geometry": {"ball_diameter_mm": 15.0}
        }),
        (f"states.loose.changes.{STIFFNESS}", {
            "states": by_name([{"name": "healthy"}, {**LOOSE, "changes": {STIFFNESS: {"times": 0.5}}}])
        }),
    ],
)  # fmt: skip
def test_what_no_bearing_is_is_refused_with_its_path(path: str, change: dict[str, Any]) -> None:
    with pytest.raises(ConfigError) as refused:
        load_config(raw(**change))
    assert path in str(refused.value)


def test_a_spall_of_such_a_bearing_pushes_under_its_load_and_clearance() -> None:
    spall = {"kind": "bearing_spall", "element": "outer", "length_mm": 2.0}
    states = [{"name": "healthy"}, {"name": "spall", "severity": "slight", "damage": spall}]
    pushed = {um: signal(made(um, states=by_name(states)), 1) for um in (10.0, 30.0)}
    assert np.std(pushed[10.0]) > 0.0
    assert np.std(pushed[10.0] - pushed[30.0]) > 0.05 * np.std(pushed[10.0])


def test_balls_that_pass_a_loaded_bearing_are_heard_at_their_order_though_nothing_is_drawn_for_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What a background of still bearings adds is lines of BPFO less its slip, larger with more clearance."""
    fix(monkeypatch, BearingNumbers, low_um_s=0.0, middle_um_s=0.0, high_um_s=0.0)
    size = {}
    for um in (0.0, 40.0):
        short: dict[str, Any] = {
            "duration_s": 0.5,
            "states": {"healthy": {}},
            "dynamics__mesh": {"law": "linear"},
        }
        short["sensors"] = {"bearing": {"bits": None, "range_m_s2": 1e6}}  # no steps of a converter
        plain, heard = made(um, **short), made(um, **short, background__bearings={})
        added = signal(heard, 0) - signal(plain, 0)
        power = np.abs(np.fft.rfft(added * np.hanning(added.size))) ** 2
        hz = 2.0 * np.arange(power.size)
        order = 0.5 * 9 * (1.0 - 7.94 / 39.04)
        near = np.zeros(power.size, dtype=bool)
        for ratio in (1.0, 18.0 / 47.0):
            for number in range(1, 9):
                line = 30.0 * ratio * order * number
                near |= (hz > 0.98 * line - 6.0) & (hz < 0.995 * line + 6.0)
        assert power[near].sum() > 0.98 * power.sum()
        size[um] = float(np.sqrt(power.sum()))
    assert size[40.0] > 1.5 * size[0.0] > 0.0
