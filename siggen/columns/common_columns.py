"""Columns of no channel: what is damaged, speed and load, what the gearbox draws, errors of its teeth."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.columns.manufacture_columns import manufacture_columns
from siggen.columns.of_parts import FAULTY_TEETH, TEETH, frequency_of, of_gear, of_shaft
from siggen.columns.planetary_columns import PLANET_HZ, SET_COLUMNS, manufacture_of_others
from siggen.keys.column import HERTZ, MILLIMETRE, Column, Role, in_role
from siggen.names import Names
from siggen.sensors.quantity import STILL_M_S2

if TYPE_CHECKING:
    from siggen.gearbox.specimen import Specimen

STATE_COLUMNS = (
    Column("fault", pa.string(), "", "what the state is called: healthy, or by its kind of damage"),
    Column("severity", pa.string(), "", "healthy, slight, moderate, severe, or a name of the configuration"),
)
DAMAGE_COLUMNS = (
    Column("damage_count", pa.int32(), "", "number of single damages on all teeth"),
    Column(
        "damaged_area_mm2",
        pa.float64(),
        "mm^2",
        "area along the flank of the union of all outlined damage, all teeth; 0 for cracks, wear and bearings",
    ),
    Column("damaged_area_share", pa.float64(), "", "damaged share of the most damaged flank"),
    Column("damage_face_length_mm", pa.float64(), MILLIMETRE, "longest single damage across the face"),
    Column("damage_profile_length_mm", pa.float64(), MILLIMETRE, "longest single damage along the profile (arc)"),
    Column(
        "contact_length_loss_mm", pa.float64(), MILLIMETRE, "largest length that a contact line loses", Role.CONSEQUENCE
    ),
    Column(
        "mesh_stiffness_loss",
        pa.float64(),
        "",
        "largest relative loss of mesh stiffness against healthy by potential energy: a pair without contact length "
        "carries nothing; a measure of the damage alone, also where the simulation lets flanks sink instead; 0 for "
        "wear, which takes neither section nor contact length: see mesh_stiffness_loss_as_simulated",
        Role.CONSEQUENCE,
    ),
    Column("contact_loss_share", pa.float64(), "", "share of the time without tooth contact", Role.CONSEQUENCE),
    Column(
        "status", pa.string(), "", "ok; records that failed are in the manifest, not among the rows", Role.PROVENANCE
    ),
    Column("through_face", pa.bool_(), "", "whether damage takes the whole contact length somewhere"),
    Column(
        "sink_depth_um",
        pa.float64(),
        "um",
        "how far the mating flank sinks at most; 0 where lands carry",
        Role.CONSEQUENCE,
    ),
    Column(
        "mesh_stiffness_loss_as_simulated",
        pa.float64(),
        "",
        "largest relative loss of force over approach at rest and at the record's torque, by the simulated law; "
        "errors of single teeth are left out",
        Role.CONSEQUENCE,
    ),
)
SHAFT_HZ = Column("{}_shaft_hz", pa.float64(), HERTZ, "rotation frequency of {}")
TORQUE = Column("torque_nm", pa.float64(), "N m", "torque at the input shaft")


def target_columns(names: Names) -> tuple[Column, ...]:
    """Return the columns about damage; teeth of the first mesh alone."""
    words = ", ".join(gear.word for gear in names.gears)
    faulty = Column("faulty_gear", pa.string(), "", f"gear with damage: none, {words} or several")
    teeth = (of_gear(FAULTY_TEETH, gear) for gear in names.first.gears)
    return in_role(Role.TARGET, *STATE_COLUMNS, faulty, *teeth, *DAMAGE_COLUMNS)


def operating_columns(names: Names, *, planetary: bool = False) -> tuple[Column, ...]:
    """Return the columns of speed, load and teeth of the first mesh; of a set the carrier's stand with its ring's."""
    driver, shafts = names.first.driver, names.shafts[: 1 if planetary else 2]
    at_start = f"angle of {driver.called} at the first sample"
    start = Column("start_angle_rad", pa.float64(), "rad", at_start, Role.PROVENANCE)
    return in_role(
        Role.CONDITION,
        *(replace(of_gear(TEETH, gear), section="gears") for gear in names.first.gears),
        Column("speed_hz", pa.float64(), HERTZ, f"nominal speed of the input shaft, that of {driver.called}"),
        TORQUE,
        *(of_shaft(SHAFT_HZ, shaft) for shaft in shafts),
        *((PLANET_HZ,) if planetary else ()),
        frequency_of(names.first),
        start,
        section="operating_points",
    )


def columns_behind(names: Names) -> tuple[Column, ...]:
    """Return teeth and frequencies of the meshes behind the first one."""
    found: list[Column] = []
    for mesh, shaft in zip(names.meshes[1:], names.shafts[2:], strict=True):
        found += [of_gear(FAULTY_TEETH, gear) for gear in mesh.gears]
        found += [of_gear(TEETH, gear) for gear in mesh.gears]
        found += [frequency_of(mesh), of_shaft(SHAFT_HZ, shaft)]
    return in_role(Role.CONDITION, *found, section="stages")


HOUSING_COLUMNS = in_role(
    Role.PROVENANCE,
    Column("housing_mass_kg", pa.float64(), "kg", "mass of the housing, without gears and shafts"),
    Column("housing_first_mode_hz", pa.float64(), "Hz", "lowest mode of the housing above the six on its bolts"),
    section="housing",
)
"""Columns of sets whose housings are drawn from their geometry."""
INTEGRATION_COLUMNS = in_role(
    Role.CONSEQUENCE,
    Column(
        "integration_error",
        pa.float64(),
        "",
        f"estimated relative rms error of the simulated motion (of at least {STILL_M_S2:g} in SI units) by the steps "
        "of integration, from a stretch of the record with twice as many, and by its start, from a later one; above "
        "the set's tolerance where the finest steps do not suffice, inf where it diverges",
    ),
    Column(
        "integration_error_of",
        pa.string(),
        "",
        "samples; or levels, over half a second at most, where teeth part and the motion depends on every rounding",
    ),
)
"""Columns of sets of the law pairs."""


def variation_columns(names: Names) -> tuple[Column, ...]:
    """Return the columns of sets in which speed or torque varies within a record."""
    shaft = names.shafts[0].word
    speed = f"standard deviation of the input shaft's speed about {shaft}_shaft_hz"
    return in_role(
        Role.CONDITION,
        Column("speed_std_hz", pa.float64(), HERTZ, speed),
        Column("mean_torque_nm", pa.float64(), "N m", "mean of the motor's torque, what speeds the train up included"),
        Column("torque_std_nm", pa.float64(), "N m", "standard deviation of the motor's torque"),
        section="variation",
    )


def common_columns(gearbox: Specimen) -> tuple[Column, ...]:
    """Return the columns of labels and operating conditions that belong to no channel."""
    names, planetary, made = gearbox.names, gearbox.planets is not None, gearbox.meshes[0].teeth.made
    return (
        *target_columns(names),
        *gearbox.states[0].labels,
        *operating_columns(names, planetary=planetary),
        *(INTEGRATION_COLUMNS if gearbox.law.method == "exponential" else ()),
        *gearbox.labels,
        *(HOUSING_COLUMNS if gearbox.boxed else ()),
        *(() if planetary else columns_behind(names)),
        *(variation_columns(names) if gearbox.points[0].variation is not None else ()),
        *manufacture_columns(gearbox),
        *(SET_COLUMNS if planetary else ()),
        *(manufacture_of_others(made) if planetary and made is not None else ()),
    )
