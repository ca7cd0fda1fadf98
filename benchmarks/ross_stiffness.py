"""Alternative: the healthy mesh stiffness of ROSS (`ross.gear_element.Mesh`), an optional import.

ROSS integrates the same kind of cantilever (rack-cut fillet of Ma 2014, Sainsot's foundation) with `quad`; healthy
teeth only, and its constants are those of its own steel. See https://github.com/petrobras/ross
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from ross.gear_element import GearElementTVMS, Mesh  # type: ignore[import-not-found, unused-ignore]
from ross.materials import Material  # type: ignore[import-not-found, unused-ignore]

from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear


def healthy_curve(pair: GearPair, points: int) -> Callable[[], np.ndarray]:
    """Return a function that computes the stiffness over one pitch (points,) [N/m]; the gears are built before."""
    mesh = Mesh(_element(0, pair, pair.pinion), _element(1, pair, pair.gear))
    return lambda: np.asarray(mesh.get_stiffness_for_mesh_period(n_points=points)[1])


def _element(node: int, pair: GearPair, gear: SpurGear) -> GearElementTVMS:
    steel = Material(name="gear_steel", rho=7850.0, E=pair.youngs_modulus_pa, Poisson=pair.poisson_ratio)
    return GearElementTVMS(
        n=node,
        material=steel,
        width=pair.face_width_m,
        bore_diameter=2.0 * gear.bore_radius_m,
        module=gear.module_m,
        n_teeth=gear.teeth,
        pr_angle=gear.pressure_angle_rad,
    )
