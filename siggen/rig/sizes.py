"""Sizes that a file leaves out where it says the rated torque: masses, bearings, couplings and shafts.

By the rules of `siggen init` (`rig_numbers`). Couplings and machines at the ends are those of a typical gearbox, with
three digits, as a file has them. Rotors, shafts and bearings are left out, null, until a gearbox is drawn: its maker's
choices (`Sizing`) are drawn first, and all of them follow from these.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import atan, cos, degrees, radians, tan
from typing import Annotated, Any

from pydantic import TypeAdapter, ValidationError

from siggen.config import Dynamics, GearsSection, RotorSection, ShaftSection
from siggen.config.config import OperatingRange
from siggen.config.dynamics import RATED, RATED_SPEED
from siggen.config.inheritance import SIZED
from siggen.damage.ball_geometry import BallGeometry
from siggen.errors import Problem
from siggen.keys.distributions import Choice, LogUniform, Uniform
from siggen.keys.drawing import Uniforms, corners, draw
from siggen.keys.merging import merged
from siggen.keys.number import MIDDLE, Number, Within, at, bounds, constant
from siggen.keys.problems import received_text
from siggen.keys.section import Section
from siggen.names import SHAFT_OF
from siggen.rig.bearings import BearingSize
from siggen.rig.rig import Pair, Rig, RigDesign
from siggen.rig.rig_numbers import RigNumbers, RotorNumbers, rig_numbers

WHEELS = ("pinion", "gear")
OTHERS = ("machine", "planetary")
OF_MAKERS = (".torque_factor", ".shear_n_per_mm2", ".length_factor", ".series", ".bearing_span_mm", ".diameter_mm")
"""Numbers that rotors and shafts follow from."""
AT = "dynamics.sizing"
"""What their uniforms are named after."""
Drawn = Annotated[Number, Within()]


class Sizing(Section):
    """What makers choose, drawn for every gearbox whose sizes follow from its rated torque (assumed).

    Design torque over the rated one: application factors of ISO 6336-6 for uniform and for shocking loads are 1 to
    1.75. Shear at shaft ends: usual of shafts that bend too. Length of a shaft over the distance of its bearings.
    Series of ball bearings (light, medium, heavy); another, or rollers, where balls do not last 20,000 h or fit. Radial
    play; below 0: preload. Damping over stiffness: 0.25e-5 to 2.5e-5 s of rolling bearings (Kraemer, Dynamics of rotors
    and foundations, 1993; from memory).
    """

    torque_factor: Drawn = Uniform(low=1.0, high=1.75)
    shear_n_per_mm2: Drawn = Uniform(low=12.0, high=25.0)
    length_factor: Drawn = Uniform(low=1.0, high=1.4)
    series: Drawn = Choice(values=(60.0, 62.0, 63.0))
    clearance_um: Drawn = Uniform(low=-5.0, high=15.0)
    damping_time_s: Drawn = LogUniform(low=2.5e-6, high=2.5e-5)


SIZING = Sizing()
"""Of every set."""


def with_sizes(raw: Mapping[str, Any]) -> tuple[dict[str, Any], list[Problem]]:
    """Return a raw configuration with what follows from its rated torque where it gives none itself.

    Null is what every gearbox draws for itself. Without `shafts` none bend. What cannot be read is left to be refused.

    Parameters
    ----------
    raw : mapping
        With everything that it extends.
    """
    dynamics = raw.get("dynamics")
    if not isinstance(dynamics, Mapping):
        return dict(raw), []
    if beside := [key for key in OTHERS if raw.get(key)]:
        problems = list(_unused(dynamics, beside[0]))
        told = {problem.path.removeprefix("dynamics.") for problem in problems}  # one slip is told once
        return {**raw, "dynamics": {key: given for key, given in dynamics.items() if key not in told}}, problems
    rated = dynamics.get(RATED)
    if rated is None:
        return dict(raw), []
    try:
        torque_nm = TypeAdapter(float).validate_python(rated, strict=True)
        gears = GearsSection.model_validate(raw.get("gears"))
        points = TypeAdapter(tuple[OperatingRange, ...]).validate_python(raw.get("operating_points"))
        first, second = (_diameter_mm(dynamics, wheel) for wheel in WHEELS)
    except ValidationError:
        return dict(raw), []
    if not (0.0 < torque_nm < float("inf") and points):
        return dict(raw), []
    bores_mm = None if first is None or second is None else (first, second)
    speed_hz = max(bound for point in points for bound in bounds(point.speed_hz))
    ends = _ends(rig_numbers(_rig(gears, torque_nm, speed_hz, bores_mm=bores_mm)))
    derived = {**SIZED, **ends}
    if dynamics.get("shafts") is None:
        derived.pop("shafts")
    found = merged(derived, dynamics)
    if found[RATED_SPEED] is None:
        found[RATED_SPEED] = speed_hz
    return {**raw, "dynamics": found}, []


def _unused(dynamics: Mapping[str, Any], beside: str) -> Iterator[Problem]:
    """Yield what says how a gearbox is made for a rated load, beside what gives its sizes itself."""
    allowed = "allowed with gears alone; here give masses, bearings and couplings themselves"
    for key in (RATED, RATED_SPEED):
        if (given := dynamics.get(key)) is not None:
            yield Problem(f"dynamics.{key}", f"{received_text(given)}, beside {beside}", allowed)


def _diameter_mm(dynamics: Mapping[str, Any], wheel: str) -> float | None:
    shafts = dynamics.get("shafts")
    given = shafts.get(SHAFT_OF[wheel]) if isinstance(shafts, Mapping) else None
    if not isinstance(given, Mapping) or given.get("diameter_mm") is None:
        return None
    law = ShaftSection.model_validate({"diameter_mm": given["diameter_mm"]}).diameter_mm
    return None if law is None else _middle(law)


def _ends(numbers: RigNumbers) -> dict[str, Any]:
    """Return keys of `dynamics` of what stands at both ends of a typical gearbox."""
    couplings = zip(("input", "output"), numbers.coupling_nm_per_rad, numbers.coupling_nm_s_per_rad, strict=True)
    return {
        "motor_inertia_kg_m2": _rounded(numbers.motor_inertia_kg_m2),
        "load_inertia_kg_m2": _rounded(numbers.load_inertia_kg_m2),
        **{
            f"{which}_coupling": {"stiffness_nm_per_rad": _rounded(k, 4), "damping_nm_s_per_rad": _rounded(c)}
            for which, k, c in couplings
        },
    }


def is_sized(dynamics: Dynamics) -> bool:
    """Tell whether all numbers of rotors and shafts are given, or no rated load is that they could follow from."""
    if None in (dynamics.rated_torque_nm, dynamics.rated_speed_hz):
        return True
    shafts = () if dynamics.shafts is None else (dynamics.shafts.driver, dynamics.shafts.driven)
    found = [number for one in shafts for number in (one.bearing_span_mm, one.diameter_mm)]
    for rotor in (dynamics.pinion, dynamics.gear):
        own = rotor.bearing
        damping = own.damping_time_s if own.damping_n_s_per_m is None else own.damping_n_s_per_m
        found += [rotor.mass_kg, rotor.inertia_kg_m2, own.stiffness_n_per_m, damping]  # type: ignore[list-item]
    return None not in found


def sized(dynamics: Dynamics, gears: GearsSection, uniform: Uniforms) -> Dynamics:
    """Return a section with the rotors and shafts of one gearbox where it gives none; laws that it gives stay.

    Parameters
    ----------
    dynamics : Dynamics
    gears : GearsSection
        Drawn.
    uniform : callable
        Path of a key -> the uniform that belongs to it.
    """
    if is_sized(dynamics):
        return dynamics
    sizing = draw(SIZING, uniform, AT)
    found = designed(dynamics, gears, sizing, uniform)
    given = dict(zip(WHEELS, (dynamics.pinion, dynamics.gear), strict=True))
    update: dict[str, Any] = {
        wheel: _rotor(given[wheel], rotor, constant(sizing.damping_time_s))
        for wheel, rotor in zip(WHEELS, found, strict=True)
    }
    if dynamics.shafts is not None:
        shafts = {SHAFT_OF[wheel]: _shaft(dynamics, wheel, rotor) for wheel, rotor in zip(WHEELS, found, strict=True)}
        update["shafts"] = dynamics.shafts.model_copy(update=shafts)
    return dynamics.model_copy(update=update)


def designed(
    dynamics: Dynamics,
    gears: GearsSection,
    sizing: Sizing,
    uniform: Uniforms,
) -> tuple[RotorNumbers, RotorNumbers]:
    """Return both rotors by a drawn section `sizing`, on shafts of what diameters and spans are given."""
    assert dynamics.rated_torque_nm is not None
    assert dynamics.rated_speed_hz is not None
    design = RigDesign(
        constant(sizing.torque_factor),
        constant(sizing.shear_n_per_mm2),
        constant(sizing.length_factor),
        round(constant(sizing.series)),
    )
    (first, second), spans_mm = (_given_mm(dynamics, key, uniform) for key in ("diameter_mm", "bearing_span_mm"))
    bores_mm = None if first is None or second is None else (first, second)
    return rig_numbers(
        _rig(gears, dynamics.rated_torque_nm, dynamics.rated_speed_hz, design, bores_mm, spans_mm)
    ).rotors


def _given_mm(dynamics: Dynamics, key: str, uniform: Uniforms) -> tuple[float | None, float | None]:
    """Return a length of both shafts as it is given; None where it is not."""
    if dynamics.shafts is None:
        return None, None
    laws = [(getattr(dynamics.shafts.of(wheel), key), f"dynamics.shafts.{SHAFT_OF[wheel]}.{key}") for wheel in WHEELS]
    first, second = (None if law is None else at(law, uniform(path)) for law, path in laws)
    return first, second


def _rotor(given: RotorSection, rotor: RotorNumbers, time_s: float) -> RotorSection:
    """Return the section of a gear on its shaft, filled where it is null."""
    own, bearing = given.bearing, rotor.shaft.bearing
    update: dict[str, Any] = {}
    if own.stiffness_n_per_m is None:
        update["stiffness_n_per_m"] = rotor.bearing_n_per_m
        if own.geometry is None and not bearing.rollers:
            update["geometry"] = BallGeometry(
                balls=bearing.balls,
                ball_diameter_mm=bearing.ball_mm,
                pitch_diameter_mm=bearing.pitch_mm,
                clearance_um=SIZING.clearance_um,
            )
    if own.damping_n_s_per_m is None and own.damping_time_s is None:
        update["damping_time_s"] = time_s
    return given.model_copy(
        update={
            "mass_kg": rotor.mass_kg if given.mass_kg is None else given.mass_kg,
            "inertia_kg_m2": rotor.inertia_kg_m2 if given.inertia_kg_m2 is None else given.inertia_kg_m2,
            "bearing": own.model_copy(update=update),
        }
    )


def _shaft(dynamics: Dynamics, wheel: str, rotor: RotorNumbers) -> ShaftSection:
    assert dynamics.shafts is not None
    own, shaft = dynamics.shafts.of(wheel), rotor.shaft
    return own.model_copy(
        update={
            "bearing_span_mm": shaft.span_mm if own.bearing_span_mm is None else own.bearing_span_mm,
            "diameter_mm": shaft.diameter_mm if own.diameter_mm is None else own.diameter_mm,
        }
    )


def bearings_of(
    dynamics: Dynamics, gears: GearsSection, uniform: Uniforms
) -> tuple[BearingSize | None, BearingSize | None]:
    """Return the bearings that a gearbox draws from the catalogue; None of a shaft whose bearings are given."""
    if is_sized(dynamics):
        return None, None
    found = designed(dynamics, gears, draw(SIZING, uniform, AT), uniform)
    first, second = (
        rotor.shaft.bearing if own.bearing.stiffness_n_per_m is None and own.bearing.geometry is None else None
        for own, rotor in zip((dynamics.pinion, dynamics.gear), found, strict=True)
    )
    return first, second


def possible_sizes(dynamics: Dynamics, gears: GearsSection) -> Dynamics:
    """Return a section with ranges that hold what any gearbox may draw, for typical gears; typical balls.

    Parameters
    ----------
    dynamics : Dynamics
    gears : GearsSection
        As a file gives it.
    """
    if is_sized(dynamics):
        return dynamics
    own = draw(gears, lambda _: MIDDLE, "gears")
    typical = sized(dynamics, own, lambda _: MIDDLE)
    ends = [*corners(lambda uniform: sized(dynamics, own, uniform), *OF_MAKERS)]
    update: dict[str, Any] = {}
    for wheel in WHEELS:
        rotor, several = getattr(typical, wheel), [getattr(one, wheel) for one in ends]
        keys = {key: _between(getattr(one, key) for one in several) for key in ("mass_kg", "inertia_kg_m2")}
        bearing = {"stiffness_n_per_m": _between(one.bearing.stiffness_n_per_m for one in several)}
        if getattr(dynamics, wheel).bearing.damping_n_s_per_m is None:
            bearing["damping_time_s"] = getattr(dynamics, wheel).bearing.damping_time_s or SIZING.damping_time_s
        update[wheel] = rotor.model_copy(update={**keys, "bearing": rotor.bearing.model_copy(update=bearing)})
    if typical.shafts is not None:
        shafts = {}
        for name in SHAFT_OF.values():
            section, several = getattr(typical.shafts, name), [getattr(one.shafts, name) for one in ends]
            keys = {key: _between(getattr(one, key) for one in several) for key in ("bearing_span_mm", "diameter_mm")}
            shafts[name] = section.model_copy(update=keys)
        update["shafts"] = typical.shafts.model_copy(update=shafts)
    return typical.model_copy(update=update)


def _between(numbers: Iterator[Any]) -> Any:
    """Return what holds all of these numbers: the number where it is one, or the law that all have."""
    first, *rest = numbers
    if all(one == first for one in rest):
        return first
    ends = [end for one in (first, *rest) for end in bounds(one)]
    return Uniform(low=min(ends), high=max(ends))


def _rig(
    gears: GearsSection,
    torque_nm: float,
    speed_hz: float,
    design: RigDesign = RigDesign(),  # noqa: B008 (frozen)
    bores_mm: Pair | None = None,
    spans_mm: tuple[float | None, float | None] = (None, None),
) -> Rig:
    """Return the pair as a rig of spur gears with the same pitch circles: helical ones by their transverse section."""
    across = cos(radians(_middle(gears.helix_deg)))
    return Rig(
        teeth=(gears.pinion.teeth, gears.gear.teeth),
        module_mm=_middle(gears.module_mm) / across,
        face_width_mm=_middle(gears.face_width_mm),
        speed_hz=(speed_hz, speed_hz),
        torque_nm=(torque_nm, torque_nm),
        pressure_angle_deg=degrees(atan(tan(radians(_middle(gears.pressure_angle_deg))) / across)),
        bores_mm=bores_mm,
        shifts=(_middle(gears.pinion.profile_shift), _middle(gears.gear.profile_shift)),
        spans_mm=spans_mm,
        design=design,
    )


def _middle(value: Number) -> float:
    return at(value, MIDDLE)


def _rounded(value: float, digits: int = 3) -> float:
    return float(f"{value:.{digits}g}")
