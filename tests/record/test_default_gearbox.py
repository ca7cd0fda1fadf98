"""A configuration that says nothing about dynamics: a casing on bolts, tooth pairs that push and rub one by one."""

from __future__ import annotations

import numpy as np

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.views.modes import specimen_modes
from tests.config.minimal import minimal
from tests.simulated import internals_table, simulate


def test_the_default_gearbox_shakes_its_casing_without_losing_contact() -> None:
    config = load_config(minimal(duration_s=0.2))
    (record,) = simulate(config, [0])
    assert isinstance(record, SimulatedRecord)
    signal = record.channels["bearing_vertical"]
    # Gear and casing move together on bolts: about 1 m/s² at 60 N m, a hundredth of a gear on bearings to the ground.
    assert 0.1 < signal.std() < 20.0
    assert record.labels["contact_loss_share"] == 0.0
    assert record.labels["clipped_share_bearing_vertical"] == 0.0


def test_its_teeth_rub_as_lubricated_ones_do() -> None:
    table = internals_table(load_config(minimal(duration_s=0.2)), 0)
    pairs = range(2)
    power = sum(
        table[f"pair_{i}_friction_n"].to_numpy() * table[f"pair_{i}_sliding_m_s"].to_numpy() for i in pairs
    ).mean()
    # Loss factor 0.171 μ of 11.3 kW with equal sharing, μ from 0.02 (film) to 0.11 (boundary).
    assert 0.171 * 0.02 * 11310.0 * 0.5 < power < 0.171 * 0.11 * 11310.0
    assert "y_gear_m" in table.column_names
    assert not [name for name in table.column_names if name.startswith("eta")]  # gearboxes differ in them


def test_all_supports_swing_and_the_lowest_modes_of_the_housing() -> None:
    # As stiff as the plain sum of pairs: the softer the mesh, the more the supports count.
    found = specimen_modes(load_config(minimal(stiffness__beam="rack_trochoid")).gearbox(0))
    assert 8 + 6 <= len(found.coordinates) <= 8 + 9
    assert (np.diff(found.modes.frequency_hz) > 0.0).all()
    inertia = dict(zip(found.coordinates, np.diag(found.mass), strict=True))
    radius_1, radius_2 = (0.5 * 3e-3 * teeth * np.cos(np.radians(20.0)) for teeth in (18, 47))
    moving = (
        radius_1**2 / inertia["theta_pinion"]
        + radius_2**2 / inertia["theta_gear"]
        + 1 / inertia["y_pinion"]
        + 1 / inertia["y_gear"]
    )
    free = np.sqrt(next(iter(found.mesh_stiffness_n_per_m.values())) * moving) / (2.0 * np.pi)
    # Gears on the mesh alone; bearings, shafts and casing are softer and stiffen it by a few per cent: by 4.1 % against
    # teeth side by side, by 5.3 % against coupled ones, which are softer by a fifth.
    assert free < found.modes.frequency_hz[-1] < 1.06 * free


def test_the_linear_law_alone_has_no_friction() -> None:
    # friction.model: auto follows the law, so that one key is enough to go back to mesh stiffness times approach
    config = load_config(minimal(duration_s=0.05, dynamics__mesh__law="linear"))
    assert config.config.dynamics.method == "product"
    table = internals_table(config, 0)
    assert "friction_force_n" not in table.column_names
