"""Numbers that are a unit off are named before anything is simulated; the shipped presets are plausible."""

from __future__ import annotations

from typing import Any

import pytest

from siggen.checks.loading import load_config
from siggen.checks.plausibility import implausible
from siggen.errors import ConfigError
from tests.config.mill import mill, with_machine

SLIPS = {
    "torque in kN m": "operating_points.0.torque_nm=0.04",
    "torque in N mm": "operating_points.0.torque_nm=40000",
    "bearings in N/mm": "dynamics.pinion.bearing.stiffness_n_per_m=2e5",
    "bolts in N/mm": "housing.bolts.axial_stiffness_n_per_m=8e4",
    "couplings in N mm": "dynamics.input_coupling.stiffness_nm_per_rad=6.3e6",
    "width in m": "gears.face_width_mm=0.02",
    "module in m": "gears.module_mm=0.003",
    "backlash in mm": "dynamics.backlash_um=0.08",
    "relief in mm": "dynamics.mesh.tip_relief_um=0.008",
    "mass in g": "dynamics.pinion.mass_kg=1000",
    "casing in t": "housing.mass_kg=0.02",
    "walls in m": "housing.wall_mm=0.012",
    "inertia in kg mm2": "dynamics.pinion.inertia_kg_m2=160",
    "roughness in mm": "dynamics.friction.roughness_um=4e-4",
    "speed in 1/min": "operating_points.0.speed_hz=2000",
    "bore in m": "gears.pinion.bore_radius_mm=0.01",
    "masses of other teeth": "gears.gear.teeth=94",
}

# What refuses a slip before its key is compared, or what it makes implausible.
SAID_OF = {
    "width in m": "face width 0.02 mm",
    "module in m": "root radius",
    "speed in 1/min": "fs_hz",
    "bore in m": "larger bores",
    "masses of other teeth": "dynamics.gear.inertia_kg_m2",
}

RIGID = {"bolts in N/mm", "casing in t", "masses of other teeth"}
"""Slips in what only the preset has whose housing is rigid, and whose masses are given."""


def told(*source: Any) -> str:
    return "\n".join(implausible(load_config(*source).possible))


@pytest.mark.parametrize("preset", ["quickstart", "bench", "industrial"])
def test_realistic_presets_are_plausible(preset: str) -> None:
    assert told(preset) == ""


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_of_units_is_refused_or_named(slip: str) -> None:
    try:
        found = told("paper_b" if slip in RIGID else "bench", [SLIPS[slip]])
    except ConfigError as error:
        found = str(error)
    key = SLIPS[slip].partition("=")[0]
    assert SAID_OF.get(slip, key) in found


def test_a_record_is_measured_by_the_turns_of_the_slowest_shaft_which_is_called_by_name() -> None:
    found = told(mill(duration_s=0.5, machine=with_machine("meshes", "fast", module_mm=60.0)))
    assert "turns of the shaft output in a record 1.88; usual" in found  # 0.5 s x 30 Hz x 18/47 x 17/52
    assert "turns of the carrier in a record 2" in told("planetary", ["duration_s=0.4"])
    assert "machine.meshes.fast.module_mm: module [mm] 60" in found


def test_idealised_sets_say_what_they_lack() -> None:
    found = told("tests/configs/ideal.yaml")
    assert "perfect gears" in found
    assert "no noise at all" in found


def test_pink_noise_alone_is_noise() -> None:
    pink = "sensors.lid.pink_noise={density_m_s2_per_sqrt_hz: 0.001}"
    assert "no noise at all" not in told("tests/configs/ideal.yaml", [pink])


def test_one_gear_pair_cannot_be_split_by_pairs_and_all_can() -> None:
    said = [told("families", [f"gears.pairs.count={count}"]) for count in (1, 60)]
    assert ["no records" in sentences for sentences in said] == [True, False]


def test_only_sensors_of_which_nothing_is_drawn_are_called_identical() -> None:
    def said(*sensors: str) -> bool:
        silent = [f"sensors={{{', '.join(sensors)}}}", "background=null"]
        return "identical, bit by bit" in told("tests/configs/ideal.yaml", silent)

    accelerometers = "one: {{bits: 16{0}}}, two: {{bits: 16{0}}}"
    assert said(accelerometers.format(""))
    assert not said(accelerometers.format(", gain: [0.9, 1.1]"))
    # each disc has marks and a seat of its own
    assert not said("one: {kind: encoder, place: pinion}", "two: {kind: encoder, place: pinion}")
