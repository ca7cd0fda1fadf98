"""Implausible numbers of a configuration: allowed, but far from gearboxes that are built, often by a slip of units.

Ranges are wide: what lies outside them is a thousand times off rather than twice, or says something that a user should
know before a set is made. They are judgement, beside the limits of the standards that are named.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import accumulate
from math import pi, sqrt
from operator import mul

from siggen.config import Config, Coupling, Housing, ModalHousing, Pair, Planetary, RigidHousing, Rotor
from siggen.config.changes import SECTIONS, changed_sections
from siggen.dynamics.structure.steel_disc import STEEL_DENSITY_KG_M3, disc_inertia_kg_m2, disc_mass_kg
from siggen.errors import counted
from siggen.gearbox.configured import pair_configs
from siggen.gearbox.mode_table import mode_table
from siggen.gearbox.pair import gear_pair
from siggen.gearbox.planetary import RIM_MODULES
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.keys.drawing import corners
from siggen.keys.number import Number, bounds
from siggen.keys.usual import unusual
from siggen.planning.plan import SPLITS, split_of
from siggen.sensors.sensor import SensorBase

FORM_FACTOR = 2.5
"""Of the nominal stress at the tooth root, F_t/(b m) Y; 2.1 to 3 for spur gears of 17 teeth and more (ISO 6336-3)."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """A number with its usual range.

    Parameters
    ----------
    path : str
        Key to blame.
    what : str
        Name of what is compared, with its unit.
    found : (low, high)
        Over all gearboxes of the set.
    least, most : float
        The usual range.
    hint : str
        What a value outside may come from.
    """

    path: str
    what: str
    found: tuple[float, float]
    least: float
    most: float
    hint: str = ""

    @property
    def implausible(self) -> bool:
        """Whether any gearbox may lie outside the usual range."""
        return not (self.least <= self.found[0] and self.found[1] <= self.most)

    def __str__(self) -> str:
        """One sentence: where, what, how much, what is usual."""
        shown = " to ".join(dict.fromkeys(f"{value:.3g}" for value in self.found))
        hint = f" ({self.hint})" if self.hint else ""
        return f"{self.path}: {self.what} {shown}; usual: {self.least:.3g} to {self.most:.3g}{hint}"


def implausible(config: Config) -> tuple[str, ...]:
    """Return a sentence on every implausible number of a configuration, in the order of its sections."""
    if config.gears.pairs:
        return (*_of_pairs(config), *missing(config))
    outside = (quantity for quantity in quantities(config) if quantity.implausible)
    found = (str(replace(quantity, path=config.names.own_path(quantity.path))) for quantity in outside)
    return (*found, *_outside_usual(config), *missing(config))


def _outside_usual(config: Config) -> Iterator[str]:
    """Yield numbers outside the usual range that their keys declare, and what states change to such a number."""
    found = _unusual(config)
    yield from (f"{config.names.own_path(path)}: {text}" for path, text in found.items())
    for state_id, state in enumerate(config.states):
        if state.changes:
            sections = {name: getattr(config, name) for name in SECTIONS}
            changed = changed_sections(sections, [change for _, change in config.changes_of(state_id)])
            for path, text in _unusual(config.model_copy(update=changed)).items():
                if found.get(path) != text:
                    yield f"states.{state.name}.changes.{config.names.own_path(path)}: {text}"


def _unusual(config: Config) -> dict[str, str]:
    """Return the path of every number outside its usual range, and what is said of it."""
    found = {}
    for path, ends, usual in unusual(config):
        if not path.startswith("machine."):  # whose numbers stand in the other sections
            shown = " to ".join(dict.fromkeys(f"{end:.3g}" for end in ends))
            found[path] = f"{shown}; usual: {usual.least:.3g} to {usual.most:.3g}"
    return found


def _of_pairs(config: Config) -> Iterator[str]:
    """Yield each implausible quantity once, of the first pair that has it, and how many pairs have."""
    found: dict[tuple[str, str], list[tuple[int, Quantity]]] = {}
    for index, own in enumerate(pair_configs(config)):
        for quantity in quantities(own):
            if quantity.implausible:
                found.setdefault((quantity.path, quantity.what), []).append((index, quantity))
    count = len(config.gears.pairs)
    for of_pairs in found.values():
        index, quantity = of_pairs[0]
        yield f"{quantity}; gears.pairs.{index}, {config.gears.pairs[index]} ({len(of_pairs)} of {count} pairs)"


def quantities(config: Config) -> Iterator[Quantity]:
    """Yield what is compared."""
    pair = gear_pair(next(corners(config.gears)))
    yield from _gears("gears", config.gears, pair)
    for index, stage in enumerate(config.stages):
        own = gear_pair(next(corners(stage.gears)))
        yield from _gears(f"stages.{index}.gears", stage.gears, own)
        yield from _rotor(f"stages.{index}.gear", stage.gear, own.gear, own)
    yield from _load(config, pair)
    for name, rotor, gear in (
        ("pinion", config.dynamics.pinion, pair.pinion),
        ("gear", config.dynamics.gear, pair.gear),
    ):
        yield from _rotor(f"dynamics.{name}", rotor, gear, pair)
    yield from _bearings(config, pair)
    if config.background is not None and config.background.base is not None:
        mass, what = config.background.base.mass_kg, "mass over both discs"
        yield _of("background.base.mass_kg", what, mass, 1.0, 2500.0, "is it in kg?", _discs_kg(pair))
    yield from _supports(config, pair)
    if config.planetary is not None and config.planetary.ring_mass_kg is not None:
        mass, what = config.planetary.ring_mass_kg, "mass over that of a steel rim"
        yield _of("planetary.ring_mass_kg", what, mass, 0.2, 20.0, "is it in kg?", _rim_kg(config.planetary, pair))
    yield from _torques(config, pair)
    yield from _teeth(config, pair)
    yield from _record(config)


def missing(config: Config) -> Iterator[str]:
    """Yield what a set lacks that every measurement has."""
    if config.manufacture is None:
        yield "manufacture: perfect gears: healthy records have no sidebands, so any damage is trivially found"
    noises = [s.noise_floor is not None or any(one.broad for one in s.sources) for s in config.sensors]
    if not any(noises) and config.background is None:
        yield "sensors: no noise at all: any damage is trivially found"
    seen: list[SensorBase] = []
    for sensor, noisy in zip(config.sensors, noises, strict=True):
        nameless = sensor.model_copy(update={"name": "any"})
        if not (noisy or sensor.drawn_by_name) and nameless in seen:
            yield f"sensors: {sensor.name} repeats another sensor: their channels will be identical, bit by bit"
        seen.append(nameless)
    yield from _empty_splits(config)


def _empty_splits(config: Config) -> Iterator[str]:
    """Yield which splits have no gear pair, where splits go by pairs."""
    if config.splits.by != "pair":
        return
    pairs = min(len(config.gears.pairs), config.specimens)
    there = {split_of(config, specimen) for specimen in range(pairs)}
    empty = [name for name in SPLITS if getattr(config.splits, name) and name not in there]
    if empty:
        yield (
            f"splits.by: pair: {counted(pairs, 'gear pair')} in all, so {' and '.join(empty)} would have no records; "
            "take more gears.pairs, or splits.by: gearbox"
        )


def _gears(at: str, gears: Pair, pair: GearPair) -> Iterator[Quantity]:
    module = 1e3 * pair.pinion.module_m
    yield _of(f"{at}.module_mm", "module [mm]", gears.module_mm, 0.3, 30.0, "is it in mm?")
    yield _of(
        f"{at}.youngs_modulus_gpa", "Young's modulus [GPa]", gears.youngs_modulus_gpa, 1.0, 230.0, "is it in GPa?"
    )
    yield _of(f"{at}.face_width_mm", "face width over module", gears.face_width_mm, 1.5, 40.0, "is it in mm?", module)
    for name, wheel, gear in (("pinion", gears.pinion, pair.pinion), ("gear", gears.gear, pair.gear)):
        root_mm = 1e3 * gear.root_radius_m
        hint = "a radius, in mm"
        yield _of(
            f"{at}.{name}.bore_radius_mm", "bore over root circle", wheel.bore_radius_mm, 0.08, 0.95, hint, root_mm
        )


def _load(config: Config, pair: GearPair) -> Iterator[Quantity]:
    radius = pair.pinion.base_radius_m
    for i, point in enumerate(config.operating_points):
        low, high = (torque / radius for torque in bounds(point.torque_nm))
        force = [abs(low), abs(high)]
        at = f"operating_points.{i}"
        speeds = [abs(speed) * 2.0 * pi * pair.pinion.pitch_radius_m for speed in bounds(point.speed_hz)]
        hint = "speeds are turns of the input shaft per second, not per minute"
        yield Quantity(f"{at}.speed_hz", "pitch-line velocity [m/s]", _ends(speeds), 0.02, 100.0, hint)
        if low <= 0.0 <= high:  # idle is no mistake: what the largest torque does is judged, if there is one
            force = [max(force)]
        if max(force) == 0.0:
            continue
        pressure = [1e-6 * _hertz_pa(pair, value) for value in force]
        hint = "torques are N m on the input shaft; 1500 MPa is what case-hardened flanks bear"
        yield Quantity(
            f"{at}.torque_nm", "contact stress at the pitch point [MPa]", _ends(pressure), 50.0, 2000.0, hint
        )
        root = [1e-6 * FORM_FACTOR * value / (pair.face_width_m * pair.pinion.module_m) for value in force]
        yield Quantity(f"{at}.torque_nm", "stress at the tooth root [MPa]", _ends(root), 0.5, 600.0, "")


def _hertz_pa(pair: GearPair, force_n: float) -> float:
    """Return the largest Hertz pressure of one pair at the pitch point, p = sqrt(F E*/(pi b R)) [Pa]."""
    position, line = pair.pitch_point_m, pair.line_of_action_m
    radius = position * (line - position) / line
    modulus = pair.youngs_modulus_pa / (2.0 * (1.0 - pair.poisson_ratio**2))
    return sqrt(force_n * modulus / (pi * pair.face_width_m * radius))


def _rotor(at: str, rotor: Rotor, gear: SpurGear, pair: GearPair) -> Iterator[Quantity]:
    hint = "null takes the disc; a value left from other teeth?"
    disc = disc_mass_kg(gear, pair.face_width_m)
    if rotor.mass_kg is not None:
        yield _of(f"{at}.mass_kg", "mass over that of a steel disc", rotor.mass_kg, 0.3, 12.0, hint, disc)
    disc = disc_inertia_kg_m2(gear, pair.face_width_m)
    if rotor.inertia_kg_m2 is not None:
        yield _of(f"{at}.inertia_kg_m2", "inertia over that of a steel disc", rotor.inertia_kg_m2, 0.3, 5.0, hint, disc)
    for axis in "xy":
        key, stiffness = (
            f"bearing_damping_{axis}_n_s_per_m",
            bounds(getattr(rotor, f"bearing_stiffness_{axis}_n_per_m")),
        )
        (low, high), hint = bounds(getattr(rotor, key)), "is it in N s/m?"
        if high > 0.0:
            found = max(low, 1e-3 * high) / stiffness[0], high / stiffness[1]
            yield Quantity(f"{at}.{key}", "damping over stiffness [s]", _ends(list(found)), 5e-7, 2e-4, hint)


def _rim_kg(section: Planetary, pair: GearPair) -> float:
    """Return the mass of a ring of steel, four modules thick behind its teeth."""
    module = pair.pinion.module_m
    inner = 0.5 * module * section.ring_teeth
    return STEEL_DENSITY_KG_M3 * pi * ((inner + RIM_MODULES * module) ** 2 - inner**2) * pair.face_width_m


def _discs_kg(pair: GearPair) -> float:
    return sum(disc_mass_kg(gear, pair.face_width_m) for gear in (pair.pinion, pair.gear))


def _bearings(config: Config, pair: GearPair) -> Iterator[Quantity]:
    """Yield how far bearings give way under the teeth at the largest torque; a planetary set has none of them."""
    torque = max(max(map(abs, bounds(point.torque_nm))) for point in config.operating_points)
    rotors = {"dynamics.pinion": config.dynamics.pinion, "dynamics.gear": config.dynamics.gear}
    forces = dict.fromkeys(rotors, torque / pair.pinion.base_radius_m)
    ratio = pair.gear.teeth / pair.pinion.teeth
    stages: dict[str, Rotor] = dict(rotors)
    for index, stage in enumerate(config.stages):
        own = gear_pair(next(corners(stage.gears)))
        stages[f"stages.{index}.gear"] = stage.gear
        forces[f"stages.{index}.gear"] = torque * ratio / own.pinion.base_radius_m
        ratio *= own.gear.teeth / own.pinion.teeth
    for at, rotor in stages.items() if torque > 0.0 and config.planetary is None else ():
        for axis in "xy":
            key = f"bearing_stiffness_{axis}_n_per_m"
            given = [1e6 * forces[at] / stiffness for stiffness in bounds(getattr(rotor, key))]
            hint = "is it in N/m, not N/mm?"
            yield Quantity(f"{at}.{key}", "gives way at full load by [µm]", _ends(given), 0.3, 1000.0, hint)


def _torques(config: Config, pair: GearPair) -> Iterator[Quantity]:
    """Yield torques and ranges that belong to the largest torque of the operating points."""
    largest = max(max(map(abs, bounds(point.torque_nm))) for point in config.operating_points)
    rated: dict[str, Number] = {}
    for sensor in config.sensors:
        if (torque := getattr(sensor, "rated_torque_nm", None)) is not None:
            rated[f"sensors.{sensor.name}.rated_torque_nm"] = torque
    if config.life is not None:
        rated["life.reference_torque_nm"] = config.life.reference_torque_nm
    if largest == 0.0:
        return
    force, ratio = largest / pair.pinion.base_radius_m, pair.gear.teeth / pair.pinion.teeth
    for sensor in config.sensors:
        for key, least, most in (("range_nm", largest, largest * ratio), ("range_n", force, force)):
            if (limit := getattr(sensor, key, None)) is not None:
                found, what = (limit / most, limit / least), "range over what the largest torque makes"
                yield Quantity(f"sensors.{sensor.name}.{key}", what, found, 0.2, 300.0, "is its unit that of the key?")
    for path, torque in rated.items():
        yield _of(path, "torque over the largest of the operating points", torque, 0.1, 20.0, "is it in N m?", largest)


def _supports(config: Config, pair: GearPair) -> Iterator[Quantity]:
    dynamics, radius = config.dynamics, pair.pinion.base_radius_m
    highest = max(max(map(abs, bounds(point.torque_nm))) for point in config.operating_points)
    ratio = pair.gear.teeth / pair.pinion.teeth
    for name, coupling, torque in (
        ("input_coupling", dynamics.input_coupling, highest),
        ("output_coupling", dynamics.output_coupling, highest * ratio),
    ):
        twist = [torque / value for value in reversed(bounds(coupling.stiffness_nm_per_rad))]
        hint = "is the stiffness in N m/rad?"
        yield Quantity(
            f"dynamics.{name}.stiffness_nm_per_rad", "twist at full load [rad]", _ends(twist), 3e-4, 1.0, hint
        )
    first, last = _inertia(dynamics.pinion, pair.pinion, pair), _inertia(dynamics.gear, pair.gear, pair)
    yield from _coupling("input_coupling", dynamics.input_coupling, dynamics.motor_inertia_kg_m2, first)
    yield from _coupling("output_coupling", dynamics.output_coupling, dynamics.load_inertia_kg_m2, last)
    disc = disc_inertia_kg_m2(pair.pinion, pair.face_width_m)
    for name, most in (("motor_inertia_kg_m2", 1.5e3), ("load_inertia_kg_m2", 1e5)):  # a mill turns behind its gears
        what, hint = "inertia over the disc of the first gear", "is it in kg m²?"
        yield _of(f"dynamics.{name}", what, getattr(dynamics, name), 0.3, most, hint, disc)
    if dynamics.model == "casing":
        yield from _housing(config.housing, pair)
    approach = 1e6 * highest / radius / (pair.face_width_m * 14e9)
    if dynamics.mesh.law == "pairs" and bounds(dynamics.mesh.tip_relief_um)[1] > 0.0:  # without relief is a choice
        hint = f"teeth deflect by about {approach:.2g} µm at full load; is it in µm?"
        yield _of(
            "dynamics.mesh.tip_relief_um", "relief [µm]", dynamics.mesh.tip_relief_um, 0.1, 3 * approach + 20, hint
        )


def _inertia(rotor: Rotor, gear: SpurGear, pair: GearPair) -> float:
    if rotor.inertia_kg_m2 is None:
        return disc_inertia_kg_m2(gear, pair.face_width_m)
    return bounds(rotor.inertia_kg_m2)[0]


def _coupling(name: str, coupling: Coupling, machine: Number, inertia_kg_m2: float) -> Iterator[Quantity]:
    """Yield the damping of a coupling over the critical one, between its gear and its machine."""
    reduced = 1.0 / (1.0 / inertia_kg_m2 + 1.0 / bounds(machine)[0])
    critical, number = 2.0 * sqrt(bounds(coupling.stiffness_nm_per_rad)[0] * reduced), coupling.damping_nm_s_per_rad
    if bounds(number)[1] > 0.0:
        path, hint = f"dynamics.{name}.damping_nm_s_per_rad", "is the damping in N m s/rad?"
        yield _of(path, "damping over the critical one", number, 2e-3, 2.0, hint, critical)


def _housing(housing: Housing, pair: GearPair) -> Iterator[Quantity]:
    gears = _discs_kg(pair)
    if isinstance(housing, ModalHousing):
        what, hint = "mass that a seat feels over both discs", "are shapes in 1/sqrt(kg), not of unit length?"
        masses = [mass / gears for mass in mode_table(housing.modes).seat_masses_kg]
        yield Quantity("housing.modes", what, _ends(masses), 0.5, 500.0, hint)
        return
    if isinstance(housing, RigidHousing):
        yield _of("housing.mass_kg", "mass over both discs", housing.mass_kg, 0.5, 500.0, "is it in kg?", gears)
        for key in ("shear_stiffness_n_per_m", "axial_stiffness_n_per_m"):
            stiffness, heaviest_first = bounds(getattr(housing.bolts, key)), bounds(housing.mass_kg)[::-1]
            count, what = len(housing.bolts.positions_mm), "housing on its bolts [Hz]"
            natural = [sqrt(count * k / mass) / (2.0 * pi) for k, mass in zip(stiffness, heaviest_first, strict=True)]
            yield Quantity(f"housing.bolts.{key}", what, _ends(natural), 40.0, 2500.0, "is it in N/m, not N/mm?")
    elif housing.wall_mm is not None:
        what, centre_mm = "thickness over the centre distance", 1e3 * pair.working_centre_distance_m
        yield _of("housing.wall_mm", what, housing.wall_mm, 0.01, 0.4, "is it in mm?", centre_mm)


def _teeth(config: Config, pair: GearPair) -> Iterator[Quantity]:
    module = 1e3 * pair.pinion.module_m
    low, _ = bounds(config.dynamics.backlash_um)
    if low > 0.0:  # no play at all is a model of its own
        what = "backlash over module [µm/mm]"
        yield _of("dynamics.backlash_um", what, config.dynamics.backlash_um, 3.0, 200.0, "is it in µm?", module)
    if config.dynamics.rubbing == "mixed_ehl":
        roughness = config.dynamics.friction.roughness_um
        yield _of("dynamics.friction.roughness_um", "roughness [µm]", roughness, 0.02, 4.0, "is it in µm?")


def _record(config: Config) -> Iterator[Quantity]:
    slowest = min(min(map(abs, bounds(point.speed_hz))) for point in config.operating_points)
    shaft, order = _slowest_shaft(config)
    turns = config.duration_s * slowest * order
    yield Quantity("duration_s", f"turns of {shaft} in a record", (turns, turns), 3.0, 1e5, "averages need several")
    for sensor in config.sensors:
        what = f"range [{sensor.quantity.shown_unit}]"
        yield _of(f"sensors.{sensor.name}.{sensor.limit_key}", what, sensor.limit, *sensor.plausible)


def _slowest_shaft(config: Config) -> tuple[str, float]:
    """Return what turns slowest, and its turns per turn of the first shaft."""
    if config.planetary is not None:
        return "the carrier", 1.0 / (1.0 + config.planetary.ring_teeth / config.gears.pinion.teeth)
    pairs = [config.gears, *(stage.gears for stage in config.stages)]
    orders = accumulate((pair.pinion.teeth / pair.gear.teeth for pair in pairs), mul, initial=1.0)
    order, shaft = min(zip(orders, (shaft.called for shaft in config.names.shafts), strict=True))
    return shaft, order


def _of(path: str, what: str, number: Number, least: float, most: float, hint: str = "", over: float = 1.0) -> Quantity:
    low, high = bounds(number)
    return Quantity(path, what, (low / over, high / over), least, most, hint)


def _ends(values: list[float]) -> tuple[float, float]:
    return min(values), max(values)
