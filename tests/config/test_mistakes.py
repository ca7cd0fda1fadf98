"""Mistakes in a configuration: each is named by its key, by what was received and by what is allowed."""

from __future__ import annotations

import pytest

from siggen.config import parse
from siggen.config.config import Config
from siggen.keys.problems import BRANCHES
from siggen.keys.wording import models_in
from tests.config.minimal import MINIMAL, minimal

CLUSTER = {
    "kind": "clustered",
    "count": 9,
    "spread_profile_mm": 0.3,
    "semi_axis_face_mm": 0.3,
    "semi_axis_profile_mm": 0.2,
    "depth_mm": 0.2,
}


# what is written, where: path of the problem, part of what was received, part of what is allowed
MISTAKES = [
    # keys
    ({"gears__modul_mm": 3}, "gears.modul_mm", "3", "did you mean 'module_mm'?"),
    ({"sensor": []}, "sensor", "a list of 0", "did you mean 'sensors'?"),
    ({"dynamics__pinion__mass": 1}, "dynamics.pinion.mass", "1", "did you mean 'mass_kg'?"),
    ({"states__slight__damage__count": 3}, "states.slight.damage.count", "3", "known keys: "),
    ({"gears__pinion": {"teeth": 18}}, "gears.pinion.bore_radius_mm", "nothing", "a number from 0.01 to 10000"),
    ({"operating_points": [{"speed_hz": 30}]}, "operating_points.0.torque_nm", "nothing", "a number from -1e+08"),
    # types
    ({"seed": "x"}, "seed", "the text 'x'", "a whole number of at least 0"),
    ({"gears__pinion__teeth": 18.0}, "gears.pinion.teeth", "18.0", "a whole number from 5 to 1000"),
    (
        {"gears__module_mm": "3"},
        "gears.module_mm",
        "the text '3'",
        "a number above 0, or a range of such: [low, high], ",
    ),
    ({"gears__module_mm": True}, "gears.module_mm", "true", "a number above 0"),
    ({"gears__module_mm": None}, "gears.module_mm", "null", "a number above 0"),
    ({"gears__module_mm": float("nan")}, "gears.module_mm", "nan", "a number above 0"),
    ({"gears__module_mm": 10**400}, "gears.module_mm", "1000", "a number above 0"),
    ({"gears": 3}, "gears", "3", "a mapping with the keys module_mm, "),
    ({"specimens": True}, "specimens", "true", "a whole number from 1"),
    ({"states": {}}, "states", "an empty mapping", "a mapping by name, such as "),
    ({"states__slight": 3}, "states.slight", "3", "a mapping with the keys fault, "),
    ({"operating_points": 5}, "operating_points", "5", "mapping with speed_hz and torque_nm"),
    ({"sensors__bearing__axes": "vertical"}, "sensors.bearing.axes", "the text 'vertical'", "a list of at least 1"),
    # ranges and words
    (
        {"states__slight__damage__kind": "spal"},
        "states.slight.damage.kind",
        "'spal'",
        "bearing_spall; did you mean 'spall'?",
    ),
    (
        {"states__slight__damage__gear": "pinoin"},
        "states.slight.damage.gear",
        "'pinoin'",
        "either; did you mean 'pinion'?",
    ),
    (
        {"sensors__bearing__kind": "acelerometer"},
        "sensors.bearing.kind",
        "'acelerometer'",
        "; did you mean 'accelerometer'?",
    ),
    ({"gears__module_mm": -3}, "gears.module_mm", "-3.0", "a number above 0"),
    ({"dynamics__mesh_damping_ratio": 1.5}, "dynamics.mesh_damping_ratio", "1.5", "of at least 0 and below 1"),
    ({"gears__gear__profile_shift": 3}, "gears.gear.profile_shift", "3.0", "a number from -1 to 1.5"),
    ({"dynamics__model": "12dof"}, "dynamics.model", "the text '12dof'", "one of 8dof, casing"),
    ({"sensors__bearing__axes": ["up"]}, "sensors.bearing.axes.0", "the text 'up'", "one of vertical, horizontal"),
    (
        {"housing": {"kind": "rigid"}, "sensors__bearing__place": "casing"},
        "sensors.bearing.position_mm",
        "null",
        "[horizontal, vertical] from the centre of gravity; or a measured path",
    ),
    (
        {"sensors__bearing__position_mm": [1.0, 2.0]},
        "sensors.bearing.position_mm",
        "[1.0, 2.0]",
        "null at place pinion_bearing",
    ),
    (
        {"sensors__bearing__place": "lid", "sensors__bearing__position_mm": [1.0]},
        "sensors.bearing.position_mm",
        "[1.0]",
        "a list of 2",
    ),
    (
        {"sensors__bearing__place": "lid", "sensors__bearing__position_mm": [1.0, 2, 3]},
        "sensors.bearing.position_mm",
        "[1.0, 2, 3]",
        "a list of 2, each a number, or a range",
    ),
    (
        {"sensors__bearing__position_mm": [1.0, "a"]},
        "sensors.bearing.position_mm.1",
        "the text 'a'",
        "allowed: a number, or a range",
    ),
    (
        {"housing": {"kind": "rigid", "bolts": {"positions_mm": [[1.0], [2.0, 3.0]]}}},
        "housing.bolts.positions_mm.0",
        "[1.0]",
        "two numbers, [horizontal, vertical] in mm",
    ),
    (
        {"dynamics__model": "8dof", "sensors__bearing__place": "casing", "sensors__bearing__position_mm": [60.0, 50.0]},
        "sensors.bearing.place",
        "'casing'",
        "one of pinion_bearing, gear_bearing (dynamics.model: 8dof)",
    ),
    # housing
    (
        {"housing": {"kind": "rigid", "bolts": {"positions_mm": [[90.0, 0.0], [90.0, 0.0]]}}},
        "housing.bolts.positions_mm",
        "all bolts at [90.0, 0.0]",
        "the casing would turn freely",
    ),
    ({"housing": {"kind": "rigid", "bolts": {"positions_mm": []}}}, "housing.bolts.positions_mm", "", "at least 2"),
    ({"housing": {"kind": "rigid", "mass_kg": -1}}, "housing.mass_kg", "-1.0", "a number above 0"),
    (
        {"housing": {"kind": "rigid", "bolts": {"shear_stiffness_n_per_m": -8e7}}},
        "housing.bolts.shear_stiffness_n_per_m",
        "-80000000.0",
        "a number above 0",
    ),
    ({"housing__kind": "ridgid"}, "housing.kind", "'ridgid'", "one of plates, modal, rigid"),
    ({"housing": 3}, "housing", "3", "a mapping with the keys kind, material"),
    ({"housing": None}, "housing", "null", "a mapping with the keys kind, material"),
    ({"housing__wall_mm": 0}, "housing.wall_mm", "0", "a number above 0 and of at most 10000"),
    ({"housing__damping_ratio": 0.5}, "housing.damping_ratio", "0.5", "a number above 0 and below 0.5"),
    ({"housing__damping_ratio": -1}, "housing.damping_ratio", "-1.0", "a number above 0"),
    ({"housing__material": "wood"}, "housing.material", "'wood'", "one of any, grey_iron, steel"),
    ({"housing__mass_kg": 20.0}, "housing.mass_kg", "20.0", "known keys: kind, material"),
    ({"housing": {"kind": "rigid", "wall_mm": 8.0}}, "housing.wall_mm", "8.0", "known keys: kind, mass_kg"),
    ({"dynamics__model": "8dof", "housing": {"kind": "rigid"}}, "housing", "a section", "dynamics.model: casing"),
    ({"dynamics__model": "8dof", "housing__wall_mm": 8.0}, "housing", "a section", "dynamics.model: casing"),
    (
        {"sensors__bearing__place": "roof"},
        "sensors.bearing.place",
        "'roof'",
        "one of lid, wall, pinion_end, gear_end, foot",
    ),
    (
        {"sensors__bearing__place": "casing", "sensors__bearing__position_mm": [60.0, 50.0]},
        "sensors.bearing.place",
        "'casing'",
        "one of lid, wall, pinion_end, gear_end, foot, pinion_bearing, gear_bearing",
    ),
    (
        {"housing": {"kind": "rigid"}, "sensors__bearing__place": "lid"},
        "sensors.bearing.place",
        "'lid'",
        "one of casing, pinion_bearing, gear_bearing",
    ),
    (
        {"housing": {"kind": "rigid"}, "sensors__bearing__axes": ["axial"]},
        "sensors.bearing.axes",
        "axial",
        "axial needs housing.kind: plates or modal, a path, or helical",
    ),
    (
        {"sensors__bearing__place": "lid", "sensors__bearing__path": {"kind": "modal"}},
        "sensors.bearing.path.kind",
        "'modal'",
        "measured; a sensor on a place of a housing of plates needs no path",
    ),
    (
        {"sensors__bearing__place": "lid", "sensors__bearing__path": {"file": "path.csv"}},
        "sensors.bearing.path",
        "a path at place lid",
        "null, or place: casing",
    ),
    (
        {"dynamics__mesh__law": "linear", "dynamics__friction__model": "constant"},
        "dynamics.friction.model",
        "'constant'",
        "dynamics.mesh.law: pairs",
    ),
    ({"dynamics__mesh__tip_relief_um": -8}, "dynamics.mesh.tip_relief_um", "-8.0", "a number of at least 0"),
    ({"sensors__bearing__bits": 64}, "sensors.bearing.bits", "64", "from 4 to 24, noise, or null"),
    ({"sensors__bearing__bits": "loud"}, "sensors.bearing.bits", "the text 'loud'", "from 4 to 24, noise, or null"),
    ({"sensors__bearing__bits": "noise"}, "sensors.bearing.bits", "noise", "without a noise floor"),
    (
        {"sensors__bearing__bits": "noise", "sensors__bearing__noise": {"floor_m_s2": {"one_of": [0, 1]}}},
        "sensors.bearing.bits",
        "noise",
        "one that may be 0",
    ),
    ({"name": "Bad Name"}, "name", "the text 'Bad Name'", "letters, digits"),
    ({"specimens": 0}, "specimens", "0", "from 1"),
    ({"splits": {"train": 12, "test": 5}}, "splits", "12 + 4 + 5 = 21", "add up to 20"),
    (
        {"stiffness__hertz": "linear"},
        "stiffness.hertz",
        "the text 'linear'",
        "no such key here; known keys: beam",
    ),
    # distributions
    ({"gears__module_mm": [3, 2]}, "gears.module_mm", "[3, 2]", "the low number first"),
    ({"gears__module_mm": [3, 4, 5]}, "gears.module_mm", "[3, 4, 5]", "allowed: [low, high]"),
    ({"gears__module_mm": [-1, 4]}, "gears.module_mm", "[-1, 4]", "above 0"),
    ({"gears__module_mm": {"oneof": [3, 4]}}, "gears.module_mm", "{oneof: [3, 4]}", "mean 'one_of'?"),
    ({"gears__module_mm": {"log": [0, 1]}}, "gears.module_mm", "{log: [0, 1]}", "above 0"),
    ({"gears__module_mm": {"normal": [3, 0.1]}}, "gears.module_mm", "{normal: [3, 0.1]}", "within: [low, high]}"),
    (
        {"gears__module_mm": {"normal": [3, 0.1], "within": [4, 5]}},
        "gears.module_mm",
        "{normal: [3, 0.1], within: [4, 5]}",
        "at least 1%",
    ),
    ({"gears__module_mm": {"one_of": [1, "a"]}}, "gears.module_mm.one_of", "[1, a]", "{one_of: [a, b]}"),
    ({"gears__module_mm": {"one_of": []}}, "gears.module_mm.one_of", "[]", "{one_of: [a, b]}"),
    # numbers for each of several things
    ({"sensors__bearing__gain": [1, -1]}, "sensors.bearing.gain", "[1, -1]", "the low number first"),
    ({"sensors__bearing__gain": {"each": [1, -1]}}, "sensors.bearing.gain.each.1", "-1.0", "above 0"),
    (
        {"sensors__bearing__gain": {"each": [1, 1]}},
        "sensors.bearing.gain",
        "one for each of 2",
        "one for each of 1 axis",
    ),
    # damage
    (
        {"states__slight__damage__kind": "blob"},
        "states.slight.damage.kind",
        "'blob'",
        "one of layered, clustered, spall, list",
    ),
    (
        {"states__slight__damage": {"layers": 1}},
        "states.slight.damage.kind",
        "nothing",
        "one of layered, clustered, spall, list",
    ),
    ({"states__slight__damage": []}, "states.slight.damage", "a list of 0", "kind: layered, clustered, spall, "),
    ({"states__slight__damage__teeth": [0, 0]}, "states.slight.damage.teeth", "[0, 0]", "different tooth indices"),
    ({"states__slight__damage__teeth": 0}, "states.slight.damage.teeth", "0", "a whole number from 1"),
    ({"states__slight__damage__teeth": 19}, "states.slight.damage.teeth", "19", "at most 18, the teeth of the pinion"),
    ({"states__slight__damage__teeth": [3, 18]}, "states.slight.damage.teeth", "tooth 18", "from 0 to 17"),
    (
        {"states__slight__damage__teeth": {"one_of": [1, 1.5]}},
        "states.slight.damage.teeth",
        "1.5",
        "whole",
    ),
    ({"states__slight__damage__gear": "any"}, "states.slight.damage.gear", "'any'", "one of pinion, gear, either"),
    ({"dynamics__friction__oil": ["ISO VG 100", "lard"]}, "dynamics.friction.oil", "a list of 2", "or a list of some"),
    ({"states__slight__damage__first_height_mm": "top"}, "states.slight.damage.first_height_mm", "'top'", "or pitch"),
    # contradictions
    (
        {"states__slight__fault": "spalling"},
        "states.slight.fault",
        "'spalling', with damage of kind layered",
        "pitting; spalling needs",
    ),
    ({"states__slight__fault": "healthy"}, "states.slight.fault", "healthy, with damage", "pitting or spalling"),
    (
        {"states__slight__severity": "healthy"},
        "states.slight.severity",
        "healthy, with damage",
        "any other name, or no damage",
    ),
    (
        {"states__healthy__fault": "pitting"},
        "states.healthy.damage",
        "nothing, with fault pitting",
        "fault and severity both",
    ),
    ({"states": [{"name": "healthy"}]}, "states", "a list of 1", "write states: {healthy: {}}"),
    ({"sensors": [{"name": "lid", "place": "lid"}]}, "sensors", "a list of 1", "write sensors: {lid: {place: lid}}"),
    ({"states__healthy__name": "sound"}, "states.healthy.name", "'sound'", "the name stands before"),
    ({"states__slight__grows": "haelthy"}, "states.slight.grows", "'haelthy'", "did you mean 'healthy'"),
    ({"states__slight__grows": "slight"}, "states.slight.grows", "the state itself", "another state: healthy"),
    ({"states__slight__like": 5}, "states.slight.like", "5", "the name of another state: healthy"),
    ({"states__slight__grows": "healthy"}, "states.slight.grows", "'healthy', which has neither", "with damage or"),
    (
        {"states__healthy__severity": "slight", "states__healthy__grows": "slight", "states__healthy__like": "slight"},
        "states.healthy.grows",
        "'slight' beside like: slight",
        "one of them",
    ),
    ({"states__again": {"grows": "healthy"}}, "states.again.grows", "'healthy', without damage", "allowed: like"),
    (
        {"sensors__bearing__axes": ["vertical", "vertical"]},
        "sensors.bearing.axes",
        "vertical, vertical",
        "each axis once",
    ),
    (
        {"sensors__bearing__noise": {"snr_db": 3, "floor_m_s2": 1}},
        "sensors.bearing.noise.snr_db",
        "3",
        "known keys: floor_m_s2",
    ),
    ({"sensors__bearing__noise": 0.1}, "sensors.bearing.noise", "0.1", "a mapping with floor_m_s2"),
    ({"fs_hz": 2000}, "fs_hz", "2000.0", "mesh harmonic 5 (mesh_harmonics)"),
    ({"duration_s": 0.00001}, "duration_s", "0.512 samples", "a whole number of at least 2 samples"),
]


@pytest.mark.parametrize(("changes", "path", "received", "allowed"), MISTAKES, ids=lambda value: str(value)[:50])
def test_a_mistake_is_the_only_problem_and_is_named(changes, path, received, allowed):
    problems = parse(minimal(**changes)).problems
    (problem,) = [found for found in problems if found.path == path]
    assert received in problem.received
    assert allowed in problem.allowed
    assert len(problems) == 1, [str(found) for found in problems]


@pytest.mark.parametrize(("changes", "path", "received", "allowed"), MISTAKES, ids=lambda value: str(value)[:50])
def test_messages_speak_of_gears_and_not_of_programs(changes, path, received, allowed):
    for problem in parse(minimal(**changes)).problems:
        for jargon in ("Input should", "pydantic", "validator", "dict", "tuple", "None", "str ", "int ", "literal"):
            assert jargon not in f"{problem.received} {problem.allowed}"


def test_states_and_sensors_whose_names_differ_in_case_alone_are_refused():
    sensor = minimal()["sensors"]["bearing"]
    found = parse(minimal(sensors={"end": sensor, "End": sensor}, states__HEALTHY={})).problems
    assert [(one.path, one.received) for one in found] == [
        ("states.HEALTHY", "'HEALTHY' beside 'healthy'"),
        ("sensors.End", "'End' beside 'end'"),
    ]


def test_all_mistakes_are_reported_at_once():
    changes = {
        "seed": "x",
        "gears__modul_mm": 3,
        "states__1st": {},
        "sensors__bearing__bits": 99,
        "fs_hz": -1,
        "foo": 1,
    }
    paths = [problem.path for problem in parse(minimal(**changes)).problems]
    assert sorted(paths) == ["foo", "fs_hz", "gears.modul_mm", "seed", "sensors.bearing.bits", "states.1st"]


def test_a_mistake_in_one_state_hides_neither_the_others_nor_what_follows_from_them():
    raw = minimal(**{"states__X Y": {}, "states__slight__damage__teeth": 40})
    assert [problem.path for problem in parse(raw).problems] == ["states.X Y", "states.slight.damage.teeth"]


def test_a_state_that_is_wrong_does_not_make_its_name_unknown():
    raw = minimal(states__slight__damage__depth_mm=-1)
    raw["states"]["severe"] = {"grows": "slight", "damage": CLUSTER}
    raw["states"]["worst"] = {"grows": "severe", "damage": {"count": 99}}
    assert [problem.path for problem in parse(raw).problems] == ["states.slight.damage.depth_mm"]


@pytest.mark.parametrize("key", list(MINIMAL))
def test_every_key_that_is_needed_is_missed(key):
    raw = minimal()
    del raw[key]
    (problem,) = parse(raw).problems
    assert problem.path == key
    assert problem.received == "nothing"
    assert "needed" in problem.allowed


def test_valid_sections_are_handed_on_when_others_fail():
    parsed = parse(minimal(seed="x", states__healthy__fault="X Y"))
    assert parsed.config is None
    assert parsed.sections["gears"].pinion.teeth == 18
    assert list(parsed.sections["states"]) == ["slight"]
    assert parsed.sections["dynamics"].model == "casing"  # left out: its default
    assert "seed" not in parsed.sections


@pytest.mark.parametrize("value", [3, "x", None, [], [1], {}, {"a": 1}, True, {"kind": []}, {"kind": None}])
@pytest.mark.parametrize("key", list(Config.model_fields))
def test_nothing_that_a_file_may_hold_makes_parsing_fail(key, value):
    assert isinstance(parse(minimal(**{key: value})).problems, tuple)


def test_tags_of_unions_are_never_keys():
    # the path of a problem is what pydantic says without these tags
    keys: set[str] = set()
    waiting: list[type] = [Config]
    while waiting:
        fields = waiting.pop().model_fields
        keys |= set(fields)
        waiting += [model for field in fields.values() for model in models_in(field.annotation)]
    assert not keys & BRANCHES
