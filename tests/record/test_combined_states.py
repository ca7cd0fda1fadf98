"""Several damages at once: each is there as if it were alone, whatever their order in the file."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord, record_schema
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from siggen.sets.drawn import set_columns
from tests.config.minimal import by_name, design, minimal
from tests.simulated import damage_rows, simulate

SIZE = {"face_length_mm": 6.0, "profile_length_mm": 1.0, "depth_mm": 0.3}
PITS = {
    "kind": "list",
    "pits": [{"tooth": 3, "face_mm": 8.0, "semi_axis_face_mm": 1.5, "semi_axis_profile_mm": 0.5, "depth_mm": 0.3}],
}
SPALL = {"kind": "spall", "gear": "gear", "teeth": [20], **SIZE}


def config(*states: dict[str, Any]) -> SetDesign:
    dynamics = {"model": "8dof", "mesh": {"law": "linear"}, "friction": {"model": "off"}}
    small = {"specimens": 1, "duration_s": 0.2, "fs_hz": 20480.0, "mesh_harmonics": 3, "dynamics": dynamics}
    sensors = [{"name": "bearing", "noise": None, "bits": None}]
    return load_config(minimal(**small, sensors=by_name(sensors), states=by_name([{"name": "healthy"}, *states])))


def state(*damage: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"name": "severe", "damage": [*damage], **more}


def record(chosen: SetDesign, record_id: int = 1) -> SimulatedRecord:
    result = simulate(chosen, [record_id])[0]
    assert isinstance(result, SimulatedRecord), result
    return result


def test_two_faults_on_different_teeth_superpose() -> None:
    healthy, pitted, spalled, both = (
        record(config(one)) for one in ({"name": "again"}, state(PITS), state(SPALL), state(PITS, SPALL))
    )
    name = next(iter(healthy.channels))
    base, first, second, found = (one.channels[name].astype(np.float64) for one in (healthy, pitted, spalled, both))
    assert both.labels["contact_loss_share"] == 0.0
    assert min(np.std(first - base), np.std(second - base)) > 1e-3 * np.std(base)
    # 5 %: a parametric mesh is linear in a small loss of stiffness only
    apart = np.std(found - (first + second - base))
    assert apart < 0.05 * np.std(found - base)


def test_their_order_does_not_matter_but_for_the_primary_fault() -> None:
    one, other = config(state(PITS, SPALL)), config(state(SPALL, PITS))
    first, second = record(one), record(other)
    assert all(first.channels[name].tobytes() == second.channels[name].tobytes() for name in first.channels)
    assert (first.labels["primary_fault"], second.labels["primary_fault"]) == ("pitting", "spalling")
    assert {**first.labels, "primary_fault": ""} == {**second.labels, "primary_fault": ""}
    assert damage_rows(one, 1) == damage_rows(other, 1)


def test_each_is_the_one_that_it_is_alone() -> None:
    rows = damage_rows(config(state(PITS, SPALL)), 1)
    alone = [row for one in (PITS, SPALL) for row in damage_rows(config(state(one)), 1)]
    assert sorted(map(str, rows)) == sorted(map(str, alone))
    found, listed = record(config(state(SPALL))), record(config({"name": "severe", "damage": SPALL}))
    name = next(iter(found.channels))
    assert found.channels[name].tobytes() == listed.channels[name].tobytes()


def test_labels_say_each_kind() -> None:
    chosen = config(
        {"name": "slight", "damage": PITS},
        state(SPALL, {**PITS, "pits": [{**PITS["pits"][0], "tooth": 5}]}, grows="slight"),
    )
    labels = record(chosen, 2).labels
    assert (labels["fault"], labels["faulty_gear"]) == ("combined", "several")
    assert (labels["has_pitting"], labels["has_spalling"]) == (True, True)
    assert labels["faulty_teeth_pinion"] == [3, 5]  # the milder state's too
    slight = record(chosen, 1).labels
    assert (slight["fault"], slight["has_pitting"], slight["has_spalling"]) == ("pitting", True, False)
    assert (labels["primary_fault"], slight["primary_fault"]) == ("spalling", "pitting")
    assert record(chosen, 0).labels["primary_fault"] == "healthy"
    alone = record_schema(set_columns(config(state(PITS)))).names
    assert not [name for name in alone if name.startswith("has_") or name == "primary_fault"]


def test_a_state_may_name_its_primary_fault_itself() -> None:
    labels = record(config(state(PITS, SPALL, fault="spalling"))).labels
    assert (labels["fault"], labels["primary_fault"], labels["has_pitting"]) == ("spalling", "spalling", True)


def test_each_fault_has_its_rows_in_one_table() -> None:
    chosen = load_config(
        minimal(
            dynamics={"model": "8dof", "mesh": {"law": "pairs"}},
            states=by_name(
                [
                    {"name": "healthy"},
                    state(
                        {"kind": "wear", "depth_um": 5.0},
                        {"kind": "chip", "gear": "gear", "teeth": [7], "height_mm": 1.0},
                        {"kind": "bearing_spall", "element": "outer", "length_mm": 2.0},
                    ),
                ]
            ),
        )
    )
    rows = damage_rows(chosen, 1)
    found = {(row["kind"], row["gear"], row["tooth"], row["bearing"], row["element"]) for row in rows}
    assert found == {
        ("wear", "pinion", -1, "", ""),
        ("wear", "gear", -1, "", ""),
        ("chip", "gear", 7, "", ""),
        ("bearing_spall", "none", -1, "pinion_bearing", "outer"),
    }
    assert len(rows) == len(found)


def test_a_row_has_the_size_of_the_flanks_of_its_gear() -> None:
    """Heights above the base circle from the half angle of the tooth at each radius, without the gear's own functions.

    A gear drawn for each gearbox has its own; damage of a bearing has none.
    """
    wear, bearing = {"kind": "wear", "depth_um": 5.0}, {"kind": "bearing_spall", "element": "outer", "length_mm": 2.0}
    shifts = {"pinion": 0.3, "gear": -0.1}
    changes = {f"gears__{gear}__profile_shift": shift for gear, shift in shifts.items()}
    changes["gears__face_width_mm"] = [18.0, 22.0]
    rows = damage_rows(design(**changes, specimens=1, states=by_name([{"name": "healthy"}, state(wear, bearing)])), 1)
    by_gear = {row["gear"]: row for row in rows}
    sizes = ("face_width_mm", "pitch_height_mm", "tip_height_mm")
    for gear, teeth in (("pinion", 18), ("gear", 47)):
        radius_mm, alpha = 1.5 * teeth, np.radians(20.0)
        base_mm = radius_mm * np.cos(alpha)
        half = (np.pi / 2 + 2 * shifts[gear] * np.tan(alpha)) / teeth + np.tan(alpha) - alpha
        tips = [radius_mm, radius_mm + 3.0 * (1.0 + shifts[gear])]
        slopes = [np.arccos(base_mm / r) for r in tips]
        heights = [
            r * np.cos(half - (np.tan(slope) - slope)) - base_mm * np.cos(half)
            for r, slope in zip(tips, slopes, strict=True)
        ]
        face, *found = (by_gear[gear][name] for name in sizes)
        assert found == pytest.approx(heights, rel=1e-9)
        assert 18.0 < face < 22.0
    assert [by_gear["none"][name] for name in sizes] == [0.0, 0.0, 0.0]


def test_a_sham_may_have_several() -> None:
    sham = record(config({"name": "sham", "acts": False, "damage": [PITS, SPALL]}))
    healthy = record(config({"name": "again"}))
    assert all(sham.channels[name].tobytes() == healthy.channels[name].tobytes() for name in healthy.channels)


@pytest.mark.parametrize(
    ("damage", "path"),
    [
        ([], "states.severe.damage"),
        ([3], "states.severe.damage.0"),
        ([PITS, {"kind": "spal"}], "states.severe.damage.1.kind"),
        ([PITS, {**SPALL, "depth_mm": 90.0}], "states.severe.damage.1.depth_mm"),
        ([PITS, {**SPALL, "teeth": [90]}], "states.severe.damage.1.teeth"),
    ],
)
def test_a_mistake_in_one_is_told_with_its_place(damage: list[Any], path: str) -> None:
    with pytest.raises(ConfigError) as refused:
        config({"name": "severe", "damage": damage})
    assert f"{path}:" in str(refused.value)
