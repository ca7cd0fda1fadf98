"""FlankTolerances: what a flank tolerance class of ISO 1328-1 allows the teeth of one gear.

ISO 1328-1:2013, formulas 5 to 12 with the step factor √2 between classes, not rounded (the standard rounds what it
prints; read from four independent public implementations, which agree). With the module m, the reference diameter d
and the face width b in mm, for class 5 in µm:

    f_p = 0.001 d + 0.4 m + 5      F_p = 0.002 d + 0.55 √d + 0.7 m + 12
    f_Hα = 0.4 m + 0.001 d + 4     f_fα = 0.55 m + 5                      F_α = √(f_Hα² + f_fα²)
    f_Hβ = 0.05 √d + 0.35 √b + 4   f_fβ = 0.07 √d + 0.45 √b + 4           F_β = √(f_Hβ² + f_fβ²)
    F_r = 0.9 F_p                  runout; informative in the standard, taken from one public implementation
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import cos, hypot, sqrt

from siggen.gears.gear_pair import GeometryProblem
from siggen.gears.spur_gear import SpurGear

CLASSES = range(1, 12)
RUNOUT_SHARE = 0.9
LIMITS: dict[str, tuple[float, float]] = {
    "teeth": (5, 1000),
    "module": (0.5, 70.0),
    "reference diameter": (5.0, 15_000.0),
    "face width": (4.0, 1200.0),
}
"""Number of teeth, and lengths in mm, for which the standard gives tolerances; it forbids to extrapolate."""


@dataclass(frozen=True, slots=True)
class FlankTolerances:
    """Largest allowed deviations [m].

    `pitch_m`, `cumulative_pitch_m`: single pitch f_p (±) and total cumulative pitch F_p, along the arc of the reference
    circle; `runout_m`: F_r, radial, twice the eccentricity of an otherwise perfect gear; `profile_slope_m`,
    `profile_form_m`, `profile_m`: f_Hα (±), f_fα and F_α, normal to the flank; `helix_slope_m`, `helix_form_m`,
    `helix_m`: f_Hβ (±), f_fβ and F_β across the face.
    """

    pitch_m: float
    cumulative_pitch_m: float
    runout_m: float
    profile_slope_m: float
    profile_form_m: float
    profile_m: float
    helix_slope_m: float
    helix_form_m: float
    helix_m: float

    def times(self, share: float) -> FlankTolerances:
        """Return the same share of every tolerance."""
        return FlankTolerances(**{field.name: share * getattr(self, field.name) for field in fields(self)})


def flank_tolerances(
    gear: SpurGear, face_width_m: float, accuracy_class: int, helix_rad: float = 0.0
) -> FlankTolerances:
    """Return the tolerances of a gear; of a helical one `gear` is the transverse section, m the normal module.

    Raises
    ------
    ValueError
        If the gear lies outside the range of the standard.
    """
    if problems := outside_iso_1328(gear, face_width_m, helix_rad=helix_rad):
        raise ValueError("; ".join(map(str, problems)))
    module, diameter, width = 1e3 * gear.module_m * cos(helix_rad), 2e3 * gear.pitch_radius_m, 1e3 * face_width_m
    slope, form = 0.4 * module + 0.001 * diameter + 4.0, 0.55 * module + 5.0
    helix_slope = 0.05 * sqrt(diameter) + 0.35 * sqrt(width) + 4.0
    helix_form = 0.07 * sqrt(diameter) + 0.45 * sqrt(width) + 4.0
    cumulative = 0.002 * diameter + 0.55 * sqrt(diameter) + 0.7 * module + 12.0
    of_class_5 = FlankTolerances(
        pitch_m=0.001 * diameter + 0.4 * module + 5.0,
        cumulative_pitch_m=cumulative,
        runout_m=RUNOUT_SHARE * cumulative,
        profile_slope_m=slope,
        profile_form_m=form,
        profile_m=hypot(slope, form),
        helix_slope_m=helix_slope,
        helix_form_m=helix_form,
        helix_m=hypot(helix_slope, helix_form),
    )
    return of_class_5.times(1e-6 * sqrt(2.0) ** (accuracy_class - 5))


def outside_iso_1328(
    gear: SpurGear, face_width_m: float, where: str = "gear", helix_rad: float = 0.0
) -> tuple[GeometryProblem, ...]:
    """Return what of a gear, named by `where`, lies outside the range of the standard; empty for one within it."""
    found = {
        "teeth": (float(gear.teeth), ""),
        "module": (1e3 * gear.module_m * cos(helix_rad), " mm"),
        "reference diameter": (2e3 * gear.pitch_radius_m, " mm"),
        "face width": (1e3 * face_width_m, " mm"),
    }
    # A billionth of room: 4.0 mm read from a file and turned into metres and back must stay 4 mm.
    return tuple(
        GeometryProblem(name, where, f"{value:.6g}{unit}", f"allowed by ISO 1328-1: {low:g} to {high:g}{unit}")
        for name, (value, unit) in found.items()
        for low, high in (LIMITS[name],)
        if not low * (1.0 - 1e-9) <= value <= high * (1.0 + 1e-9)
    )
