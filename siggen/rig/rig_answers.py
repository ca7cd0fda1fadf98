"""A rig from what a user wrote: numbers with their units, and proposals for what was left out."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

from siggen.errors import UsageError
from siggen.rig.rating import FACE_OVER_MODULE, RULE, proposed_face_width_mm, rated_torque_nm
from siggen.rig.rig import Pair, Rig, checked_rig

QUESTIONS = {
    "teeth": "teeth of pinion and gear, such as 25,56",
    "module": "module [mm]",
    "speed": "speed of the pinion, one or lowest,highest: 24.1667 [Hz], 1450rpm or 1450/60",
}
"""What has to be said, and how; face width and torque are proposed."""
SPEED = "one speed in Hz, or the lowest and the highest with a comma between; also 1450rpm and 1450/60"
ONE_OR_TWO = "one number, or the lowest and the highest with a comma between"
SHIFTS = "one number, or two with a comma between, pinion first"
_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_SPEED = re.compile(rf"({_NUMBER})(?:/({_NUMBER}))?\s*(hz|rpm)?", re.IGNORECASE | re.ASCII)


def missing_answers(answers: Mapping[str, str]) -> list[str]:
    """Return the options that have to be given and were not, in their order."""
    return [option for option in QUESTIONS if not answers.get(option, "").strip()]


def refuse_missing(options: list[str]) -> None:
    """Raise if there are any.

    Raises
    ------
    UsageError
        Names all of them at once, and what each of them is.
    """
    if options:
        lines = [f"--{option}: received nothing; give the {QUESTIONS[option]}" for option in options]
        raise UsageError("\n  ".join(["what describes the machine is missing:", *lines] if len(lines) > 1 else lines))


def rig_of(
    answers: Mapping[str, str],
    sensors: int = 2,
    pressure_angle_deg: float = 20.0,
    *,
    damage: str = "spalls",
    severities: int = 3,
) -> tuple[Rig, dict[str, str]]:
    """Return the rig, and a sentence on each number that was proposed: how and from which source.

    Parameters
    ----------
    answers : mapping
        Option of `siggen init`, without dashes -> what was written; `face-width`, `torque`, `fs` and `shift`
        may be empty.

    Raises
    ------
    UsageError
        If something is missing, is no number, or lies outside `LIMITS`.
    """
    refuse_missing(missing_answers(answers))
    first, second = _two("teeth", ",".join(re.split("[,/]", answers["teeth"])))  # pages write 25/56
    teeth = round(first), round(second)
    if teeth != (first, second):
        raise _wrong("teeth", answers["teeth"], "two whole numbers with a comma between, pinion first")
    module_mm, proposals = _one("module", answers["module"]), {}
    width = answers.get("face-width", "")
    width_mm = _one("face-width", width) if width else float(f"{proposed_face_width_mm(module_mm):.4g}")
    if not width:
        proposals["face-width"] = (
            f"{width_mm:g} mm, {FACE_OVER_MODULE:g} modules (usual: 8 to 16; Norton, Machine Design)"
        )
    rig = Rig(teeth, module_mm, width_mm, _speeds(answers["speed"]), (1.0, 1.0), sensors, pressure_angle_deg)
    if fs := answers.get("fs", ""):
        rig = replace(rig, fs_hz=_one("fs", fs))
    shift = answers.get("shift", "")
    shifts = _numbers("shift", shift, SHIFTS) if shift else []
    if len(shifts) > 2:
        raise _wrong("shift", shift, SHIFTS)
    pinion, gear = (*shifts, 0.0, 0.0)[:2]
    rig = checked_rig(replace(rig, shifts=(pinion, gear), damage=damage, severities=severities))
    torque = answers.get("torque", "")
    if not torque:
        rated = float(f"{rated_torque_nm(teeth, module_mm, width_mm, pressure_angle_deg):.3g}")
        proposals["torque"] = f"{rated:g} N m, what the gears are rated for ({RULE})"
        return checked_rig(replace(rig, torque_nm=(rated, rated))), proposals
    return checked_rig(replace(rig, torque_nm=_range("torque", torque))), proposals


def _speeds(text: str) -> Pair:
    """Return lowest and highest speed [Hz]; a unit behind the last number holds for both."""
    parts = [part.strip() for part in text.split(",")]
    found = [_SPEED.fullmatch(part) for part in parts]
    if len(parts) > 2 or not all(found):
        raise _wrong("speed", text, SPEED)
    last = (found[-1][3] or "hz").lower()  # type: ignore[index]
    values = []
    for form in found:
        assert form is not None
        value, divisor, unit = float(form[1]), float(form[2] or 1.0), (form[3] or last).lower()
        if divisor == 0.0:
            raise _wrong("speed", text, SPEED)
        values.append(value / divisor / (60.0 if unit == "rpm" else 1.0))
    return values[0], values[-1]


def _numbers(option: str, text: str, allowed: str) -> list[float]:
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise _wrong(option, text, allowed) from None


def _one(option: str, text: str) -> float:
    values = _numbers(option, text, "one number")
    if len(values) != 1:
        raise _wrong(option, text, "one number")
    return values[0]


def _two(option: str, text: str) -> Pair:
    allowed = f"two {'whole ' if option == 'teeth' else ''}numbers with a comma between, pinion first"
    values = _numbers(option, text, allowed)
    if len(values) != 2:
        raise _wrong(option, text, allowed)
    return values[0], values[1]


def _range(option: str, text: str) -> Pair:
    values = _numbers(option, text, ONE_OR_TWO)
    if len(values) > 2:
        raise _wrong(option, text, ONE_OR_TWO)
    return values[0], values[-1]


def _wrong(option: str, text: str, allowed: str) -> UsageError:
    return UsageError(f"--{option}: received '{text}'; allowed: {allowed}")
