"""loosened: a box one of whose feet has lost a part of its stiffness, from the modes of the sound box.

    K' = K - Σ_a (1 - s) k_a b_a b_aᵀ

with b_a the motion of the foot along x, y, z and s what is left. The foot ties both halves of the modes together.
They are not solved anew: K' and M are taken on the modes kept of the sound box and on what the foot's own forces move
beyond them, K⁻¹ b_a less its share of these modes (Ritz; reference: standard literature, modal synthesis with residual
attachment modes). Static flexibility is exact (Woodbury). `tests/dynamics/housing/test_loose_foot.py` states the error
against the pencil of all coordinates.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf, pi
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.drivetrain.box import Axis, Bolt, Box
from siggen.drivetrain.box_functions import HalfFunctions
from siggen.drivetrain.housing_modes import BoxModes, HousingModes, WallMotion, bolt_motions, columns
from siggen.drivetrain.stiff_pencil import lowest_modes, own_squares, solve_lower, solve_upper, squares, upper_root

WALLS = ("front", "back")


class FootSpring(NamedTuple):
    """What a foot does along one axis: its stiffness [N/m], the part of it that is lost, and the floor's motion."""

    bolt: Bolt
    axis: Axis
    stiffness_n_per_m: float
    lost_n_per_m: float
    motion: WallMotion


def springs(box: Box, halves: tuple[HalfFunctions, HalfFunctions], share: float) -> Iterator[FootSpring]:
    """Yield the springs of all feet; the one at the pinion's end by the back wall has a share left."""
    for bolt in box.bolts:
        motions = bolt_motions(halves, bolt)
        for axis in Axis:
            for wall in WALLS:
                whole = bolt.stiffness_n_per_m[axis]
                left = share * whole if bolt is box.bolts[-1] and wall == WALLS[-1] else whole
                yield FootSpring(bolt, axis, left, whole - left, motions[f"{wall}/{axis.name.lower()}"])


@dataclass(frozen=True, slots=True)
class LoosenedModes(BoxModes):
    """As many modes as the sound box has.

    Attributes
    ----------
    sound : modes of the sound box
    beyond : motions of the box under the foot's own forces that the sound modes lack (of either half, (n, 3))
    weights : (m + 3, m) of sound modes and those motions in each mode
    foot : motions of the loose foot along x, y, z
    root : U (3, 3) with UᵀU = diag(1/((1 - s) k)) - bᵀ K⁻¹ b
    """

    frequency_hz: FloatArray
    bolt_share: FloatArray
    halves: tuple[HalfFunctions, HalfFunctions]
    sound: HousingModes
    beyond: tuple[FloatArray, FloatArray]
    weights: FloatArray
    foot: tuple[WallMotion, ...]
    root: FloatArray

    def shapes(self, motions: Sequence[WallMotion]) -> FloatArray:
        """Return the shapes (motions, m) [kg^-1/2] of all modes, as displacements; slopes per metre."""
        return squares(_rows(self.sound, self.beyond, motions), self.weights)

    def static_flexibility(self, outputs: Sequence[WallMotion], inputs: Sequence[WallMotion]) -> FloatArray:
        """Return static displacements (outputs, inputs) under unit forces, what is left of bolts included [m/N]."""
        more = [solve_lower(self.root, self.sound.static_flexibility(self.foot, side)) for side in (outputs, inputs)]
        return self.sound.static_flexibility(outputs, inputs) + squares(*more)


def loosened(sound: HousingModes, box: Box, share: float) -> LoosenedModes:
    """Return the modes of a box of which one foot has a share of its stiffness left, above 0 and below 1."""
    feet = list(springs(box, sound.halves, share))
    loose = [spring for spring in feet if spring.lost_n_per_m > 0.0]
    foot = tuple(spring.motion for spring in loose)
    lost = np.array([spring.lost_n_per_m for spring in loose])
    beyond = _beyond(sound, foot)
    at_foot = _rows(sound, beyond, foot)
    stiffness, mass = _sound_pencil(sound, beyond)
    stiffness -= squares(lost[:, None] * at_foot.T, np.ascontiguousarray(at_foot.T))
    found = lowest_modes(stiffness, mass, inf)
    kept = sound.frequency_hz.size
    omega_squared, weights = found.omega_squared[:kept], np.ascontiguousarray(found.shapes[:, :kept])
    held = squares(_rows(sound, beyond, [spring.motion for spring in feet]), weights)
    left = np.array([spring.stiffness_n_per_m for spring in feet])
    return LoosenedModes(
        frequency_hz=np.sqrt(omega_squared) / (2.0 * pi),
        bolt_share=(left[:, None] * held * held).sum(axis=0) / omega_squared,
        halves=sound.halves,
        sound=sound,
        beyond=beyond,
        weights=weights,
        foot=foot,
        root=upper_root(np.diag(1.0 / lost) - sound.static_flexibility(foot, foot)),
    )


def _beyond(sound: HousingModes, foot: Sequence[WallMotion]) -> tuple[FloatArray, FloatArray]:
    """Return K⁻¹ b - Σ_r φ_r (φ_rᵀ b)/ω_r² of both halves, each (n, 3), their modal masses together 1 kg."""
    found = []
    for h, modes in enumerate(sound.found):
        pressed = columns(foot, h)
        static = solve_upper(modes.root, solve_lower(modes.root, pressed))
        known = squares(modes.shapes, pressed) / modes.omega_squared[:, None]
        found.append(static - squares(np.ascontiguousarray(modes.shapes.T), known))
    masses = sum(np.diag(squares(own, squares(modes.mass, own))) for own, modes in zip(found, sound.found, strict=True))
    even, odd = (own / np.sqrt(masses) for own in found)
    return even, odd


def _sound_pencil(sound: HousingModes, beyond: tuple[FloatArray, FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return stiffness and mass (m + 3, m + 3) of the sound box on its modes and the motions beyond them."""
    kept, added = sound.frequency_hz.size, beyond[0].shape[1]
    stiffness, mass = np.zeros((2, kept + added, kept + added))
    modes = np.arange(kept)
    stiffness[modes, modes], mass[modes, modes] = (2.0 * pi * sound.frequency_hz) ** 2, 1.0
    for own, half in zip(beyond, sound.found, strict=True):
        stiffness[kept:, kept:] += own_squares(_times(half.root, own))
        mass[kept:, kept:] += squares(own, squares(half.mass, own))
    return stiffness, mass


def _times(root: FloatArray, right: FloatArray) -> FloatArray:
    return squares(np.ascontiguousarray(root.T), right)


def _rows(sound: HousingModes, beyond: tuple[FloatArray, FloatArray], motions: Sequence[WallMotion]) -> FloatArray:
    """Return what motions are on the sound modes and beyond them, (m + 3, motions)."""
    more = sum(squares(own, columns(motions, h)) for h, own in enumerate(beyond))
    return np.concatenate([sound.shapes(motions).T, more])
