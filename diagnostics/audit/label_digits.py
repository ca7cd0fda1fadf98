"""How the numbers of label columns are written: digits, single precision, the sign of zero.

A column that went through another program in one state keeps its values and loses digits. Source: derived.
"""

from __future__ import annotations

import numpy as np

FEW_DIGITS = 12
"""A number that was computed has 15 to 17."""


def digit_columns(name: str, values: np.ndarray) -> dict[str, np.ndarray]:
    """Return the numbers of a column (records,) float, (records,) float64 each; those that do not vary are left out."""
    known = np.isfinite(values)
    if not known.any():
        return {}
    with np.errstate(over="ignore"):
        is_single = values.astype(np.float32).astype(np.float64) == values
    found = {
        f"few digits of {name}": np.array([_digits(value) < FEW_DIGITS for value in values.tolist()], dtype=np.float64),
        f"single precision of {name}": is_single.astype(np.float64),
        f"sign of zero of {name}": ((values == 0.0) & np.signbit(values)).astype(np.float64),
    }
    return {column: np.where(known, numbers, 0.0) for column, numbers in found.items() if np.ptp(numbers[known]) > 0.0}


def _digits(value: float) -> int:
    return len(repr(value).split("e")[0].replace(".", "").strip("-0"))
