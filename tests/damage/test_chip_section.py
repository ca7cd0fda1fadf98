"""Chipped and broken teeth of a state: from the configuration to records, labels, growth and messages."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from siggen.columns.record import SimulatedRecord
from siggen.damage.chip import WholeChip
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from siggen.record.quantity_names import available_quantities
from siggen.record.specimen_state import specimen_state
from tests.damage.test_damage import config_with, damage_of
from tests.simulated import damage_rows, simulate

CHIP: dict[str, Any] = {"kind": "chip", "height_mm": 1.5}
BROKEN: dict[str, Any] = {"kind": "chip", "height_mm": "whole"}


def quick(*damages: dict[str, Any], torque_nm: float = 60.0, speed_hz: float = 30.0) -> SetDesign:
    config = config_with(*damages)
    (point,) = config.config.operating_points
    points = (point.model_copy(update={"torque_nm": torque_nm, "speed_hz": speed_hz}),)
    return config.with_sections(fs_hz=27000.0, duration_s=0.3, operating_points=points)


def records(config: SetDesign, ids: list[int]) -> list[SimulatedRecord]:
    found = simulate(config, ids)
    assert all(isinstance(one, SimulatedRecord) for one in found), found
    return [one for one in found if isinstance(one, SimulatedRecord)]


def test_a_missing_tooth_is_simulated_and_strikes_once_per_turn() -> None:
    config = quick(BROKEN)
    healthy, broken = records(config, [0, 1])
    assert (broken.labels["fault"], broken.labels["faulty_gear"]) == ("broken_tooth", "pinion")
    (tooth,) = broken.labels["faulty_teeth_pinion"]  # type: ignore[misc]
    assert 0 <= tooth < 18
    signals = [one.channels["bearing_vertical"].astype(float) for one in (healthy, broken)]
    turns = [signal.reshape(9, 900) for signal in signals]
    # Perfect gears: every turn like the others, but one of the broken gear's is no mesh period like the others.
    np.testing.assert_allclose(turns[1][3], turns[1][6], atol=0.02 * np.abs(turns[1]).max())
    levels = [np.sqrt(np.mean(turn[4].reshape(18, 50) ** 2, axis=1)) for turn in turns]
    assert levels[1].max() > 10.0 * levels[0].max()


def test_a_small_chip_shows_where_its_pair_leaves_and_no_teeth_part() -> None:
    """Against its sham, which starts at the same angle and differs in nothing else."""
    config = quick(CHIP)
    sham = (config.config.states[0], config.config.states[1].model_copy(update={"acts": False}))
    (whole,), (chipped,) = records(config.with_sections(states=sham), [1]), records(config, [1])
    assert chipped.labels["fault"] == "chip"
    assert chipped.labels["contact_loss_share"] == 0.0
    first, second = (one.channels["bearing_vertical"].astype(float) for one in (whole, chipped))
    # a tip of 1.5 mm is a third of the way after the pitch point: more than rounding, less than another machine
    assert 0.05 * np.std(first) < np.std(second - first) < 2.0 * np.std(first)


def test_quantities_of_pairs_are_as_many_as_a_missing_tooth_has_in_reach() -> None:
    names = [available_quantities(config_with(*damages).possible) for damages in ((CHIP,), (BROKEN,))]
    pairs = [len({name.split("_")[1] for name in found if name.startswith("pair_")}) for found in names]
    assert pairs == [2, 3]


def test_rows_tell_what_is_lost_and_a_broken_tooth_takes_the_place_of_its_chip() -> None:
    config = config_with({**CHIP, "teeth": [4, 9]}, {**BROKEN, "teeth": [4, 9]})
    assert [(one.tooth, one.height_m) for one in damage_of(config, 1)] == [(4, 1.5e-3), (9, 1.5e-3)]
    assert [(one.tooth, one.whole_tooth) for one in damage_of(config, 2)] == [(4, True), (9, True)]
    rows = damage_rows(config, 1), damage_rows(config, 2)
    assert [(row["kind"], row["tooth"], row["chip_height_mm"]) for row in rows[0]] == [
        ("chip", 4, 1.5),
        ("chip", 9, 1.5),
    ]
    assert [(row["kind"], row["chip_height_mm"]) for row in rows[1]] == [("broken_tooth", 0.0)] * 2


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"height_mm": 0.0}, r"states\.slight\.damage\.height_mm: received 0\.0; allowed: a number above 0"),
        (
            {"height_mm": 6.8},
            r"states\.slight\.damage\.height_mm: received 6\.8; allowed: up to 6\.75, the height of the",
        ),
        ({"height_mm": "half"}, r"states\.slight\.damage\.height_mm: received the text 'half'; .* or whole"),
        (
            {"height_mm": "whole", "teeth": 2},
            r"states\.slight\.damage\.teeth: received 2; allowed: teeth that are no neigh",
        ),
        ({"height_mm": "whole", "teeth": [0, 17]}, r"states\.slight\.damage\.teeth: .* no neighbours"),
        ({"face_share": 1.2}, r"states\.slight\.damage\.face_share: received 1\.2; allowed: a number above 0"),
        ({"face_share": 0.0}, r"states\.slight\.damage\.face_share: received 0\.0; allowed: a number above 0"),
        ({"teeth": [18]}, r"states\.slight\.damage\.teeth: received tooth 18"),
    ],
)
def test_what_cannot_be_is_refused_by_name(change: dict[str, Any], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        config_with({**CHIP, **change})


@pytest.mark.parametrize("share", [None, 1.0])
def test_a_chip_over_all_of_the_face_is_the_one_without_a_share(share: float | None) -> None:
    config = config_with({**CHIP, "teeth": [4], "face_share": share})
    assert damage_of(config, 1) == (WholeChip("pinion", 4, 1.5e-3),)


def test_rows_tell_how_much_of_the_face_is_lost_and_more_takes_the_place_of_less() -> None:
    part = {**CHIP, "teeth": [4], "face_share": 0.3}
    config = config_with(part, {**part, "height_mm": "whole", "face_share": 0.5})
    assert [len(damage_of(config, state)) for state in (1, 2)] == [1, 1]
    found = [damage_rows(config, state)[0] for state in (1, 2)]
    assert [(row["kind"], row["chip_height_mm"], row["chip_width_mm"]) for row in found] == [
        ("chip", 1.5, 6.0),
        ("broken_tooth", 0.0, 10.0),
    ]


def test_a_chip_needs_flanks_with_a_shape_and_a_state_more_of_it_than_its_milder_one() -> None:
    with pytest.raises(ConfigError, match=r"states\.slight\.damage\.kind: received 'chip'; allowed: another kind with"):
        config_with(CHIP, law="linear")
    with pytest.raises(ConfigError, match=r"states\.moderate\.damage\.height_mm"):
        config_with(CHIP, {**CHIP, "height_mm": 1.0})


def test_a_missing_tooth_is_missing_under_either_torque() -> None:
    losses = []
    for torque_nm in (10.0, -10.0):
        found = records(quick(BROKEN, torque_nm=torque_nm), [0, 1])
        losses.append([float(one.labels["contact_loss_share"]) for one in found])  # type: ignore[arg-type]
    assert [healthy for healthy, _ in losses] == [0.0, 0.0]
    assert all(0.01 < broken < 0.2 for _, broken in losses)


def measured(damage: dict[str, Any], state: int = 1) -> tuple[dict[str, Any], float]:
    """Return the labels of a damage alone, and the loss of stiffness at 60 N m."""
    config = quick({**damage, "teeth": [4]})
    found = specimen_state(config.gearbox(0), state)
    return found.labels, found.static.largest_loss(60.0)


def test_labels_of_a_chip_over_the_face_are_its_area_and_its_stiffness() -> None:
    """Of the involute above a radius R the area is b (R_a² - R²)/(2 R_b); of nearly all of the face nearly as much."""
    deep = {"kind": "chip", "height_mm": 3.0}
    (whole, lost), (_, nearly), (_, sound) = measured(deep), measured({**deep, "face_share": 0.999}), measured(deep, 0)
    pair = quick(deep).gearbox(0).pair
    tip = pair.pinion.tip_radius_m
    area = pair.face_width_m * (tip**2 - (tip - 3e-3) ** 2) / (2.0 * pair.pinion.base_radius_m)
    assert whole["damaged_area_mm2"] == pytest.approx(1e6 * area, rel=1e-6)
    assert whole["mesh_stiffness_loss"] == 1.0  # above the line its pair is the only one
    assert sound == 0.0
    # What stands at the end sinks in and carries a little: 2 % were found.
    assert lost == pytest.approx(nearly, rel=0.05)


@pytest.mark.parametrize(
    "damages", [({**BROKEN, "teeth": [4]},), ({"kind": "chip", "height_mm": 3.0, "face_share": 0.6, "teeth": [4, 7]},)]
)
def test_what_is_gone_on_both_flanks_is_lost_under_either_torque(damages: tuple[dict[str, Any], ...]) -> None:
    """Perfect gears are their own mirror image, in which the teeth count the other way round."""
    config = quick(*damages)
    static = specimen_state(config.gearbox(0), 1).static
    assert static.largest_loss(-60.0) == pytest.approx(static.largest_loss(60.0), rel=1e-9)
    assert static.largest_loss(60.0) > 0.1


def test_a_chip_beside_pits_has_lost_its_tip_alone_under_a_torque_below_0() -> None:
    chip = {"kind": "chip", "height_mm": 0.3, "teeth": [4]}
    wide = {"gear": "pinion", "tooth": 9, "height_mm": 3.0, "face_mm": 10.0, "semi_axis_face_mm": 8.0}
    pits = {"kind": "list", "pits": [{**wide, "semi_axis_profile_mm": 0.5, "depth_mm": 0.2}]}
    alone, (_, state) = quick(chip), quick(pits).config.states
    both = alone.config.states[1].model_copy(update={"damage": (*alone.config.states[1].damages, *state.damages)})
    grown = alone.with_sections(states=(alone.config.states[0], both))
    tip, more = (specimen_state(one.gearbox(0), 1).static for one in (alone, grown))
    assert more.largest_loss(-60.0) == pytest.approx(tip.largest_loss(-60.0), rel=1e-12)
    assert tip.largest_loss(-60.0) == pytest.approx(tip.largest_loss(60.0), rel=1e-9)
    assert more.largest_loss(60.0) > tip.largest_loss(60.0)


def test_a_missing_tooth_has_lost_all_of_its_flank() -> None:
    gone, lost = measured(BROKEN)
    assert gone["damaged_area_share"] == pytest.approx(1.0)
    assert gone["mesh_stiffness_loss"] == 1.0
    assert 0.5 < lost < 1.0  # the corners beside it carry
