"""Gearboxes from a drawing: what a user knows of it, and siggen's rules for all else."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeVar

from siggen.checks.loading import load_config
from siggen.checks.notes import covering_classes
from siggen.keys.yaml_source import parse_yaml
from siggen.library.arguments import finite, refused, saying
from siggen.library.gearbox import Gearbox, draw
from siggen.rig.rating import bearable_torque_nm, proposed_face_width_mm, rated_torque_nm
from siggen.rig.rig import Rig, checked_rig
from siggen.rig.rig_text import rig_text
from siggen.uncollected import uncollected

__all__ = ["counts", "made", "single_stage"]

Counts = TypeVar("Counts", tuple[int, int], tuple[int, int, int])

KEYS = {
    "--teeth": "teeth", "--module": "module_mm", "--face-width": "face_width_mm", "--speed": "rated_hz",
    "--torque": "rated_nm", "--pressure-angle": "pressure_angle_deg", "--fs": "rated_hz",
    "gears.module_mm": "module_mm", "gears.face_width_mm": "face_width_mm",
    "gears.pressure_angle_deg": "pressure_angle_deg",
    "operating_points.0.torque_nm": "rated_nm", "operating_points.0.speed_hz": "rated_hz",
}  # fmt: skip
"""Option of `siggen init`, or key of a file -> argument."""


def single_stage(
    teeth: tuple[int, int],
    module_mm: float,
    *,
    face_width_mm: float | None = None,
    pressure_angle_deg: float = 20.0,
    rated_nm: float | None = None,
    rated_hz: float = 25.0,
    number: int = 0,
) -> Gearbox:
    """Return a gearbox of one pair of spur gears, `pinion` and `gear`, in a housing of plates.

    Parameters
    ----------
    teeth : (int, int)
        Of pinion and gear.
    module_mm : float
        Module [mm].
    face_width_mm : float
        Face width [mm]; default 8 modules.
    pressure_angle_deg : float
        [degrees].
    rated_nm, rated_hz : float
        Torque [N m] and speed [Hz] of the pinion's shaft that shafts, bearings and couplings are made for; default
        what flank and root bear after ISO 6336-5, case-hardened.
    number : int
        Which gearbox of this drawing: others have other errors of teeth, bearings, housing and noise.

    Returns
    -------
    Gearbox
        Healthy, with two accelerometers on its housing. All else follows the rules of `siggen init`
        (docs/start/own_gearbox.md).

    Raises
    ------
    UsageError
        If an argument cannot be, or the teeth cannot mesh: names it, what came and what is allowed.
    """
    pair = counts("teeth", teeth, (23, 61))
    module = finite("module_mm", module_mm, "a number above 0", 1e-9)
    width = proposed_face_width_mm(module) if face_width_mm is None else face_width_mm
    width = finite("face_width_mm", width, "a number above 0", 1e-9)
    angle = finite("pressure_angle_deg", pressure_angle_deg, "14.5 to 30 degrees", 14.5, 30.0)
    speed = finite("rated_hz", rated_hz, "a number above 0", 1e-9)
    own = {"gears": f"teeth={pair}", "gears.pinion": f"teeth={pair}, pinion", "gears.gear": f"teeth={pair}, gear"}
    with saying({**KEYS, **own}), uncollected():  # the first compiled function loads a thousand templates of numba
        checked_rig(Rig(pair, module, width, (speed, speed), (1.0, 1.0), pressure_angle_deg=angle))
        torque = rated_torque_nm(pair, module, width, angle) if rated_nm is None else rated_nm
        most = bearable_torque_nm(pair, module, width, angle)
        torque = finite("rated_nm", torque, f"above 0 up to {most:.4g} N m, which the teeth bear", 1e-9, most)
        rig = Rig(pair, module, width, (speed, speed), (torque, torque), pressure_angle_deg=angle)
        rig = replace(rig, accuracy_classes=covering_classes(checked_rig(rig)))
        raw = parse_yaml(rig_text(rig, "single_stage"), "single_stage")
        return made({**raw, "states": {"others": None, "healthy": {}}}, number)


def made(raw: Mapping[str, Any], number: int) -> Gearbox:
    """Return a gearbox without points of its own."""
    return replace(draw(load_config(raw), number), points=())


def counts(argument: str, values: object, example: Counts) -> Counts:
    """Return whole numbers, as many as in an example.

    Raises
    ------
    UsageError
        If these are none.
    """
    if isinstance(values, Sequence) and len(values) == len(example) and all(type(value) is int for value in values):
        return tuple(values)
    raise refused(argument, repr(values), f"{len(example)} whole numbers, such as {example}")
