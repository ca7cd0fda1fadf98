"""Force washers: the load of the mesh on both shafts, and models without bearings."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.gearbox.plan import planned_record
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state
from tests.sensors.runs import loaded, problems, record
from tests.sensors.test_encoder import OFF

PINION = {"kind": "bearing_force", "name": "pinion", "axes": ["vertical", "horizontal"], "range_n": 1e5, "bits": None}
GEAR = {**PINION, "name": "gear", "place": "gear_bearing"}


def test_both_shafts_press_on_their_seats_with_the_mesh_force_and_against_each_other() -> None:
    config = loaded(PINION, GEAR, duration_s=1.0, **OFF)
    channels, pair = record(config).channels, config.gearbox(0).pair
    force, angle = 60.0 / pair.pinion.base_radius_m, pair.working_pressure_angle_rad
    along = {"vertical": np.cos(angle), "horizontal": np.sin(angle)}
    for axis, share in along.items():
        # the mesh force of a torque acts along the line of action; 30 turns of a steady load
        assert abs(channels[f"pinion_{axis}"].mean()) == pytest.approx(force * share, rel=2e-3)
        assert channels[f"gear_{axis}"].mean() == pytest.approx(-channels[f"pinion_{axis}"].mean(), rel=2e-3)


def test_it_holds_what_the_model_gives() -> None:
    config = loaded(PINION)
    specimen = config.gearbox(0)
    state = specimen_state(specimen, 0)
    response, _ = record_response(specimen, state, planned_record(config, 0))
    expected = response.bearing_force_n["pinion_bearing/vertical"].astype(np.float32)
    np.testing.assert_array_equal(record(config).channels["pinion_vertical"], expected)


def test_a_place_without_bearings_is_refused() -> None:
    assert "pinion_bearing, gear_bearing" in problems({**PINION, "place": "lid"})["sensors.pinion.place"]
