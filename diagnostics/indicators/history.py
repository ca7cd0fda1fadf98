"""Indicators with a history, NA4, NA4* and NB4: the states of one specimen stand for the records of a machine in time.

A history is one specimen at one operating point, repeat and channel; its records stand in order of damaged area, then
of the state's place in the configuration. So these indicators know the healthy level of their own specimen, which the
others do not. All have one form: fourth central moment of the judged record over the squared mean variance of the
history. Formulas take those moments by name: of the residual, or of the envelope round the dominant mesh harmonic.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from diagnostics.indicators.indicator import CONDITION_METRICS, INDICATORS, indicator
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.gear_train import PAIR, MeshNames
from diagnostics.records.state_classes import HEALTHY

NO_HISTORY = "no record of the history varies, or one of them is unusable"


def central_moments(signal: np.ndarray) -> tuple[float, float]:
    """Return the fourth and the second central moment."""
    squared = np.square(signal - signal.mean())
    return float(np.mean(squared * squared)), float(np.mean(squared))


def moment_over_history(fourth: float, variances: Sequence[float]) -> float:
    """Return mu_4 / mean(mu_2 of the history)^2; NaN where that mean is zero or anything is undefined.

    Parameters
    ----------
    fourth : float
        Fourth central moment of the record that is judged.
    variances : sequence of float
        Variances of the records that count.
    """
    variance = float(np.mean(np.asarray(variances, dtype=np.float64))) if len(variances) else math.nan
    return fourth / variance**2 if variance > 0.0 else math.nan


@indicator(
    "na4_{shaft}",
    "NA4",
    signal="residual, with the specimen's milder states as history",
    formula="μ₄(r)/(mean of μ₂ over the history up to this record)²",
    known="first record: Gaussian 3, sine 1.5",
    undefined=NO_HISTORY,
    source=f"Zakrajsek et al. 1993; {CONDITION_METRICS} takes residuals in chronological order",
)
def na4(residual_fourth: float, residual_variances: Sequence[float]) -> float:
    """Return N sum (r_M - mean)^4 / {(1/M) sum_j sum (r_j - mean)^2}^2 of the last record.

    Parameters
    ----------
    residual_fourth : float
        Fourth central moment of the judged residual (average without shaft orders and mesh harmonics, sidebands kept).
    residual_variances : sequence of float
        Variances of the residuals up to and including it.

    Notes
    -----
    With one record: the kurtosis of the residual (Gaussian 3, sine 1.5). Unlike kurtosis it grows with the level of the
    residual against the history. Source: Zakrajsek, Townsend & Decker 1993.
    """
    return moment_over_history(residual_fourth, residual_variances)


@indicator(
    "na4_star_{shaft}",
    "NA4*",
    signal="residual, with the specimen's healthy records as history",
    formula="μ₄(r)/(mean of μ₂ over the healthy records)²",
    known="healthy: Gaussian 3; a c-fold residual: 3 c⁴",
    undefined="the specimen has no usable healthy record at this operating point",
    source="Decker et al. 1994",
)
def na4_star(residual_fourth: float, healthy_residual_variances: Sequence[float]) -> float:
    """Return mu_4 of the last residual over the squared mean variance of the healthy records among them.

    Decker freezes the denominator where the variance leaves its statistical limits; in a simulated set it is known
    which records are healthy. Gaussian, healthy: 3. A residual that is c times as strong gives 3 c^4, where NA4 levels
    off. NaN without a healthy record. Source: Decker, Handschuh & Zakrajsek 1994.
    """
    return moment_over_history(residual_fourth, healthy_residual_variances)


@indicator(
    "nb4_{shaft}",
    "NB4",
    signal="envelope of the average within six sidebands of the dominant mesh line, with the same history",
    formula="NA4's form",
    known="first record: narrow-band Gaussian 3.25",
    undefined=NO_HISTORY,
    source="Zakrajsek et al. 1994",
)
def nb4(envelope_fourth: float, envelope_variances: Sequence[float]) -> float:
    """Return NA4's form for s = |b + j H(b)| of the band b round the mesh harmonic that dominates in the first record.

    Envelope of band-passed Gaussian noise (Rayleigh): 3.245 at the first record. NaN where no envelope varies. Source:
    Zakrajsek, Handschuh & Decker 1994.
    """
    return moment_over_history(envelope_fourth, envelope_variances)


def dominant_harmonic(lines: np.ndarray, teeth: int, harmonics: int) -> int:
    """Return the mesh harmonic 1 ... harmonics of largest amplitude, from line amplitudes at whole shaft orders."""
    return 1 + int(np.argmax(lines[teeth : harmonics * teeth + 1 : teeth]))


def histories(labels: Mapping[str, np.ndarray]) -> list[np.ndarray]:
    """Return the rows of each history in order.

    Parameters
    ----------
    labels : mapping of str to (n,)
        Columns `specimen_id`, `operating_point_id`, `repeat`, `damaged_area_mm2`, `state_id`.
    """
    owner = np.stack([labels[name] for name in ("specimen_id", "operating_point_id", "repeat")], axis=1)
    order = np.lexsort((labels["state_id"], labels["damaged_area_mm2"]))
    _, group = np.unique(owner, axis=0, return_inverse=True)
    group = group.reshape(-1)[order]
    return [order[group == number] for number in range(int(group.max()) + 1)]


def history_indicators(
    labels: Mapping[str, np.ndarray], moments: Mapping[str, np.ndarray], mesh: MeshNames = PAIR[0]
) -> dict[str, np.ndarray]:
    """Return the indicators with a history of the gears of a mesh in one channel, (n,) each by column.

    Parameters
    ----------
    labels : mapping of str to (n,)
        As of `histories`, and `fault`.
    moments : mapping of str to (n,)
        Moments of every record of the channel by name, see `ChannelSignals.moments`; NaN where unusable.
    mesh : MeshNames
    """
    known = [entry for entry in INDICATORS if entry.history]
    count, settings = len(labels["state_id"]), IndicatorSettings()
    named = {(entry, chosen["shaft"]): column for entry in known for column, chosen in entry.columns(settings, mesh)}
    columns = {column: np.full(count, np.nan) for column in named.values()}
    for rows in histories(labels):
        healthy = labels["fault"][rows] == HEALTHY
        for shaft in mesh.gears:
            for last, row in enumerate(rows.tolist()):
                told = _moments_of(moments, shaft, rows[: last + 1], healthy[: last + 1])
                for entry in known:
                    columns[named[entry, shaft]][row] = entry.function(
                        **{name: told[name] for name in entry.parameters}
                    )
    return columns


def _moments_of(
    moments: Mapping[str, np.ndarray], shaft: str, rows: np.ndarray, healthy: np.ndarray
) -> dict[str, float | list[float]]:
    """Return what a formula with a history may take, of the history's records up to the judged one, the last."""
    missing = np.full(len(healthy), np.nan)

    def of(name: str) -> np.ndarray:
        return moments[name][rows] if name in moments else missing

    dominant = of(f"dominant_{shaft}")[0]
    which = f"{shaft}_h{int(dominant)}" if np.isfinite(dominant) else "none"
    second = of(f"residual_second_{shaft}")
    return {
        "residual_fourth": float(of(f"residual_fourth_{shaft}")[-1]),
        "residual_variances": second.tolist(),
        "healthy_residual_variances": second[healthy].tolist(),
        "envelope_fourth": float(of(f"envelope_fourth_{which}")[-1]),
        "envelope_variances": of(f"envelope_second_{which}").tolist(),
    }
