"""Axial motion: what the axial force of helical teeth moves along the shafts, and the moments that it has about them.

Derived. z runs along the shafts so that flanks of a right-handed pinion are ahead at larger z. The normal of a flank in
the plane of action is then (cos β_b, -sin β_b) along the line of action and z. Approaches and forces are those of the
transverse plane, 1/cos β_b and cos β_b times those along the normal, so that z counts tan β_b and power is one number.
A gear whose tilts move its axis by φ per distance along z moves at a place X from its axis by -φ X along z. The force
acts at the pitch point; pairs that are before or behind it have their mean there.

Tilted gears feel slices at s_0 + w tan β_b, which are farther from the pitch point the farther they are from the middle
of the face: a tilt counts 1 + tan² β_b there.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, tan
from typing import NamedTuple

from siggen.dynamics.structure.gear_stage import GearStage


class AxialBearing(NamedTuple):
    """Coordinate of a shaft along its axis, and stiffness [N/m] and damping [N s/m] of what holds it there."""

    coordinate: str
    stiffness: float
    damping: float


def axial_inertias(stage: GearStage) -> dict[str, float]:
    """Return coordinate -> mass [kg] of the shafts along their axes; nothing with spur teeth, which push none."""
    return {"z_1": stage.pinion.mass_kg, "z_2": stage.gear.mass_kg} if stage.base_helix_rad != 0.0 else {}


def axial_bearings(stage: GearStage) -> dict[str, AxialBearing]:
    """Return place/axis -> the bearing that holds each shaft along its axis; none with spur teeth."""
    if stage.base_helix_rad == 0.0:
        return {}
    rotors = {"pinion": ("z_1", stage.pinion), "gear": ("z_2", stage.gear)}
    return {f"{name}_bearing/axial": AxialBearing(z, *one.bearing.along_axis) for name, (z, one) in rotors.items()}


def axial_approach(stage: GearStage, centre_line: tuple[float, float] | None = None) -> dict[str, float]:
    """Return what axial motions add to the approach along the line of action; nothing with spur teeth.

    Parameters
    ----------
    stage : GearStage
    centre_line : (2,) or None
        Unit vector from gear to pinion in x and y, of gears that tilt.
    """
    if stage.base_helix_rad == 0.0:
        return {}
    slope = tan(stage.base_helix_rad)
    found = {"z_1": -slope, "z_2": slope}
    if centre_line is None:
        return found
    radii = (rotor.base_radius_m / cos(stage.working_pressure_angle_rad) for rotor in (stage.pinion, stage.gear))
    arms = {
        f"phi_{axis}_{index}": -slope * radius * share
        for index, radius in zip("12", radii, strict=True)
        for axis, share in zip("xy", centre_line, strict=True)
    }
    return found | arms


def tilt_share(stage: GearStage) -> float:
    """Return what a tilt of the gears counts at the slices, per distance from the middle of the face."""
    return 1.0 + tan(stage.base_helix_rad) ** 2


def turned_back(row: Mapping[str, float]) -> dict[str, float]:
    """Return an approach of drive flanks, mirrored in the plane of rotation, with the axial motions of back flanks.

    Teeth keep their hand, so the normal of a back flank points the other way along z.
    """
    return {name: -value if name.startswith(("z_", "phi_")) else value for name, value in row.items()}
