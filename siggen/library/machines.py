"""Gearboxes of several meshes, with names of the user's own, and planetary sets."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from siggen.checks.notes import covering_classes
from siggen.errors import UsageError
from siggen.gearbox.configured import preset
from siggen.library.arguments import finite, refused, saying
from siggen.library.gearbox import Gearbox
from siggen.library.makers import counts, made
from siggen.rig.rating import bearable_torque_nm, proposed_face_width_mm, rated_torque_nm
from siggen.rig.rig import Rig, checked_rig
from siggen.rig.rig_numbers import RigNumbers, RotorNumbers, rig_numbers
from siggen.rig.rig_text import BENCH_FACE_MM

__all__ = ["machine", "planetary"]

FS_HZ = 409_600.0
"""What checks of the rated speed take; a run has a sampling rate of its own."""
SPREAD = (0.75, 1.33)
"""Of stiffness between bearings of one size: fit, clearance and number of balls are not known (assumed)."""
Entries = Mapping[str, Mapping[str, Any]]
HOUSING_MM, HOUSING_KG = 235.5, (40.0, 80.0)
"""Centre distances of the preset `two_stage` together, and its housing, which grows with them."""
BOLTS_MM, SENSORS_MM = ((190, -110), (190, -110), (-190, -110), (-190, -110)), ((110, 120), (-170, 0))
SET_TORQUE_NM, SET_SIZE_MM = 90.0, 154.0
"""Of the preset `planetary`: largest torque on the sun, pitch diameter of the ring."""


def machine(
    *,
    shafts: Entries,
    gears: Entries,
    meshes: Entries,
    rated_nm: float,
    rated_hz: float = 25.0,
    number: int = 0,
) -> Gearbox:
    """Return a gearbox of shafts, gears and meshes in a row, under your names.

    Parameters
    ----------
    shafts : mapping
        Name -> what is known of a shaft, which may be nothing: `span_mm` between its bearings where it carries two
        gears, `mass_kg`, and the other keys of `machine.shafts` of a file (docs/reference/yaml.md).
    gears : mapping
        Name -> `teeth`, `shaft`, and where they are known `bore_radius_mm`, `profile_shift`.
    meshes : mapping
        Name -> `gears` (driving, driven), `module_mm`, and where they are known `face_width_mm` (8 modules),
        `direction_deg`, `helix_deg`, `pressure_angle_deg`.
    rated_nm, rated_hz : float
        Torque [N m] and speed [Hz] of the first shaft that shafts, bearings and couplings are made for.
    number : int
        Which gearbox of this drawing.

    Returns
    -------
    Gearbox
        Healthy, its shafts in a rigid casing on bolts with two accelerometers, `input_vertical` and
        `output_horizontal`. Masses, bearings and couplings follow the rules of `siggen init`, the casing grows with the
        centre distances (docs/understand/stages.md).

    Raises
    ------
    UsageError
        If an argument cannot be: names it, what came and what is allowed.
    """
    torque = finite("rated_nm", rated_nm, "a number above 0", 1e-9)
    speed = finite("rated_hz", rated_hz, "a number above 0", 1e-9)
    listed = {
        "shafts": _listed("shafts", shafts),
        "gears": _listed("gears", gears),
        "meshes": _listed("meshes", meshes),
    }
    for mesh in listed["meshes"]:
        both = mesh.pop("gears", None)
        if not isinstance(both, (list, tuple)) or len(both) != 2:
            raise refused(f"meshes[{mesh['name']!r}]['gears']", repr(both), "the names of two gears, driving first")
        mesh["driver"], mesh["driven"] = both
    keys = {
        f"machine.{kind}.{one['name']}": f"{kind}[{one['name']!r}]"
        for kind, several in listed.items()
        for one in several
    }
    rest: dict[str, Any] = {}
    steps = _steps(listed, torque, speed)
    if steps:
        borne = (
            (bearable_torque_nm(one.teeth, one.module_mm, one.face_width_mm), one) for one in (s.rig for s in steps)
        )
        most = min(least * torque / one.torque_nm[1] for least, one in borne)
        finite("rated_nm", torque, f"above 0 up to {most:.4g} N m, which all teeth bear", 1e-9, most)
        rest = _filled(listed, steps)
    for several, key, value in ((listed["gears"], "bore_radius_mm", 1.0), (listed["meshes"], "face_width_mm", 10.0)):
        for one in several:
            one.setdefault(key, value)  # where rules know none: what is wrong is said of the file that this makes
    raw = {
        "extends": "two_stage", "name": "machine", "machine": {"others": None, **_named(listed)},
        "states": {"others": None, "healthy": {}},
        "operating_points": [{"speed_hz": speed, "torque_nm": torque}], "mesh_harmonics": 1, "fs_hz": FS_HZ, **rest,
    }  # fmt: skip
    with saying({**keys, "machine.": "", "operating_points.0.torque_nm": "rated_nm", "fs_hz": "rated_hz"}):
        return made(raw, number)


@dataclass(frozen=True)
class _Step:
    """One mesh in the order of power: its place in the list, and what it is made for."""

    place: int
    driver: dict[str, Any]
    driven: dict[str, Any]
    rig: Rig
    numbers: RigNumbers


def _listed(argument: str, entries: Entries) -> list[dict[str, Any]]:
    if not isinstance(entries, Mapping) or not all(isinstance(one, Mapping) for one in entries.values()):
        raise refused(argument, repr(entries), "a mapping from names to mappings")
    return [{"name": name, **one} for name, one in entries.items()]


def _named(listed: Mapping[str, list[dict[str, Any]]]) -> dict[str, Any]:
    """Return what a file says of shafts, gears and meshes."""
    return {
        kind: {one["name"]: {key: value for key, value in one.items() if key != "name"} for one in several}
        for kind, several in listed.items()
    }


def _steps(listed: Mapping[str, list[dict[str, Any]]], torque_nm: float, speed_hz: float) -> list[_Step]:
    """Return the meshes from the first shaft on; none where what is given is no row of them, which is refused later."""
    gears = {gear["name"]: gear for gear in listed["gears"]}
    found: list[_Step] = []
    try:
        driven_shafts = {gears[mesh["driven"]]["shaft"] for mesh in listed["meshes"]}
        shaft = next(one["name"] for one in listed["shafts"] if one["name"] not in driven_shafts)
        for _ in listed["meshes"]:
            place = next(i for i, mesh in enumerate(listed["meshes"]) if gears[mesh["driver"]]["shaft"] == shaft)
            mesh = listed["meshes"][place]
            driver, driven = gears[mesh["driver"]], gears[mesh["driven"]]
            mesh.setdefault("face_width_mm", proposed_face_width_mm(mesh["module_mm"]))
            rig = checked_rig(Rig(
                (driver["teeth"], driven["teeth"]), mesh["module_mm"], mesh["face_width_mm"], (speed_hz,) * 2,
                (torque_nm,) * 2,
            ))  # fmt: skip
            found.append(_Step(place, driver, driven, rig, rig_numbers(rig)))
            ratio = driver["teeth"] / driven["teeth"]
            shaft, speed_hz, torque_nm = driven["shaft"], speed_hz * ratio, torque_nm / ratio
    except (KeyError, TypeError, ValueError, StopIteration, UsageError):
        return []
    return found


def _filled(listed: Mapping[str, list[dict[str, Any]]], steps: list[_Step]) -> dict[str, Any]:
    """Fill what is not known of gears and shafts, and return the sections around them."""
    shafts, first, last = {one["name"]: one for one in listed["shafts"]}, steps[0].numbers, steps[-1].numbers
    _stand(shafts[steps[0].driver["shaft"]], first.rotors[0], first.rotors[0])
    for step, behind in zip(steps, [*steps[1:], None], strict=True):
        for gear, rotor in zip((step.driver, step.driven), step.numbers.rotors, strict=True):
            gear.setdefault("bore_radius_mm", 0.5 * rotor.shaft.bore_mm)
        own = step.numbers.rotors[1]
        stiffest = own if behind is None else max(own, behind.numbers.rotors[0], key=lambda one: one.bearing_n_per_m)
        _stand(shafts[step.driven["shaft"]], own, stiffest)
    size = sum(0.5 * one.rig.module_mm * sum(one.rig.teeth) for one in steps) / HOUSING_MM
    module_mm, face_mm = min(one.rig.module_mm for one in steps), max(one.rig.face_width_mm for one in steps)
    relief = sorted(first.tip_relief_um)
    base, density = (
        {"log": [low * scale, high * scale]}
        for low, high, scale in ((50.0, 300.0, size**3), (0.16, 1.6, last.load_share))
    )
    return {
        "dynamics": {
            "motor_inertia_kg_m2": first.motor_inertia_kg_m2, "load_inertia_kg_m2": last.load_inertia_kg_m2,
            "backlash_um": [20 * module_mm, 40 * module_mm],
            "mesh": {"tip_relief_um": list(relief)},
            **{
                f"{end}_coupling": {"stiffness_nm_per_rad": n.coupling_nm_per_rad[i],
                                    "damping_nm_s_per_rad": n.coupling_nm_s_per_rad[i]}
                for i, (end, n) in enumerate((("input", first), ("output", last)))
            },
        },
        "manufacture": {
            "accuracy_class": {"one_of": list(min(covering_classes(one.rig) for one in steps))},
            "crowning_um": [0.0, 4.0 * face_mm / BENCH_FACE_MM],
            "lead_misalignment_um": [0.0, 2.0 * face_mm / BENCH_FACE_MM],
        },
        "housing": {
            "kind": "rigid", "inertia_kg_m2": None,
            "mass_kg": {"log": [HOUSING_KG[0] * size**3, HOUSING_KG[1] * size**3]},
            "bolts": {"positions_mm": [[size * x, size * y] for x, y in BOLTS_MM]},
        },
        "background": {"base": {"mass_kg": base}, "machines": {"density_n_per_sqrt_hz": density}},
        "sensors": {"others": None} | {
            name: {**_SENSOR, "axes": [axis], "position_mm": [size * x for x in place]}
            for name, axis, place in zip(("input", "output"), ("vertical", "horizontal"), SENSORS_MM, strict=True)
        },
    }  # fmt: skip


_SENSOR = {
    "place": "casing", "gain": {"normal": [1.0, 0.05], "within": [0.9, 1.1]},
    "noise": {"floor_m_s2": {"log": [0.003, 0.01]}}, "range_m_s2": 500.0, "bits": "noise",
    "high_pass_hz": {"log": [0.5, 2.0]},
    "mounting": {"frequency_hz": [6000.0, 15000.0], "damping_ratio": 0.06},
}  # fmt: skip
"""Accelerometers as `siggen init` proposes them."""


def _stand(shaft: dict[str, Any], gear: RotorNumbers, bearings: RotorNumbers) -> None:
    """Fill masses of the gear that is driven on a shaft, and its bearings."""
    stiffness = bearings.bearing_n_per_m
    damping = [2.0 * ratio * (stiffness * gear.mass_kg) ** 0.5 for ratio in (0.02, 0.04)]
    shaft.setdefault("mass_kg", gear.mass_kg)
    shaft.setdefault("inertia_kg_m2", gear.inertia_kg_m2)
    between = {"log": [share * stiffness for share in SPREAD]}
    sized = {"stiffness_n_per_m": between, "damping_n_s_per_m": {"log": damping}}
    given = shaft.get("bearing", {})
    shaft["bearing"] = {**sized, **given} if isinstance(given, Mapping) else given


def planetary(
    teeth: tuple[int, int, int],
    module_mm: float,
    *,
    planets: int = 3,
    face_width_mm: float | None = None,
    rated_nm: float | None = None,
    rated_hz: float = 25.0,
    number: int = 0,
) -> Gearbox:
    """Return a planetary set: `sun`, planets and `ring`, which is held; the carrier drives the load.

    Parameters
    ----------
    teeth : (int, int, int)
        Of sun, planets and ring.
    module_mm, face_width_mm : float
        Module and face width; default 8 modules [mm].
    planets : int
        Evenly round the sun, as far as teeth fit.
    rated_nm, rated_hz : float
        Torque [N m] and speed [Hz] of the sun; default what one planet bears (ISO 6336-5, case-hardened) times their
        number.
    number : int
        Which gearbox of this drawing.

    Returns
    -------
    Gearbox
        Healthy, with accelerometers on the ring and at the carrier's bearing. Supports and masses are those of the
        preset `planetary`, grown with the ring's diameter, couplings with the torque (assumed;
        docs/understand/planetary.md).

    Raises
    ------
    UsageError
        If an argument cannot be: names it, what came and what is allowed.
    """
    sun, planet, ring = counts("teeth", teeth, (25, 26, 77))
    finite("planets", planets, "1 to 9", 1, 9)
    module = finite("module_mm", module_mm, "0.3 to 50 mm", 0.3, 50.0)
    width = proposed_face_width_mm(module) if face_width_mm is None else face_width_mm
    width = finite("face_width_mm", width, "1 to 500 mm", 1.0, 500.0)
    most = planets * bearable_torque_nm((sun, planet), module, width)
    torque = planets * rated_torque_nm((sun, planet), module, width) if rated_nm is None else rated_nm
    torque = finite("rated_nm", torque, f"above 0 up to {most:.4g} N m, which the teeth bear", 1e-9, most)
    speed = finite("rated_hz", rated_hz, "0.05 to 500 Hz", 0.05, 500.0)
    size, load = module * ring / SET_SIZE_MM, torque / SET_TORQUE_NM
    base = preset("planetary")
    supports = {key: _times(base["planetary"][key], size) for key in base["planetary"] if "stiffness" in key}
    couplings = {
        f"{end}_coupling": {key: _times(value, load) for key, value in base["dynamics"][f"{end}_coupling"].items()}
        for end in ("input", "output")
    }
    raw = {
        "extends": "planetary", "states": {"others": None, "healthy": {}}, "mesh_harmonics": 1, "fs_hz": FS_HZ,
        "gears": {
            "module_mm": module, "face_width_mm": width,
            "pinion": {"teeth": sun, "bore_radius_mm": 0.16 * module * sun},
            "gear": {"teeth": planet, "bore_radius_mm": 0.16 * module * planet},
        },
        "planetary": {
            "ring_teeth": ring, "positions_deg": [round(360.0 * i / planets, 6) for i in range(planets)],
            "ring_mass_kg": _times(base["planetary"]["ring_mass_kg"], size**3), **supports,
        },
        "dynamics": {
            **{key: _times(base["dynamics"][key], load) for key in ("motor_inertia_kg_m2", "load_inertia_kg_m2")},
            "backlash_um": [30 * module, 60 * module], **couplings,
        },
        "operating_points": [{"speed_hz": speed, "torque_nm": torque}],
    }  # fmt: skip
    keys = {
        "gears.module_mm": "module_mm",
        "gears.face_width_mm": "face_width_mm",
        "operating_points.0.torque_nm": "rated_nm",
    }
    keys |= {"gears.pinion": f"teeth={teeth}, sun", "gears.gear": f"teeth={teeth}, planet"}
    keys |= {"operating_points.0.torque_nm": "rated_nm"}
    keys |= {"planetary.ring_teeth": f"teeth={teeth}, ring", "planetary.positions_deg": "planets", "fs_hz": "rated_hz"}
    with saying(keys):
        return made(raw, number)


def _times(value: Any, factor: float) -> Any:
    """Return a number of a file, or a range, times a factor."""
    if isinstance(value, Mapping):
        return {key: _times(item, factor) for key, item in value.items()}
    return [_times(item, factor) for item in value] if isinstance(value, list) else value * factor
