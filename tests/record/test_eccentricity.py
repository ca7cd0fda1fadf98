"""Gears off the axes of their shafts: what a state adds to the drawn run-out of a gearbox."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.errors import ConfigError
from siggen.gearbox.configured import state_config
from siggen.gearbox.design import SetDesign
from siggen.gearbox.teeth import SpecimenErrors
from tests.config.minimal import by_name
from tests.sensors.runs import loaded, record
from tests.sensors.test_encoder import GEAR, OFF, PINION
from tests.sensors.test_transmission_error import ERROR

STATE = "off: {{fault: eccentricity, severity: severe, changes: {{dynamics.{}.eccentricity_um: {{add: {}}}}}}}"


def config(which: str, added_um: float, manufacture: str = "{accuracy_class: 6}") -> SetDesign:
    states = f"states={{healthy: {{}}, {STATE.format(which, added_um)}}}"
    return load_config("tests/configs/casing.yaml", ["specimens=2", f"manufacture={manufacture}", states])


def errors(chosen: SetDesign, state: int) -> SpecimenErrors:
    own = state_config(chosen.config, 0, state)
    teeth = SetDesign(own).gearbox(0).meshes[0].teeth
    found = teeth.errors(teeth.drawn_for(state))
    assert found is not None
    return found


@pytest.mark.slow
@pytest.mark.parametrize(("which", "order"), [("pinion", 1.0), ("gear", 18 / 47)])
def test_two_encoders_see_a_circle_of_the_added_eccentricity_and_nothing_else(which: str, order: float) -> None:
    speed_hz, fs_hz = 47 / 18, 2000.0

    def seen_um(added_um: float) -> np.ndarray:
        changes = {f"dynamics.{which}.eccentricity_um": {"add": added_um}}
        off = {"name": "off", "fault": "eccentricity", "severity": "severe", "changes": changes}
        chosen = loaded(
            PINION, GEAR, ERROR, dynamics__mesh={"law": "pairs", "tip_relief_um": 15.0}, fs_hz=fs_hz, duration_s=1.0,
            manufacture={"accuracy_class": 6}, operating_points=[{"speed_hz": speed_hz, "torque_nm": 60.0}],
            states=by_name([{"name": "healthy"}, off]), **OFF,
        )  # fmt: skip
        return record(chosen, 1).channels["error_line_of_action"].astype(np.float64)

    added = (seen_um(30.0) - seen_um(0.0))[20:-20]
    turned = 2.0 * np.pi * order * speed_hz * np.arange(added.size) / fs_hz
    basis = np.array([np.cos(turned), np.sin(turned), np.ones(added.size)]).T
    found, *_ = np.linalg.lstsq(basis, added, rcond=None)
    # what moves the gears grows with the square of the speed: 3 % of the mesh's part at this one, far less at order 1
    assert np.hypot(found[0], found[1]) == pytest.approx(30.0, rel=2e-3)
    assert (added - basis @ found).std() < 0.01 * 30.0


def test_it_adds_to_the_drawn_run_out_as_a_vector_and_leaves_all_other_errors() -> None:
    chosen = config("gear", 30.0)
    before, after = errors(chosen, 0), errors(chosen, 1)
    moved = [e.eccentricity_m * np.exp(1j * e.phase_rad) for e in (before.gear.errors, after.gear.errors)]
    assert abs(moved[1] - moved[0]) == pytest.approx(30e-6, rel=1e-12)
    np.testing.assert_array_equal(before.gear.errors.pitch_m, after.gear.errors.pitch_m)
    np.testing.assert_array_equal(before.gear.errors.form_m, after.gear.errors.form_m)
    assert after.gear.found.runout_m == 2.0 * after.gear.errors.eccentricity_m
    assert before.pinion.found.runout_m == after.pinion.found.runout_m


def test_perfect_gears_have_no_place_for_it() -> None:
    with pytest.raises(ConfigError, match=r"states\.off\.changes\.dynamics\.pinion\.eccentricity_um"):
        config("pinion", 30.0, "null")
