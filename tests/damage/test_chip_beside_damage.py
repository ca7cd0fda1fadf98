"""Chips on teeth with other damage: what lies on lost metal is no damage any more, what lies on it partly acts less."""

from __future__ import annotations

from typing import Any

import pytest

from siggen.damage.chip import PartChip, WholeChip, lost_outline
from siggen.damage.on_flank import with_outlines
from siggen.damage.outlines import Polygon
from siggen.damage.pits import FlankPit
from siggen.damage.spalls import FlankSpall
from siggen.mesh.damage_summary import damage_summary
from tests.damage.test_damage import PIT, config_with, damage_of
from tests.gears.builders import pair_18_47

PAIR = pair_18_47()
GEAR, WIDTH = PAIR.pinion, PAIR.face_width_m
TIP_M = float(GEAR.height_m(GEAR.tip_roll_rad))
CHIP: dict[str, Any] = {"kind": "chip", "height_mm": 1.5, "teeth": [3]}
AXES = {key: value for key, value in PIT.items() if key != "depth_mm"} | {"depth_mm": 0.2}


def tip_mm() -> float:
    gear = config_with(CHIP).gearbox(0).pair.pinion
    return 1e3 * float(gear.height_m(gear.tip_roll_rad))


def pits(*places_mm: tuple[float, float]) -> dict[str, Any]:
    """Return a list of pits on tooth 3, at distances below the tip and places across the face."""
    listed = [
        {"gear": "pinion", "tooth": 3, "height_mm": tip_mm() - down, "face_mm": w, **AXES} for down, w in places_mm
    ]
    return {"kind": "list", "pits": listed}


ON_LOST, BELOW, ACROSS, OVER_THE_TIP = (0.6, 5.0), (3.0, 5.0), (1.45, 9.0), (0.05, 19.9)
FOUR = (ON_LOST, BELOW, ACROSS, OVER_THE_TIP)


def left_of(*damages: dict[str, Any]) -> list[tuple[float, float]]:
    """Return the pits that the last state has, below the tip and across the face [mm]."""
    found = [one for one in damage_of(config_with(*damages), len(damages)) if isinstance(one, FlankPit)]
    return [(round(tip_mm() - 1e3 * one.height_m, 6), round(1e3 * one.face_m, 6)) for one in found]


def test_pits_wholly_on_metal_that_breaks_off_are_no_damage_any_more() -> None:
    """Over the face all that is above the line, beyond tip and ends of the face too, where no metal ever was."""
    assert left_of(pits(*FOUR)) == list(FOUR)
    assert left_of(pits(*FOUR), CHIP) == [BELOW, ACROSS]
    assert left_of(pits(*FOUR), {**CHIP, "face_share": 0.5}) == [BELOW, ACROSS, OVER_THE_TIP]
    assert left_of(pits(*FOUR), {**CHIP, "height_mm": "whole"}) == []


@pytest.mark.parametrize("share", [None, 0.6])
def test_no_pits_come_up_on_metal_that_is_gone(share: float | None) -> None:
    lost = {**CHIP, "face_share": share}
    kept = [BELOW, ACROSS] if share is None else [BELOW, ACROSS, OVER_THE_TIP]
    assert left_of(lost, pits(*FOUR)) == kept
    # nor a second time, in a state that lists again what the chip took with it
    assert left_of(pits(*FOUR), lost, pits(*FOUR)) == kept
    assert left_of({**CHIP, "height_mm": "whole"}, pits(*FOUR)) == []


def test_more_of_a_chip_takes_the_place_of_less_and_less_height_over_more_of_the_face_comes_beside_it() -> None:
    part = {**CHIP, "face_share": 0.4}
    assert damage_of(config_with(part, CHIP), 2) == (WholeChip("pinion", 3, 1.5e-3),)
    assert len(damage_of(config_with(part, {**CHIP, "height_mm": 1.0}), 2)) == 2


def test_labels_count_what_stands_of_a_pit_that_a_chip_cuts() -> None:
    """Chip and pit unite: their area is the chip's and that of the half ellipse below its line, clipped by nothing."""
    height_m = 1.5e-3
    lost = WholeChip("pinion", 3, height_m)
    line_m = lost.outlined(PAIR)[0].outline.height_range_m[0]  # type: ignore[union-attr]
    pit = FlankPit("pinion", 3, line_m, 0.4 * WIDTH, 1e-3, 0.05e-3, 0.2e-3)
    (alone, cut), whole = (
        [damage_summary(PAIR, with_outlines(parts, PAIR)).union_area_m2 for parts in ((lost,), (lost, pit))],
        damage_summary(PAIR, (pit,)).union_area_m2,
    )
    # the involute's arc per height changes by 1 % over the pit's 0.1 mm
    assert cut - alone == pytest.approx(0.5 * whole, rel=0.02)


def test_of_what_a_part_chip_cuts_only_the_rest_acts() -> None:
    """A rectangular spall across the line and its part below it: the same area, lengths of contact and union."""
    height_m, width_m = 1.5e-3, 0.6 * WIDTH
    lost = PartChip("pinion", 3, height_m, width_m, lost_outline(GEAR, height_m, width_m))
    line_m = lost.outline.height_range_m[0]
    across, below = (_box(line_m - 0.4e-3, top) for top in (line_m + 0.3e-3, line_m))
    one, other = (damage_summary(PAIR, (lost, spall)) for spall in (across, below))
    assert one.union_area_m2 == pytest.approx(other.union_area_m2, rel=1e-12)
    assert one.contact_length_loss_m == other.contact_length_loss_m
    assert not lost.hides(across)
    assert lost.hides(_box(line_m + 1e-6, TIP_M))


def _box(low_m: float, high_m: float) -> FlankSpall:
    corners = ((low_m, 2e-3), (low_m, 6e-3), (high_m, 6e-3), (high_m, 2e-3))
    return FlankSpall("pinion", 3, Polygon(corners, "rectangle"), 0.2e-3)
