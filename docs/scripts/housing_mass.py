"""Mass of a housing round the gears of bench: boxes of even wall, for the range of `dynamics.casing.mass_kg`.

`python docs/scripts/housing_mass.py`. A box leaves out flanges, ribs and bosses, which real castings have besides.
"""

from __future__ import annotations

from typing import NamedTuple

CENTRE_MM = 97.5
TIPS_MM = (60.0, 147.0)
SPANS_MM = (70.0, 140.0)
"""Shortest and longest distance of the bearings in bench."""


class Wall(NamedTuple):
    """One way to make a housing; `clearance_mm` between tips and wall."""

    name: str
    thickness_mm: float
    clearance_mm: float
    density_kg_m3: float


WALLS = (
    Wall("grey cast iron, 8 mm: least wall of design handbooks, 0.025 a + 1 mm but 8 mm", 8.0, 10.0, 7200.0),
    Wall("steel plates of 15 mm (assumed)", 15.0, 20.0, 7850.0),
    Wall("steel plates of 25 mm (assumed: a stiff laboratory rig)", 25.0, 20.0, 7850.0),
)


def outer_mm(wall: Wall, span_mm: float) -> tuple[float, float, float]:
    """Return length, height and depth of the box."""
    around = 2.0 * (wall.clearance_mm + wall.thickness_mm)
    return CENTRE_MM + 0.5 * sum(TIPS_MM) + around, max(TIPS_MM) + around, span_mm + 2.0 * wall.thickness_mm


def mass_kg(wall: Wall, span_mm: float) -> float:
    """Return the mass of the wall: the box less what is inside."""
    length, height, depth = outer_mm(wall, span_mm)
    twice = 2.0 * wall.thickness_mm
    inside = (length - twice) * (height - twice) * (depth - twice)
    return 1e-9 * wall.density_kg_m3 * (length * height * depth - inside)


def gyration_mm(wall: Wall, span_mm: float) -> float:
    """Return the radius of gyration about the middle, round the shafts' direction: box less box."""
    length, height, depth = outer_mm(wall, span_mm)
    twice = 2.0 * wall.thickness_mm
    inner = (length - twice, height - twice, depth - twice)
    volume, moment = 0.0, 0.0
    for sign, (x, y, z) in ((1.0, (length, height, depth)), (-1.0, inner)):
        volume += sign * x * y * z
        moment += sign * x * y * z * (x**2 + y**2) / 12.0
    return float((moment / volume) ** 0.5)


if __name__ == "__main__":
    print("| wall | span [mm] | mass [kg] | radius of gyration over centre distance |\n|---|---|---|---|")
    for wall in WALLS:
        for span_mm in SPANS_MM:
            size = gyration_mm(wall, span_mm) / CENTRE_MM
            print(f"| {wall.name} | {span_mm:g} | {mass_kg(wall, span_mm):.1f} | {size:.2f} |")
