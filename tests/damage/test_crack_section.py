"""Cracks as a user writes them: drawn, grown, refused."""

from __future__ import annotations

from math import degrees, inf

import pytest

from siggen.damage.crack import RootCrack
from siggen.errors import ConfigError
from siggen.gears.spur_gear import root_chord
from tests.damage.test_damage import config_with, damage_of
from tests.simulated import damage_rows

UNIFORM = [0.1, 0.2]


def cracked(**keys):
    return {"kind": "crack", **keys}


def test_its_depth_is_a_share_of_the_chord_of_the_root() -> None:
    config = config_with(cracked(depth_share=0.25))
    chord_m = root_chord(config.gearbox(0).pair.pinion).length_m
    (one,) = damage_of(config, 1)
    assert isinstance(one, RootCrack)
    assert (degrees(one.angle_rad), one.run_m) == (pytest.approx(45.0), inf)
    assert one.depth_m == pytest.approx(0.25 * chord_m)


def test_it_grows_deeper_on_its_teeth_and_stays_one_crack_each() -> None:
    deeper = [0.15, 0.4]
    config = config_with(
        cracked(depth_share=UNIFORM, face_share=0.5, teeth=2, angle_deg=[40, 60]),
        cracked(depth_share=deeper, teeth=2, angle_deg=[40, 60]),
    )
    for specimen in range(4):
        milder, harder = damage_of(config, 1, specimen), damage_of(config, 2, specimen)
        assert len(milder) == len(harder) == 2
        for old, new in zip(milder, harder, strict=True):
            assert new.hides(old)
            assert (new.tooth, new.angle_rad) == (old.tooth, old.angle_rad)
            assert new.depth_m > old.depth_m


def test_a_crack_in_another_tooth_may_have_another_angle() -> None:
    config = config_with(
        cracked(depth_share=0.3, teeth=[2]), cracked(depth_share=0.1, teeth=[7], angle_deg=60.0, face_share=0.5)
    )
    assert [one.tooth for one in damage_of(config, 2)] == [2, 7]


def test_its_row_has_depth_angle_and_run_and_stands_beside_pits() -> None:
    pits = {"kind": "clustered", "count": 2, "spread_profile_mm": 0.2, "semi_axis_face_mm": 0.3}
    pits |= {"semi_axis_profile_mm": 0.2, "depth_mm": 0.3}
    config = config_with(pits, cracked(depth_share=0.2, angle_deg=50, face_share=0.5))
    rows = [row for n in range(3 * config.repeats) for row in damage_rows(config, n) if row["kind"] == "crack"]
    assert rows
    for row in rows:
        assert (row["depth_mm"], row["crack_run_mm"]) == (pytest.approx(0.2 * 5.7188, rel=1e-4), pytest.approx(10.0))
        assert row["crack_angle_deg"] == pytest.approx(50.0)
        assert (row["shape"], row["polygon_face_mm"]) == ("none", [])


@pytest.mark.parametrize(
    ("damages", "said"),
    [
        ([cracked(depth_share=0.5)], ("states.slight.damage.depth_share", "0.5", "above 0 and of at most 0.45")),
        ([cracked(depth_share=0.2, angle_deg=80)], ("states.slight.damage.angle_deg", "80", "35", "70")),
        ([cracked()], ("states.slight.damage.depth_share", "nothing", "this key is needed")),
        ([cracked(depth_share=0.2, face_share=0)], ("states.slight.damage.face_share", "0", "above 0")),
        ([cracked(depth_share=0.2, gear="pinion", teeth=[18])], ("states.slight.damage.teeth", "tooth 18", "0 to 17")),
        (
            [cracked(depth_share=0.2), cracked(depth_share=0.3, angle_deg=60)],
            ("states.moderate.damage.angle_deg", "60", "45, as in the milder state"),
        ),
        (
            [cracked(depth_share=0.2), cracked(depth_share=0.2)],
            ("states.moderate.damage.depth_share", "like: slight in place of grows"),
        ),
        ([cracked(depth_share=0.2), cracked(depth_share=0.1)], ("states.moderate.damage.depth_share", "at least 0.2")),
        (
            [cracked(depth_share=UNIFORM), cracked(depth_share=[0.05, 0.2])],
            ("states.moderate.damage.depth_share", "0.05 to 0.2", "at least 0.1 to 0.2"),
        ),
        (
            [cracked(depth_share=0.2), cracked(depth_share=0.3, face_share=0.6)],
            ("states.moderate.damage.face_share", "received 0.6", "allowed: null, as in the milder state"),
        ),
    ],
)
def test_what_cannot_be_is_refused_with_key_value_and_what_is_allowed(damages, said) -> None:
    with pytest.raises(ConfigError) as refused:
        config_with(*damages)
    for part in said:
        assert part in str(refused.value)
