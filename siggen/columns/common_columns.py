"""Columns of no channel: what is damaged, speed and load, what the gearbox draws, errors of its teeth."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.columns.gearbox_columns import gearbox_columns
from siggen.columns.manufacture_columns import manufacture_columns
from siggen.columns.planetary_columns import of_planets
from siggen.columns.stage_columns import stage_columns
from siggen.columns.state_columns import state_columns
from siggen.keys.column import HERTZ, MILLIMETRE, Column, Role, in_role, list_of
from siggen.sensors.quantity import STILL_M_S2

if TYPE_CHECKING:
    from siggen.config import Config

LABEL_COLUMNS = in_role(
    Role.TARGET,
    Column("fault", pa.string(), "", "what the state is called: healthy, or by its kind of damage"),
    Column("severity", pa.string(), "", "healthy, slight, moderate, severe, or a name of the configuration"),
    Column("faulty_gear", pa.string(), "", "gear with damage: none, pinion, gear, both, STAGE.pinion, ... or several"),
    Column("faulty_teeth_pinion", list_of(pa.int32()), "", "indices of the pinion's damaged teeth"),
    Column("faulty_teeth_gear", list_of(pa.int32()), "", "indices of the gear's damaged teeth"),
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
OPERATING_COLUMNS = in_role(
    Role.CONDITION,
    Column("teeth_pinion", pa.int32(), "", "number of teeth of the pinion", section="gears"),
    Column("teeth_gear", pa.int32(), "", "number of teeth of the gear", section="gears"),
    Column("speed_hz", pa.float64(), HERTZ, "nominal speed of the input (pinion) shaft"),
    Column("torque_nm", pa.float64(), "N m", "torque at the input shaft"),
    Column("pinion_shaft_hz", pa.float64(), HERTZ, "rotation frequency of the pinion's shaft"),
    Column("gear_shaft_hz", pa.float64(), HERTZ, "rotation frequency of the gear's shaft"),
    Column("mesh_hz", pa.float64(), HERTZ, "tooth mesh frequency"),
    Column("start_angle_rad", pa.float64(), "rad", "pinion angle at the first sample", Role.PROVENANCE),
    section="operating_points",
)
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
VARIATION_COLUMNS = in_role(
    Role.CONDITION,
    Column("speed_std_hz", pa.float64(), HERTZ, "standard deviation of the pinion's speed about pinion_shaft_hz"),
    Column("mean_torque_nm", pa.float64(), "N m", "mean of the motor's torque, what speeds the train up included"),
    Column("torque_std_nm", pa.float64(), "N m", "standard deviation of the motor's torque"),
    section="variation",
)
"""Columns of sets in which speed or torque varies within a record."""


def common_columns(config: Config) -> tuple[Column, ...]:
    """Return the columns of labels and operating conditions that belong to no channel, in the words of the program."""
    varying = VARIATION_COLUMNS if config.variation.active else ()
    stepped = INTEGRATION_COLUMNS if config.dynamics.method == "exponential" else ()
    return of_planets(config, (
        *LABEL_COLUMNS,
        *state_columns(config),
        *OPERATING_COLUMNS,
        *stepped,
        *gearbox_columns(config),
        *stage_columns(config),
        *varying,
        *manufacture_columns(config),
    ))  # fmt: skip
