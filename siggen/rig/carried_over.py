"""The sections of a configuration carried over from the pair that they were written for to another gear pair.

What is not named here stays: speeds, orders of other machines, damping ratios, roughness, oil, accuracy class, shares,
noise of sensors. A housing of plates follows the pair by itself.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from siggen.config import GearsSection
from siggen.config.gears import PairSection
from siggen.damage.flank_place import FACE_WIDTH, MODULE, SKEW
from siggen.keys.scaling import grown, multiplied, scaled
from siggen.names import SHAFT_OF
from siggen.rig.pair_scales import PairScales, pair_scales
from siggen.sensors.sensor import SIZE


def carried_over(sections: Mapping[str, Any], pair: PairSection) -> dict[str, Any]:
    """Return the sections of a gearbox with another pair, by key; those that do not change are left out.

    Parameters
    ----------
    sections : mapping
        Valid sections of a configuration, `gears` and `operating_points` among them; states and sensors as tuples or
        by name.
    pair : Pair
    """
    gears: GearsSection = sections["gears"]
    scales = pair_scales(gears, pair, sections["operating_points"])
    found: dict[str, Any] = {
        "gears": _gears(gears, pair, scales),
        "operating_points": _each(sections["operating_points"], {"torque_nm": scales.torque}),
    }
    for name, factors in _factors(scales).items():
        if sections.get(name) is not None:
            found[name] = scaled(sections[name], factors)
    if sections.get("sensors") is not None:
        found["sensors"] = _grown(sections["sensors"], {SIZE: scales.size})
    if sections.get("states") is not None:
        found["states"] = _damaged(sections["states"], scales)
    return found


def _damaged(states: Any, scales: PairScales) -> Any:
    """Return states whose damage takes the same share of the other flanks."""
    factors = {MODULE: scales.module, FACE_WIDTH: scales.face_width, SKEW: scales.module / scales.face_width}
    return _grown(states, factors)


def _grown(entries: Any, factors: Mapping[str, float]) -> Any:
    if isinstance(entries, Mapping):
        return {index: grown(entry, factors) for index, entry in entries.items()}
    return tuple(grown(entry, factors) for entry in entries)


def _each(entries: Any, factors: Mapping[str, float]) -> Any:
    if isinstance(entries, Mapping):
        return {index: scaled(entry, factors) for index, entry in entries.items()}
    return tuple(scaled(entry, factors) for entry in entries)


def _gears(gears: GearsSection, pair: PairSection, scales: PairScales) -> GearsSection:
    wheels = {
        name: wheel.model_copy(
            update={
                "teeth": pair.teeth[i],
                "profile_shift": pair.profile_shifts[i],
                "bore_radius_mm": multiplied(wheel.bore_radius_mm, scales.bore[i]),
            }
        )
        for i, (name, wheel) in enumerate((("pinion", gears.pinion), ("gear", gears.gear)))
    }
    sizes = {"module_mm": pair.module_mm, "face_width_mm": pair.face_width_mm, "centre_distance_mm": None}
    return gears.model_copy(update={**sizes, **wheels, "pairs": ()})


def _factors(scales: PairScales) -> dict[str, dict[str, float]]:
    """Return section -> path of a key below it -> factor."""
    mass = scales.size**3
    return {
        "dynamics": _dynamics(scales),
        "manufacture": {
            "lead_misalignment_um": scales.face_width,
            "crowning_um": scales.face_width,
            "crowning_driven_um": scales.face_width,
        },
        "housing": _housing(scales.size),
        "background": {
            "base.mass_kg": mass,
            "base.gyration_m": scales.size,
            "machines.density_n_per_sqrt_hz": scales.load,
            "shafts.coupling_stiffness_n_per_um": scales.load,
            "shafts.rotor_mass_kg": mass,
            "second_stage.order": scales.gear_order,
        },
    }


def _housing(size: float) -> dict[str, float]:
    lengths = ("length_mm", "height_mm", "width_mm", "wall_mm", "bolts.positions_mm")
    stiffnesses = (f"bolts.{way}_stiffness_n_per_m" for way in ("shear", "axial"))
    return {**dict.fromkeys((*lengths, *stiffnesses), size), "mass_kg": size**3, "inertia_kg_m2": size**5}


def _dynamics(scales: PairScales) -> dict[str, float]:
    found = {
        "rated_torque_nm": scales.torque,
        "motor_inertia_kg_m2": scales.end_inertia[0],
        "load_inertia_kg_m2": scales.end_inertia[1],
        "backlash_um": scales.module,
        "mesh.tip_relief_um": scales.load / scales.face_width,
        "mesh.pit_edge_radius_mm": scales.module,
    }
    for i, (wheel, end) in enumerate((("pinion", "input"), ("gear", "output"))):
        damping = (scales.bearing[i] * scales.mass[i]) ** 0.5
        found |= {
            f"{wheel}.bearing.stiffness_n_per_m": scales.bearing[i],
            f"{wheel}.bearing.axial_stiffness_n_per_m": scales.bearing[i],
            f"{wheel}.bearing.damping_n_s_per_m": damping,
            f"{wheel}.mass_kg": scales.mass[i],
            f"{wheel}.inertia_kg_m2": scales.inertia[i],
            f"shafts.{SHAFT_OF[wheel]}.bearing_span_mm": scales.span[i],
            f"shafts.{SHAFT_OF[wheel]}.diameter_mm": scales.bore[i],
            f"{end}_coupling.stiffness_nm_per_rad": scales.coupling[i],
            f"{end}_coupling.damping_nm_s_per_rad": scales.coupling_damping[i],
        }
    return found
