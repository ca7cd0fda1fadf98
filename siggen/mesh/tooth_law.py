"""ToothLaw: how the teeth of a gearbox push and rub, and how their motion is stepped; the same for all its meshes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

# Mesh damping that depends on the lubrication: the parts of its ratio.
#
# Ratio by asperity share: ζ = ζ_s + ζ_f (1 - La) + ζ_a La. Derived (ours): literature gives mesh damping ratios of
# 0.03 to 0.17 and names structure, film and asperities as sources, but no law that was read relates them. What follows
# from the ratio: `pair_law`.


class DampingLaw(NamedTuple):
    """Parts of the mesh damping ratio (a named tuple, since compiled code takes no dataclass).

    `structure`: ζ_s, always present (0.03 to 0.05); `film`: ζ_f (0.01 to 0.03); `asperities`: ζ_a (0.03 to 0.08).
    """

    structure: float = 0.04
    film: float = 0.02
    asperities: float = 0.05


LINEAR, PAIRS = "linear", "pairs"
EXPONENTIAL, PRODUCT, RUNGE_KUTTA = "exponential", "product", "runge_kutta"
OFF, CONSTANT, MIXED_EHL = "off", "constant", "mixed_ehl"


@dataclass(frozen=True, slots=True)
class FlankFriction:
    """How the flanks rub.

    Attributes
    ----------
    model : off, constant or mixed_ehl
    coefficient : of the model constant; `boundary_friction`: where asperities carry
    oil, oil_temperature_c : grade, and temperature at the inlet [°C]
    roughness_m, pit_roughness_m : rms, of each flank and of land beside damage
    """

    model: str
    coefficient: float
    oil: str
    oil_temperature_c: float
    roughness_m: float
    pit_roughness_m: float
    boundary_friction: float


@dataclass(frozen=True, slots=True)
class ToothLaw:
    """How the teeth push and rub.

    Attributes
    ----------
    kind : linear (mesh stiffness times approach) or pairs (each by itself, its contact solved across the face)
    method, steps_per_sample, tolerance : the integrator; steps are those of the law linear, the tolerance that of pairs
    damping_ratio, damping : of critical, as one number and as the law of the pairs has it
    backlash_m : along the line of action
    relief_m, relief_pitches : at the tips of both gears, and its length along the line of action in base pitches
    edge_radius_m : of damage
    section_loss : whether damage weakens the sections of teeth, too
    tilts : whether gears tilt under load
    """

    kind: str
    method: str
    steps_per_sample: int
    tolerance: float
    damping_ratio: float
    damping: float | DampingLaw
    backlash_m: float
    relief_m: float
    relief_pitches: float
    edge_radius_m: float
    section_loss: bool
    tilts: bool
    friction: FlankFriction

    def with_oil_at(self, temperature_c: float) -> ToothLaw:
        """Return the law with oil of another temperature [°C]."""
        return replace(self, friction=replace(self.friction, oil_temperature_c=temperature_c))

    @property
    def across_the_face(self) -> bool:
        """Whether the contact is solved across the face, so that damage is geometry and may take its whole length."""
        return self.kind == PAIRS

    def by_reference(self, steps_per_sample: int | None = None) -> ToothLaw:
        """Return the law as the classical Runge-Kutta method steps it, a reference that no file can ask for."""
        return replace(self, method=RUNGE_KUTTA, steps_per_sample=steps_per_sample or self.steps_per_sample)
