"""From the configuration to the physics: options of the stiffness model, and its limits at the bounds of the gears."""

from __future__ import annotations

import pytest

from siggen.checks.loading import load_config
from siggen.checks.physical_problems import physical_problems
from siggen.config import parse
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from siggen.gearbox.possible import PossibleGearbox
from siggen.gearbox.teeth import gear_pair, stiffness_options
from siggen.mesh.mesh_tables import mesh_tables
from siggen.mesh.stiffness_options import StiffnessOptions
from tests.config.minimal import config, minimal


def test_defaults_of_configuration_and_physics_agree_but_for_the_coupling_of_calibrated_teeth():
    assert stiffness_options(config().stiffness) == StiffnessOptions(coupling="body")


@pytest.mark.parametrize("beam", ["base_circle", "root_circle", "rack_trochoid"])
def test_models_of_the_literature_stay_plain_sums(beam):
    assert stiffness_options(config(stiffness__beam=beam).stiffness).coupling == "none"


THIN_BORES = {"gears__pinion": {"teeth": 17, "bore_radius_mm": 0.6}, "gears__gear": {"teeth": 47, "bore_radius_mm": 10}}


def test_teeth_that_are_stiffer_than_their_coupling_are_refused_at_load_by_name():
    # A pinion on a shaft of a twentieth of its root radius twists far more than a tooth bends.
    with pytest.raises(ConfigError, match=r"stiffness\.beam: received 'calibrated', whose .*allowed: larger bores, or"):
        load_config(minimal(**THIN_BORES))
    assert load_config(minimal(**THIN_BORES, stiffness={"beam": "base_circle"}))


def test_what_load_lets_pass_gives_tables_and_what_it_refuses_does_not():
    # Bores between: the check at load and the tables must agree where one turns into the other.
    seen = set()
    for bore_mm in (0.4, 0.6, 0.8, 1.1, 6.0):
        pinion = {"teeth": 17, "bore_radius_mm": bore_mm}
        raw = minimal(**{**THIN_BORES, "gears__pinion": pinion})
        usable = parse(raw).config
        possible = PossibleGearbox.of_sections(parse(raw).sections)
        refused = any(problem.path == "stiffness.beam" for problem in physical_problems(possible))
        seen.add(refused)
        if refused:
            with pytest.raises(ValueError, match="coupling 'body'"):
                mesh_tables(gear_pair(usable.gears), (), stiffness_options(usable.stiffness), points=65)
        else:
            mesh_tables(gear_pair(usable.gears), (), stiffness_options(usable.stiffness), points=65)
    assert seen == {True, False}


def notes(**changes: object) -> tuple[str, ...]:
    return SetDesign(config(**changes)).possible.stiffness_notes


def test_notes_look_at_both_ends_of_a_distribution():
    small, large = ([low, high] for low, high in ((3.0, 10.0), (6.0, 17.5)))
    assert notes() == ()
    (thick,) = notes(gears__pinion__bore_radius_mm=small)
    assert "is 7.75" in thick
    # Above a third of the root radius it is the shaft inside that gives way: a solid body, which the fit knows.
    assert notes(gears__pinion__bore_radius_mm=large) == ()
