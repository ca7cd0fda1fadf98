"""Loading: physics that is impossible is refused like any other mistake, at the bounds of what may be drawn."""

from __future__ import annotations

from pathlib import Path

import pytest

from siggen.checks.loading import load_config
from siggen.config import yaml_text
from siggen.damage.flank_place import height_m_of
from siggen.errors import ConfigError, UsageError
from siggen.gearbox.plan import plan
from siggen.gearbox.teeth import gear_pair
from siggen.gears.gear_pair import geometry_problems
from tests.config.minimal import config, minimal

CONFIGS = Path(__file__).resolve().parents[2] / "configs"
LINEAR = {"dynamics__mesh__law": "linear"}  # refuses what takes away the whole length of contact
PIT = {"face_mm": 10, "semi_axis_face_mm": 0.3, "semi_axis_profile_mm": 0.2, "depth_mm": 0.4}
CLUSTER = {
    "kind": "clustered",
    "count": 9,
    "spread_profile_mm": 0.3,
    "semi_axis_face_mm": 0.3,
    "semi_axis_profile_mm": 0.2,
    "depth_mm": 0.2,
}


def uniform(low: float, high: float) -> dict:
    return [low, high]


def refusals(**changes) -> dict[str, tuple[str, str]]:
    """Return the problems of the minimal configuration with changes: received and allowed by path."""
    with pytest.raises(ConfigError) as caught:
        load_config(minimal(**changes))
    return {problem.path: (problem.received, problem.allowed) for problem in caught.value.problems}


def damage(**keys):
    return {"states__slight__damage": {**minimal()["states"]["slight"]["damage"], **keys}}


def pits(*listed: dict, **keys):
    return {"states__slight__damage": {"kind": "list", "pits": [{**PIT, **pit} for pit in listed], **keys}}


# Lengths for 18/47 teeth of 3 mm at 20 degrees: root radius of the pinion 27 - 3.75 = 23.25 mm, centre distance
# 3 (18 + 47)/2 = 97.5 mm; along the tooth axis the pinion's tip is 4.743 mm and its pitch point 1.658 mm above the base
# circle; half thickness at the pitch point 2.353 mm (derived; reference: standard literature for the radii).
IMPOSSIBLE = [
    ({"gears__pinion__bore_radius_mm": 25}, "gears.pinion.bore_radius_mm", "25 mm", "below the root radius 23.25 mm"),
    ({"gears__gear__bore_radius_mm": uniform(15, 70)}, "gears.gear.bore_radius_mm", "70 mm", "66.75 mm"),
    ({"gears__pinion__profile_shift": 1.2}, "gears.pinion", "pointed tip", "lower the profile shift"),
    ({"gears__pinion__profile_shift": uniform(0, 1.2)}, "gears.pinion", "pointed tip", "lower the profile shift"),
    ({"gears__pinion__teeth": 8, "gears__pinion__bore_radius_mm": 4}, "gears.pinion", "below the base circle", "teeth"),
    (
        {
            "gears__pinion__teeth": 16,
            "gears__gear__teeth": 100,
        },  # 16 teeth are undercut; a large gear reaches down there
        "gears.pinion",
        "undercut",
        "from the start of the involute",
    ),
    ({"gears__centre_distance_mm": 90}, "gears.centre_distance_mm", "90 mm", "at least 97.5 mm"),
    (damage(first_height_mm=30), "states.slight.damage.first_height_mm", "30 mm", "4.74319 mm"),
    (damage(first_height_mm=uniform(1, 6)), "states.slight.damage.first_height_mm", "6 mm", "4.74319 mm"),
    (damage(layers=12), "states.slight.damage.first_height_mm", "row 12 of 12: height 6.05", "involute flank"),
    (damage(pits_per_layer=30), "states.slight.damage.spacing_face_mm", "face -4.5 mm", "0 to 20 mm"),
    (damage(pits_per_layer=1, face_centre_mm=21), "states.slight.damage.face_centre_mm", "21 mm", "0 to 20 mm"),
    (damage(depth_mm=3), "states.slight.damage.depth_mm", "3 mm", "half tooth thickness"),
    (damage(depth_mm=uniform(0.1, 3)), "states.slight.damage.depth_mm", "3 mm", "half tooth thickness"),
    (damage(pits_per_layer=20, semi_axis_face_mm=1) | LINEAR, "states.slight.damage", "whole contact length", "20 mm"),
    (pits({"height_mm": 6}), "states.slight.damage.pits.0.height_mm", "6 mm", "4.74319 mm"),
    (pits({}, {"face_mm": 20.5}), "states.slight.damage.pits.1.face_mm", "20.5 mm", "0 to 20 mm"),
    (pits({"depth_mm": 2.5}), "states.slight.damage.pits.0.depth_mm", "2.5 mm", "half tooth thickness"),
    (pits({"semi_axis_face_mm": 11}) | LINEAR, "states.slight.damage", "whole contact length", "20 mm"),
    (
        {"states__slight__damage": {**CLUSTER, "centre_height_mm": 5}},
        "states.slight.damage.centre_height_mm",
        "5 mm",
        "flank",
    ),
    ({"states__slight__damage": {**CLUSTER, "depth_mm": 1.5}}, "states.slight.damage.depth_mm", "1.5 mm", "half tooth"),
]


@pytest.mark.parametrize(("changes", "path", "received", "allowed"), IMPOSSIBLE, ids=lambda value: str(value)[:60])
def test_what_is_physically_impossible_is_refused(changes, path, received, allowed):
    found = refusals(**changes)
    assert list(found) == [path]
    assert received in found[path][0]
    assert allowed in found[path][1]


@pytest.mark.parametrize("changes", [changes for changes, *_ in IMPOSSIBLE], ids=str)
def test_lengths_are_given_in_the_units_of_the_file(changes):
    for received, allowed in refusals(**changes).values():
        assert "_m " not in received
        assert " m;" not in f"{received};{allowed};".replace("module m;", "")
        assert allowed.startswith("allowed: ")


@pytest.mark.parametrize(
    "changes",
    [
        {"gears__pinion__teeth": 14, "gears__pinion__profile_shift": 0.3, "gears__pinion__bore_radius_mm": 8},
        {"gears__pinion__teeth": 17},  # undercut that does not reach the active flank
        {"gears__centre_distance_mm": uniform(97.5, 97.8)},
        {"gears__module_mm": uniform(2.9, 3.1)},
        damage(face_centre_mm=0.0, pits_per_layer=1),  # cut by the tooth's end
        damage(pits_per_layer=20, spacing_face_mm=1.0),
        damage(first_height_mm=4.7),  # cut by the tip
        pits({"height_mm": 0.5}, {"gear": "gear", "tooth": 46, "height_mm": "pitch"}),
        {"states__slight__damage": CLUSTER},
    ],
    ids=str,
)
def test_what_is_only_unusual_is_accepted(changes):
    assert load_config(minimal(**changes)).name == "minimal"


def test_physical_problems_are_named_beside_mistakes_in_other_sections():
    found = refusals(seed="x", gears__pinion__bore_radius_mm=25, states__healthy__name="X Y", sensors__bearing__bits=99)
    assert sorted(found) == ["gears.pinion.bore_radius_mm", "seed", "sensors.bearing.bits", "states.healthy.name"]


def test_damage_is_checked_where_another_state_is_wrong():
    found = refusals(states__healthy__name="X Y", **damage(depth_mm=3))
    assert sorted(found) == ["states.healthy.name", "states.slight.damage.depth_mm"]


def test_heights_along_the_axis_and_along_the_flank_are_of_one_point():
    pair = gear_pair(config().gears)
    # Pitch point of 18 teeth of 3 mm above the base circle: axial 1.6579, arc
    # R_b tan^2(20)/2 = 1.6805 mm; both are the same point (given to 4 decimals)
    heights = [
        height_m_of(pair, "pinion", height, reading)
        for height, reading in [("pitch", "axial"), (1.6579, "axial"), (1.6805, "arc")]
    ]
    assert heights == pytest.approx([1.6579e-3] * 3, abs=1e-7)


def test_the_gear_pair_is_in_si_units():
    pair = gear_pair(config(gears__centre_distance_mm=97.6).gears)
    assert pair.pinion.module_m == pytest.approx(0.003, rel=1e-14)
    assert pair.pinion.bore_radius_m == pytest.approx(0.01, rel=1e-14)
    assert pair.face_width_m == pytest.approx(0.02, rel=1e-14)
    assert pair.youngs_modulus_pa == 206e9
    assert pair.centre_distance_m == pytest.approx(0.0976, rel=1e-14)  # one rounding of mm to m
    assert geometry_problems(pair) == ()


def test_a_section_that_is_not_drawn_has_no_gear_pair():
    with pytest.raises(TypeError, match=r"received \[2, 3\]"):
        gear_pair(config(gears__module_mm=uniform(2, 3)).gears)


def test_a_file_and_a_mapping_give_the_same_configuration(tmp_path):
    path = tmp_path / "set.yaml"
    path.write_text(yaml_text(minimal()), encoding="utf-8")
    assert load_config(path) == load_config(str(path)) == load_config(minimal())


def test_the_file_is_named_in_the_message(tmp_path):
    path = tmp_path / "set.yaml"
    path.write_text(yaml_text(minimal(seed=-1)), encoding="utf-8")
    with pytest.raises(ConfigError, match=r"set\.yaml: 1 problem\n  seed: received -1; allowed: "):
        load_config(path)


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(UsageError, match="there is no such file; allowed are the path of a YAML file, or a preset"):
        load_config(tmp_path / "missing.yaml")


def test_overrides_are_applied_before_checks():
    assert load_config(minimal(), ["gears.module_mm=3.5", "specimens=1"]).config.gears.module_mm == 3.5
    with pytest.raises(ConfigError, match=r"gears\.pinion\.bore_radius_mm"):
        load_config(minimal(), ["gears.pinion.bore_radius_mm=30"])


@pytest.mark.parametrize("path", sorted(CONFIGS.glob("*.yaml")), ids=lambda path: path.name)
def test_every_configuration_that_ships_is_usable(path):
    loaded = load_config(path)
    assert loaded.name == path.stem
    assert load_config(loaded.canonical()) == loaded


@pytest.mark.parametrize(("name", "records"), [("quickstart", 120), ("../tests/configs/linear_pits", 240)])
def test_a_first_set_has_few_records_of_4_severities_that_grow(name, records):
    loaded = load_config(CONFIGS / f"{name}.yaml")
    assert len(plan(loaded)) == records
    assert [state.severity for state in loaded.config.states[:4]] == ["healthy", "slight", "moderate", "severe"]
    assert all(state.sham for state in loaded.config.states[4:])
    assert [loaded.config.grown_from(i) for i in range(4)] == [None, None, 1, 2]


def test_paper_a_has_the_numbers_that_the_paper_states():
    loaded = load_config(CONFIGS / "paper_a.yaml")
    assert (loaded.config.gears.pinion.teeth, loaded.config.gears.gear.teeth) == (18, 47)
    assert loaded.config.operating_points[0].speed_hz == 30.0
    assert (loaded.fs_hz, loaded.duration_s) == (51_200.0, 10.0)
    for state in loaded.config.states[1:]:
        pit = state.damage
        assert (pit.semi_axis_face_mm, pit.semi_axis_profile_mm, pit.depth_mm) == (0.3, 0.2, 0.4)
        assert pit.first_height_mm == 1.9
    assert [(s.damage.layers, s.damage.pits_per_layer) for s in loaded.config.states[1:]] == [(1, 8), (1, 16), (3, 16)]
