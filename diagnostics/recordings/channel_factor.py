"""What a channel is multiplied by to be in the unit that is wanted: by the unit that the file states, or the user says.

Accelerations and voltages of accelerometers are turned into m/s^2. Any other quantity is taken as it is, or not at all.
"""

from __future__ import annotations

import re
from pathlib import Path

from siggen.errors import UsageError

STANDARD_GRAVITY_M_S2 = 9.80665
ACCELERATIONS = {
    "m/s2": 1.0,
    "m/s^2": 1.0,
    "mm/s2": 1e-3,
    "g": STANDARD_GRAVITY_M_S2,
    "mg": 1e-3 * STANDARD_GRAVITY_M_S2,
}
VOLTAGES_MV = {"mV": 1.0, "V": 1000.0}

ASSUMED = "m/s2"
ACCELERATION_UNIT = "m/s^2"
"""How sets and models write it."""
SPELLINGS = {
    "m/s²": "m/s2",
    "m/s^2": "m/s2",
    "m/s**2": "m/s2",
    "m/s/s": "m/s2",
    "mm/s²": "mm/s2",
    "mm/s^2": "mm/s2",
    "gn": "g",
    "Volts": "V",
    "Volt": "V",
}
"""Other spellings of known units, as recorders write them."""
KNOWN = ("m/s2", "mm/s2", "g", "mg", "mV", "V")
OTHER_QUANTITY = re.compile(
    r"[kMmcduµn]?(N|Pa|bar|N[ *·]?m|m/m|m/s|m|rad|rad/s|A|W|s|Hz|K)|lbf|psi|in|in/s|ips|rpm|1/min|°|deg|(°|deg ?)[CF]",
    re.IGNORECASE,
)
"""Units that are certainly not of an acceleration, nor of an accelerometer's voltage."""


def factor_to_m_s2(unit: str, sensitivity_mv_per_g: float | None = None) -> float:
    """Return what a value in the unit is multiplied by.

    Parameters
    ----------
    unit : str
        m/s2, mm/s2, g, mg, mV or V.
    sensitivity_mv_per_g : float, optional
        Of the accelerometer; needed for voltages, and only there.

    Raises
    ------
    UsageError
        If the unit is unknown, or a voltage comes without a sensitivity, or the sensitivity is not positive.
    """
    if unit in ACCELERATIONS:
        return ACCELERATIONS[unit]
    if unit not in VOLTAGES_MV:
        raise UsageError(
            f"unit: received {unit!r}; allowed are {', '.join((*ACCELERATIONS, *VOLTAGES_MV))}. Without the unit the "
            "level of a recording means nothing to a model."
        )
    if sensitivity_mv_per_g is None or not sensitivity_mv_per_g > 0.0:
        raise UsageError(
            f"unit {unit}: received sensitivity {sensitivity_mv_per_g}; a voltage needs the accelerometer's, in mV per "
            "g, from its calibration sheet: --sensitivity 100"
        )
    return VOLTAGES_MV[unit] / sensitivity_mv_per_g * STANDARD_GRAVITY_M_S2


def channel_factor(
    path: Path,
    column: str,
    stated: str | None,
    said: str | None,
    mv_per_g: float | None,
    wanted: str = ACCELERATION_UNIT,
) -> float:
    """Return the factor.

    Parameters
    ----------
    path, column : Path, str
        Named in messages.
    stated : str, optional
        Unit in the file.
    said : str, optional
        Unit of the user; m/s2 is assumed where nobody names one.
    mv_per_g : float, optional
        Sensitivity, for voltages.
    wanted : str, optional
        Unit that the values are wanted in; only accelerations are converted.

    Raises
    ------
    UsageError
        If file and user name different units, the file an unknown one and the user none, or one of another quantity
        than is wanted, or as of `factor_to_m_s2`.
    """
    stated, said = (SPELLINGS.get(unit.strip(), unit.strip()) if unit else None for unit in (stated, said))
    if wanted != ACCELERATION_UNIT:
        _check_same(path, column, stated or said, wanted)
        return 1.0
    if stated and stated not in KNOWN and OTHER_QUANTITY.fullmatch(stated):
        raise UsageError(
            f"{path}: states the unit {stated[:40]!r} of {column}, which is no acceleration; allowed are "
            f"{', '.join(KNOWN)}. Name a column of an accelerometer (--channel NAME=COLUMN), or correct the file"
        )
    if stated in KNOWN and said and said != stated:
        raise UsageError(
            f"{path}: states the unit {stated} of {column}, received --unit {said}; leave --unit out or "
            "correct the file"
        )
    if stated and stated not in KNOWN and not said:
        raise UsageError(
            f"{path}: states the unit {stated[:40]!r} of {column}; allowed are {', '.join(KNOWN)}. Say what the values "
            "are, e.g. --unit g"
        )
    return factor_to_m_s2(said or stated or ASSUMED, mv_per_g)


def _check_same(path: Path, column: str, found: str | None, wanted: str) -> None:
    """Refuse another unit than the one wanted, or none at all."""
    if found == wanted:
        return
    received = f"the unit {found[:40]!r}" if found else "no unit"
    way_out = f"Name a column in {wanted} (--channel NAME=COLUMN), or take a model of other channels"
    if not found:
        way_out = f"If the file holds {wanted}, say so: --unit {wanted}"
    raise UsageError(f"{path}: {column}: received {received}; allowed: {wanted}, as it is. {way_out}")
