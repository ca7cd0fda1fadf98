"""Units a recording may come in, and the factor that turns them into m/s^2."""

from __future__ import annotations

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
