"""An idler, one gear in two meshes: how far the second one has turned where the first has none.

All derived. Angles ψ about the idler count in its own sense of turning. The gear in front, at ψ_a, pushes its hinder
flanks: contact at ρ = T - s before the base tangent point ψ_a + α_1, so that flank begins on the base circle at
ψ_a + α_1 - ρ/R_b. Its fore flanks push the gear behind, at ψ_c: contact at s after the base tangent point ψ_c - α_2, so
that flank begins at ψ_c - α_2 + s/R_b. Between both lies the tooth on the base circle.
"""

from __future__ import annotations

from math import pi

from siggen.gears.geometry.gear_pair import GearPair


def idler_ahead_pitches(front: GearPair, behind: GearPair, between_rad: float) -> float:
    """Return the base pitches that the mesh behind an idler has turned where that in front has turned none.

    Both count from the moment when a pair of the idler's tooth 0 enters, from 0 to below the idler's teeth.

    Parameters
    ----------
    front, behind : GearPair
        The idler is the gear of the first and the pinion of the second.
    between_rad : float
        Angle about the idler from the gear behind to the gear in front, in the sense in which the idler turns [rad].
    """
    idler = behind.pinion
    turned = between_rad + front.working_pressure_angle_rad + behind.working_pressure_angle_rad
    pitches = idler.teeth / (2.0 * pi) * (turned + 2.0 * idler.base_half_angle_rad)
    return (pitches - _flank_pitches(front, behind)) % idler.teeth


def idler_later_rad(front: GearPair, behind: GearPair) -> float:
    """Return by how much the phase of an idler's eccentricity is later in the mesh behind than in that in front.

    Moved by e the idler stands back from the gear in front by e cos β, with β its angle against the push, and from the
    gear behind by -e cos β; where both gears stand cancels against `idler_ahead_pitches`.
    """
    idler = behind.pinion
    flanks_rad = 2.0 * pi / idler.teeth * _flank_pitches(front, behind)
    return flanks_rad - pi - 2.0 * idler.base_half_angle_rad


def _flank_pitches(front: GearPair, behind: GearPair) -> float:
    """Return the base pitches along both flanks of a tooth from the base circle to where it enters."""
    return (front.line_of_action_m - front.contact_start_m + behind.contact_start_m) / behind.base_pitch_m
