"""How the numbers of label columns are written: digits, single precision, the sign of zero.

A column that went through another program in one state keeps its values and loses digits. Source: derived.
"""

from __future__ import annotations

import numpy as np

FEW_DIGITS = 12
"""A number that was computed has 15 to 17."""


def digit_columns(name: str, values: np.ndarray) -> dict[str, np.ndarray]:
    """Return the numbers of a column (records,) float, (records,) float64 each; those that do not vary are left out.

    Numbers that are zero or undefined have no digits.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        is_single = values.astype(np.float32).astype(np.float64) == values
    few = np.array([_digits(value) < FEW_DIGITS for value in values.tolist()])
    written = np.isfinite(values) & (values != 0.0)
    found = {f"few digits of {name}": few & written, f"single precision of {name}": is_single & written}
    return _varied(found) | zero_signs(name, values)


def zero_signs(name: str, values: np.ndarray) -> dict[str, np.ndarray]:
    """Return which zeros of a column (records,) float have a minus sign; nothing where none or all have."""
    return _varied({f"sign of zero of {name}": (values == 0.0) & np.signbit(values)})


def _varied(columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    return {name: flags.astype(np.float64) for name, flags in columns.items() if flags.any() and not flags.all()}


def _digits(value: float) -> int:
    return len("".join(filter(str.isdigit, repr(value).split("e")[0])).strip("0"))
