"""From the configuration to the physics: options of the stiffness model, and its limits at the bounds of the gears."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.checks.physical_problems import physical_problems
from siggen.config import parse
from siggen.errors import ConfigError
from siggen.gears.stiffness.mesh_stiffness import pair_stiffness
from siggen.gears.stiffness.mesh_tables import mesh_tables
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from siggen.specimen.gears import gear_pair, model_notes, stiffness_options
from tests.config.minimal import config, minimal


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


def test_defaults_of_configuration_and_physics_agree_but_for_the_coupling_of_calibrated_teeth():
    assert stiffness_options(config().stiffness) == StiffnessOptions(coupling="body")


@pytest.mark.parametrize("beam", ["base_circle", "root_circle", "rack_trochoid"])
def test_models_of_the_literature_stay_plain_sums_unless_told_otherwise(beam):
    assert stiffness_options(config(stiffness__beam=beam).stiffness).coupling == "none"
    assert stiffness_options(config(stiffness__beam=beam, stiffness__coupling="body").stiffness).coupling == "body"


THIN_BORES = {"gears__pinion": {"teeth": 17, "bore_radius_mm": 1.1}, "gears__gear": {"teeth": 47, "bore_radius_mm": 10}}


def test_teeth_that_are_stiffer_than_their_coupling_are_refused_at_load_by_name():
    # A pinion on a shaft of a tenth of its root radius twists far more than a literature tooth bends.
    with pytest.raises(ConfigError, match=r"stiffness\.coupling.*'body' with beam: base_circle.*allowed: none, or"):
        load_config(minimal(**THIN_BORES, stiffness={"beam": "base_circle", "coupling": "body"}))
    for stiffness in ({"beam": "base_circle"}, {"beam": "calibrated"}, {"beam": "calibrated", "coupling": "none"}):
        assert load_config(minimal(**THIN_BORES, stiffness=stiffness))


def test_what_load_lets_pass_gives_tables_and_what_it_refuses_does_not():
    # Bores between: the check at load and the tables must agree where one turns into the other.
    seen = set()
    for bore_mm in (1.1, 1.5, 2.0, 3.0, 6.0):
        pinion = {"teeth": 17, "bore_radius_mm": bore_mm}
        raw = minimal(**{**THIN_BORES, "gears__pinion": pinion}, stiffness={"beam": "base_circle", "coupling": "body"})
        usable = parse(raw).config
        refused = any(problem.path == "stiffness.coupling" for problem in physical_problems(parse(raw)))
        seen.add(refused)
        if refused:
            with pytest.raises(ValueError, match="coupling 'body'"):
                mesh_tables(gear_pair(usable.gears), (), stiffness_options(usable.stiffness), points=65)
        else:
            mesh_tables(gear_pair(usable.gears), (), stiffness_options(usable.stiffness), points=65)
    assert seen == {True, False}


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
