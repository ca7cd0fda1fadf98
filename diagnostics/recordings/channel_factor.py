"""What a channel is multiplied by to be in the unit that is wanted: by the unit that the file states, or the user says.

Accelerations and voltages of accelerometers are turned into m/s^2. Any other quantity is taken as it is, or not at all.
"""

from __future__ import annotations

from pathlib import Path

from diagnostics.recordings.in_rig import in_rig
from diagnostics.recordings.units import (
    ACCELERATION,
    ACCELERATIONS,
    STANDARD_GRAVITY_M_S2,
    VOLTAGE,
    VOLTAGES,
    known_unit,
)
from siggen.errors import UsageError

ACCELERATION_UNIT = "m/s^2"
"""How sets and models write it."""
UNKNOWN_UNIT = "unknown"
"""That nobody names: levels are then compared with those of the same machine alone."""
ALLOWED = (*ACCELERATIONS, *VOLTAGES)


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
    known = known_unit(unit)
    if known is not None and known.quantity == ACCELERATION:
        return known.factor
    if known is None or known.quantity != VOLTAGE:
        raise UsageError(
            f"unit: received {unit!r}; allowed are {', '.join(ALLOWED)}. Without the unit the level of a recording "
            "means nothing to a model."
        )
    if sensitivity_mv_per_g is None or not sensitivity_mv_per_g > 0.0:
        raise UsageError(
            f"unit {unit}: received sensitivity {sensitivity_mv_per_g}; a voltage needs the accelerometer's, in mV per "
            f"g, from its calibration sheet: {in_rig('sensitivity_mv_per_g: 100')}"
        )
    return known.factor / sensitivity_mv_per_g * STANDARD_GRAVITY_M_S2


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
        Unit of the user, or `unknown`: as the file has it.
    mv_per_g : float, optional
        Sensitivity, for voltages.
    wanted : str, optional
        Unit that the values are wanted in; only accelerations are converted.

    Raises
    ------
    UsageError
        If nobody names a unit, file and user name different ones, the file an unknown one and the user none, or one
        of another quantity than is wanted, or as of `factor_to_m_s2`.
    """
    if wanted != ACCELERATION_UNIT:
        _check_same(path, column, stated or said, wanted)
        return 1.0
    known, named = known_unit(stated or ""), known_unit(said or "")
    if said == UNKNOWN_UNIT:
        if stated:
            raise UsageError(
                f"{path}: states the unit {stated[:40]!r} of {column}; the machine's references state none, so their "
                "levels cannot be compared. Make the machine again with its unit"
            )
        return 1.0
    if stated and known is not None and known.quantity not in (ACCELERATION, VOLTAGE):
        raise UsageError(
            f"{path}: states the unit {stated[:40]!r} of {column}, no acceleration ({known.quantity}); allowed are "
            f"{', '.join(ALLOWED)}. Name a column of an accelerometer, {in_rig('channels: {NAME: COLUMN}')}, or "
            f"correct the file"
        )
    if known is not None and said and known != named:
        raise UsageError(
            f"{path}: states the unit {stated} of {column}, the rig file {said}; leave `unit` out or correct the file"
        )
    if stated and known is None and not said:
        raise UsageError(
            f"{path}: states the unit {stated[:40]!r} of {column}; allowed are {', '.join(ALLOWED)}. Say what the "
            f"values are: {in_rig('unit: g')}"
        )
    if not (stated or said):
        raise UsageError(
            f"{path}: no unit of {column} is stated. Say what the values are, {in_rig('unit: g')}; "
            f"allowed are {', '.join(ALLOWED)}"
        )
    return factor_to_m_s2(said or stated or "", mv_per_g)


def _check_same(path: Path, column: str, found: str | None, wanted: str) -> None:
    """Refuse another unit than the one wanted, or none at all."""
    if found == wanted or (found and known_unit(found) == known_unit(wanted) is not None):
        return
    received = f"the unit {found[:40]!r}" if found else "no unit"
    way_out = f"Name a column in {wanted}, {in_rig('channels: {NAME: COLUMN}')}, or take a model of other channels"
    if not found:
        way_out = f"If the file holds {wanted}, say so: {in_rig(f'unit: {wanted}')}"
    raise UsageError(f"{path}: {column}: received {received}; allowed: {wanted}, as it is. {way_out}")
