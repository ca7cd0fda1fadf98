"""Every pair of a set is checked before anything is simulated, and named with its place."""

from __future__ import annotations

from pathlib import Path

import pytest

from siggen.checks.loading import load_config
from siggen.checks.plausibility import implausible
from siggen.config import yaml_text
from siggen.errors import ConfigError

PLAIN = str(Path(__file__).parents[1] / "configs" / "linear_pits.yaml")
SOUND = "{teeth: [18, 47], module_mm: 3, face_width_mm: 20}"
WRONG = [
    # (pair, what is told)
    ("{teeth: [7, 40], module_mm: 3, face_width_mm: 20}", "7/40 teeth, m 3, b 20 mm: gears.pinion"),
    ("{teeth: [18, 47], module_mm: 3, face_width_mm: 20, profile_shifts: [-0.9, 0]}", "m 3, b 20 mm: gears.gear"),
    ("{teeth: [290, 291], module_mm: 3, face_width_mm: 20}", "fs_hz"),
]


@pytest.mark.parametrize(("pair", "told"), WRONG)
def test_a_pair_that_cannot_be_is_refused_by_name_and_the_others_are_not(pair: str, told: str) -> None:
    with pytest.raises(ConfigError) as refused:
        load_config(PLAIN, [f"gears.pairs=[{SOUND}, {pair}]"])
    (problem,) = refused.value.problems
    assert problem.path == ("fs_hz" if told == "fs_hz" else "gears.pairs.1")
    assert told in f"{problem.path}: {problem.received}"


def test_an_empty_list_is_refused_where_someone_wrote_it_and_not_in_a_stored_configuration(tmp_path: Path) -> None:
    own = tmp_path / "own.yaml"
    own.write_text(f"extends: {PLAIN}\ngears:\n  pairs: []\n")
    for source, overrides, where in ((own, [], "line 3"), (PLAIN, ["gears.pairs=[]"], "--set gears.pairs")):
        with pytest.raises(ConfigError, match="a list without a pair; allowed: one pair at least, or null") as refused:
            load_config(source, overrides)
        assert refused.value.problems[0].where == where
    plain = load_config(PLAIN, ["gears.pairs=null"])
    stored = tmp_path / "config.yaml"
    stored.write_text(yaml_text(plain.canonical()))
    assert "pairs: []" in stored.read_text()
    assert load_config(stored).identity == load_config(PLAIN).identity


def test_damage_that_may_be_on_either_gear_is_checked_on_both() -> None:
    layered = "states.slight.damage={{kind: layered, gear: {}, layers: 1, pits_per_layer: 1, first_height_mm: 1.2, \
semi_axis_face_mm: 0.2, semi_axis_profile_mm: 0.2, depth_mm: 0.1}}"
    alone = ["states.moderate=null", "states.severe=null"]
    load_config(PLAIN, [layered.format("pinion"), *alone])
    found = {}
    for gear in ("gear", "either"):
        with pytest.raises(ConfigError) as refused:
            load_config(PLAIN, [layered.format(gear), *alone])
        found[gear] = [str(problem) for problem in refused.value.problems]
    assert found["gear"] == found["either"]


def test_what_is_implausible_of_a_pair_is_told_once_with_that_pair_and_their_number() -> None:
    thin = "{teeth: [19, 48], module_mm: 3, face_width_mm: 4}"
    sentences = [
        sentence
        for sentence in implausible(load_config("quickstart", [f"gears.pairs=[{SOUND}, {thin}]"]).possible)
        if "face width over module" in sentence
    ]
    assert len(sentences) == 1
    assert "gears.pairs.1, 19/48 teeth, m 3, b 4 mm (1 of 2 pairs)" in sentences[0]


def test_a_state_may_shift_a_drawn_number_of_every_pair_as_far_as_its_key_allows() -> None:
    pairs = f"gears.pairs=[{SOUND}, {SOUND.replace('47', '48')}]"
    shifted = (
        "states.sham={{severity: slight, fault: misalignment, changes: "
        "{{manufacture.lead_misalignment_um: {{add: [15, 30]}}, sensors.side.gain: {{times: {}}}}}}}"
    )
    load_config("quickstart", [pairs, shifted.format(0.7)])
    with pytest.raises(ConfigError) as refused:
        load_config("quickstart", [pairs, shifted.format(-1)])
    assert {problem.path for problem in refused.value.problems} == {"states.sham.changes.sensors.side.gain"}
