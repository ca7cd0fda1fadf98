"""Shafts so soft that an end of the face meets the other flank already under the steady torque.

Derived: springs k at the distances l from the gear's middle (`tilting_shaft`), a force F in that middle, towards the
bearings, and no moment give, per axis, the tilt F S_1/(S_0 S_2 - S_1²) with S_j = Σ k l^j. The flanks' tilt is the sum
over axes and gears, each times the squared share of the line of action along the axis; bounds of the numbers enter gear
by gear. The axial force of helical teeth, tan β_b F at the pitch point, is a moment M about the vertical axis of each
gear: it tilts the horizontal one by M S_0/(S_0 S_2 - S_1²) more, of which the flanks see the difference of both gears.
Half the face times the tilt is how far an end is behind: beyond approach and backlash together it meets the other
flank, of which the contact across the face knows nothing. Refused is what tilts too far in half of the gearboxes of a
set; where fewer do, plan says so. How far a motion swings about that is known only when it is simulated: it then ends
as `outside_model`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from siggen.config import Dynamics, Rotor, Shaft
from siggen.dynamics.bearings.loaded_bearing import loaded_bearing
from siggen.dynamics.structure.gear_stage import Shaft as Beam
from siggen.dynamics.structure.gear_stage import cantilever_compliance_m_per_n
from siggen.errors import Problem
from siggen.gearbox.pair import stiffness_options
from siggen.gearbox.teeth import largest_force_n
from siggen.gears.contact.table_columns import approach_under_m
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.distributions import Uniform
from siggen.keys.drawing import corners
from siggen.keys.number import Number, at, bounds
from siggen.specimen.loaded_bearings import BEARINGS, shaft_load_n

NEEDED = ("dynamics", "operating_points", "stiffness")
MEMBERS = ("pinion", "gear")


def tilt_problems(sections: Mapping[str, Any], pairs: Sequence[GearPair]) -> Iterator[Problem]:
    """Yield the shaft that tilts most where the steady torque alone tilts half of all gearboxes too far."""
    if not set(NEEDED) <= sections.keys() or sections["dynamics"].shafts is None:
        return
    for pair in pairs:
        if not np.isfinite(largest_force_n(sections["operating_points"], pair)):
            allowed = "allowed: torques whose force on the teeth, three times over, is a finite number"
            yield Problem("operating_points", f"a torque of {_largest_torque_nm(sections):g} N m", allowed)
            return
        tilts = flank_tilts(sections, pair)
        # half of the gearboxes tilt no farther than the one at all bounds
        if tilts.largest_rad > tilts.limit_rad and median_tilt_rad(sections, pair) > tilts.limit_rad:
            yield _problem(sections["dynamics"], pair, tilts)
            return


class FlankTilts(NamedTuple):
    """Tilts of a pair's flanks under the largest steady torque, and at which an end meets the other flank."""

    torque_nm: float
    limit_rad: float
    ranges_rad: dict[str, tuple[float, float]]
    """Least and largest tilt of pinion and gear, with signs."""

    @property
    def largest_rad(self) -> float:
        """Largest size of the sum over both gears."""
        low, high = map(sum, zip(*self.ranges_rad.values(), strict=True))
        return float(max(-low, high))


def flank_tilts(sections: Mapping[str, Any], pair: GearPair) -> FlankTilts:
    """Return the tilts of a pair under the largest torque of all operating points, over the bounds of the numbers."""
    dynamics, torque_nm = sections["dynamics"], _largest_torque_nm(sections)
    force_n = torque_nm / pair.pinion.base_radius_m
    approach_m = approach_under_m(pair, stiffness_options(sections["stiffness"]), force_n) if force_n > 0.0 else 0.0
    room_m = 1e-6 * at(dynamics.backlash_um, 0.5) + approach_m
    ranges = {which: static_tilts_rad(dynamics, which, pair, torque_nm) for which in MEMBERS}
    return FlankTilts(torque_nm, 2.0 * room_m / pair.face_width_m, ranges)


def median_tilt_rad(sections: Mapping[str, Any], pair: GearPair) -> float:
    """Return the size of the flanks' tilt that half of the gearboxes exceed under the largest torque."""
    dynamics, torque_nm = sections["dynamics"], _largest_torque_nm(sections)
    return _median_rad(*(_tilts_over_places_rad(dynamics, which, pair, torque_nm) for which in MEMBERS))


def _largest_torque_nm(sections: Mapping[str, Any]) -> float:
    return float(max(abs(limit) for point in sections["operating_points"] for limit in bounds(point.torque_nm)))


def _median_rad(pinion_rad: NDArray[np.float64], gear_rad: NDArray[np.float64]) -> float:
    """Return the median size of the sum, each place of one gear with each of the other."""
    return float(np.median(np.abs(np.add.outer(pinion_rad, gear_rad))))


def _tilts_over_places_rad(
    dynamics: Dynamics, which: str, pair: GearPair, torque_nm: float, diameter_mm: float | None = None
) -> NDArray[np.float64]:
    """Return tilts (4,) [rad] of one gear at equally likely places on its shaft, all other numbers in their middle."""
    shafts: Any = dynamics.shafts
    shaft: Shaft = getattr(shafts, which)
    thickness = at(shaft.diameter_mm, 0.5) if diameter_mm is None else diameter_mm
    halves = {"bearing_span_mm": at(shaft.bearing_span_mm, 0.5), "diameter_mm": thickness}
    middle = _in_the_middle(dynamics, which)
    tilts = []
    for place in (0.125, 0.375, 0.625, 0.875):
        own = shaft.model_copy(update={**halves, "gear_position": at(shaft.gear_position, place)})
        placed = middle.model_copy(update={"shafts": shafts.model_copy(update={which: own})})
        tilts.append(static_tilts_rad(placed, which, pair, torque_nm)[1])
    return np.array(tilts)


def _in_the_middle(dynamics: Dynamics, which: str) -> Dynamics:
    """Return the dynamics with one gear's bearings at the middle of what is drawn."""
    rotor: Rotor = getattr(dynamics, which)
    names = ("bearing_stiffness_y_n_per_m", "bearing_stiffness_x_n_per_m")
    rotor = rotor.model_copy(update={name: at(getattr(rotor, name), 0.5) for name in names})
    return dynamics.model_copy(update={which: rotor})


def static_tilts_rad(dynamics: Dynamics, which: str, pair: GearPair, torque_nm: float) -> tuple[float, float]:
    """Return least and largest tilt [rad] of one gear under a motor torque, over the bounds of shaft and bearings."""
    shaft: Shaft = getattr(dynamics.shafts, which)
    rotor = under_load(dynamics, which, pair, torque_nm)
    along = {"vertical": np.cos(pair.working_pressure_angle_rad), "horizontal": np.sin(pair.working_pressure_angle_rad)}
    levers = {"vertical": 0.0, "horizontal": _axial_lever_m(pair, which)}
    bearings = {"vertical": rotor.bearing_stiffness_y_n_per_m, "horizontal": rotor.bearing_stiffness_x_n_per_m}
    found = []
    for span, place, thick in product(*map(bounds, (shaft.bearing_span_mm, shaft.gear_position, shaft.diameter_mm))):
        beam = Beam(1e-3 * span, place, 1e-3 * thick, pair.youngs_modulus_pa, pair.poisson_ratio, 0.0)
        each = []
        for axis, share in along.items():
            ends = [_tilt_per_n(beam, k, levers[axis] / share) for k in bounds(bearings[axis])]
            each.append((share**2 * min(ends), share**2 * max(ends)))
        found.append([sum(ends) for ends in zip(*each, strict=True)])
    force_n = (1.0 + np.tan(pair.base_helix_rad) ** 2) * torque_nm / pair.pinion.base_radius_m  # as slices feel it
    return force_n * min(low for low, _ in found), force_n * max(high for _, high in found)


def under_load(dynamics: Dynamics, which: str, pair: GearPair, torque_nm: float) -> Rotor:
    """Return the section of one gear with what its bearings have under a torque, where they follow the load."""
    rotor: Rotor = getattr(dynamics, which)
    if rotor.bearing is None:
        return rotor
    load_n = shaft_load_n(pair, which, torque_nm, 0.0, housed=dynamics.model == "casing") / BEARINGS
    each = [BEARINGS * loaded_bearing(one.bearing(), load_n).stiffness_n_per_m for one in corners(rotor.bearing)]
    ends = {axis: [float(k[i, i]) for k in each] for i, axis in enumerate("xy")}
    numbers = {
        f"bearing_stiffness_{axis}_n_per_m": Uniform(low=min(ends[axis]), high=max(ends[axis]))
        if len(each) > 1
        else ends[axis][0]
        for axis in ends
    }
    return rotor.model_copy(update=numbers)


def _axial_lever_m(pair: GearPair, which: str) -> float:
    """Return the moment about the vertical axis per force along the line of action, as it tilts the flanks [m]."""
    radius = pair.member(which).base_radius_m / np.cos(pair.working_pressure_angle_rad)
    return float(np.tan(pair.base_helix_rad) * radius * (1.0 if which == "gear" else -1.0))


def _tilt_per_n(beam: Beam, bearing_n_per_m: float, lever_m: float) -> float:
    """Return the tilt per force [rad/N] at the middle of the gear, with a moment at a lever, on both bearings."""
    levers = np.array(list(beam.levers_m.values()))
    give_way = [cantilever_compliance_m_per_n(beam, abs(lever)) for lever in levers]
    springs = 1.0 / (2.0 / bearing_n_per_m + np.array(give_way))
    zeroth, first, second = (float((springs * levers**power).sum()) for power in (0, 1, 2))
    return (first + lever_m * zeroth) / (zeroth * second - first**2)


def _problem(dynamics: Dynamics, pair: GearPair, tilts: FlankTilts) -> Problem:
    """Return what is wrong with the worse shaft, and the least diameter that would do beside the other one as it is."""
    torque_nm, limit = tilts.torque_nm, tilts.limit_rad
    own = {which: _tilts_over_places_rad(dynamics, which, pair, torque_nm) for which in MEMBERS}
    which, kept = sorted(MEMBERS, key=lambda member: -float(np.median(np.abs(own[member]))))

    def tilt(diameter_mm: float | None) -> float:
        return _median_rad(_tilts_over_places_rad(dynamics, which, pair, torque_nm, diameter_mm), own[kept])

    shaft: Shaft = getattr(dynamics.shafts, which)
    thin, thick = bounds(shaft.diameter_mm)[0], 2e3 * pair.member(which).root_radius_m
    received = (
        f"{_rounded(shaft.diameter_mm)}, with which the flanks tilt by {1e6 * tilt(None):.0f} urad under "
        f"{torque_nm:g} N m, with gears.youngs_modulus_gpa {pair.youngs_modulus_pa / 1e9:g} and "
        f"dynamics.{which}.bearing_stiffness_x_n_per_m {getattr(dynamics, which).bearing_stiffness_x_n_per_m}"
    )
    allowed = f"allowed: a tilt of at most {1e6 * limit:.0f} urad, where an end of the face meets the other flank"
    if tilt(thick) > limit:
        advice = "no diameter below that of the root does; move gear_position nearer to 0.5, or take stiffer bearings"
        return Problem(f"dynamics.shafts.{which}.diameter_mm", received, f"{allowed}; {advice}")
    for _ in range(40):
        middle = 0.5 * (thin + thick)
        thin, thick = (thin, middle) if tilt(middle) <= limit else (middle, thick)
    advice = f"from {np.ceil(10.0 * thick) / 10.0:.1f} mm on, or a gear_position nearer to 0.5"
    return Problem(f"dynamics.shafts.{which}.diameter_mm", received, f"{allowed}: {advice}")


def _rounded(number: Number) -> str:
    """Return a number as people write it: what was carried over to another pair has many digits."""
    return str(round(number, 3)) if isinstance(number, float) else str(number)
