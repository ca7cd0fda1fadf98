"""A machine in the user's own names: what it means, what is refused, and where it is said to be wrong."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from siggen.checks.loading import load_config
from siggen.config import parse, yaml_text
from siggen.errors import ConfigError
from siggen.gearbox.configured import gearbox_config
from siggen.record.structure import structure
from siggen.record.teeth import all_teeth
from siggen.sets.drawn import set_columns
from tests.config.idler import MACHINE as MACHINE_OF_IDLER
from tests.config.idler import idler, with_idler
from tests.config.mill import MACHINE, mill, with_machine
from tests.config.minimal import by_name
from tests.config.staged import SLOW, SPALL, staged
from tests.simulated import label_names

WHEEL = {"teeth": 20, "bore_radius_mm": 12.0}
MESH = {"module_mm": 2.0, "face_width_mm": 20.0}


def test_other_names_and_another_order_make_the_same_gearbox() -> None:
    own, short = parse(mill()).config, parse(staged(
        stages=[{**SLOW, "gear": {"mass_kg": 6.0}, "span_mm": 120.0}], sensors={"bearing": {}}
    )).config  # fmt: skip
    assert own is not None
    assert short is not None
    for section in ("gears", "stages", "dynamics"):
        assert getattr(own, section) == getattr(short, section), section
    assert own.identity != short.identity, "their columns have other names"


def test_gears_that_bear_each_others_usual_names_keep_them_in_columns_labels_and_the_graph() -> None:
    """The driver is called gear and runs on a shaft gear, what it drives is called pinion."""
    called = {"ida": "gear", "otto": "pinion", "input": "gear", "middle": "pinion", "eva": "Eva"}
    renamed = {
        part: {
            called.get(name, name): {key: called.get(str(value), value) for key, value in one.items()}
            for name, one in MACHINE[part].items()
        }
        for part in MACHINE
    }
    damage = {**SPALL, "gear": "gear", "teeth": [3]}
    states = by_name([{"name": "healthy"}, {"name": "severe", "damage": damage}])
    config = load_config(mill(machine=renamed, sensors={"at": {"place": "gear_bearing"}}, states=states))
    of = {(column.quantity, column.of): column for column in set_columns(config).labels if column.of}
    assert of["teeth", "gear"].name == "teeth_gear"
    assert of["teeth", "gear"].label == "teeth_pinion"  # which the driver of a mesh is inside
    assert of["shaft_hz", "pinion"].name == "pinion_shaft_hz"
    assert of["teeth", "Eva"].name == "teeth_Eva"
    assert config.config.states[1].damages[0].hit_gear == "gear"
    assert structure(config.gearbox(0)).coordinates[1:4] == ("x_gear", "y_gear", "theta_gear")


def test_its_own_file_reads_the_same_and_never_says_pinion() -> None:
    config = parse(mill(manufacture={"accuracy_class": 6}, internals={"quantities": ["mesh_force_n"]})).config
    assert config is not None
    text = yaml_text(config.canonical())
    assert "pinion" not in text
    assert parse(config.canonical()).config == config


def test_states_change_shafts_by_their_place_in_the_machine() -> None:
    key = "machine.shafts.input.bearing.stiffness_n_per_m"
    state = {"name": "soft", "fault": "loose_bearing", "severity": "slight", "changes": {key: {"times": 0.5}}}
    config = load_config(mill(states=by_name([{"name": "healthy"}, state])))
    assert list(config.config.canonical()["states"]["soft"]["changes"]) == [key]
    healthy, soft = (config.gearbox(0).in_state(state).train for state in range(2))
    assert healthy is not None
    assert soft is not None
    bearings = [one.first.pinion.bearing.stiffness_x_n_per_m for one in (healthy, soft)]
    assert bearings[1] == 0.5 * bearings[0]


def loop(teeth: int) -> dict[str, Any]:
    """Return the machine with a mesh that drives the first shaft from the last one."""
    gears = {"x": {**WHEEL, "shaft": "output"}, "y": {**WHEEL, "shaft": "input", "teeth": teeth}}
    meshes = {**MACHINE["meshes"], "back": {**MESH, "driver": "x", "driven": "y"}}
    return {**MACHINE, "gears": {**MACHINE["gears"], **gears}, "meshes": meshes}


def beside(*gears: dict[str, Any], meshes: tuple[dict[str, Any], ...] = (), **shaft: Any) -> dict[str, Any]:
    """Return the machine with more gears and meshes, and a shaft if it is given."""
    more = {"shafts": [shaft] if shaft else [], "gears": gears, "meshes": meshes}
    return {part: {**MACHINE[part], **by_name(more[part])} for part in MACHINE}


def renamed(part: str, old: str, new: str) -> dict[str, Any]:
    """Return the machine with another name of a shaft or gear that nothing else says."""
    return {**MACHINE, part: {new if name == old else name: one for name, one in MACHINE[part].items()}}


ELSE = {**WHEEL, "name": "else", "shaft": "output"}
MISTAKES: dict[str, tuple[dict[str, Any], str, str]] = {
    "a gear on no shaft": (
        with_machine("gears", "ida", shaft="inptu"), "machine.gears.ida.shaft", "did you mean 'input'?",
    ),
    "a mesh of no gear": (
        with_machine("meshes", "slow", driver="eve"), "machine.meshes.slow.driver", "did you mean 'eva'?",
    ),
    "gears of one shaft": (
        with_machine("meshes", "slow", driven="otto"), "machine.meshes.slow.driven", "the shaft middle",
    ),
    "a name but for its case": (renamed("gears", "ida", "OTTO"), "machine.gears.otto", "'otto' beside 'OTTO'"),
    "a word that is taken": (renamed("shafts", "input", "Load"), "machine.shafts.Load", "another name than"),
    "a gear in no mesh": (beside(ELSE), "machine.gears.else", "'else', in 0 meshes"),
    "a gear in three meshes": (
        beside(
            ELSE, {**ELSE, "name": "more", "shaft": "input"},
            meshes=tuple({**MESH, "name": f"m_{one}", "driver": "otto", "driven": one} for one in ("else", "more")),
        ), "machine.gears.otto", "'otto', in 3 meshes: fast, m_else, m_more; allowed: one mesh, or two of an idler",
    ),
    "a shaft apart": (beside(name="far"), "machine.shafts.far", "'far', which no mesh joins with the shaft output"),
    "a loop that cannot turn": (
        loop(23), "machine.meshes.back",
        "'back', which closes a loop with slow, fast and cannot turn: by its teeth the shaft input makes -0.8696 turns "
        "per turn of output, by theirs 7.987; allowed: one way from the motor to the load; leave one mesh of the loop",
    ),
    "a gear called as a mesh": (renamed("gears", "karl", "fast"), "machine.gears.fast", "as a mesh is called"),
    "a list": (
        {**MACHINE, "shafts": [{"name": "input"}, {"name": "output", "mass_kg": 6.0}]},
        "machine.shafts", "write {input: {}, output: {mass_kg: 6}}",
    ),
    "a span of one gear's shaft": (
        with_machine("shafts", "input", span_mm=90.0), "machine.shafts.input.span_mm", "one gear",
    ),
    "a branch": (
        beside(
            ELSE | {"shaft": "side"}, {**ELSE, "name": "more", "shaft": "middle"}, name="side",
            meshes=({**MESH, "name": "aside", "driver": "more", "driven": "else"},),
        ), "machine.shafts.middle", "'middle', which drives 2 meshes",
    ),
    "too few teeth": (with_machine("gears", "eva", teeth=3), "machine.gears.eva.teeth", "from 5 to 1000"),
    "a key that is none": (with_machine("gears", "eva", teeht=3), "machine.gears.eva.teeht", "did you mean 'teeth'?"),
    "centres too close": (
        with_machine("meshes", "slow", centre_distance_mm=40.0), "machine.meshes.slow.centre_distance_mm", "40",
    ),
}  # fmt: skip


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_machine_that_cannot_be_is_refused_at_the_users_line(mistake: str, tmp_path: Path) -> None:
    machine, path, words = MISTAKES[mistake]
    text = yaml_text(mill(machine=machine))
    (tmp_path / "mill.yaml").write_text(text)
    with pytest.raises(ConfigError) as refused:
        load_config(tmp_path / "mill.yaml")
    found = {one.path: one for one in refused.value.problems}
    assert path in found, str(refused.value)
    assert words in str(found[path])
    assert found[path].where.startswith("line "), found[path]
    assert "pinion" not in str(refused.value)


def test_an_idler_is_named_by_the_mesh_of_each_flank() -> None:
    config = load_config(idler(sensors={"out": {"kind": "encoder", "place": "b"}}))
    assert [state.damages[0].gear for state in config.config.states[1:]] == ["first.b", "second.b"]
    assert parse(config.canonical()).config == config.config
    assert {"faulty_teeth_first_b", "faulty_teeth_second_b"} <= set(label_names(config))
    drawn = config.gearbox(0)
    assert drawn.meshes[1].pair.pinion == drawn.pair.gear


def test_an_idler_whose_bore_is_drawn_has_one() -> None:
    bore = [10.0, 14.0]
    drawn = load_config(idler(machine=with_idler("gears", "b", bore_radius_mm=bore))).gearbox(3)
    assert drawn.meshes[1].pair.pinion.bore_radius_m == drawn.pair.gear.bore_radius_m


@pytest.mark.parametrize(("word", "gears"), [("fast.either", {"ida", "otto"}), ("slow.either", {"eva", "karl"})])
def test_either_of_any_mesh_is_one_of_its_gears_drawn_per_gearbox(word: str, gears: set[str]) -> None:
    damage = {**SPALL, "gear": word, "teeth": 1}
    config = load_config(mill(states={"healthy": {}, "severe": {"damage": damage}}))
    drawn = [gearbox_config(config.config, number).states[1].damages[0].hit_gear for number in range(12)]
    assert set(drawn) == gears
    specimen, (front, behind) = config.gearbox(0), (("ida", "otto"), ("eva", "karl"))
    counts = [len(one.damage(1)) for one in all_teeth(specimen)]
    assert counts == [int(drawn[0] in front), int(drawn[0] in behind)]


@pytest.mark.parametrize(("place", "drawn"), [("input_bearing", "pinion_bearing"), ("middle_bearing", "gear_bearing")])
def test_a_spalled_bearing_is_called_by_its_shaft_and_is_one_of_the_first_two(place: str, drawn: str) -> None:
    def made(bearing: str) -> dict[str, Any]:
        spall = {"kind": "bearing_spall", "element": "outer", "length_mm": 1.0, "bearing": bearing}
        return mill(states={"healthy": {}, "severe": {"damage": spall}})

    config = load_config(made(place))
    assert config.canonical()["states"]["severe"]["damage"]["bearing"] == place
    (part,) = next(iter(all_teeth(config.gearbox(0)))).damage(1)
    assert part.table_row()["bearing"] == drawn
    (problem,) = parse(made("output_bearing")).problems
    assert problem.path == "states.severe.damage.bearing"
    assert problem.allowed.startswith("allowed: one of input_bearing, middle_bearing")


OF_IDLERS: dict[str, tuple[dict[str, Any], str, str]] = {
    "teeth of two sizes": (
        {"machine": with_idler("meshes", "second", module_mm=2.5)},
        "machine.meshes.second.module_mm", "an idler is one gear",
    ),
    "a span": ({"machine": with_idler("shafts", "middle", span_mm=90.0)}, "machine.shafts.middle.span_mm", "one gear"),
    "tips in one another": (
        {"machine": with_idler("meshes", "second", direction_deg=150.0)},
        "machine.meshes.second.direction_deg", "tip radii",
    ),
    "two gears that drive it": (
        {"machine": with_idler("meshes", "second", driver="c", driven="b")},
        "machine.shafts.middle", "is driven in 2 meshes",
    ),
    "damage of no flank": (
        {"states": {"bad": {"severity": "slight", "damage": {**SPALL, "gear": "b"}}}},
        "states.bad.damage.gear", "first.b, second.b, c",
    ),
    "a tooth that is gone": (
        {"states": {"bad": {"severity": "slight", "damage": {
            "kind": "chip", "gear": "second.b", "height_mm": "whole",
        }}}}, "states.bad.damage.kind", "pits, spalls and cracks of an idler",
    ),
    "a name of a flank": (
        {"machine": {
            **with_idler("meshes", "second", driven="second_b"),
            "gears": {{"c": "second_b"}.get(name, name): one for name, one in MACHINE_OF_IDLER["gears"].items()},
        }}, "machine.gears.second_b", "whose columns are its own",
    ),
}  # fmt: skip


@pytest.mark.parametrize("mistake", OF_IDLERS)
def test_an_idler_that_cannot_be_is_refused_with_the_users_names(mistake: str) -> None:
    changes, path, words = OF_IDLERS[mistake]
    with pytest.raises(ConfigError) as refused:
        load_config(idler(**changes))
    found = {one.path: str(one) for one in refused.value.problems}
    assert path in found, str(refused.value)
    assert words in found[path]
    assert "pinion" not in str(refused.value)


def test_a_loop_whose_ratios_agree_turns_but_has_two_ways_for_power() -> None:
    twins = {"p": {**WHEEL, "shaft": "input", "teeth": 18}, "q": {**WHEEL, "shaft": "middle", "teeth": 47}}
    gears = {**MACHINE["gears"], **twins}
    meshes = {**MACHINE["meshes"], "twin": {**MESH, "driver": "p", "driven": "q"}}
    (problem,) = parse(mill(machine={**MACHINE, "gears": gears, "meshes": meshes})).problems
    assert problem.path == "machine.meshes.twin"
    assert problem.received == "'twin', which closes a loop with fast"


def test_a_machine_takes_the_place_of_gears_and_shafts_that_its_file_extends() -> None:
    own = {"machine": mill()["machine"]} | {key: {"others": None, **mill()[key]} for key in ("sensors", "states")}
    found = load_config({"extends": "quickstart", **own, "housing": {"kind": "rigid"}, "background": None})
    assert found.config.gears.pinion.teeth == 18
    assert found.config.dynamics.shafts is None
    assert found.config.dynamics.pinion.mass_kg is None
    with pytest.raises(ConfigError) as refused:
        load_config({"extends": "quickstart", **own, "gears": {"module_mm": 2.0}, "dynamics": {"shafts": {}}})
    told = [problem.path for problem in refused.value.problems]
    assert sorted(told) == sorted({*told}), "one sentence at each key"
    assert {"gears", "dynamics.shafts"} < {*told}


OTHERS: dict[str, tuple[dict[str, Any], str, str]] = {
    "damage": (
        {"states": {"bad": {"severity": "slight", "damage": {**SPALL, "gear": "pinion"}}}},
        "states.bad.damage.gear",
        "karl",
    ),
    "place": ({"sensors": {"a": {"place": "pinion_bearing"}}}, "sensors.a.place", "input_bearing"),
    "beside": ({"planetary": {"ring_teeth": 77}}, "planetary", "either this section or machine"),
    "rotor": ({"dynamics": {"model": "8dof", "gear": {"mass_kg": 1.0}}}, "dynamics.gear", "machine.shafts"),
    "casing": ({"dynamics": {"model": "6dof"}}, "dynamics.model", "8dof, casing"),
}


@pytest.mark.parametrize("case", OTHERS)
def test_words_of_a_pair_are_none_of_a_machine(case: str) -> None:
    changes, path, words = OTHERS[case]
    found = {one.path: one for one in parse(mill(**changes)).problems}
    assert list(found) == [path]
    assert words in found[path].allowed
    assert "pinion" not in found[path].allowed


BEHIND: dict[str, tuple[dict[str, Any], str]] = {
    "balls": ({"bearing": {"geometry": {}}}, "bearing.geometry"),
    "a seat off its axis": ({"eccentricity_um": 5.0}, "eccentricity_um"),
}


@pytest.mark.parametrize("case", BEHIND)
def test_what_only_the_first_two_shafts_can_have_is_refused_on_those_behind(case: str) -> None:
    shaft, key = BEHIND[case]
    (problem,) = parse(
        mill(machine=with_machine("shafts", "output", **shaft), manufacture={"accuracy_class": 6})
    ).problems
    assert problem.path == f"machine.shafts.output.{key}"
    assert problem.allowed == "allowed: none on a shaft behind the second"
