"""Compliance of one tooth of a ring under a load normal to its flank.

Equations: standard literature. Beam: potential energy as in `compliance`, over the ring's own profile, whose root is
its thickest part. With the half angle tau and the pressure angle alpha at the contact the load is slanted by
alpha + tau against the normal of the tooth's centre line, towards the root (derived). Foot: O'Donnell's flexible root
in plane stress, coefficients as in Cornell 1981 (memory): the ring is held in a housing, so it has no thin rim.
What notches take of the sections between contact and root is added as in other teeth (`compliance`).
"""

from __future__ import annotations

from math import pi

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.internal_pair import RingGear
from siggen.gears.geometry.quadrature import NODES_48, WEIGHTS_48

ROTATION, SHIFT = 16.67 / pi, 1.534
"""Of a foot on a half plane: by a moment, by a shearing force."""
SHEAR_FACTOR = 1.2


def ring_tooth_parts(pair: GearPair, ring: RingGear, roll: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return bending, shear and axial compliance (3, k) and that of the foot (k,) of a tooth at roll angles [m/N].

    Parameters
    ----------
    pair : GearPair
        Of which face width and material are read.
    ring : RingGear
    roll : (k,)
        Roll angles of the contact on the ring's flank [rad].

    Source: module; exact to the quadrature of 48 nodes, which is exact to 1e-12 for these smooth profiles.
    """
    width = pair.face_width_m
    radius = ring.radius_m(roll)
    tau = ring.half_angle_rad(radius)
    slant = np.arctan(roll) + tau
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
    bending = (weight * lever**2 * 12.0 / thickness**3).sum(axis=0) / (young * width)
    beam = np.stack([bending, 2.0 * SHEAR_FACTOR * (1.0 + poisson) * across**2 * area, along**2 * area])
    return beam, across**2 * bracket / (young * width)
