"""What is worth saying of a set that can be made: idealised damage, shafts, its size, what varies."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees

from siggen.checks.physical_problems import STIFFNESS
from siggen.checks.tilt_problems import flank_tilts
from siggen.damage.registry import FAULT_WORDS, KNOWN_CHANGES
from siggen.drivetrain.varying_drive import SLOW_CORNER_HZ
from siggen.errors import UsageError, counted
from siggen.gearbox.configured import state_config
from siggen.gearbox.design import SetDesign
from siggen.gearbox.draw import draw_specimen
from siggen.gearbox.plan import specimen_count
from siggen.gearbox.possible import PossibleGearbox
from siggen.gearbox.specimen import Specimen
from siggen.gears.gear_pair import GearPair
from siggen.gears.tolerances import flank_tolerances
from siggen.keys.number import Number, bounds
from siggen.keys.problems import nearest
from siggen.names import Side
from siggen.record.drive import RATED_SPEED_HZ
from siggen.record.structure import BEARINGS, specimen_bearings
from siggen.rig.rig import Rig
from siggen.rig.rig_numbers import single_stiffness_n_um_mm


def torque_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield what torques of 0 and below mean for the records of a set."""
    config = gearbox.config
    torques = [bounds(point.torque_nm) for point in config.operating_points]
    damaged = any(state.damaged for state in config.states)
    if any(low <= 0.0 <= high for low, high in torques):
        behind = "springs without tilt, on the line of action of the drive flanks"
        also = f"; back flanks they meet are {behind}" if config.dynamics.mesh.law == "pairs" else ""
        idle = "a torque of 0 N m is idle: flanks rattle within the backlash, and no two integrators agree for long"
        yield f"{idle}{also}"
    if any(low < 0.0 for low, _ in torques):
        harmless = ", so damage of drive flanks changes nothing, and a missing tooth counts as whole" if damaged else ""
        yield f"torques below 0 N m load the back flanks: the driven gear drives{harmless}"


def state_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield which faults of changed machines are next to a known word: any word is taken, so a slip is none."""
    known = (*KNOWN_CHANGES, *FAULT_WORDS)
    for state in gearbox.config.states:
        if state.fault not in known and (near := nearest(state.fault, known)):
            yield f"state {state.name}: fault {state.fault} is a word of your own{near}"


def oil_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield that a temperature of oil acts on nothing."""
    dynamics = gearbox.config.dynamics
    if (
        dynamics.friction.oil_temperature_c is not None
        and dynamics.rubbing != "mixed_ehl"
        and not gearbox.config.background
    ):
        yield (
            f"dynamics.friction.oil_temperature_c acts on no record: friction is {dynamics.rubbing}, and there is no "
            "background. Friction mixed_ehl asks for oil"
        )


def damage_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield what to know about the shapes of damage in a set.

    A spall through the face whose edges are exactly parallel to the axis takes the whole contact line at once; with
    edges skewed by 0.1 to 1 mm over the face the line crosses them bit by bit, as lines of helical teeth always do.
    """
    pairs = gearbox.meshes[0].pairs
    width_mm = 1e3 * min(pair.face_width_m for pair in pairs)
    damages = (one for state in gearbox.config.states if state.damaged for one in state.damages)
    found = [edges for one in damages if (edges := one.straight_edges(width_mm)) is not None]
    straight = all(parallel for parallel, _ in found) and any(through for _, through in found)
    if straight and not any(pair.helix_rad for pair in pairs):
        yield (
            "all spalls are idealised: their edges are exactly parallel to the axis, so the whole contact line enters "
            "a spall across the face at once; edges of real spalls are skewed and wavy (damage kind: irregular, "
            "docs/understand/methods.md)"
        )


# Sentences about contact and tilt across the face, what limits them, and bearings whose stiffness follows the load.


def shaft_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield what to know where the contact is solved across the face or gears tilt."""
    dynamics = gearbox.config.dynamics
    if dynamics.mesh.law == "pairs":
        yield "contact across the face: load-dependent, with elastic edges of damage (dynamics.mesh.law: pairs)"
    if dynamics.shafts is not None:
        yield (
            "shafts bend and gears tilt (dynamics.shafts), down to no load; only a tilt at which an end of the face "
            "meets the other flank is outside_model"
        )
        tilts = flank_tilts(gearbox, gearbox.meshes[0].pairs[0])
        if tilts.largest_rad > tilts.limit_rad:
            yield (
                f"at the bounds of shafts and bearings {gearbox.largest_torque_nm:.3g} N m tilt the flanks by "
                f"{1e6 * tilts.largest_rad:.0f} urad; at {1e6 * tilts.limit_rad:.0f} an end meets the other flank: "
                "such gearboxes end as outside_model; stiffer bearings, or a gear_position nearer to 0.5, prevent it"
            )
    if any(getattr(gearbox.dynamics, role).bearing.geometry is not None for role in Side):
        yield from _bearing_notes(gearbox)


def _bearing_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield the stiffness of both bearings of each such shaft of gearbox 0, and that of states that change it."""
    config = gearbox.config
    for role in Side:  # a preset that a file extends may have given them
        bearing = getattr(config.dynamics, role).bearing
        if bearing.geometry is not None and STIFFNESS in bearing.model_fields_set:
            at = config.names.own_path(f"dynamics.{role}.bearing")
            yield (
                f"{at}.{STIFFNESS}: not used: {at}.geometry has a stiffness by load; "
                f"{at}.geometry: null takes the given one"
            )
    found = dict(_bearings(draw_specimen(config, 0)))
    yield from (f"{key}: {text}" for key, text in found.items())
    for index, state in enumerate(config.states):
        if state.changes:
            changed = _bearings(draw_specimen(state_config(config, 0, index), 0))
            yield from (f"{key}, state {state.name}: {text}" for key, text in changed if found.get(key) != text)


def _bearings(specimen: Specimen) -> Iterator[tuple[str, str]]:
    for point in specimen.points:
        for role, one in specimen_bearings(specimen.under(point)).items():
            balls = f"{one.bearing.balls} balls of {1e3 * one.bearing.ball_diameter_m:.3g} mm"
            text = (
                f"{BEARINGS * one.along_n_per_m:.3g} N/m along the load, {BEARINGS * one.across_n_per_m:.3g} across; "
                f"{balls} bear it over {degrees(one.half_zone_rad):.0f} degrees to either side (clearance "
                f"{1e6 * one.bearing.clearance_m:.3g} um)"
            )
            shaft = next(one.called for one in specimen.names.shafts if one.inner == role)
            yield f"both bearings of {shaft} under {point.torque_nm:.3g} N m (gearbox 0)", text


# Notes on a set that is too small to judge a model by: few gearboxes in the test split, short records.

FEWEST_TESTED = 6
WINDOW_TURNS, FEWEST_WINDOWS = 8, 2


def size_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield a sentence on each."""
    config = gearbox.config
    tested = specimen_count(SetDesign(config), "test")
    if tested < FEWEST_TESTED and config.splits.by != "pair":
        share, block = config.splits.test, config.splits.train + config.splits.validation + config.splits.test
        more = f"specimens: {-(-FEWEST_TESTED * block // share)} or more" if share else "a share of splits.test"
        yield (
            f"splits: {counted(tested, 'gearbox', 'gearboxes')} in the test split: below {FEWEST_TESTED} the limits of "
            f"every score are too wide to tell models apart; take {more}"
        )
    slowest_hz = min(abs(bound) for point in config.operating_points for bound in bounds(point.speed_hz))
    slowest_hz *= config.variation.speed_ratios[0]
    turns, wanted = config.duration_s * slowest_hz, FEWEST_WINDOWS * WINDOW_TURNS
    if turns < wanted:
        yield (
            f"duration_s: the slowest record has {turns:.3g} turns of the first shaft, fewer than {FEWEST_WINDOWS} "
            f"windows of {WINDOW_TURNS}, which models read; take {wanted / slowest_hz:.2g} s or more"
        )


# What varies within the records of a set, in sentences for its plan, and what the model leaves out of that.


def variation_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield what varies and which forces the shafts bring; nothing for constant speed and torque alone."""
    config = gearbox.config
    speed, torque, unbalance = config.variation.speed, config.variation.torque, config.dynamics.unbalance.grade_mm_s
    if (speed.start_ratio, speed.end_ratio) != (1.0, 1.0):
        yield f"speed runs from {_span(speed.start_ratio)} to {_span(speed.end_ratio)} times nominal over a record"
    slow, once = f"rms up to {SLOW_CORNER_HZ:g} Hz", "per revolution"
    for number, sentence in (
        (speed.random_rms, f"slow random speed of {_percent(speed.random_rms)} {slow}"),
        (speed.ripple_once, f"speed ripple of {_percent(speed.ripple_once)} once {once}"),
        (speed.ripple_twice, f"speed ripple of {_percent(speed.ripple_twice)} twice {once}"),
        (speed.slip, f"motor slip of {_percent(speed.slip)} at {gearbox.rated_nm:g} N m"),
        (torque.random_rms, f"slow random torque of {_percent(torque.random_rms)} {slow}"),
        (torque.load_once, f"load torque pulsates by {_percent(torque.load_once)} once {once} of its shaft"),
        (torque.line_ripple, f"motor torque pulsates by {_percent(torque.line_ripple)} at 100 Hz, twice the line"),
        (unbalance, f"unbalance of grade G{_span(unbalance)} at {RATED_SPEED_HZ:g} Hz"),
    ):
        if bounds(number)[1] > 0.0:
            yield sentence
    if config.variation.active and config.dynamics.rubbing == "mixed_ehl":
        yield "the oil film is that of the operating point; it does not follow the variation of speed and torque"


def reversal_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield whose torque may change its sign within a record, at the largest draws and rare random values."""
    then = {"load": "the load then drives", "motor": "the motor then brakes"}
    for body, least in gearbox.config.variation.least_torques.items():
        if least < 0.0:
            fall = f"{body} torque falls to {100.0 * least:.3g} % of its mean"
            yield f"{fall}: {then[body]}, and teeth may lose contact or touch on the other flank"


def _percent(number: Number) -> str:
    return f"{_span(number, 100.0)} %"


def _span(number: Number, times: float = 1.0) -> str:
    return "-".join(dict.fromkeys(f"{times * value:g}" for value in bounds(number)))


# The flank tolerance classes with which the whole face of a rig's gears carries at full load.
#
# ISO 6336-1, method C: a pair whose flanks are F_βy apart at one end touches over the whole face, and its load there
# is at most twice the mean (K_Hβ <= 2), where F_βy c_γβ <= 2 F/b. F_βy is here what helix slopes of both gears and the
# parallelism of the shafts make at their largest; c_γβ = 0.85 c' (0.75 ε + 0.25).

FINEST, COARSEST = 3, 7
"""Classes that are proposed: from gears ground with the greatest care to the preset's coarsest (assumed)."""
CHOICES = 3
LARGEST_SHARE = 0.5
"""Of its tolerance that a gear uses in the preset."""
PARALLEL_UM_PER_MM = 0.1
"""Largest misalignment of the preset's shafts per face width."""


def covering_classes(rig: Rig) -> tuple[int, ...]:
    """Return up to three neighbouring classes, of which the coarsest is the last that covers the face, or the finest.

    Those of the preset where there are no such gears, or none within ISO 1328-1: whoever loads the file says why.
    """
    try:
        pair = GearPair.of(rig.teeth, rig.module_mm, rig.face_width_mm, pressure_angle_deg=rig.pressure_angle_deg)
        allowed_um = _allowed_um(rig, pair) - PARALLEL_UM_PER_MM * rig.face_width_mm
        fitting = [grade for grade in range(FINEST, COARSEST + 1) if _slopes_um(pair, grade) <= allowed_um]
    except (UsageError, ValueError):
        return rig.accuracy_classes
    coarsest = max(fitting, default=FINEST)
    return tuple(range(max(FINEST, coarsest - CHOICES + 1), coarsest + 1))


def _allowed_um(rig: Rig, pair: GearPair) -> float:
    """Return 2 F/(b c_γβ) at the largest torque [µm]."""
    line_load_n_mm = rig.torque_nm[1] / pair.pinion.base_radius_m / rig.face_width_mm
    stiffness = 0.85 * single_stiffness_n_um_mm(rig.teeth) * (0.75 * pair.contact_ratio + 0.25)
    return 2.0 * line_load_n_mm / stiffness


def _slopes_um(pair: GearPair, grade: int) -> float:
    """Return the largest helix slopes of both gears together [µm]."""
    return sum(
        1e6 * LARGEST_SHARE * flank_tolerances(gear, pair.face_width_m, grade, pair.helix_rad).helix_slope_m
        for gear in (pair.pinion, pair.gear)
    )
