"""A configuration carried over to another gear pair, against similarity, stresses and `siggen init`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from siggen.checks.loading import load_config
from siggen.config import Config, inherited, parse_yaml
from siggen.config.gears import PairSection
from siggen.gearbox.configured import pair_config
from siggen.gearbox.design import SetDesign
from siggen.gearbox.teeth import gear_pair
from siggen.gears.gear_pair import GearPair
from siggen.rig.rig import Rig
from siggen.rig.rig_text import rig_text
from tests.config.minimal import config as minimal

RANGE = {"log": [1e8, 2e8]}


def family(*pairs: dict[str, Any], **changes: Any) -> Config:
    return minimal(gears__pairs=list(pairs), dynamics__pinion__bearing__stiffness_n_per_m=RANGE, **changes)


def hertz_pa2(pair: GearPair, torque_nm: float) -> float:
    """Return the square of the contact stress at the pitch point but for the material: force over width and radius."""
    position, line = pair.pitch_point_m, pair.line_of_action_m
    return torque_nm / pair.pinion.base_radius_m / pair.face_width_m / (position * (line - position) / line)


def root_pa(pair: GearPair, torque_nm: float) -> float:
    """Return the nominal stress at the tooth root but for the form factor: force over width and module."""
    return torque_nm / pair.pinion.pitch_radius_m / (pair.face_width_m * pair.pinion.module_m)


def test_the_pair_that_the_file_was_written_for_leaves_the_configuration_as_it_is() -> None:
    set_of_pairs = family({"teeth": [18, 47], "module_mm": 3.0, "face_width_mm": 20.0})
    plain = minimal(dynamics__pinion__bearing__stiffness_n_per_m=RANGE)
    assert pair_config(set_of_pairs, 0) == plain
    assert pair_config(set_of_pairs, 0).identity == plain.identity != set_of_pairs.identity


def test_a_pair_of_the_same_shape_and_twice_the_size_has_eight_masses_and_bears_eight_torques() -> None:
    masses = {"dynamics__pinion__mass_kg": 1.0, "dynamics__gear__inertia_kg_m2": 6.4e-3}
    rigid = {"kind": "rigid", "inertia_kg_m2": 0.25}
    own = pair_config(family({"teeth": [18, 47], "module_mm": 6.0, "face_width_mm": 40.0}, **masses, housing=rigid), 0)
    assert own.operating_points[0].torque_nm == pytest.approx(8.0 * 60.0)
    assert own.housing.mass_kg == pytest.approx(8.0 * 20.0)  # type: ignore[union-attr]
    assert own.housing.inertia_kg_m2 == pytest.approx(32.0 * 0.25)  # type: ignore[union-attr]
    # Shafts come in steps of 5 mm, so masses and inertias of rotors are those of similar bodies within some per cent.
    assert own.dynamics.pinion.mass_kg == pytest.approx(8.0, rel=0.1)
    assert own.dynamics.gear.inertia_kg_m2 == pytest.approx(32.0 * 6.4e-3, rel=0.1)
    damage = own.states[1].damage
    assert damage is not None
    assert (damage.semi_axis_face_mm, damage.depth_mm) == (0.6, 0.8)  # type: ignore[union-attr]
    drawn = own.dynamics.pinion.bearing.stiffness_n_per_m
    assert drawn.high / drawn.low == pytest.approx(2.0)  # type: ignore[union-attr]


def test_a_box_that_was_given_grows_with_the_pair_and_one_that_was_not_is_drawn_round_it() -> None:
    given = {"length_mm": 260.0, "wall_mm": [8, 12]}
    twice = {"teeth": [18, 47], "module_mm": 6.0, "face_width_mm": 40.0}
    own = pair_config(family(twice, housing=given), 0).housing
    assert own.length_mm == pytest.approx(520.0)  # type: ignore[union-attr]
    assert own.wall_mm.high == pytest.approx(24.0)  # type: ignore[union-attr]
    assert own.width_mm is None  # type: ignore[union-attr]


@pytest.mark.parametrize("teeth", [(17, 19), (18, 83), (35, 104)])
def test_the_torque_of_a_pair_stresses_flank_or_root_as_before_and_neither_more(teeth: tuple[int, int]) -> None:
    config = family({"teeth": list(teeth), "module_mm": 2.0, "face_width_mm": 25.0})
    own, before = pair_config(config, 0), gear_pair(config.gears.model_copy(update={"pairs": ()}))
    torque, pair = own.operating_points[0].torque_nm, gear_pair(own.gears)
    assert isinstance(torque, float)
    shares = hertz_pa2(pair, torque) / hertz_pa2(before, 60.0), root_pa(pair, torque) / root_pa(before, 60.0)
    assert max(shares) == pytest.approx(1.0)


def test_a_machine_carried_over_is_the_one_that_siggen_init_writes() -> None:
    """With the bores that the carried-over gearbox has: `siggen init` takes its own from the catalogue, in steps."""
    before = Rig((18, 47), 3.0, 20.0, (30.0, 35.0), (15.0, 60.0), bores_mm=(25.0, 35.0))
    pair = PairSection(teeth=(25, 56), module_mm=4.0, face_width_mm=45.0)
    written = _parsed(rig_text(before, "before"))
    pairs = written.config.gears.model_copy(update={"pairs": (pair,)})
    own = pair_config(written.with_sections(gears=pairs).config, 0)
    torque = own.operating_points[0].torque_nm.high  # type: ignore[union-attr]
    bores_mm = (2.0 * own.gears.pinion.bore_radius_mm, 2.0 * own.gears.gear.bore_radius_mm)  # type: ignore[operator]
    rig = Rig(pair.teeth, 4.0, 45.0, (30.0, 35.0), (torque / 4.0, torque), bores_mm=bores_mm)
    after = _parsed(rig_text(rig, "a"))
    edge = ".mesh.pit_edge_radius_mm"  # grows with the module here; `siggen init` leaves the preset's
    for section in ("gears", "dynamics"):
        found, wanted = (dict(_numbers(getattr(one, section).model_dump())) for one in (own, after.config))
        found.pop(edge, None)
        wanted.pop(edge, None)
        if section == "dynamics":
            _compare_reliefs(found, wanted)
            for wheel in ("pinion", "gear"):  # `siggen init` leaves the preset's, which spur teeth do not ask
                found.pop(f".{wheel}.bearing.axial_stiffness_n_per_m")
                wanted.pop(f".{wheel}.bearing.axial_stiffness_n_per_m")
        assert found == pytest.approx(wanted, rel=0.012)  # both files give three digits


def _compare_reliefs(found: dict[str, float], wanted: dict[str, float]) -> None:
    """Take the reliefs out: carried over, both ends grow with the line load; running in is the steel's own."""
    reliefs = [[numbers.pop(f".mesh.tip_relief_um.{end}") for end in (0, 1)] for numbers in (found, wanted)]
    assert reliefs[1][0] == 2.0
    assert reliefs[0][1] == pytest.approx(reliefs[1][1], rel=0.1)  # c' of other teeth


def _parsed(text: str) -> SetDesign:
    return load_config(inherited(parse_yaml(text, "rig")))


def _numbers(value: Any, path: str = "") -> Iterator[tuple[str, float]]:
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _numbers(item, f"{path}.{key}")
    elif isinstance(value, (list, tuple)):
        for index, item in enumerate(value):
            yield from _numbers(item, f"{path}.{index}")
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path, value
