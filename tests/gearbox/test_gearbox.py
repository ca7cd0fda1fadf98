"""Which gear pair a gearbox has, and which split a pair belongs to."""

from __future__ import annotations

from collections import Counter
from math import gcd

import pytest

from siggen.config import parse
from siggen.gearbox.configured import gearbox_config, pair_of
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import SPLITS, specimen_count, split_of
from tests.config.minimal import by_name, config, minimal

RANGES = {
    "count": 40,
    "pinion_teeth": [16.5, 30.5],
    "ratio": {"log": [1.2, 4.0]},
    "module_mm": {"one_of": [2.0, 2.5, 3.0]},
    "face_width_over_module": [8.0, 15.0],
}


def test_every_pair_occurs_once_in_every_block_and_more_gearboxes_change_none() -> None:
    small, large = (config(gears__pairs=RANGES, specimens=count) for count in (60, 90))
    chosen = [pair_of(large, i) for i in range(80)]
    assert Counter(chosen) == dict.fromkeys(range(40), 2)
    assert [pair_of(small, i) for i in range(60)] == chosen[:60]
    assert chosen[:40] != sorted(chosen[:40])


def test_drawn_pairs_lie_in_their_ranges_differ_and_hunt() -> None:
    pairs = config(gears__pairs=RANGES).gears.pairs
    assert len(set(pairs)) == 40
    assert all(gcd(*pair.teeth) == 1 and 17 <= pair.teeth[0] <= 30 for pair in pairs)
    assert all(7.5 <= pair.face_width_mm / pair.module_mm <= 15.5 for pair in pairs)
    assert pairs == config(gears__pairs=RANGES, seed=8).gears.pairs
    made = config(gears__pairs=RANGES)
    again = parse(made.canonical()).config
    assert again is not None
    assert (again, again.identity) == (made, made.identity)
    assert pairs[:20] == config(gears__pairs={**RANGES, "count": 20}).gears.pairs


def test_split_by_pair_shares_no_pair_between_splits_and_counts_without_listing() -> None:
    made = config(gears__pairs=RANGES, splits__by="pair", specimens=130)
    members = {split: [i for i in range(130) if split_of(SetDesign(made), i) == split] for split in SPLITS}
    pairs = {split: {pair_of(made, i) for i in members[split]} for split in SPLITS}
    assert [len(pairs[split]) for split in SPLITS] == [24, 8, 8]
    assert not pairs["train"] & pairs["test"]
    assert not pairs["train"] & pairs["validation"]
    assert [specimen_count(SetDesign(made), split) for split in SPLITS] == [len(members[s]) for s in SPLITS]
    by_gearbox = config(gears__pairs=RANGES, specimens=130)
    assert by_gearbox.identity != made.identity
    assert any(split_of(SetDesign(by_gearbox), i) != split_of(SetDesign(made), i) for i in range(40))


@pytest.mark.parametrize(
    ("changes", "path", "text"),
    [
        ({"gears__pairs": {**RANGES, "pinion_teeth": 18, "ratio": 2, "module_mm": 3}}, "gears.pairs.count", "as many"),
        ({"gears__pairs": [{"teeth": [18, 47], "module_mm": 3, "face_width_mm": 20}] * 2}, "gears.pairs.1", "once"),
        ({"gears__pairs": [{"teeth": [8], "module_mm": 3, "face_width_mm": 9}]}, "gears.pairs.0.teeth", "pinion, gear"),
        ({"gears__pairs": {"count": 3}}, "gears.pairs.pinion_teeth", "a number"),
        ({"splits__by": "pair"}, "splits.by", "gears.pairs"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_with_its_place(changes: dict[str, object], path: str, text: str) -> None:
    problems = {problem.path: problem.allowed for problem in parse(minimal(**changes)).problems}
    assert path in problems, problems
    assert text in problems[path]


PITS = {
    "kind": "clustered",
    "spread_profile_mm": 0.3,
    "semi_axis_face_mm": 0.3,
    "semi_axis_profile_mm": 0.2,
    "depth_mm": 0.1,
}
DRAWN = {
    "states": by_name(
        [
            {"name": "healthy"},
            *(
                {
                    "name": name,
                    "damage": {**PITS, "gear": "either", "teeth": {"one_of": [1, 3]}, "count": n},
                }
                for name, n in (("slight", 4), ("severe", 9))
            ),
        ]
    ),
    "dynamics__friction__oil": ["ISO VG 100", "ISO VG 220", "ISO VG 460"],
    "sensors": {"lid": {"place": "lid", "position_mm": [[20, 60], 5.0]}},
}


def test_a_gearbox_draws_gear_teeth_and_oil_once_for_all_of_its_states_and_place_of_its_sensor() -> None:
    made = config(**DRAWN)
    seen: Counter[object] = Counter()
    for specimen_id in range(40):
        own = gearbox_config(made, specimen_id)
        assert gearbox_config(own, specimen_id) == own
        slight, severe = (state.damage for state in own.states[1:])
        assert (slight.gear, slight.teeth) == (severe.gear, severe.teeth)  # type: ignore[union-attr]
        oil, horizontal = SetDesign(made).gearbox(specimen_id).labels.values()
        assert oil == own.dynamics.friction.oil
        assert 20.0 <= float(str(horizontal)) <= 60.0
        seen.update((slight.gear, slight.teeth, own.dynamics.friction.oil))  # type: ignore[union-attr]
    assert all(10 <= seen[value] <= 30 for value in ("pinion", "gear", 1, 3)), seen
    assert all(5 <= seen[oil] <= 25 for oil in DRAWN["dynamics__friction__oil"]), seen


def test_naming_one_gear_one_number_and_one_place_keeps_the_identity() -> None:
    plain = config(sensors={"lid": {"place": "lid", "position_mm": [20.0, 5.0]}})
    assert plain.sensors[0].position_mm == (20.0, 5.0)
    assert gearbox_config(plain, 3) is plain
