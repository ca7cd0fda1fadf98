"""Housings drawn at random: ranges of usual proportions for a centre distance of 97.5 mm, scaled with the distance.

The ranges are assumed: clearances, walls and ribs from design rules, bosses and welded walls from nothing better. They
serve to compare models over many different housings, not to describe a population.
"""

from __future__ import annotations

import numpy as np

from siggen.dynamics.housing.box import Box, Material
from siggen.dynamics.housing.layout import Contents, Proportions, layout

CENTRE_M = 0.0975
IRON_SHARE = 0.6
RIBBED_SHARE = 0.3


def drawn_box(rng: np.random.Generator, centre_m: float = CENTRE_M) -> Box:
    """Return a housing for a pair of this centre distance; all other lengths are in proportion to it."""
    scale = centre_m / CENTRE_M
    u = rng.uniform
    ratio = u(1.0, 4.0)
    module = scale * 3e-3
    pitch = centre_m * ratio / (1.0 + ratio), centre_m / (1.0 + ratio)
    contents = Contents(
        centre_distance_m=centre_m,
        tip_radius_m=(pitch[0] + module, pitch[1] + module),
        face_width_m=scale * u(0.015, 0.04),
        bearing_outer_m=(scale * u(0.047, 0.072), scale * u(0.035, 0.052)),
    )
    iron = bool(rng.random() < IRON_SHARE)
    wall = scale * (u(0.006, 0.016) if iron else u(0.008, 0.025))
    proportions = Proportions(
        end_m=scale * u(0.010, 0.025),
        above_m=scale * u(0.015, 0.030),
        sump_m=scale * u(0.025, 0.060),
        side_m=scale * u(0.025, 0.055),
        wall_m=wall,
        lid=u(0.7, 1.0),
        floor=u(1.3, 1.7),
        boss=u(1.4, 1.8),
        boss_thickness=u(1.5, 4.0),
        overhang_m=scale * u(0.0, 0.010),
        bolt_inset=u(0.08, 0.2),
        bolt_n_per_m=(scale * u(6e7, 11e7), scale * u(1.1e8, 2e8)),
        rib_height=u(2.0, 5.0) if rng.random() < RIBBED_SHARE else 0.0,
    )
    material = Material(u(90e9, 130e9), 0.26, u(7100.0, 7300.0)) if iron else Material(206e9, 0.3, 7850.0)
    return layout(contents, proportions, material)
