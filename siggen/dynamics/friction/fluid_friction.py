"""Friction of the lubricated part by name, as a function of position and load that an asperity table takes.

The roughness is the healthy flank's for every model: inside a pit the composite law raises the friction by the share of
the asperities alone, so no regression is used on a flank it was not fitted to. Equations: `friction_coefficient`.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from siggen.dynamics.friction.asperity_table import FluidFriction
from siggen.dynamics.friction.contact_kinematics import (
    Values,
    entrainment_speed,
    hertz_pressure,
    relative_radius,
    slide_roll_ratio,
    sliding_speed,
)
from siggen.dynamics.friction.friction import FLUID_FRICTION
from siggen.dynamics.friction.friction_coefficient import (
    benedict_kelley_friction,
    eyring_friction,
    xu_kahraman_friction,
)
from siggen.dynamics.friction.lubrication import LubricatedMesh, masjedi_khonsari_central

FRICTION_TARGET = (0.02, 0.08)
"""Mean coefficients over the mesh that lubricated steel gears show (reference: standard literature)."""


def fluid_friction(name: str, mesh: LubricatedMesh, healthy_roughness_m: float) -> FluidFriction:
    """Return the friction coefficient of the lubricated part as a function of position [m] and force [N].

    Parameters
    ----------
    name : str
        'constant' (0.02), 'eyring', 'xu_kahraman' or 'benedict_kelley'.
    mesh : LubricatedMesh
    healthy_roughness_m : float
        Composite rms roughness of undamaged flanks [m].

    Raises
    ------
    ValueError
        If the name is unknown or the roughness is beyond the model's data.
    """
    if name not in FLUID_FRICTION_MODELS:
        raise ValueError(f"fluid friction: received {name!r}; allowed are {', '.join(FLUID_FRICTION_MODELS)}")
    model = FLUID_FRICTION_MODELS[name]
    # Once for its errors: a refused roughness is a mistake of the input, not of the table that asks later.
    model(mesh, healthy_roughness_m, np.array(0.5 * mesh.line_m), np.array(1e3))
    return lambda position_m, force_n: model(mesh, healthy_roughness_m, position_m, force_n)


def _constant(mesh: LubricatedMesh, roughness_m: float, position_m: Values, force_n: Values) -> Values:  # noqa: ARG001
    return np.full(np.broadcast(position_m, force_n).shape, FLUID_FRICTION)


def _eyring(mesh: LubricatedMesh, roughness_m: float, position_m: Values, force_n: Values) -> Values:
    slide = sliding_speed(position_m, mesh.line_m, mesh.speed_1_rad_s, mesh.speed_2_rad_s, 0.0)
    film = masjedi_khonsari_central(mesh.groups(position_m, force_n, roughness_m))
    pressure = _pressure(mesh, position_m, force_n)
    return eyring_friction(slide, film, pressure, mesh.viscosity_pa_s, mesh.pressure_viscosity_per_pa)


def _xu_kahraman(mesh: LubricatedMesh, roughness_m: float, position_m: Values, force_n: Values) -> Values:
    speeds = (position_m, mesh.line_m, mesh.speed_1_rad_s, mesh.speed_2_rad_s)
    radius = relative_radius(position_m, mesh.line_m)
    pressure = _pressure(mesh, position_m, force_n)
    rolling, ratio = entrainment_speed(*speeds), slide_roll_ratio(*speeds)
    return xu_kahraman_friction(ratio, pressure, rolling, mesh.viscosity_pa_s, radius, roughness_m)


def _benedict_kelley(mesh: LubricatedMesh, roughness_m: float, position_m: Values, force_n: Values) -> Values:
    speeds = (position_m, mesh.line_m, mesh.speed_1_rad_s, mesh.speed_2_rad_s)
    slide, total = sliding_speed(*speeds, 0.0), 2.0 * entrainment_speed(*speeds)
    # The formula takes arithmetic mean roughness: 0.8 of the rms of a Gaussian surface.
    mean = np.sqrt(2.0 / np.pi) * roughness_m
    return benedict_kelley_friction(force_n / mesh.contact_length_m, slide, total, mesh.viscosity_pa_s, mean)


def _pressure(mesh: LubricatedMesh, position_m: Values, force_n: Values) -> Values:
    radius = relative_radius(position_m, mesh.line_m)
    return hertz_pressure(force_n / mesh.contact_length_m, radius, mesh.effective_modulus_pa)


FLUID_FRICTION_MODELS: dict[str, Callable[[LubricatedMesh, float, Values, Values], Values]] = {
    "constant": _constant,
    "eyring": _eyring,
    "xu_kahraman": _xu_kahraman,
    "benedict_kelley": _benedict_kelley,
}
"""Models by name; the first is the default."""
