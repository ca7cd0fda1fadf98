"""A damage that shows on no flank, such as a crack in the root, goes through all that asks about damage."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pytest

from siggen.arrays import FloatArray
from siggen.columns.damage_columns import DAMAGE_COLUMNS
from siggen.gears.contact.contact_table import contact_table
from siggen.gears.contact.table_columns import FORCE, ROUGH
from siggen.gears.contact.table_options import TableOptions
from siggen.gears.damage.flank_damage import damage_problems, pit_rows
from siggen.gears.damage.tooth_damage import Refusal, ToothDamage, has_extent
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.gears.stiffness.damage_summary import damage_summary
from siggen.gears.stiffness.mesh_tables import largest_stiffness_loss, mesh_tables
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from siggen.views.flank_views import _views
from tests.gears.builders import pair_18_47, pit

PAIR, OPTIONS = pair_18_47(), StiffnessOptions()


@dataclass(frozen=True, slots=True)
class Hinge:
    """A crack as a torsional spring in the root: at the lever u of a contact it adds u²/k to the compliance."""

    gear: str
    tooth: int
    depth_m: float
    spring_nm_per_rad: float
    kind: str = "crack"
    outline: None = None

    def rows(self) -> list[tuple[float, ...]]:
        return []

    def tooth_compliance_m_per_n(self, pair: GearPair, roll_rad: FloatArray) -> FloatArray:
        gear = pair.member(self.gear)
        slant = roll_rad - gear.base_half_angle_rad
        lever = gear.height_m(roll_rad) * np.cos(slant) - gear.half_thickness_m(roll_rad) * np.sin(slant)
        return np.asarray(lever**2 / self.spring_nm_per_rad)

    def profile_arc_m(self, gear: SpurGear) -> float:
        return 0.0

    def hides(self, other: ToothDamage) -> bool:
        return isinstance(other, Hinge) and (other.gear, other.tooth) == (self.gear, self.tooth)

    def own_problems(self) -> Iterator[Refusal]:
        if self.depth_m <= 0.0:
            yield Refusal("depth_m", f"depth_m {self.depth_m!r} m", "above 0")

    def place_problems(self, pair: GearPair) -> Iterator[Refusal]:
        if not 0 <= self.tooth < pair.member(self.gear).teeth:
            yield Refusal("tooth", f"tooth {self.tooth!r}", "a tooth of the gear")

    def table_row(self) -> dict[str, object]:
        lengths = ("height_mm", "face_mm", "semi_axis_face_mm", "semi_axis_profile_mm")
        names = {"gear": self.gear, "tooth": self.tooth, "kind": self.kind, "shape": "none", "depth_law": "none"}
        return {
            **names,
            **dict.fromkeys(lengths, 0.0),
            "depth_mm": 1e3 * self.depth_m,
            "polygon_face_mm": [],
            "polygon_height_mm": [],
        }


CRACK = Hinge("pinion", 3, 1e-3, 2e4)


def test_it_softens_its_pairs_by_its_own_compliance_and_no_others() -> None:
    tables = mesh_tables(PAIR, (CRACK,), OPTIONS, points=65)
    position = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 65)
    added = CRACK.tooth_compliance_m_per_n(PAIR, position / PAIR.pinion.base_radius_m)
    healthy, cracked = tables.pair_stiffness_n_per_m
    assert 1.0 / cracked - 1.0 / healthy == pytest.approx(added, rel=1e-6)
    assert np.array_equal(healthy, mesh_tables(PAIR, (), OPTIONS, points=65).pair_stiffness_n_per_m[0])
    assert 0.0 < largest_stiffness_loss(PAIR, (CRACK,), OPTIONS) < 0.5


def test_the_contact_keeps_its_land_and_pits_beside_it_stay() -> None:
    damage = (CRACK, pit(tooth=5))
    table = contact_table(PAIR, damage, OPTIONS, TableOptions(4e3), 65)
    # Pinion teeth ascending, the crack's tooth first; forces at the largest approach in the middle of the path.
    healthy, cracked, pitted = (table.curves[int(table.column[row, 32])] for row in range(3))
    assert not np.any(table.touch_m)
    assert 0.5 * healthy[-1, FORCE] < cracked[-1, FORCE] < 0.99 * healthy[-1, FORCE]
    assert np.array_equal(cracked[:, ROUGH], healthy[:, ROUGH])
    assert table.curves[:, :, ROUGH].max() > 0.0
    assert not np.any(pitted[:, ROUGH] < 0.0)
    assert pit_rows(damage).shape[0] == 1
    assert has_extent(CRACK)


def test_labels_problems_rows_and_pictures_do_without_an_outline() -> None:
    summary = damage_summary(PAIR, (CRACK,))
    assert (summary.count, summary.union_area_m2, summary.largest_profile_length_m, summary.sagitta_m) == (
        1,
        0.0,
        0.0,
        0.0,
    )
    assert not summary.through_face
    assert not damage_problems(PAIR, (CRACK,))
    (problem,) = damage_problems(PAIR, (Hinge("pinion", 40, 1e-3, 2e4),))
    assert str(problem) == "crack 0: received tooth 40; allowed: a tooth of the gear"
    assert set(CRACK.table_row()) == {column.name for column in DAMAGE_COLUMNS} - {"record_id"}
    (view,) = _views(PAIR, "cracked", (CRACK,))
    assert view.outlines_mm == ()
