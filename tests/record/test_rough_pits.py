"""Pits roughen the flank about them: friction in their reach, and levels that rise with the damage."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.config import read_yaml
from tests.config.minimal import by_name
from tests.simulated import simulate

# Perfect gears on stiff shafts in the middle of the ranges of paper_b: only the damage is beside the mesh lines.
MIDDLE = [
    "specimens=1", "manufacture=null", "dynamics.shafts=null", "duration_s=0.2", "internals.quantities=[all]",
    "dynamics.mesh_damping_ratio=0.07", "dynamics.backlash_um=80", "dynamics.mesh.tip_relief_um=8",
    *(f"dynamics.{gear}.bearing.stiffness_n_per_m=2e8" for gear in ("pinion", "gear")),
    *(f"dynamics.{gear}.bearing.damping_n_s_per_m=1000" for gear in ("pinion", "gear")),
    "housing.bolts.shear_stiffness_n_per_m=8e7", "housing.bolts.axial_stiffness_n_per_m=1.5e8",
    "dynamics.friction.oil_temperature_c=50", "dynamics.friction.roughness_um=0.4",
    "dynamics.friction.boundary_friction=0.09", "dynamics.friction.pit_roughness_um=2.0",
]  # fmt: skip


def pits(count: int, spread_mm: float) -> dict[str, object]:
    return {
        "kind": "clustered", "gear": "pinion", "teeth": [0], "count": count, "centre_height_mm": "pitch",
        "spread_profile_mm": spread_mm, "semi_axis_face_mm": 0.4, "semi_axis_profile_mm": 0.4, "depth_mm": 0.25,
        "floor": "dish",
    }  # fmt: skip


SPALL = {
    "kind": "spall", "gear": "pinion", "teeth": [0], "centre_height_mm": "pitch", "depth_mm": 0.2,
    "profile_length_mm": 1.0, "face_length_mm": 20.0,
}  # fmt: skip
STATES = [
    {"name": "healthy"}, {"name": "slight", "damage": pits(9, 0.3)}, {"name": "severe", "damage": pits(36, 0.4)},
    {"name": "through", "severity": "severe", "damage": SPALL},
]  # fmt: skip


def quantities(speed_hz: float, *overrides: str) -> list[dict[str, np.ndarray]]:
    """Internal quantities of the states, healthy to through."""
    points = [{"speed_hz": speed_hz, "torque_nm": 30.0}]
    raw = {**read_yaml("configs/paper_b.yaml"), "states": by_name(STATES), "operating_points": points}
    config = load_config(raw, [*MIDDLE, *overrides])
    found = simulate(config, list(range(len(STATES))))
    assert all(isinstance(record, SimulatedRecord) for record in found)
    return [record.internals for record in found]


def casing_rms(internals: dict[str, np.ndarray]) -> float:
    return float(np.hypot(*(internals[f"clean_accel_casing_lid_{axis}_m_s2"].std() for axis in FRAME)))


FRAME = ("vertical", "horizontal")


@pytest.mark.parametrize("speed_hz", [15.0, 35.0])
def test_levels_of_perfect_gears_rise_with_pits_and_spalls(speed_hz: float) -> None:
    levels = [casing_rms(internals) for internals in quantities(speed_hz)]
    # 15 Hz: 1.33, 1.46, 1.65, 2.63 m/s²; 35 Hz: 3.05, 3.14, 3.31, 8.32
    assert levels == sorted(levels)
    assert levels[1] > 1.02 * levels[0]
    assert levels[2] > 1.02 * levels[1]
    smooth = [casing_rms(internals) for internals in quantities(speed_hz, "dynamics.friction.pit_roughness_um=0.4")]
    # Of what severe pits add, lost length alone is the smaller part.
    assert smooth[2] - smooth[0] < 0.5 * (levels[2] - levels[0])


def test_flanks_rub_more_in_the_reach_of_pits_and_as_ever_beside_it() -> None:
    healthy, _, severe, _ = quantities(15.0)

    def friction(internals: dict[str, np.ndarray], low_mm: float, high_mm: float) -> np.ndarray:
        """Mean coefficient of every pass of pairs, ascending; places from the pitch point on the line of action."""
        slots = len({name.split("_")[1] for name in internals if name.startswith("pair_")})
        pitch_point_m = 27e-3 * np.sin(np.radians(20.0))
        means = []
        for slot in range(slots):
            place = 1e3 * (internals[f"pair_{slot}_position_m"] - pitch_point_m)
            there = np.flatnonzero((place > low_mm) & (place < high_mm) & (internals[f"pair_{slot}_force_n"] > 0.0))
            for one in np.split(there, np.flatnonzero(np.diff(there) > 1) + 1):
                means.append(float(np.nanmean(internals[f"pair_{slot}_friction_coefficient"][one])))
        return np.sort(means)

    sound, pitted = friction(healthy, -2.0, -0.5), friction(severe, -2.0, -0.5)
    turns = int(15.0 * 0.2)
    # Tooth 0 passes once a turn: its friction doubles, that of the other teeth is the same.
    assert np.all(pitted[-turns:] > 1.7 * sound.max())
    np.testing.assert_allclose(pitted[:-turns].mean(), sound[:-turns].mean(), rtol=0.03)
    far = friction(severe, 4.0, 5.0).max() / friction(healthy, 4.0, 5.0).max()
    assert 0.9 < far < 1.1
