"""Records of damage through the whole face, and of the readings of damage, from the configuration on."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from tests.config.minimal import by_name
from tests.simulated import simulate

SPALL = {
    "kind": "spall", "gear": "pinion", "teeth": 1, "centre_height_mm": "pitch",
    "face_length_mm": 20.0, "profile_length_mm": 1.0, "depth_mm": 0.2,
}  # fmt: skip
WHOLE_FACE = "take the whole contact length"


def config(damage: dict[str, Any] | None = None, *overrides: str) -> SetDesign:
    spall = SPALL if damage is None else damage
    states = [{"name": "healthy"}, {"name": "damaged", "fault": "spalling", "severity": "severe", "damage": spall}]
    from siggen.config import read_yaml

    raw = {**read_yaml("tests/configs/casing.yaml"), "states": by_name(states), "specimens": 1, "duration_s": 0.1}
    return load_config(raw, overrides)


def record(chosen: SetDesign, record_id: int) -> SimulatedRecord:
    result = simulate(chosen, [record_id])[0]
    assert isinstance(result, SimulatedRecord), result
    return result


def test_damage_through_the_face_is_simulated_and_labelled() -> None:
    chosen = config(None, "operating_points=[{speed_hz: 25.0, torque_nm: 20.0}]")
    healthy, damaged = record(chosen, 0), record(chosen, 1)
    assert damaged.labels["through_face"] is True
    # 1 mm of arc near the pitch point: l²/(8 R_e) with R_e of 6.7 mm and the edges' rounding of 0.1 mm.
    assert damaged.labels["sink_depth_um"] == pytest.approx(1e3 / (8.0 * 6.78), rel=0.03)
    assert damaged.labels["contact_length_loss_mm"] == 20.0
    assert damaged.labels["mesh_stiffness_loss"] == 1.0
    # As simulated the flank rests on the edges: the approach grows by the sink of 18 µm, not without bound.
    assert 0.5 < damaged.labels["mesh_stiffness_loss_as_simulated"] < 0.9
    assert healthy.labels["mesh_stiffness_loss_as_simulated"] == 0.0
    assert healthy.labels["through_face"] is False
    assert healthy.labels["sink_depth_um"] == 0.0
    name = next(iter(healthy.channels))
    assert damaged.channels[name].std() > 2.0 * healthy.channels[name].std()


LINEAR = ("dynamics.mesh.law=linear", "dynamics.friction.model=off", "dynamics.mesh.damping=constant")


def test_the_law_without_a_sink_refuses_damage_through_the_face() -> None:
    with pytest.raises(ConfigError, match=WHOLE_FACE) as refused:
        config(None, *LINEAR)
    assert "or dynamics.mesh.law: pairs" in str(refused.value)


def test_the_readings_of_damage_differ_and_agree_on_healthy_teeth() -> None:
    spall = {**SPALL, "face_length_mm": 12.0, "profile_length_mm": 2.0, "depth_mm": 0.4}
    readings = [config(spall, *chosen) for chosen in (LINEAR, ["dynamics.mesh.damage=geometry"], [])]
    point = len(readings[0].config.operating_points)
    stiffness, geometry, both = (record(chosen, point) for chosen in readings)
    assert not np.array_equal(geometry.channels["lid_vertical"], both.channels["lid_vertical"])
    healthy = [record(chosen, 0).channels["lid_vertical"].tobytes() for chosen in readings[1:]]
    assert len(set(healthy)) == 1
    labels = [found.labels for found in (stiffness, geometry, both)]
    assert len({found["mesh_stiffness_loss"] for found in labels}) == 1
    losses = [found["mesh_stiffness_loss_as_simulated"] for found in labels]
    # Sections that weaken come on top of the softer contact; the law linear has both, as the label by energy.
    assert 0.0 < losses[1] < losses[2]
    assert losses[0] == pytest.approx(labels[0]["mesh_stiffness_loss"], rel=0.05)


def test_damping_by_asperities_needs_the_oil_and_changes_the_vibration() -> None:
    with pytest.raises(ConfigError, match=r"dynamics\.mesh\.damping"):
        config(None, "dynamics.mesh.damping=asperity_share", "dynamics.friction.model=constant")
    constant, shared = config(None, "dynamics.mesh.damping=constant"), config()
    assert constant.identity != shared.identity
    first, second = (record(chosen, 0).channels["lid_vertical"] for chosen in (constant, shared))
    assert second.std() == pytest.approx(first.std(), rel=0.3)
    assert not np.array_equal(first, second)
