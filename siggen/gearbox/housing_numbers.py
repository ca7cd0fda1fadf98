"""Proportions of a housing of plates that no file sets, with their sources; drawn per gearbox, by name, like its keys.

Ranges are those of `docs/understand/methods.md`: clearances, walls and ribs from design rules, bosses and welded walls
assumed. Lengths are shares of the centre distance or of the wall.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

from siggen.config import PlateHousing
from siggen.keys.distributions import Uniform
from siggen.keys.drawing import draw
from siggen.keys.number import Number, Within
from siggen.keys.section import Section

IRON_SHARE = 0.6
"""Of gearboxes of any material (assumed)."""
Drawn = Annotated[Number, Within()]


class FootNumbers(Section):
    """Of the four bolts under the corners of the floor: their share in the damping of a mode's energy (assumed)."""

    damping_ratio: Drawn = Uniform(low=0.03, high=0.07)


class PlateNumbers(PlateHousing):
    """Of the box: what its contents leave open.

    `end`, `above`, `sump`, `side`: clearances over the centre distance (10 to 25, 15 to 30, 25 to 60 and 25 to 55 mm at
    97.5 mm); `wall`, `modulus` and `density`: places within the ranges of the material; `lid`, `floor`: thickness over
    the wall's; `boss` over the bearing, `boss_thickness` over the wall; `bearing`: outer diameter over the shaft's;
    `overhang`: over the centre distance; `shear`, `axial`: stiffness of a bolt per metre of centre distance [N/m²];
    `bolt_inset`: over length and width; `ribbed`: below 0.3 with ribs; `rib_height`: over the wall.
    """

    end: Drawn = Uniform(low=0.10, high=0.26)
    above: Drawn = Uniform(low=0.15, high=0.31)
    sump: Drawn = Uniform(low=0.26, high=0.62)
    side: Drawn = Uniform(low=0.26, high=0.56)
    wall: Drawn = Uniform(low=0.0, high=1.0)
    modulus: Drawn = Uniform(low=0.0, high=1.0)
    density: Drawn = Uniform(low=0.0, high=1.0)
    lid: Drawn = Uniform(low=0.7, high=1.0)
    floor: Drawn = Uniform(low=1.3, high=1.7)
    boss: Drawn = Uniform(low=1.4, high=1.8)
    boss_thickness: Drawn = Uniform(low=1.5, high=4.0)
    bearing: Drawn = Uniform(low=1.8, high=2.2)
    shear: Drawn = Uniform(low=0.62e9, high=1.13e9)
    axial: Drawn = Uniform(low=1.13e9, high=2.05e9)
    overhang: Drawn = Uniform(low=0.0, high=0.10)
    bolt_inset: Drawn = Uniform(low=0.08, high=0.2)
    ribbed: Drawn = Uniform(low=0.0, high=1.0)
    rib_height: Drawn = Uniform(low=2.0, high=5.0)
    feet: FootNumbers = FootNumbers()


def plate_numbers(section: PlateHousing, uniform: Callable[[str], float]) -> PlateNumbers:
    """Return the numbers of one gearbox's box; the damping of plates belongs to modes and stays as it is."""
    numbers: PlateNumbers = draw(PlateNumbers.model_construct(**dict(section)), uniform, "housing")
    material = section.material
    if material == "any":
        material = "grey_iron" if uniform("housing.material") < IRON_SHARE else "steel"
    return numbers.model_copy(update={"material": material, "damping_ratio": section.damping_ratio})
