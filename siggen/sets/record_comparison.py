"""In what a stored record differs from the same one simulated again: in bits, or by more than rounding does."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from siggen.dataset.reading import as_internals, as_record
from siggen.dataset.simulated_rows import SimulatedRows
from siggen.errors import counted
from siggen.gearbox.design import SetDesign

LABEL_TOLERANCE = 1e-6
"""Relative difference that other instructions and versions may make in a label: well above rounding, below meaning."""

PULSE_TOLERANCE_S = 1e-9


def result_difference(
    design: SetDesign,
    stored: Mapping[str, Any],
    internals: Mapping[str, Any] | None,
    result: SimulatedRows,
    *,
    exact: bool,
) -> str:
    """Return in what a stored record differs from the result that holds it alone, or an empty string."""
    if result.failures:
        return f"now fails: {result.failures[0].status} ({result.failures[0].reason})"
    batch = result.internals
    again = as_internals(batch) if batch is not None and batch.num_rows else None
    found = difference(design, stored, as_record(result.rows), exact=exact)
    return found or internal_difference(internals, again, exact=exact)


def difference(design: SetDesign, stored: Mapping[str, Any], again: Mapping[str, Any], *, exact: bool) -> str:
    """Return in what two versions of a record differ, or an empty string."""
    steps = {} if exact else _steps(design)
    if stored.keys() != again.keys():
        return f"it has other columns: {', '.join(sorted(stored.keys() ^ again.keys()))[:80]}"
    for name, before in stored.items():
        now = again[name]
        if isinstance(before, np.ndarray):
            tolerance = steps.get(name, 0.0 if exact else PULSE_TOLERANCE_S)
            if before.shape != now.shape:
                return f"{name} has {counted(len(now), 'value')} instead of {len(before)}"
            largest = float(np.max(np.abs(before.astype(float) - now), initial=0.0))
            if largest > tolerance or (exact and before.tobytes() != now.tobytes()):
                return f"{name} differs by up to {largest:.3g} (allowed {tolerance:.3g})"
        elif not _same_label(before, now, exact=exact):
            return f"{name} is {now} instead of {before}"
    return ""


def internal_difference(stored: Mapping[str, Any] | None, again: Mapping[str, Any] | None, *, exact: bool) -> str:
    """Return in which internal quantity two versions of a record differ, or an empty string."""
    if stored is None or again is None:
        return "" if stored is again else "its internal quantities are stored but not asked for, or missing"
    if stored.keys() != again.keys():
        return f"it has the internal quantities {', '.join(again)} instead of {', '.join(stored)}"
    for name, now in again.items():
        before, after = stored[name].astype(float), now.astype(float)
        apart = np.isnan(after)  # pairs that do not touch
        if (np.isnan(before) != apart).any():
            return f"internal quantity {name} differs in where it is NaN"
        largest = float(np.abs(before - after)[~apart].max(initial=0.0))
        tolerance = 0.0 if exact else LABEL_TOLERANCE * float(np.abs(after[~apart]).max(initial=0.0))
        if largest > tolerance or (exact and stored[name].tobytes() != now.tobytes()):
            return f"internal quantity {name} differs by up to {largest:.3g} (allowed {tolerance:.3g})"
    return ""


def _same_label(before: object, now: object, *, exact: bool) -> bool:
    if exact or not isinstance(before, float) or not isinstance(now, float):
        return before == now
    return before == now or abs(before - now) <= LABEL_TOLERANCE * max(1.0, abs(before))


def _steps(design: SetDesign) -> dict[str, float]:
    """Return the converter's step of every signal column; without one, the rounding of float32 at full range."""
    from siggen.sensing.measurement import converter_step

    steps: dict[str, float] = {}
    for sensor in design.sensors:
        step = sensor.converter_step or converter_step(sensor.limit, 24)
        steps |= {sensor.quantity.column(name): step for name, _ in sensor.channels}
    return steps
