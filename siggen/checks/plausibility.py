"""Implausible numbers of a configuration: allowed, but far from gearboxes that are built, often by a slip of units.

Ranges are wide: what lies outside them is a thousand times off rather than twice, or says something that a user should
know before a set is made. They are judgement, beside the limits of the standards that are named.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate
from math import pi, sqrt
from operator import mul

from siggen.drivetrain.gear_stage import STEEL_DENSITY_KG_M3, disc_inertia_kg_m2, disc_mass_kg
from siggen.errors import counted
from siggen.gearbox.design import SetDesign
from siggen.gearbox.mode_table import mode_table
from siggen.gearbox.plan import SPLITS, split_of
from siggen.gearbox.possible import PossibleGearbox
from siggen.gearbox.train import RIM_MODULES
from siggen.gears.gear_pair import GearPair
from siggen.gears.spur_gear import SpurGear
from siggen.keys.number import LOW, bounds
from siggen.keys.usual import unusual
from siggen.names import Side
from siggen.sensors.sensor import SensorBase

FORM_FACTOR = 2.5
"""Of the nominal stress at the tooth root, F_t/(b m) Y; 2.1 to 3 for spur gears of 17 teeth and more (ISO 6336-3)."""


@dataclass(frozen=True, slots=True)
class UsualQuantity:
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


def implausible(gearbox: PossibleGearbox) -> tuple[str, ...]:
    """Return a sentence on every implausible number of a configuration, in the order of its sections."""
    if gearbox.config.gears.pairs:
        return (*_of_pairs(gearbox), *missing(gearbox))
    own_path = gearbox.config.names.own_path
    outside = (quantity for quantity in quantities(gearbox) if quantity.implausible)
    found = (_said(gearbox, replace(quantity, path=own_path(quantity.path)), quantity.path) for quantity in outside)
    return (*found, *_outside_usual(gearbox), *missing(gearbox))


def _said(gearbox: PossibleGearbox, quantity: UsualQuantity, path: str) -> str:
    """Return its sentence at the key that a user wrote: a size that follows from a rated torque has none of its own."""
    given = gearbox.given(path)
    return str(quantity if given == path else replace(quantity, path=given, what=f"{quantity.path}: {quantity.what}"))


def _outside_usual(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield numbers outside the usual range that their keys declare, and what states change to such a number."""
    own_path, found = gearbox.config.names.own_path, _unusual(gearbox)
    yield from (f"{own_path(path)}: {text}" for path, text in found.items())
    for number, state in enumerate(gearbox.config.states):
        for path, text in _unusual(gearbox.changed(number)).items() if state.changes else ():
            if found.get(path) != text:
                yield f"states.{state.name}.changes.{own_path(path)}: {text}"


def _unusual(gearbox: PossibleGearbox) -> dict[str, str]:
    """Return the path of every number outside its usual range, and what is said of it."""
    found = {}
    for path, ends, usual in unusual(gearbox.config):
        if not path.startswith("machine."):  # whose numbers stand in the other sections
            shown = " to ".join(dict.fromkeys(f"{end:.3g}" for end in ends))
            found[path] = f"{shown}; usual: {usual.least:.3g} to {usual.most:.3g}"
    return found


def _of_pairs(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield each implausible quantity once, of the first pair that has it, and how many pairs have."""
    found: dict[tuple[str, str], list[tuple[int, UsualQuantity]]] = {}
    for index, own in enumerate(gearbox.pairs):
        for quantity in quantities(own):
            if quantity.implausible:
                found.setdefault((quantity.path, quantity.what), []).append((index, quantity))
    pairs = gearbox.config.gears.pairs
    for of_pairs in found.values():
        index, quantity = of_pairs[0]
        said = _said(gearbox.pairs[index], quantity, quantity.path)
        yield f"{said}; gears.pairs.{index}, {pairs[index]} ({len(of_pairs)} of {len(pairs)} pairs)"


def quantities(gearbox: PossibleGearbox) -> Iterator[UsualQuantity]:
    """Yield what is compared."""
    compared = _SizesCompared(gearbox)
    for group in (
        compared.gears,
        compared.load,
        compared.rotors,
        compared.ends,
        compared.rated,
        compared.housing,
        compared.others,
    ):
        yield from group()


@dataclass(frozen=True)
class _SizesCompared:
    """Numbers of a gearbox over sizes of its gears at their lower bounds; nothing of keys that are null."""

    gearbox: PossibleGearbox

    @cached_property
    def meshes(self) -> Sequence[tuple[str, GearPair]]:
        """What stands before the keys of meshes of a train, and their gears."""
        return [(mesh.at, mesh.pairs[0]) for mesh in self.gearbox.meshes if not mesh.internal]

    @cached_property
    def pair(self) -> GearPair:
        """The first gears."""
        return self.meshes[0][1]

    @cached_property
    def discs_kg(self) -> float:
        """Mass of both as discs."""
        return sum(disc_mass_kg(gear, self.pair.face_width_m) for gear in (self.pair.pinion, self.pair.gear))

    def of(
        self, path: str, what: str, usual: tuple[float, float], hint: str, over: float = 1.0
    ) -> Iterator[UsualQuantity]:
        """Yield the number of a key over something."""
        if (number := self.gearbox.number(path)) is not None:
            low, high = bounds(number)
            yield UsualQuantity(path, what, (low / over, high / over), *usual, hint)

    def under(self, path: str, what: str, usual: tuple[float, float], hint: str, force: float) -> UsualQuantity:
        """Return what a force or torque makes of a stiffness."""
        low, high = bounds(self.gearbox.number(path))
        return UsualQuantity(path, what, (force / high, force / low), *usual, hint)

    def gears(self) -> Iterator[UsualQuantity]:
        """Yield sizes of gears."""
        for at, pair in self.meshes:
            module = 1e3 * pair.pinion.module_m
            yield from self.of(f"{at}gears.module_mm", "module [mm]", (0.3, 30.0), "is it in mm?")
            what, path = "face width over module", f"{at}gears.face_width_mm"
            yield from self.of(path, what, (1.5, 40.0), "is it in mm?", module)
            for side in Side:
                what, path = "bore over root circle", f"{at}gears.{side}.bore_radius_mm"
                yield from self.of(path, what, (0.08, 0.95), "a radius, in mm", 1e3 * pair.member(side).root_radius_m)

    def load(self) -> Iterator[UsualQuantity]:
        """Yield speeds and torques of operating points."""
        pair, radius = self.pair, self.pair.pinion.base_radius_m
        for i, point in enumerate(self.gearbox.config.operating_points):
            at, torque_nm, speed_hz = f"operating_points.{i}", bounds(point.torque_nm), bounds(point.speed_hz)
            low, high = (speed * 2.0 * pi * pair.pinion.pitch_radius_m for speed in speed_hz)
            hint = "speeds are turns of the input shaft per second, not per minute"
            yield UsualQuantity(f"{at}.speed_hz", "pitch-line velocity [m/s]", (low, high), 0.02, 100.0, hint)
            force = sorted(abs(torque / radius) for torque in torque_nm)
            if torque_nm[0] <= 0.0 <= torque_nm[1]:  # idle is no mistake: what the largest torque does is judged
                force = [force[1]] * 2
            if force[1] == 0.0:
                continue
            low, high = (1e-6 * _hertz_pa(pair, value) for value in force)
            what, hint = "contact stress at the pitch point [MPa]", "torques are N m on the input shaft; "
            hint += "1500 MPa is what case-hardened flanks bear"
            yield UsualQuantity(f"{at}.torque_nm", what, (low, high), 50.0, 2000.0, hint)
            low, high = (1e-6 * FORM_FACTOR * value / (pair.face_width_m * pair.pinion.module_m) for value in force)
            yield UsualQuantity(f"{at}.torque_nm", "stress at the tooth root [MPa]", (low, high), 0.5, 600.0)

    def _rotors(self) -> Iterator[tuple[str, SpurGear, GearPair, float]]:
        """Yield path, gear and pair of every rotor, and the force on its teeth per torque of the first shaft [1/m]."""
        ratio = 1.0
        yield "dynamics.pinion", self.pair.pinion, self.pair, 1.0 / self.pair.pinion.base_radius_m
        for at, pair in self.meshes:
            yield f"{at or 'dynamics.'}gear", pair.gear, pair, ratio / pair.pinion.base_radius_m
            ratio *= pair.gear.teeth / pair.pinion.teeth

    def rotors(self) -> Iterator[UsualQuantity]:
        """Yield masses, and bearings, of which a planetary set has none."""
        number, torque = self.gearbox.number, self.gearbox.largest_torque_nm
        dynamics = self.gearbox.config.dynamics
        from_catalogue = [f"dynamics.{side}" for side in Side if not getattr(dynamics, side).bearing.stiffness_n_per_m]
        for at, gear, pair, of_torque in self._rotors():
            hint = "null takes the disc; a value left from other teeth?"
            what, disc = "over that of a steel disc", disc_mass_kg(gear, pair.face_width_m)
            yield from self.of(f"{at}.mass_kg", f"mass {what}", (0.3, 12.0), hint, disc)
            disc = disc_inertia_kg_m2(gear, pair.face_width_m)
            yield from self.of(f"{at}.inertia_kg_m2", f"inertia {what}", (0.3, 5.0), hint, disc)
            stiffness, damping = f"{at}.bearing.stiffness_n_per_m", f"{at}.bearing.damping_n_s_per_m"
            if torque > 0.0 and not number("planetary") and at not in from_catalogue:
                what, gives_um = "gives way at full load by [µm]", 1e6 * torque * of_torque
                yield self.under(stiffness, what, (0.3, 1000.0), "is it in N/m, not N/mm?", gives_um)
            if number(damping) is None:  # damping_time_s is that ratio
                continue
            (low, high), (least, most) = bounds(number(damping)), bounds(number(stiffness))
            if high > 0.0:
                ratios = max(low, 1e-3 * high) / least, high / most
                found, what = (min(ratios), max(ratios)), "damping over stiffness [s]"
                yield UsualQuantity(damping, what, found, 5e-7, 2e-4, "is it in N s/m?")

    def ends(self) -> Iterator[UsualQuantity]:
        """Yield couplings and machines at both ends."""
        number, pair, torque = self.gearbox.number, self.pair, self.gearbox.largest_torque_nm
        disc_kg_m2 = disc_inertia_kg_m2(pair.pinion, pair.face_width_m)
        behind_nm = torque * pair.gear.teeth / pair.pinion.teeth
        both = (
            ("input", "motor", Side.DRIVER, 1.5e3, torque),
            ("output", "load", Side.DRIVEN, 1e5, behind_nm),
        )  # such as a mill
        for end, machine, side, most, torque_nm in both:
            stiffness, inertia = f"dynamics.{end}_coupling.stiffness_nm_per_rad", f"dynamics.{machine}_inertia_kg_m2"
            hint = "is the stiffness in N m/rad?"
            yield self.under(stiffness, "twist at full load [rad]", (3e-4, 1.0), hint, torque_nm)
            own = self.gearbox.rotor(side, pair, lambda _: LOW).inertia_kg_m2, bounds(number(inertia))[0]
            critical = 2.0 * sqrt(bounds(number(stiffness))[0] / sum(1.0 / one for one in own))
            damping, what = f"dynamics.{end}_coupling.damping_nm_s_per_rad", "damping over the critical one"
            if bounds(number(damping))[1] > 0.0:
                yield from self.of(damping, what, (2e-3, 2.0), "is the damping in N m s/rad?", critical)
            what = "inertia over the disc of the first gear"
            yield from self.of(inertia, what, (0.3, most), "is it in kg m²?", disc_kg_m2)

    def housing(self) -> Iterator[UsualQuantity]:
        """Yield what the bearings stand in, and on."""
        config, what = self.gearbox.config, "mass over both discs"
        if config.background is not None and config.background.base is not None:
            yield from self.of("background.base.mass_kg", what, (1.0, 2500.0), "is it in kg?", self.discs_kg)
        if config.dynamics.model != "casing":
            return
        if config.housing.kind == "modal":
            what, hint = "mass that a seat feels over both discs", "are shapes in 1/sqrt(kg), not of unit length?"
            masses = [mass / self.discs_kg for mass in mode_table(config.housing.modes).seat_masses_kg]
            yield UsualQuantity("housing.modes", what, (min(masses), max(masses)), 0.5, 500.0, hint)
        elif config.housing.kind == "rigid":
            yield from self.of("housing.mass_kg", what, (0.5, 500.0), "is it in kg?", self.discs_kg)
            for way in ("shear", "axial"):
                path, count = f"housing.bolts.{way}_stiffness_n_per_m", len(config.housing.bolts.positions_mm)
                ends = zip(bounds(self.gearbox.number(path)), bounds(config.housing.mass_kg)[::-1], strict=True)
                low, high = (sqrt(count * stiffness / mass) / (2.0 * pi) for stiffness, mass in ends)
                hint = "is it in N/m, not N/mm?"
                yield UsualQuantity(path, "housing on its bolts [Hz]", (low, high), 40.0, 2500.0, hint)
        else:
            what, centre_mm = "thickness over the centre distance", 1e3 * self.pair.working_centre_distance_m
            yield from self.of("housing.wall_mm", what, (0.01, 0.4), "is it in mm?", centre_mm)

    def rated(self) -> Iterator[UsualQuantity]:
        """Yield the rated speed over that of the operating points."""
        most_hz = max((bounds(point.speed_hz)[1] for point in self.gearbox.config.operating_points), default=0.0)
        if most_hz > 0.0:
            what = "speed over the highest of the operating points"
            yield from self.of("dynamics.rated_speed_hz", what, (0.1, 20.0), "is it in Hz?", most_hz)

    def others(self) -> Iterator[UsualQuantity]:
        """Yield what belongs to the largest torque, clearances of teeth, and what records hold."""
        config, dynamics, pair = self.gearbox.config, self.gearbox.config.dynamics, self.pair
        torque, module = self.gearbox.largest_torque_nm, 1e3 * pair.pinion.module_m
        force, ratio = torque / pair.pinion.base_radius_m, pair.gear.teeth / pair.pinion.teeth
        if dynamics.mesh.law == "pairs" and bounds(dynamics.mesh.tip_relief_um)[1] > 0.0:  # without relief is a choice
            approach = 1e6 * force / (pair.face_width_m * 14e9)
            hint = f"teeth deflect by about {approach:.2g} µm at full load; is it in µm?"
            yield from self.of("dynamics.mesh.tip_relief_um", "relief [µm]", (0.1, 3 * approach + 20), hint)
        if config.planetary is not None:
            what, rim_kg = "mass over that of a steel rim", _rim_kg(config.planetary.ring_teeth, pair)
            yield from self.of("planetary.ring_mass_kg", what, (0.2, 20.0), "is it in kg?", rim_kg)
        for sensor in config.sensors if torque > 0.0 else ():
            for key, least, most in (("range_nm", torque, torque * ratio), ("range_n", force, force)):
                if (limit := getattr(sensor, key, None)) is not None:
                    found, what = (limit / most, limit / least), "range over what the largest torque makes"
                    path, hint = f"sensors.{sensor.name}.{key}", "is its unit that of the key?"
                    yield UsualQuantity(path, what, found, 0.2, 300.0, hint)
        rated = [f"sensors.{one.name}.rated_torque_nm" for one in config.sensors if hasattr(one, "rated_torque_nm")]
        for path in (*rated, *(["life.reference_torque_nm"] if config.life else [])) if torque > 0.0 else ():
            what = "torque over the largest of the operating points"
            yield from self.of(path, what, (0.1, 20.0), "is it in N m?", torque)
        if bounds(dynamics.backlash_um)[0] > 0.0:  # no play at all is a model of its own
            what = "backlash over module [µm/mm]"
            yield from self.of("dynamics.backlash_um", what, (3.0, 200.0), "is it in µm?", module)
        if dynamics.rubbing == "mixed_ehl":
            yield from self.of("dynamics.friction.roughness_um", "roughness [µm]", (0.02, 4.0), "is it in µm?")
        slowest = min(min(map(abs, bounds(point.speed_hz))) for point in config.operating_points)
        shaft, order = _slowest_shaft(self.gearbox, [own for _, own in self.meshes])
        what, one_turn_s = f"turns of {shaft} in a record", 1.0 / (slowest * order)
        yield from self.of("duration_s", what, (3.0, 1e5), "averages need several", one_turn_s)
        for sensor in config.sensors:
            least, most, hint = sensor.plausible
            path, what = f"sensors.{sensor.name}.{sensor.limit_key}", f"range [{sensor.quantity.shown_unit}]"
            yield UsualQuantity(path, what, (sensor.limit, sensor.limit), least, most, hint)


def missing(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield what a set lacks that every measurement has."""
    config = gearbox.config
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
    yield from _empty_splits(gearbox)


def _empty_splits(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield which splits have no gear pair, where splits go by pairs."""
    config = gearbox.config
    if config.splits.by != "pair":
        return
    pairs = min(len(config.gears.pairs), config.specimens)
    design = SetDesign(config)
    there = {split_of(design, specimen) for specimen in range(pairs)}
    empty = [name for name in SPLITS if getattr(config.splits, name) and name not in there]
    if empty:
        yield (
            f"splits.by: pair: {counted(pairs, 'gear pair')} in all, so {' and '.join(empty)} would have no records; "
            "take more gears.pairs, or splits.by: gearbox"
        )


def _hertz_pa(pair: GearPair, force_n: float) -> float:
    """Return the largest Hertz pressure of one pair at the pitch point, p = sqrt(F E*/(pi b R)) [Pa]."""
    position, line = pair.pitch_point_m, pair.line_of_action_m
    radius = position * (line - position) / line
    modulus = pair.youngs_modulus_pa / (2.0 * (1.0 - pair.poisson_ratio**2))
    return sqrt(force_n * modulus / (pi * pair.face_width_m * radius))


def _rim_kg(teeth: int, pair: GearPair) -> float:
    """Return the mass of a ring of steel, four modules thick behind its teeth."""
    module = pair.pinion.module_m
    inner = 0.5 * module * teeth
    return STEEL_DENSITY_KG_M3 * pi * ((inner + RIM_MODULES * module) ** 2 - inner**2) * pair.face_width_m


def _slowest_shaft(gearbox: PossibleGearbox, pairs: Sequence[GearPair]) -> tuple[str, float]:
    """Return what turns slowest, and its turns per turn of the first shaft."""
    if gearbox.config.planetary is not None:
        return "the carrier", 1.0 / (1.0 + gearbox.config.planetary.ring_teeth / pairs[0].pinion.teeth)
    orders = accumulate((pair.pinion.teeth / pair.gear.teeth for pair in pairs), mul, initial=1.0)
    order, shaft = min(zip(orders, (shaft.called for shaft in gearbox.config.names.shafts), strict=True))
    return shaft, order
