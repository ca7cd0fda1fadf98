"""A sham goes wherever a damage goes, and no record tells it from healthy teeth."""

from __future__ import annotations

from typing import Any

import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord, record_schema
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from siggen.record.specimen_state import specimen_state
from siggen.sets.drawn import set_columns
from tests.config.minimal import by_name, minimal
from tests.kinds.machines import DAMAGES
from tests.simulated import damage_rows, simulate


def config(*states: dict[str, Any], law: str = "pairs") -> SetDesign:
    small = {"specimens": 1, "duration_s": 0.05, "fs_hz": 20480.0, "mesh_harmonics": 3}
    dynamics = {"model": "8dof", "mesh": {"law": law}, "friction": {"model": "off"}}
    return load_config(minimal(**small, dynamics=dynamics, states=by_name([{"name": "healthy"}, *states])))


def sham_of(kind: str) -> dict[str, Any]:
    return {"name": "sham", "acts": False, "damage": {"kind": kind, **DAMAGES[kind]}}


def record(chosen: SetDesign, record_id: int) -> SimulatedRecord:
    result = simulate(chosen, [record_id])[0]
    assert isinstance(result, SimulatedRecord), result
    return result


def assert_same(sham: SimulatedRecord, healthy: SimulatedRecord) -> None:
    """Signals, pulses and labels byte for byte: step counts and solved numbers are among the labels."""
    for name, signal in healthy.channels.items():
        assert sham.channels[name].tobytes() == signal.tobytes(), name
    assert sham.tacho_s.tobytes() == healthy.tacho_s.tobytes()
    own = {name: label for name, label in sham.labels.items() if name not in ("state", "sham")}
    assert own == {name: label for name, label in healthy.labels.items() if name != "state"}


def test_springs_between_teeth_know_no_sham_either() -> None:
    found = record(config(sham_of("layered"), law="linear"), 1)
    assert_same(found, record(config({"name": "again"}, law="linear"), 1))


def test_its_teeth_have_kinds_of_pairs_of_their_own() -> None:
    chosen = config(sham_of("spall"), {**sham_of("spall"), "name": "real", "acts": True, "severity": "severe"})
    specimen = chosen.gearbox(0)
    healthy, sham, real = (specimen_state(specimen, state).mesh.tables.table_of_pair for state in range(3))
    assert healthy.max() == 0 < sham.max() == real.max()
    assert (sham > 0).sum() == (real > 0).sum()


def test_rounding_in_the_tables_of_its_teeth_is_no_loss_of_stiffness() -> None:
    chosen = load_config("quickstart")
    specimen = chosen.gearbox(1)
    sham = [state.name for state in chosen.config.states].index("sham")
    assert specimen_state(specimen, sham).static.largest_loss(specimen.points[0].torque_nm) == 0.0


def test_it_shifts_no_other_state() -> None:
    real = {"name": "real", "severity": "severe", "damage": {"kind": "spall", **DAMAGES["spall"]}}
    grown = {"name": "grown", "grows": "real", "damage": {"teeth": 2}}
    between, without = config(real, sham_of("layered"), grown), config(real, {"name": "again"}, grown)
    assert damage_rows(between, 3) == damage_rows(without, 3)


@pytest.mark.parametrize(
    ("state", "path"),
    [
        ({"name": "sham", "acts": False}, "states.sham.acts"),
        ({**sham_of("spall"), "fault": "spalling"}, "states.sham.fault"),
        ({**sham_of("spall"), "severity": "slight"}, "states.sham.severity"),
        ({**sham_of("spall"), "acts": 1}, "states.sham.acts"),
        (
            {**sham_of("spall"), "damage": {"kind": "spall", **DAMAGES["spall"], "depth_mm": 40.0}},
            "states.sham.damage",
        ),
    ],
)
def test_what_a_sham_cannot_be_is_refused_by_name(state: dict[str, Any], path: str) -> None:
    with pytest.raises(ConfigError, match=path.replace(".", r"\.")):
        config(state)


def test_sets_without_one_have_no_column_of_it() -> None:
    assert "sham" not in record_schema(set_columns(config({"name": "again"}))).names
    assert "sham" in record_schema(set_columns(config(sham_of("spall")))).names
