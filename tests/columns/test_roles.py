"""Every column has a role, in the files and in the manifest; what nobody lists is a condition."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pyarrow as pa
import pytest

import siggen
from siggen.columns.record import damage_schema, listed_columns, record_schema
from siggen.dataset.seal import sealed, unsealed
from siggen.errors import DatasetError
from siggen.gearbox.design import SetDesign
from siggen.keys.column import Role
from siggen.sets.drawn import set_columns
from tests.dataset.fake_set import copy_fake_set, fake_config

ROOT = Path(__file__).resolve().parents[2]
PRESETS = sorted(path.name for path in (ROOT / "configs").glob("*.yaml"))


def role(schema: pa.Schema, name: str) -> str:
    return str((schema.field(name).metadata or {}).get(b"role", b"").decode())


@cache
def loaded(preset: str) -> SetDesign:
    return siggen.load_config(ROOT / "configs" / preset)


@pytest.mark.parametrize("preset", PRESETS)
def test_every_column_of_records_and_of_damage_has_a_role(preset: str) -> None:
    config = loaded(preset)
    for schema in (record_schema(set_columns(config)), damage_schema(set_columns(config))):
        assert {name for name in schema.names if role(schema, name) not in set(Role)} == set()


NEVER_FOR_SCORES = {"paper_a.yaml", "paper_b.yaml"}


@pytest.mark.parametrize("preset", [name for name in PRESETS if name not in NEVER_FOR_SCORES])
def test_every_preset_for_scores_has_a_sham_unless_it_runs_to_failure(preset: str) -> None:
    config = loaded(preset)
    assert any(state.sham for state in config.config.states) != config.lives


def test_what_the_simulation_alone_knows_is_neither_condition_nor_measured() -> None:
    schema = record_schema(set_columns(loaded("bench.yaml")))
    usable = {name for name in schema.names if role(schema, name) in {Role.CONDITION, Role.MEASURED}}
    assert {"speed_hz", "torque_nm", "teeth_pinion", "clipped_share_lid_vertical"} <= usable
    hidden = {"fault", "sham", "damaged_area_mm2", "mesh_stiffness_loss", "snr_lid_vertical_db", "start_angle_rad"}
    assert not usable & {*hidden, "noise_floor_lid_vertical_m_s2", "runout_pinion_um", "rubbing_force_n"}


def test_a_finished_set_says_the_roles_of_its_columns(tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    dataset = siggen.open(tmp_path)
    listed = {one["name"]: one for one in listed_columns(record_schema(set_columns(fake_config())))}
    schema = next(dataset.records()).schema
    assert set(listed) == set(schema.names)
    assert {name: str(dataset.role(name)) for name in listed} == {name: role(schema, name) for name in listed}
    assert dataset.section("speed_hz") == "operating_points"


def test_record_ids_tell_the_state_by_design_so_they_are_keys_and_no_input(tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    dataset = siggen.open(tmp_path)
    rows = dataset.labels().to_pylist()
    states = 1 + max(row["state_id"] for row in rows)
    of_a_state = len(rows) // states // len({row["specimen_id"] for row in rows})
    assert all(row["record_id"] // of_a_state % states == row["state_id"] for row in rows)
    assert {dataset.role(name) for name in ("record_id", "specimen_id", "state_id", "repeat", "split")} == {Role.KEY}


def test_columns_that_a_stranger_does_not_list_are_conditions(tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    manifest = tmp_path / "manifest.json"
    content = unsealed("manifest.json", manifest.read_bytes())
    manifest.write_bytes(sealed({**content, "columns": [{"name": "fault", "role": "target"}]}))
    dataset = siggen.open(tmp_path)
    assert (dataset.role("fault"), dataset.role("damaged_area_mm2")) == (Role.TARGET, Role.CONDITION)
    manifest.write_bytes(sealed({**content, "columns": [{"name": "fault", "role": "harmless"}]}))
    with pytest.raises(DatasetError, match=r"columns\.0\.role: received 'harmless'; allowed: 'key', 's"):
        siggen.open(tmp_path)
