"""What a channel is multiplied by to be in m/s^2: by the unit that the file states, or that the user says."""

from __future__ import annotations

from pathlib import Path

from diagnostics.recordings.acceleration_unit import factor_to_m_s2
from siggen.errors import UsageError

ASSUMED = "m/s2"
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


def channel_factor(path: Path, column: str, stated: str | None, said: str | None, mv_per_g: float | None) -> float:
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

    Raises
    ------
    UsageError
        If file and user name different units, the file an unknown one and the user none, or as of `factor_to_m_s2`.
    """
    stated, said = (SPELLINGS.get(unit.strip(), unit.strip()) if unit else None for unit in (stated, said))
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
