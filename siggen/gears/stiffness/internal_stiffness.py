"""Stiffness of a planet in a ring: the ring's tooth as a beam on a half plane, hollow contact, all pairs together.

Equations: standard literature. Beam: potential energy as in `compliance`, over the ring's own profile, whose root is
its thickest part. With the half angle tau and the pressure angle alpha at the contact the load is slanted by
alpha + tau against the normal of the tooth's centre line, towards the root (derived). Foot: O'Donnell's flexible root
in plane stress, coefficients as in Cornell 1981 (memory): the ring is held in a housing, so it has no thin rim.
Contact: `hertz`, with the difference of both curvatures.
"""

from __future__ import annotations

from math import ceil, pi

import numpy as np
from numpy.typing import ArrayLike

from siggen.arrays import FloatArray
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.internal_pair import InternalPair
from siggen.gears.geometry.quadrature import NODES_48, WEIGHTS_48
from siggen.gears.stiffness.compliance import ROLL_TOLERANCE, SHEAR_FACTOR, ToothCompliance, tooth_compliance
from siggen.gears.stiffness.hertz import linear_compliance
from siggen.gears.stiffness.mesh_tables import TABLE_POINTS, MeshTables
from siggen.gears.stiffness.stiffness_options import StiffnessOptions

ROTATION, SHIFT = 16.67 / pi, 1.534
"""Of a foot on a half plane: by a moment, by a shearing force."""


def ring_tooth_compliance(pair: InternalPair, position_m: ArrayLike) -> ToothCompliance:
    """Return the compliances of one tooth of the ring loaded at positions along the line of action (k,) [m/N].

    Parameters
    ----------
    pair : InternalPair
    position_m : (k,)
        From the planet's base tangent point, on the path of contact [m].

    Raises
    ------
    ValueError
        If a position is off the path of contact.

    Source: module; exact to the quadrature of 48 nodes, which is exact to 1e-12 for these smooth profiles.
    """
    position = _on_path(pair, position_m)
    ring, width = pair.ring, pair.face_width_m
    radius = pair.ring_radius_m(position)
    tau = ring.half_angle_rad(radius)
    slant = np.arccos(ring.base_radius_m / radius) + tau
    along, across, offset = np.sin(slant), np.cos(slant), radius * np.sin(tau)
    half = 0.5 * (ring.root_radius_m - radius)
    radii = radius + half * (1.0 + NODES_48[:, np.newaxis])
    half_angles = ring.half_angle_rad(radii)
    # height Y = R cos(tau) with d tau/dR = tan(alpha)/R
    rise = np.cos(half_angles) - np.sin(half_angles) * np.sqrt((radii / ring.base_radius_m) ** 2 - 1.0)
    weight = WEIGHTS_48[:, np.newaxis] * half * rise
    thickness = 2.0 * radii * np.sin(half_angles)
    lever = across * (radii * np.cos(half_angles) - radius * np.cos(tau)) - along * offset
    young, poisson = pair.youngs_modulus_pa, pair.poisson_ratio
    area = (weight / thickness).sum(axis=0) / (young * width)
    foot = float(ring.half_angle_rad(np.array([ring.root_radius_m]))[0])
    thick, root = 2.0 * ring.root_radius_m * np.sin(foot), ring.root_radius_m * np.cos(foot)
    # the force acts where its line crosses the centre line
    share = (root - radius * np.cos(tau) - offset * along / across) / thick
    bracket = ROTATION * share**2 + 2.0 * (1.0 - poisson) * share
    bracket = bracket + SHIFT * (1.0 + (along / across) ** 2 / (2.4 * (1.0 + poisson)))
    return ToothCompliance(
        bending=(weight * lever**2 * 12.0 / thickness**3).sum(axis=0) / (young * width),
        shear=2.0 * SHEAR_FACTOR * (1.0 + poisson) * across**2 * area,
        axial=along**2 * area,
        foundation=across**2 * bracket / (young * width),
    )


def internal_pair_stiffness(
    sun_pair: GearPair, pair: InternalPair, position_m: ArrayLike, options: StiffnessOptions
) -> FloatArray:
    """Return the stiffness of one pair of planet and ring at positions along the line of action (k,) [N/m].

    Parameters
    ----------
    sun_pair : GearPair
        Sun and planet; the planet's tooth is the same in both meshes.
    pair : InternalPair
    position_m : (k,)
        From the planet's base tangent point, on the path of contact [m].
    options : StiffnessOptions
        Tooth and contact law; neighbours do not act on each other here.

    Raises
    ------
    ValueError
        If a position is off the path of contact.

    Source: module (springs in series).
    """
    position = _on_path(pair, position_m)
    roll = position / pair.planet.base_radius_m
    planet, ring = tooth_compliance(sun_pair, "gear", roll, options), ring_tooth_compliance(pair, position)
    return np.asarray(1.0 / (planet.total + ring.total + _contact(sun_pair, pair, position, options)))


def internal_mesh_stiffness(
    sun_pair: GearPair, pair: InternalPair, pitches: ArrayLike, options: StiffnessOptions
) -> FloatArray:
    """Return the sum over all pairs in contact, `pitches` (k,) after one stands at the pitch point [N/m].

    Other arguments and errors are those of `internal_pair_stiffness`.
    """
    turned = np.atleast_1d(np.asarray(pitches, dtype=np.float64)) % 1.0
    total = np.zeros(turned.size)
    for n in range(-ceil(pair.contact_ratio) - 1, ceil(pair.contact_ratio) + 2):
        position = pair.pitch_point_m + (turned + n) * pair.base_pitch_m
        inside = (position >= pair.contact_start_m) & (position <= pair.contact_end_m)
        total[inside] += internal_pair_stiffness(sun_pair, pair, position[inside], options)
    return total


def internal_tables(
    sun_pair: GearPair, pair: InternalPair, options: StiffnessOptions, points: int = TABLE_POINTS
) -> MeshTables:
    """Return the tables of a healthy planet in its ring; arguments as `internal_pair_stiffness`."""
    position = np.linspace(pair.contact_start_m, pair.contact_end_m, points)
    return MeshTables(
        start_m=pair.contact_start_m,
        end_m=pair.contact_end_m,
        step_m=(pair.contact_end_m - pair.contact_start_m) / (points - 1),
        base_pitch_m=pair.base_pitch_m,
        pair_stiffness_n_per_m=internal_pair_stiffness(sun_pair, pair, position, options)[np.newaxis],
        table_of_pair=np.zeros((pair.planet.teeth, pair.ring.teeth), dtype=np.int32),
    )


def _contact(sun_pair: GearPair, pair: InternalPair, position_m: FloatArray, options: StiffnessOptions) -> FloatArray:
    """Return the compliance of the contact (k,) [m/N]; see `hertz`, here with a hollow flank."""
    linear = linear_compliance(sun_pair, np.full(position_m.size, pair.face_width_m))
    if options.hertz_force_n is None:
        return linear
    planet, ring = pair.planet, pair.ring
    roll, radius = position_m / planet.base_radius_m, pair.ring_radius_m(position_m)
    first = planet.half_thickness_m(roll) / np.cos(roll - planet.base_half_angle_rad)
    tau = ring.half_angle_rad(radius)
    second = radius * np.sin(tau) / np.cos(np.arccos(ring.base_radius_m / radius) + tau)
    hollow = position_m + pair.line_of_action_m
    curvature = 1.0 / position_m - 1.0 / hollow
    width = np.sqrt(2.0 * options.hertz_force_n * linear / curvature)  # 8 F R (1 - nu^2)/(pi E L)
    poisson = pair.poisson_ratio
    return linear * (np.log(2.0 * np.sqrt(first * second) / width) - poisson / (2.0 * (1.0 - poisson)))


def _on_path(pair: InternalPair, position_m: ArrayLike) -> FloatArray:
    position = np.atleast_1d(np.asarray(position_m, dtype=np.float64))
    slack = ROLL_TOLERANCE * pair.contact_end_m
    if not bool(np.all((position >= pair.contact_start_m - slack) & (position <= pair.contact_end_m + slack))):
        span = f"{np.min(position):.6g} to {np.max(position):.6g}"
        raise ValueError(
            f"position_m {span} m is off the path of contact; allowed: {pair.contact_start_m:.6g} to "
            f"{pair.contact_end_m:.6g} m"
        )
    return position
