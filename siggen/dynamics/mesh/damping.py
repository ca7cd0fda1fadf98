"""Mesh damping that depends on the lubrication: the parts of its ratio.

Ratio by asperity share: ζ = ζ_s + ζ_f (1 - La) + ζ_a La. Derived (ours): literature gives mesh damping ratios of 0.03
to 0.17 and names structure, film and asperities as sources, but no law that was read relates them. What follows from
the ratio: `pair_law`.
"""

from __future__ import annotations

from typing import NamedTuple


class DampingLaw(NamedTuple):
    """Parts of the mesh damping ratio (a named tuple, since compiled code takes no dataclass).

    `structure`: ζ_s, always present (0.03 to 0.05); `film`: ζ_f (0.01 to 0.03); `asperities`: ζ_a (0.03 to 0.08).
    """

    structure: float = 0.04
    film: float = 0.02
    asperities: float = 0.05
