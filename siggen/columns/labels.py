"""Columns of no channel: what is damaged, speed and load, what the gearbox draws, errors of its teeth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.keys.column import DECIBEL, HERTZ, MICROMETRE, MILLIMETRE, Column, Role, in_role, list_of
from siggen.names import MACHINES, PLANETARY, GearName, MeshName, Names, ShaftName
from siggen.sensing.inputs import MOTION
from siggen.sensors.quantity import STILL_M_S2

if TYPE_CHECKING:
    from siggen.gearbox.channels import DrawnChannel
    from siggen.gearbox.specimen import Specimen
    from siggen.gearbox.teeth import MadeWith


# Columns about one gear, shaft or mesh: their names and meanings are composed of the names of the gearbox.

FAULTY_TEETH = Column("faulty_teeth_{}", list_of(pa.int32()), "", "indices of {}'s damaged teeth", Role.TARGET)
TEETH = Column("teeth_{}", pa.int32(), "", "number of teeth of {}")
MESH_HZ = Column("mesh_hz", pa.float64(), HERTZ, "tooth mesh frequency", quantity="mesh_hz")


def of_gear(column: Column, gear: GearName) -> Column:
    """Return a column, whose name and meaning leave a gear open as {}, about that gear."""
    return _named(column, gear.column, gear.called, gear.word, gear.inner_column)


def of_shaft(column: Column, shaft: ShaftName) -> Column:
    """Return a column, whose name and meaning leave a shaft open as {}, about that shaft."""
    return _named(column, shaft.word, shaft.called, shaft.word, shaft.inner)


def frequency_of(mesh: MeshName) -> Column:
    """Return name and meaning of the column of a mesh's frequency."""
    meaning = f"tooth mesh frequency of {mesh.word}" if mesh.word else "tooth mesh frequency"
    label = f"mesh_{mesh.inner}_hz" if mesh.inner else "mesh_hz"
    return replace(MESH_HZ, name=mesh.frequency, meaning=meaning, of=mesh.word, label=label)


def quantity_of(column: Column) -> str:
    """Return what a column holds whose name leaves open of what."""
    return "_".join(part for part in column.name.split("_") if part != "{}")


def _named(column: Column, in_name: str, called: str, of: str, in_label: str) -> Column:
    return replace(
        column,
        name=column.name.format(in_name),
        meaning=column.meaning.format(called),
        quantity=quantity_of(column),
        of=of,
        label=column.name.format(in_label),
    )


# Columns of manufacturing errors, part of the labels of `siggen.columns.record`.

GEAR_ERROR_COLUMNS = (
    Column("accuracy_class_{}", pa.int32(), "", "flank tolerance class of {} by ISO 1328-1:2013"),
    Column("tolerance_share_{}", pa.float64(), "", "share of that class's tolerances that {} may use"),
    Column("pitch_deviation_{}_um", pa.float64(), MICROMETRE, "largest single pitch deviation of {}"),
    Column("cumulative_pitch_{}_um", pa.float64(), MICROMETRE, "total cumulative pitch deviation of {}"),
    Column("runout_{}_um", pa.float64(), MICROMETRE, "radial runout of {}, twice its eccentricity; part of its pitch"),
    Column("profile_slope_{}_um", pa.float64(), MICROMETRE, "largest profile slope deviation of {}'s teeth"),
    Column("profile_form_{}_um", pa.float64(), MICROMETRE, "largest profile form deviation of {}'s teeth"),
    Column("profile_deviation_{}_um", pa.float64(), MICROMETRE, "largest total profile deviation of {}'s teeth"),
)
"""Columns of each gear in sets with manufacturing errors: as a machine measures them about the shaft's axis."""


CROWNING_COLUMNS = (
    Column("crowning_{}_um", pa.float64(), MICROMETRE, "crowning of {}: what its teeth miss at both ends of the face"),
)
HELIX_COLUMNS = (
    Column("helix_slope_{}_um", pa.float64(), MICROMETRE, "helix slope deviation of {}; part of lead_misalignment_um"),
    Column("helix_form_{}_um", pa.float64(), MICROMETRE, "helix form deviation of {}"),
)

WAVE_COLUMNS = (
    Column("ghost_orders_{}", list_of(pa.int32()), "", "waves over all teeth of {}, per turn of its shaft"),
    Column(
        "ghost_amplitudes_{}_um",
        list_of(pa.float64()),
        MICROMETRE,
        "amplitudes of these waves on the flanks of {}, averaged over the face",
    ),
)


def manufacture_columns(gearbox: Specimen) -> tuple[Column, ...]:
    """Return the columns of manufacturing errors; none for sets of perfect gears."""
    made = gearbox.meshes[0].teeth.made
    if made is None:
        return ()
    gears = gearbox.names.first.gears
    of_gears = (of_gear(column, gear) for gear in gears for column in error_columns(made))
    waves = (of_gear(column, gear) for gear in gears for column in wave_columns(made))
    lead = "gap of the flanks at one end of the face when they touch at the other; its sign is the end"
    return in_role(
        Role.PROVENANCE,
        Column("manufacture_draw", pa.string(), "", "whether states share their gears: specimen or state"),
        *of_gears,
        Column("lead_misalignment_um", pa.float64(), MICROMETRE, lead),
        *waves,
        section="manufacture",
    )


def error_columns(made: MadeWith) -> tuple[Column, ...]:
    """Return the columns of errors of one gear, which is left open."""
    return (
        *GEAR_ERROR_COLUMNS,
        *(CROWNING_COLUMNS if made.crowned else ()),
        *(HELIX_COLUMNS if made.helices else ()),
    )


def wave_columns(made: MadeWith) -> tuple[Column, ...]:
    """Return the columns of waves of one gear, which is left open."""
    return WAVE_COLUMNS if made.waves else ()


# Columns of planetary sets: those of a pair under the names of sun and planets, and those of ring and carrier.

EACH = "each_planet"
RING = PLANETARY.meshes[1].driven
PLANET_HZ = Column(
    "planet_hz",
    pa.float64(),
    HERTZ,
    "rotation frequency of the planets about their pins, against the carrier",
    quantity="hz",
    of="planet",
)
SET_COLUMNS = in_role(
    Role.CONDITION,
    *(replace(of_gear(column, RING), label="") for column in (FAULTY_TEETH, TEETH)),
    Column("planet_positions_deg", list_of(pa.float64()), "deg", "where the planets stand on the carrier"),
    Column("carrier_hz", pa.float64(), HERTZ, "rotation frequency of the carrier"),
    Column(
        "pin_errors_um", list_of(pa.float64()), "um", "how far each planet's pin is ahead of its place", Role.PROVENANCE
    ),
    section="planetary",
)


def manufacture_of_others(made: MadeWith) -> tuple[Column, ...]:
    """Return the columns of errors of the ring and of all planets, as lists, of the flanks towards the sun."""
    ring, each = GearName("ring", "ring", "ring", "the ring"), GearName(EACH, EACH, EACH, "each planet")
    of_ring = (of_gear(column, ring) for column in (*error_columns(made), *wave_columns(made)))
    of_planets = (of_gear(replace(column, type=list_of(column.type)), each) for column in error_columns(made))
    return in_role(Role.PROVENANCE, *of_ring, *of_planets, section="manufacture")


STATE_COLUMNS = (
    Column("fault", pa.string(), "", "healthy, or the word of its damage"),
    Column("severity", pa.string(), "", "healthy, slight, moderate, severe, or a name of the configuration"),
)
DAMAGE_COLUMNS = (
    Column("damage_count", pa.int32(), "", "number of single damages on all teeth"),
    Column(
        "damaged_area_mm2",
        pa.float64(),
        "mm^2",
        "area along the flanks of all outlined damage together; 0 for cracks, wear and bearings",
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
        "largest relative loss of mesh stiffness by potential energy, whatever the simulated law: a pair "
        "without contact length carries nothing; 0 for wear",
        Role.CONSEQUENCE,
    ),
    Column("contact_loss_share", pa.float64(), "", "share of the time without tooth contact", Role.CONSEQUENCE),
    Column("status", pa.string(), "", "ok; failed records stand in the manifest alone", Role.PROVENANCE),
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
        "largest relative loss of force over approach at rest and at the record's torque, by the simulated law",
        Role.CONSEQUENCE,
    ),
)
SHAFT_HZ = Column("{}_shaft_hz", pa.float64(), HERTZ, "rotation frequency of {}")
TORQUE = Column("torque_nm", pa.float64(), "N m", "torque at the input shaft")
OIL_TEMPERATURE = Column(
    "oil_temperature_c",
    pa.float64(),
    "°C",
    "of the oil, given or warmed by losses",
    Role.CONDITION,
    "dynamics",
)


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
    Column("housing_mass_kg", pa.float64(), "kg", "of the housing, without gears and shafts"),
    Column("housing_first_mode_hz", pa.float64(), "Hz", "lowest mode above the six on its bolts"),
    section="housing",
)
"""Columns of sets whose housings are drawn from their geometry."""
INTEGRATION_COLUMNS = in_role(
    Role.CONSEQUENCE,
    Column(
        "integration_error",
        pa.float64(),
        "",
        f"estimated relative rms error of the motion (of at least {STILL_M_S2:g} in SI units) by the steps of "
        "integration and by its start; above the set's tolerance where the finest steps do not suffice, inf where it "
        "diverges",
    ),
    Column(
        "integration_error_of",
        pa.string(),
        "",
        "samples; or levels, over half a second at most, where teeth part",
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
        Column("mean_torque_nm", pa.float64(), "N m", "mean of the motor's torque"),
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
        *((OIL_TEMPERATURE,) if gearbox.oiled else ()),
        *(INTEGRATION_COLUMNS if gearbox.law.method == "exponential" else ()),
        *gearbox.labels,
        *(HOUSING_COLUMNS if gearbox.boxed else ()),
        *(() if planetary else columns_behind(names)),
        *(variation_columns(names) if gearbox.points[0].variation is not None else ()),
        *manufacture_columns(gearbox),
        *(SET_COLUMNS if planetary else ()),
        *(manufacture_of_others(made) if planetary and made is not None else ()),
    )


# Columns about the background of a healthy machine, part of the labels of `siggen.columns.record`.

F64 = pa.float64()

RUBBING = (
    Column("rubbing_force_n", F64, "N", "rms of the rubbing force along the line of action, without bursts"),
    Column("rubbing_asperity_share", F64, "", "share of the mean load that asperities carry at the pitch point"),
    Column("rubbing_level_std", F64, "", "s of the rubbing's random level exp(s U - s^2/2)"),
)
DEPTH = Column("rubbing_{}_depth", F64, "", "modulation of the rubbing by the shaft of {}")
VELOCITY = Column(
    "bearing_velocity_{}_um_s", F64, "um/s", "waviness of the bearings of {}, 1800 to 10000 Hz at 30 turns/s"
)
COUPLING = Column("coupling_force_{}_n", F64, "N", "once per turn, of the misaligned coupling on {}")
MACHINE = Column(
    "machine_force_n_per_sqrt_hz", F64, "N/sqrt(Hz)", "noise of the force of motor and load each, above its low corner"
)


def background_columns(gearbox: Specimen) -> tuple[Column, ...]:
    """Return the columns of the parts that the background of a gearbox has; none without one."""
    drawn = gearbox.background
    if drawn is None:
        return ()
    names, columns = gearbox.names, list[Column]()
    if drawn.bearings:
        columns += [of_shaft(VELOCITY, shaft) for shaft in names.shafts]
    if drawn.machines is not None:
        columns.append(MACHINE)
    if drawn.rubbing is not None:
        columns += [*RUBBING, *(of_gear(DEPTH, gear) for gear in names.first.gears)]
    if drawn.shafts:
        columns += [of_shaft(COUPLING, names.shafts[place]) for place in MACHINES.values()]
    for name in drawn.foreign:
        what = " ".join(name.split("_"))
        columns.append(Column(f"{name}_order", F64, "", f"mesh of the {what}, per turn of the input shaft"))
        columns.append(Column(f"{name}_force_n", F64, "N", f"first line of the {what}"))
    if drawn.rubbing is not None and drawn.rubbing.bursts is not None:
        columns.append(Column("burst_count", pa.int32(), "", "bursts of the rubbing that begin within the record"))
    return in_role(Role.PROVENANCE, *columns, section="background")


# Columns about one channel: its noise, its path, its disturbances; a set has those of the parts that its sensors have.
#
# What a channel measures stands in `siggen.columns.record`.


def channel_columns(gearbox: Specimen) -> tuple[Column, ...]:
    """Return the columns of all channels: their noise, then path and disturbances of each."""
    noises = (column for channel in gearbox.channels for column in _noise(channel))
    ways = (column for channel in gearbox.channels for column in _way(channel, heard=gearbox.passes_forces))
    return in_role(Role.PROVENANCE, *noises, *ways, section="sensors")


def _noise(channel: DrawnChannel) -> Iterator[Column]:
    name, quantity = channel.name, channel.quantity
    floor = f"noise_floor_{name}_{quantity.suffix}"
    level = f"power of the signal over the white noise in {name}"
    yield Column(floor, pa.float64(), quantity.unit, f"RMS of the white noise in {name}")
    yield Column(f"snr_{name}_db", pa.float64(), DECIBEL, level, Role.CONSEQUENCE)
    yield Column(f"clipped_share_{name}", pa.float64(), "", f"share of clipped samples in {name}", Role.MEASURED)


def _way(channel: DrawnChannel, *, heard: bool) -> Iterator[Column]:
    name, quantity, path = channel.name, channel.quantity, channel.path
    if path is not None or (heard and MOTION in channel.reads):
        accelerance = f"rms accelerance to {name}, 100 Hz to 0.45 fs, all forces"
        yield Column(f"path_modes_{name}", pa.int32(), "", f"modes of the housing to {name}; 0 if it was measured")
        yield Column(f"path_accelerance_{name}_m_s2_per_n", pa.float64(), "m/s^2/N", accelerance)
    if path is not None and path.of_several:
        yield Column(f"path_number_{name}", pa.int32(), "", f"which of the measured paths to {name}, from 0")
    for source in channel.sources:
        unit = f"{quantity.unit}{source.per[1]}"
        yield Column(source.column(name, quantity.suffix), pa.float64(), unit, f"{source.meaning} {name}")
