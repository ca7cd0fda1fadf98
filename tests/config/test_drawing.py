"""Drawing a section: every number by the uniform that belongs to its path."""

from __future__ import annotations

from functools import partial

import pytest

from siggen.config import GearsSection
from siggen.keys.distributions import Uniform
from siggen.keys.drawing import corners, draw
from siggen.keys.number import Within, bounds
from siggen.keys.section import Section
from siggen.seeding import Stream, named_uniforms
from siggen.sensors.accelerometer import Accelerometer
from tests.config.minimal import config

SPREAD = [0.05, 0.10]


UNIFORM = named_uniforms(11, Stream.SUPPORTS, 0)


def drawn(section):
    return draw(section, UNIFORM, type(section).__name__.lower())


def test_constants_are_left_as_they_are():
    gears = config().gears
    assert drawn(gears) == gears


@pytest.mark.parametrize(("section", "count"), [("gears", 9), ("dynamics", 38), ("stiffness", 0)])
def test_every_number_is_drawn_by_its_own_path(section, count):
    # 6 numbers of the pair and 2 per wheel; 4 of the gearbox, 7 per rotor, 2 per coupling, 8 of
    # the mesh and 8 of friction
    asked: list[str] = []

    def everywhere(value):
        return Uniform(low=0.0, high=1.0) if isinstance(value, float) or value is None else value

    def spread(part):
        changed = {}
        for name, field in type(part).model_fields.items():
            value = getattr(part, name)
            is_number = any(isinstance(marker, Within) for marker in field.metadata)
            changed[name] = everywhere(value) if is_number else spread(value) if isinstance(value, Section) else value
        return part.model_copy(update=changed)

    draw(spread(getattr(config(), section)), lambda name: asked.append(name) or 0.5, section)
    assert len(asked) == len(set(asked)) == count
    assert all(name.startswith(f"{section}.") for name in asked)


def test_gain_is_drawn_per_axis_and_noise_is_left_to_the_record():
    sensor = Accelerometer.model_validate(
        {"name": "a", "axes": ["vertical", "horizontal"], "gain": SPREAD, "noise": {"floor_m_s2": SPREAD}}
    )
    gains = sensor.drawn(UNIFORM).gain
    assert len(set(gains.each)) == 2
    assert sensor.drawn(UNIFORM).noise == sensor.noise


def test_corners_are_all_combinations_of_the_bounds():
    gears = config(gears__module_mm=SPREAD, gears__gear__bore_radius_mm={"one_of": [9, 4, 6]}).gears
    found = {(corner.module_mm, corner.gear.bore_radius_mm) for corner in corners(partial(draw, gears, path=""))}
    assert found == {(0.05, 4.0), (0.05, 9.0), (0.10, 4.0), (0.10, 9.0)}


def test_a_section_without_distributions_is_its_only_corner():
    gears = config().gears
    assert list(corners(partial(draw, gears, path=""))) == [gears]
    assert isinstance(gears, GearsSection)
    assert bounds(gears.module_mm) == (3.0, 3.0)
