"""Units as recorders write them, in the name of a column or in a row of units, and the quantity of each."""

from __future__ import annotations

import re
from typing import NamedTuple

STANDARD_GRAVITY_M_S2 = 9.80665
ACCELERATION, VELOCITY, DISPLACEMENT, VOLTAGE = "acceleration", "velocity", "displacement", "voltage"
TIME, SPEED, ANGLE, COUNTS, OTHER = "time", "speed", "angle", "counts", "other quantity"


class Unit(NamedTuple):
    """A unit: its spelling here, its quantity, and its value in m/s2, m/s, m, mV, s, Hz or turns."""

    text: str
    quantity: str
    factor: float


def _units(quantity: str, **factors: float) -> dict[str, Unit]:
    return {text: Unit(text, quantity, factor) for text, factor in factors.items()}


_G = STANDARD_GRAVITY_M_S2
KNOWN = {
    **_units(ACCELERATION, **{"m/s2": 1.0, "mm/s2": 1e-3, "g": _G, "mg": 1e-3 * _G, "ug": 1e-6 * _G}),
    **_units(ACCELERATION, **{"in/s2": 0.0254, "ft/s2": 0.3048}),
    **_units(VELOCITY, **{"m/s": 1.0, "mm/s": 1e-3, "cm/s": 1e-2, "um/s": 1e-6, "in/s": 0.0254}),
    **_units(DISPLACEMENT, **{"m": 1.0, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "mil": 2.54e-5, "in": 0.0254}),
    **_units(VOLTAGE, V=1e3, mV=1.0, uV=1e-3),
    **_units(TIME, s=1.0, ms=1e-3, us=1e-6, ns=1e-9, min=60.0, h=3600.0),
    **_units(SPEED, **{"Hz": 1.0, "rpm": 1.0 / 60.0, "rad/s": 0.15915494309189535, "deg/s": 1.0 / 360.0}),
    **_units(ANGLE, rad=0.15915494309189535, deg=1.0 / 360.0, rev=1.0),
    **_units(COUNTS, counts=1.0),
}
ACCELERATIONS = tuple(text for text, unit in KNOWN.items() if unit.quantity == ACCELERATION)
VOLTAGES = tuple(text for text, unit in KNOWN.items() if unit.quantity == VOLTAGE)

SPELLINGS = {
    **dict.fromkeys(("m/s^2", "m/s**2", "m/s/s", "m/sec2", "m/sec^2", "mps2", "m/ss", "ms-2", "ms^-2"), "m/s2"),
    **dict.fromkeys(("mm/s^2", "mm/s**2", "mm/s/s", "mmps2"), "mm/s2"),
    **dict.fromkeys(("in/s^2", "in/sec^2"), "in/s2"),
    **dict.fromkeys(("ft/s^2", "ft/sec^2"), "ft/s2"),
    **dict.fromkeys(("gn", "g0", "gs", "g's", "G"), "g"),
    **dict.fromkeys(("mm/sec", "mmps"), "mm/s"),
    **dict.fromkeys(("ips", "in/sec"), "in/s"),
    **dict.fromkeys(("mils", "thou"), "mil"),
    **dict.fromkeys(("micron", "microns"), "um"),
    **dict.fromkeys(("Volt", "Volts", "volt", "volts"), "V"),
    **dict.fromkeys(("sec", "secs", "second", "seconds", "S", "Sek", "sek"), "s"),
    **dict.fromkeys(("msec", "millisec", "milliseconds", "millisecond"), "ms"),
    **dict.fromkeys(("usec", "microsec", "microseconds", "microsecond"), "us"),
    **dict.fromkeys(("nsec", "nanoseconds"), "ns"),
    **dict.fromkeys(("hz", "HZ"), "Hz"),
    **dict.fromkeys(("RPM", "Rpm", "1/min", "min-1", "min^-1", "U/min", "r/min", "rev/min"), "rpm"),
    **dict.fromkeys(("rps", "rev/s", "r/s", "1/s", "U/s"), "Hz"),
    **dict.fromkeys(("rad/sec",), "rad/s"),
    **dict.fromkeys(("°", "degree", "degrees", "Grad"), "deg"),
    **dict.fromkeys(("radian", "radians"), "rad"),
    **dict.fromkeys(("revs", "turn", "turns", "revolution", "revolutions"), "rev"),
    **dict.fromkeys(("count", "cts", "tick", "ticks", "LSB", "lsb", "digits", "ADC", "adc", "raw"), "counts"),
    "minutes": "min",
}
"""Other spellings of known units."""

_OTHER = re.compile(
    r"[kMmcduµn]?(N|Pa|bar|N[ *·]?m|m/m|A|W|K|J|g/l)|kg|lbf|psi|inHg|°[CFK]|deg ?[CF]|[CF]|dB.*|%|strain|ue|L/min",
)
"""Units that are certainly not of vibration, time or turning."""

_BRACKETED = re.compile(r"^(?P<name>.*?)\s*[\[({]\s*(?P<unit>[^\[\](){}]*?)\s*[\])}]\s*$")
_BEHIND = re.compile(r"^(?P<name>.*\S)(?:\s+/\s*|\s*/\s+|,\s*|\s+in\s+|\s+)(?P<unit>\S+)$")
_JOINED = re.compile(r"^(?P<name>.*?)[_.\- ](?P<unit>[A-Za-zµ0-9]+(?:_(?:s2|s|s_2))?)$")
_JOINTS = {
    **dict.fromkeys(("m_s2", "ms2", "mps2", "m_s_2"), "m/s2"),
    **dict.fromkeys(("mm_s2", "mmps2"), "mm/s2"),
    **dict.fromkeys(("mm_s", "mmps"), "mm/s"),
    **dict.fromkeys(("mV", "mv"), "mV"),
    **dict.fromkeys(("volts", "volt"), "V"),
    **dict.fromkeys(("ms", "msec"), "ms"),
    **dict.fromkeys(("us", "usec"), "us"),
    **dict.fromkeys(("sec", "seconds"), "s"),
    **dict.fromkeys(("rpm", "RPM"), "rpm"),
    **dict.fromkeys(("hz", "Hz"), "Hz"),
    **dict.fromkeys(("rev", "revs", "turns"), "rev"),
    **dict.fromkeys(("mil", "mils"), "mil"),
    **dict.fromkeys(("ips", "in_s"), "in/s"),
    **dict.fromkeys(("Nm", "nm"), "N m"),
    "rad_s": "rad/s",
    **{unit: unit for unit in ("mg", "ug", "ns", "rad", "deg", "counts", "mm", "um", "degC")},
}
"""Endings of names that nothing but a unit explains; a single letter may as well count channels."""
_LETTERS = {
    "g": ("g", re.compile(r"acc|vib|beschl|(^|[_\W])a_?[xyz]?\d*$", re.IGNORECASE)),
    "G": ("g", re.compile(r"acc|vib|beschl|(^|[_\W])a_?[xyz]?\d*$", re.IGNORECASE)),
    "s": ("s", re.compile(r"^(t|time|zeit|timestamp|temps|tacho|pulse|pulses)$", re.IGNORECASE)),
    "V": ("V", re.compile(r"volt|spannung|(^|[_\W])u\d*$", re.IGNORECASE)),
}
"""Single letters that are a unit behind certain names."""


def known_unit(text: str) -> Unit | None:
    """Return the unit that a text spells, brackets or not; of other quantities too; None for what is not known."""
    plain = text.strip().strip("[](){}").strip().replace("²", "2").replace("µ", "u").replace("μ", "u")
    plain = plain.replace("⋅", "·").replace("·s-2", "/s2").replace("m s-2", "m/s2")
    for spelled in (plain, plain.replace(" ", "")):
        unit = KNOWN.get(SPELLINGS.get(spelled, spelled))
        if unit is not None:
            return unit
    return Unit(plain, OTHER, 1.0) if plain and _OTHER.fullmatch(plain) else None


def unit_of_name(name: str) -> tuple[str, str]:
    """Return the name of a column without its unit, and the unit as written there; empty where it names none.

    A unit stands in brackets, behind a stroke, comma or blank, or behind the last underscore; there a single letter is
    one only behind a word that says so, such as acc_g or time_s.
    """
    if found := _BRACKETED.match(name):
        return found["name"].strip() or name, found["unit"]
    if (found := _BEHIND.match(name)) and (known_unit(found["unit"]) and len(found["unit"]) > 1):
        return found["name"].rstrip(" ,/"), found["unit"]
    for pattern in (_JOINED, _BEHIND):
        if found := pattern.match(name):
            letter, after = _LETTERS.get(found["unit"], ("", None))
            if after is not None and after.search(found["name"]):
                return found["name"], letter
            if pattern is _BEHIND and re.search(r"/\s*\S+$|,", name) and known_unit(found["unit"]):
                return found["name"].rstrip(" ,/"), found["unit"]
    for ending, unit in sorted(_JOINTS.items(), key=lambda item: -len(item[0])):
        for mark in "_.- ":
            if name.endswith(mark + ending) and len(name) > len(ending) + 1:
                return name[: -len(ending) - 1], unit
    return name, _JOINTS.get(name, "") if name in ("rpm", "RPM") else ""
