"""TableOptions: how finely the contact is tabulated, and the slices that follow from it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import TipRelief
from siggen.mesh.hertz import contact_half_width
from siggen.mesh.mesh_stiffness import rolls_at

CELL_WIDTHS = 1.28
"""Width of a slice in Hertz half widths of the reference force."""
FEWEST_SLICES, MOST_SLICES = 40, 100


class TableOptions(NamedTuple):
    """How finely the contact is tabulated.

    `largest_force_n`: up to which the nodes go, if it is above the reference force; `edge_radius_m`: of damage;
    `cell_widths`: width of a slice in Hertz half widths of the reference force; `nodes`: approaches up to that of the
    reference force; `healthy_columns`; `finest`: intervals of the fine grid below which columns are not refined;
    `section_loss`: whether damage also weakens the tooth's sections; `coupled`: whether slices feel each other;
    `tilts`: whether gears do; `relief`: of helical teeth, whose slices meet it one after the other.

    All but the last nodes follow from the pair alone, so that no load moves the numbers of a smaller one.
    """

    largest_force_n: float = 0.0
    edge_radius_m: float = 0.1e-3
    cell_widths: float = CELL_WIDTHS
    nodes: int = 19
    healthy_columns: int = 129
    finest: int = 2
    section_loss: bool = False
    coupled: bool = True
    tilts: bool = False
    relief: TipRelief | None = None


def face_slices(pair: GearPair, options: TableOptions) -> int:
    """Return the number of slices: cells of the width at which the kernel holds, within bounds of cost."""
    middle = np.array([0.5 * (pair.contact_start_m + pair.contact_end_m)])
    width = options.cell_widths * float(half_width(pair, middle, pair.reference_force_n)[0])
    return int(np.clip(round(pair.face_width_m / width), FEWEST_SLICES, MOST_SLICES))


def half_width(pair: GearPair, position_m: FloatArray, force_n: float) -> FloatArray:
    """Return Hertz's half width of the whole face (k,) [m]."""
    length = np.full(position_m.shape, pair.face_width_m)
    return contact_half_width(pair, *rolls_at(pair, position_m), length, force_n)
