"""What a column of a recording is, by its unit and its name: time, vibration, tacho, speed, angle, counter, or none."""

from __future__ import annotations

import re
from enum import StrEnum
from typing import NamedTuple

from diagnostics.recordings.units import (
    ACCELERATION,
    ANGLE,
    COUNTS,
    DISPLACEMENT,
    OTHER,
    SPEED,
    TIME,
    VELOCITY,
    VOLTAGE,
    known_unit,
)


class ColumnUse(StrEnum):
    """What a column is."""

    TIME = "time"
    VIBRATION = "vibration"
    TACHO = "tacho"
    SPEED = "speed"
    ANGLE = "angle"
    COUNTER = "counter"
    LABEL = "label"


class NamedRole(NamedTuple):
    """A role, and why it is taken."""

    role: ColumnUse
    why: str


WORDS: dict[ColumnUse, str] = {
    ColumnUse.TIME: "t|time|times|timestamps?|datetime|date|zeit|zeitstempel|uhrzeit|datum|temps|tiempo|tempo|epoch|"
    "unix|utc|clock|when|seconds?|secs?|milliseconds?|elapsed",
    ColumnUse.TACHO: "tachos?|tach|tachometers?|keyphasor|keyphaser|kph|pulses?|puls|impuls|trigger|trig|"
    "1xpulse|drehgeber",
    ColumnUse.SPEED: "speed|rpm|drehzahl|drehzahlen|revs|rotationspeed",
    ColumnUse.ANGLE: "angle|angles|winkel|drehwinkel|phase|theta|phi|azimuth",
    ColumnUse.COUNTER: "ticks?|counts?|counter|encoder|index|idx|samples?|nr|no|number|record|row|line|zeile|point|"
    "punkt|unnamed",
    ColumnUse.LABEL: "labels?|class|classes|state|status|fault|target|severity|comments?|kommentar|note|notes|flag|"
    "temperature|temperatur|temp|torque|drehmoment|load|last|pressure|druck|current|strom|humidity|power",
}
_PATTERNS = {role: re.compile(words) for role, words in WORDS.items()}
_VIBRATION = re.compile(
    r"acc\w*|vib\w*|beschl\w*|bearing|lager|[xyz]|axial|radial|vertical|horizontal|housing|casing|mic|micro\w*"
)
_BY_QUANTITY = {
    **dict.fromkeys((ACCELERATION, VELOCITY, DISPLACEMENT, VOLTAGE), ColumnUse.VIBRATION),
    TIME: ColumnUse.TIME,
    SPEED: ColumnUse.SPEED,
    ANGLE: ColumnUse.ANGLE,
    COUNTS: ColumnUse.VIBRATION,
    OTHER: ColumnUse.LABEL,
}


def named_role(name: str, unit: str) -> NamedRole:
    """Return the role that a name without its unit, and the unit, give a column.

    A unit decides; volts and counts leave it to the name, since they may be of anything. In a name its last word
    decides, then its first, unless it also speaks of vibration: `high_speed_bearing` is none of a speed.
    """
    stated = known_unit(unit)
    # a name that siggen or a user wrote as several words: shaftSpeed, shaft_speed, shaft speed 1
    words = [word.lower() for word in re.findall(r"[A-Z]+(?![a-zà-ÿ])|[A-Za-zà-ÿÀ-ß][a-zà-ÿ]*", name)]
    ends = (*words[-1:], *words[:1])
    by_name = next((role for word in ends for role, known in _PATTERNS.items() if known.fullmatch(word)), None)
    if name.lower() == "x_value":
        by_name = ColumnUse.TIME
    elif by_name and len(words) > 1 and any(_VIBRATION.fullmatch(word) for word in words):
        by_name = None
    if stated is not None and stated.quantity not in (VOLTAGE, COUNTS):
        role = _BY_QUANTITY[stated.quantity]
        if role is ColumnUse.TIME and by_name is ColumnUse.TACHO:
            role = ColumnUse.TACHO
        return NamedRole(role, f"unit {unit}")
    if by_name is not None:
        return NamedRole(by_name, "name")
    return NamedRole(ColumnUse.VIBRATION, "")
