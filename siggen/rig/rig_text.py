"""The YAML file of a rig: what the user gave, what follows from it, and everything else from the preset bench."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from siggen.names import SHAFT_OF
from siggen.rig.rig import Pair, Rig
from siggen.rig.rig_numbers import ASSUMED, RigNumbers, rig_numbers

SCHEMA_FILE = "siggen.schema.json"
"""Beside the file of a rig, whose first line names it to editors (`yaml-language-server`)."""
PLACES = (("lid", "vertical"), ("gear_end", "horizontal"), ("wall", "axial"), ("pinion_end", "horizontal"))
"""Of sensors on the housing; further sensors take the same again."""
BENCH_MODULE_MM, BENCH_FACE_MM = 3.0, 20.0
CLASSES_RULE = "the whole face carries at full load (ISO 6336-1: K_Hbeta up to 2)"
NAMES = {1: ["severe"], 2: ["slight", "severe"], 3: ["slight", "moderate", "severe"]}
"""Of so many sizes; of more, size_1, size_2 ..."""
PIT_LAWS = {"semi_axis_face_mm": (0.3, 0.05, 0.2, 0.4), "semi_axis_profile_mm": (0.2, 0.05, 0.1, 0.3)}
"""Mean, standard deviation and bounds at a module of 3 mm, as in the preset bench."""
SECOND_STAGE_TEETH = range(17, 29)
"""Of a pinion on the gear's shaft: from the least without undercut at 20 degrees (assumed; a measured one had 21)."""


def rig_text(rig: Rig, name: str, proposals: Mapping[str, str] | None = None) -> str:
    """Return the file's text.

    Parameters
    ----------
    rig : Rig
    name : str
        Of the set.
    proposals : mapping, optional
        Option of `siggen init` -> where its number comes from, for those that were not given.
    """
    numbers, why = rig_numbers(rig), dict(proposals or {})
    gears = (_head(rig, name, numbers, why), _gears(rig, numbers, why), _manufacture(rig))
    around = (_background(rig, numbers), _sensors(rig))
    return "\n".join((*gears, _dynamics(rig, numbers), _states(rig), *around))


def _head(rig: Rig, name: str, numbers: RigNumbers, why: Mapping[str, str]) -> str:
    turns = numbers.duration_s * rig.speed_hz[0]
    cut = f"less than the hunting period of {rig.hunting_turns} turns"
    whole = "one hunting period and a turn more" if turns > rig.hunting_turns else cut
    return f"""\
# yaml-language-server: $schema={SCHEMA_FILE}
# Made by `siggen init`. What stands here differs from the preset bench; all else is its own.
# `siggen plan` says what follows from it and what is implausible. Numbers that you know better: change them here.

name: {_quoted(name)}
extends: bench
specimens: 40                 # gearboxes; more only add records
{_sampling(rig, numbers)}
duration_s: {_exact(numbers.duration_s)}               # {whole} at {rig.speed_hz[0]:g} Hz

operating_points:
  - speed_hz: {_given_range(rig.speed_hz)}             # of the pinion
    torque_nm: {_given_range(rig.torque_nm)}            # on the pinion{_proposed(why, "torque")}
"""


def _sampling(rig: Rig, numbers: RigNumbers) -> str:
    """Return the sampling rate; with the mesh harmonics that it carries, if it was given."""
    rate = f"fs_hz: {_exact(numbers.fs_hz)}              # "
    if rig.fs_hz is None:
        return rate + "carries ten mesh harmonics"
    return f"{rate}as given\nmesh_harmonics: {numbers.mesh_harmonics}            # what it carries, ten at most"


def _gears(rig: Rig, numbers: RigNumbers, why: Mapping[str, str]) -> str:
    bores = [_exact(0.5 * rotor.shaft.bore_mm) for rotor in numbers.rotors]
    reason = "as given" if rig.bores_mm else "of the shaft, at most 0.6 of the root circle"
    return f"""\
gears:
  module_mm: {_exact(rig.module_mm)}
  pressure_angle_deg: {_exact(rig.pressure_angle_deg)}
  face_width_mm: {_exact(rig.face_width_mm)}            # of both{_proposed(why, "face-width")}
  pinion: {{teeth: {rig.teeth[0]}, bore_radius_mm: {bores[0]}{_shift(rig.shifts[0])}}}     # {reason}
  gear: {{teeth: {rig.teeth[1]}, bore_radius_mm: {bores[1]}{_shift(rig.shifts[1])}}}
"""


def _shift(modules: float) -> str:
    return f", profile_shift: {_exact(modules)}" if modules else ""


def _manufacture(rig: Rig) -> str:
    share = rig.face_width_mm / BENCH_FACE_MM
    return f"""\
manufacture:
  accuracy_class: {{one_of: {list(rig.accuracy_classes)}}}     # of ISO 1328-1; {CLASSES_RULE}
  crowning_um: {_range((0.0, 4.0 * share))}     # in proportion to the face width, as in the preset
  lead_misalignment_um: {_range((0.0, 2.0 * share))}
"""


def _dynamics(rig: Rig, numbers: RigNumbers) -> str:
    shafts = [rotor.shaft for rotor in numbers.rotors]
    on = [f"{shaft.bearing.kind} bearings of {shaft.bearing.bore_mm:.3g} mm bore" for shaft in shafts]
    given = [
        f"    {name}: {{diameter_mm: {_exact(shaft.diameter_mm)}}}"
        for name, shaft in zip(SHAFT_OF.values(), shafts, strict=True)
        if rig.bores_mm is not None
    ]
    lines = [
        "dynamics:",
        "  # Masses, bearings, shafts and couplings follow from it where they are not given; the set's config.yaml has",
        f"  # them. Shafts of {shafts[0].diameter_mm:.4g} and {shafts[1].diameter_mm:.4g} mm, {on[0]} and {on[1]}.",
        f"  rated_torque_nm: {_exact(rig.torque_nm[1])}     # on the pinion",
        *(["  shafts:                     # as thick as the bores", *given] if given else []),
        f"  backlash_um: [{20 * rig.module_mm:.3g}, {40 * rig.module_mm:.3g}]     # {ASSUMED}",
        f"  mesh: {{tip_relief_um: {_range(numbers.tip_relief_um)}}}    # running in alone, deflection at full load",
    ]
    return "\n".join(lines) + "\n"


def _states(rig: Rig) -> str:
    """Return healthy, healthy again, damage of growing size, and a sham of its middle size."""
    first, size = {"spalls": _spall, "pits": _pits}[rig.damage](rig)
    share = [k / (rig.severities - 1) for k in range(rig.severities)] if rig.severities > 1 else [1.0]
    names = NAMES[rig.severities] if rig.severities in NAMES else [f"size_{k + 1}" for k in range(rig.severities)]
    lines = [
        f"states:                       # {rig.damage} on one tooth of the pinion; sizes grow with the module",
        "  others: null                # none of the preset's",
        "  healthy: {}",
        "  healthy_again: {}           # the same gearbox measured a second time: what a paired comparison starts from",
        f"  {names[0]}:",
        *(f"    {line}" for line in ("damage:", *first, *(f"  {key}: {one}" for key, one in size(share[0])))),
    ]
    for milder, name, part in zip(names, names[1:], share[1:], strict=False):
        own = ", ".join(f"{key}: {one}" for key, one in size(part))
        lines += [f"  {name}: {{grows: {milder}, damage: {{{own}}}}}"]
    own = ", ".join(f"{key}: {one}" for key, one in size(0.5))
    lines += [
        "  # its damage passes everywhere, with nothing removed: what finds it is a leak",
        f"  sham: {{like: {names[0]}, acts: false, damage: {{{own}}}}}",
    ]
    return "\n".join(lines) + "\n"


def _spall(rig: Rig) -> tuple[list[str], Callable[[float], list[tuple[str, str]]]]:
    """Return a spall without its size, and the size at a share of the way from the smallest to the largest."""
    m = rig.module_mm
    skew = 0.15 * min(1.0, (m / rig.face_width_mm) / (BENCH_MODULE_MM / BENCH_FACE_MM))
    first = [
        "  kind: irregular",
        "  gear: pinion",
        "  teeth: 1",
        f"  edge_radius_mm: [{0.007 * m:.2g}, {min(0.07 * m, 0.2):.2g}]",
        f"  skew_mm_per_10mm: [{-skew:.3g}, {skew:.3g}]",
    ]
    return first, lambda share: [
        ("profile_length_mm", f"{_between(share, 0.2, 0.33, 0.5) * m:.3g}"),
        ("face_share", f"{_between(share, 0.25, 0.6, 1.0):.3g}"),
    ]


def _pits(rig: Rig) -> tuple[list[str], Callable[[float], list[tuple[str, str]]]]:
    """Return a cluster without its count, and the count; pits as of the preset bench, in proportion to the module."""
    m = rig.module_mm / BENCH_MODULE_MM
    first = [
        "  kind: clustered",
        "  gear: pinion",
        "  teeth: 1",
        "  centre_height_mm: pitch",
        f"  spread_profile_mm: {0.3 * m:.3g}",
        *(f"  {key}: {_normal(*(m * value for value in law))}" for key, law in PIT_LAWS.items()),
        f"  depth_mm: {_range((0.1 * m, 0.4 * m))}",
        "  floor: dish",
    ]
    wide = (rig.face_width_mm / BENCH_FACE_MM) / m  # so many pits cover the same share of the face
    return first, lambda share: [("count", f"{12 * wide * 10.0**share:.0f}")]


def _between(share: float, low: float, middle: float, high: float) -> float:
    """Return a size at a share of the way, along two straight lines."""
    return low + 2 * share * (middle - low) if share < 0.5 else middle + (2 * share - 1) * (high - middle)


def _normal(mean: float, std: float, low: float, high: float) -> str:
    return f"{{normal: [{mean:.3g}, {std:.3g}], within: [{low:.3g}, {high:.3g}]}}"


def _background(rig: Rig, numbers: RigNumbers) -> str:
    """Return what stands around the gears: the preset's, in proportion to size and load."""
    mass, force = numbers.scale**3, numbers.load_share
    orders = ", ".join(f"{z * rig.teeth[0] / rig.teeth[1]:.6f}" for z in SECOND_STAGE_TEETH)
    return f"""\
background:                   # {ASSUMED}
  base: {{mass_kg: {_range((50.0 * mass, 300.0 * mass), log=True)}}}
  machines: {{density_n_per_sqrt_hz: {_range((0.16 * force, 1.6 * force), log=True)}}}
  # {SECOND_STAGE_TEETH[0]} to {SECOND_STAGE_TEETH[-1]} teeth on the gear's shaft, turns of that shaft times teeth
  second_stage: {{order: {{one_of: [{orders}]}}}}
"""


def _sensors(rig: Rig) -> str:
    lines = [
        "sensors:                      # on the housing, about 15 mm around the middle of its plates",
        "  others: null",
        *(_sensor(i) for i in range(rig.sensors)),
    ]
    return "\n".join(lines) + "\n"


def _sensor(i: int) -> str:
    place, axis = PLACES[i % len(PLACES)]
    return f"  sensor_{i + 1}: {{place: {place}, axes: [{axis}], model: laboratory, mount: any}}"


def _range(values: Pair, log: bool = False) -> str:
    low, high = (_number(value) for value in values)
    text = low if low == high else f"[{low}, {high}]"
    return f"{{log: {text}}}" if log and low != high else text


def _given_range(values: Pair) -> str:
    """Return what a user gave with all its digits."""
    low, high = (_exact(value) for value in values)
    return low if low == high else f"[{low}, {high}]"


def _exact(value: float) -> str:
    """Return a number that reads back as the same one; what was computed loses the dust of its last digits."""
    rounded = float(f"{value:.15g}")
    return f"{rounded:.0f}" if rounded == int(rounded) else repr(rounded)


def _proposed(why: Mapping[str, str], option: str) -> str:
    return f"; proposed: {why[option]}" if option in why else ""


def _number(value: float) -> str:
    """Return three digits, without an exponent where four or five places do."""
    rounded = float(f"{value:.3g}")
    return f"{rounded:.0f}" if 100.0 <= rounded < 1e5 else f"{rounded:g}"


def _quoted(name: str) -> str:
    """Return a name as YAML reads it as a text: one that begins with a digit may pass for a number."""
    return f'"{name}"' if name[:1].isdigit() else name
