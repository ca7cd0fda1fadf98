"""Teeth of the meshes of a planetary set: one sun, one ring, and planets that turn about one axis each."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from siggen.arrays import FloatArray
from siggen.checks.loading import load_config
from siggen.columns.labels import manufacture_of_others
from siggen.gearbox.specimen import Specimen
from siggen.gears.errors import eccentric_m
from siggen.gears.planetary import ring_begins_pitches
from siggen.record.specimen_state import specimen_state
from siggen.record.teeth import MeshTeeth, all_teeth
from tests.config.planets import planets
from tests.dynamics.trains import planetary_structure
from tests.simulated import label_names

COUNT = 3


@pytest.fixture(scope="module")
def specimen() -> Specimen:
    return load_config(planets(manufacture={"accuracy_class": 6, "flank_waves": "on"})).gearbox(0)


@pytest.fixture(scope="module")
def meshes(specimen: Specimen) -> Sequence[MeshTeeth]:
    return all_teeth(specimen)


def test_sun_and_ring_are_the_same_in_all_of_their_meshes_and_every_flank_of_planets_is_its_own(
    meshes: Sequence[MeshTeeth],
) -> None:
    found = [one.errors(0) for one in meshes]
    assert all(one is not None for one in found)
    suns = [one.pinion.errors.pitch_m for one in found[:COUNT] if one is not None]
    rings = [one.gear.errors.pitch_m for one in found[COUNT:] if one is not None]
    assert all(np.array_equal(one, suns[0]) for one in suns)
    assert all(np.array_equal(one, rings[0]) for one in rings)
    flanks = [one.gear for one in found[:COUNT] if one is not None] + [
        one.pinion for one in found[COUNT:] if one is not None
    ]
    assert len({one.errors.pitch_m.tobytes() for one in flanks}) == 2 * COUNT
    waves = [one.waves(0) for one in meshes]
    assert len({one.pinion.common_m.tobytes() for one in waves[:COUNT] if one is not None}) == 1
    assert len({one.gear.common_m.tobytes() for one in waves[COUNT:] if one is not None}) == 1


def test_labels_tell_the_errors_of_the_ring_and_of_every_planet_as_they_were_made(
    specimen: Specimen, meshes: Sequence[MeshTeeth]
) -> None:
    config, made = load_config(planets(manufacture={"accuracy_class": 6, "flank_waves": "on"})), meshes[0].teeth.made
    labels = specimen_state(specimen, 0).labels
    errors = [one.errors(0) for one in meshes]
    runouts = [1e6 * one.gear.found.largest["runout_m"] for one in errors if one is not None]
    assert labels["runout_ring_um"] == runouts[COUNT]
    assert labels["runout_each_planet_um"] == runouts[:COUNT]
    assert labels["runout_each_planet_um"][0] == labels["runout_gear_um"]
    assert len(set(runouts[:COUNT])) == COUNT
    assert len(labels["ghost_orders_ring"]) == len(labels["ghost_amplitudes_ring_um"]) > 0
    assert made is not None
    assert {column.name for column in manufacture_of_others(made)} <= set(label_names(config)) & set(labels)


def missing_m(made: MeshTeeth, which: str, pitches: FloatArray) -> FloatArray:
    """Return what the eccentricity takes from the pair that is in contact (k,) [m], `pitches` after pair 0 entered."""
    errors = made.errors(0)
    assert errors is not None
    gear = getattr(errors, which).errors
    number = np.floor(pitches).astype(int)
    position = made.pair.contact_start_m + (pitches - number) * made.pair.base_pitch_m
    every = eccentric_m(made.pair, which, gear, position)
    return np.asarray(every[number % made.pair.member(which).teeth, np.arange(pitches.size)])


@pytest.mark.parametrize("planet", range(COUNT))
def test_an_eccentric_planet_stands_back_from_sun_and_ring_as_the_structure_says_of_its_shift(
    specimen: Specimen, meshes: Sequence[MeshTeeth], planet: int
) -> None:
    """The shift is found from the sun's mesh by the vectors of the motion, turned, and told to the ring's."""
    planets = specimen.planets
    assert planets is not None
    teeth, pair, inner = planets.teeth, planets.pair, planets.ring
    structure = planetary_structure(planets.stage)
    place = [structure.coordinates.index(f"{axis}_planet_{planet + 1}") for axis in ("x", "y")]
    to_sun, to_ring = (structure.meshes[i].vector[place] for i in (planet, COUNT + planet))
    turned = 30.0 + np.linspace(0.0, 26.0, 53)  # pitches of the first mesh
    at_sun, lag = turned + float(teeth.sun_begins[planet]), ring_begins_pitches(pair, inner)
    at_ring = turned + lag + float(teeth.ring_begins[planet])
    angle = -2.0 * np.pi * turned / teeth.planet  # planets turn against the sun
    turns = np.stack([np.cos(angle), np.sin(angle), -np.sin(angle), np.cos(angle)]).reshape(2, 2, -1)
    shift = np.linalg.lstsq(
        -np.einsum("a,bak->kb", to_sun, turns), missing_m(meshes[planet], "gear", at_sun), rcond=None
    )
    expected = -np.einsum("a,bak,b->k", to_ring, turns, shift[0])
    found = missing_m(meshes[COUNT + planet], "pinion", at_ring)
    assert np.ptp(expected) > 1e-6
    assert found == pytest.approx(expected, abs=1e-9 * np.ptp(expected) + 1e-15)


def test_the_ring_weighs_and_turns_like_thin_hoops_of_steel() -> None:
    specimen = load_config(planets()).gearbox(0)
    ring, inner = specimen.planets.stage.ring, specimen.planets.ring
    # From the root circle of its teeth to the rim, four modules behind; teeth of the ring point inwards.
    edges = np.linspace(inner.gear.root_radius_m, inner.gear.root_radius_m + 4.0 * inner.gear.module_m, 10_001)
    radius_m = 0.5 * (edges[1:] + edges[:-1])
    hoops_kg = 7850.0 * 2.0 * np.pi * radius_m * np.diff(edges) * inner.face_width_m
    assert ring.mass_kg == pytest.approx(hoops_kg.sum(), rel=1e-8)
    assert ring.inertia_kg_m2 == pytest.approx((hoops_kg * radius_m**2).sum(), rel=1e-6)
