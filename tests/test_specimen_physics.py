"""From the configuration to the physics: options of the stiffness model, and its limits at the bounds of the gears."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.gears import StiffnessOptions, mesh_tables, pair_stiffness
from siggen.specimen_physics import gear_pair, model_notes, stiffness_options
from tests.config.minimal import config


def test_every_option_of_the_section_reaches_the_model():
    section = {
        "beam": "root_circle",
        "foundation": "none",
        "foundation_angle": "rack",
        "hertz": "weber_banaschek",
        "hertz_force_n": 2000.0,
    }
    found = stiffness_options(config(stiffness=section).stiffness)
    assert found == StiffnessOptions("root_circle", "none", "rack", "weber_banaschek", 2000.0)


def test_defaults_of_configuration_and_physics_agree():
    assert stiffness_options(config().stiffness) == StiffnessOptions()


@pytest.mark.parametrize("hertz", ["weber_banaschek", "power_law"])
def test_tables_are_made_with_the_contact_law_of_the_configuration(hertz):
    usable = config(stiffness__hertz=hertz, stiffness__hertz_force_n=2000.0)
    pair, options = gear_pair(usable.gears), stiffness_options(usable.stiffness)
    tables = mesh_tables(pair, (), options, points=65)
    position = np.linspace(tables.start_m, tables.end_m, 65)
    np.testing.assert_array_equal(tables.pair_stiffness_n_per_m[0], pair_stiffness(pair, position, options))
    assert np.all(
        tables.pair_stiffness_n_per_m[0] < mesh_tables(pair, (), StiffnessOptions(), 65).pair_stiffness_n_per_m[0]
    )


def test_a_contact_law_changes_the_identity():
    linear, softer = config(), config(stiffness__hertz="power_law", stiffness__hertz_force_n=2000.0)
    assert (
        len(
            {
                linear.identity,
                softer.identity,
                config(stiffness__hertz="power_law", stiffness__hertz_force_n=1e3).identity,
            }
        )
        == 3
    )


def test_notes_look_at_both_ends_of_a_distribution():
    small, large = ({"kind": "uniform", "low": low, "high": high} for low, high in ((3.0, 10.0), (6.0, 17.5)))
    assert model_notes(config()) == ()
    (thick,) = model_notes(config(gears__pinion__bore_radius_mm=small))
    assert "is 7.75" in thick
    (thin,) = model_notes(config(gears__pinion__bore_radius_mm=large))
    # 18 teeth of module 3 have a root radius of 23.25 mm.
    assert "is 1.329" in thin
