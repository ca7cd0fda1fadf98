"""Baselines of remaining life: what age, indicators and true areas tell of gearboxes that were not trained on.

Age: Weibull law of all lives, those of gearboxes that were taken out as at least as long, given that the gearbox still
runs. A network on averages: `life_network`. Everything else: gradient boosting of quantiles on the rows of failed
gearboxes. Source: standard literature.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.base.single_thread import single_thread
from diagnostics.statistics.life_scores import QUANTILES, unit_folds

if TYPE_CHECKING:
    from diagnostics.training.average_rows import AveragedRecords

FOLDS = 5
WORST_TEETH = 3
CONSTANT, AGE, RMS, FIVE, FIVE_AGE = "constant", "age", "RMS", "five indicators", "five indicators, age"
HISTORY, DEBRIS = "five indicators with their history, age", "oil debris, age"
NETWORK = "sequence network on averages, age"
AREAS, OUTLOOK = "true areas of the three worst teeth, age", "the true state itself"
Predictor = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Rows to learn from and rows to predict, (n,) bool each; returns the latter's quantiles, (m, 3) in hours."""


@dataclass(frozen=True, slots=True)
class Inspections:
    """Inspections of a set of lives, with what may be known at each.

    Attributes
    ----------
    record_id, specimen : (n,) int
        `record_id` of an inspection's first record.
    split : (n,) str
    age_h, rul_h, observed_h : (n,) float64
        Age, remaining life (NaN where a gearbox was taken out), age at which its gearbox was last known to run.
    indicators : dict of str to (n, columns) float64
        The means over an inspection's records, by indicator: of every channel and gear.
    history : (n, columns) float64
        Likewise NA4 and NB4, which compare with the gearbox's own inspections so far.
    sample_bytes : (n, columns) float64
        Likewise what the samples look like as bytes.
    debris_mg : (n,) float64
        What a counter in the oil says.
    worst_shares : (n, 3) float64
        True areas of the worst teeth over that of a flank, 0 where none is pitted.
    outlook_h : (n, 3) float64
        Quantiles of the remaining life over continuations of the true state.
    averages : AveragedRecords, optional
        Averages of one turn of the first shaft, means over an inspection's records; None where records are too short.
    """

    record_id: np.ndarray
    specimen: np.ndarray
    split: np.ndarray
    age_h: np.ndarray
    rul_h: np.ndarray
    observed_h: np.ndarray
    indicators: dict[str, np.ndarray]
    history: np.ndarray
    sample_bytes: np.ndarray
    debris_mg: np.ndarray
    worst_shares: np.ndarray
    outlook_h: np.ndarray
    averages: AveragedRecords | None = None

    @property
    def median_life_h(self) -> float:
        """Median life of the gearboxes that failed."""
        _, first = np.unique(self.specimen, return_index=True)
        return float(np.nanmedian(self.age_h[first] + self.rul_h[first]))


@single_thread()
def baseline_predictions(found: Inspections, seed: int, *, network: bool) -> dict[str, np.ndarray]:
    """Return what each baseline predicts, (n, 3) in hours at `QUANTILES`, always by the other gearboxes.

    The network is left out where it is not wanted or there are no averages.
    """
    return {
        **{name: _by_folds(found, seed, predict) for name, predict in predictors(found, seed).items()},
        **(_by_network(found, found.averages, seed) if network and found.averages else {}),
        AREAS: tree_predictions(np.concatenate([found.worst_shares, found.age_h[:, None]], axis=1), found, seed),
        OUTLOOK: found.outlook_h,
    }


def predictors(found: Inspections, seed: int) -> dict[str, Predictor]:
    """Return the baselines that see what sensors tell, without the network."""
    age, five = found.age_h[:, None], _five(found)
    seen = {
        RMS: found.indicators["rms"],
        FIVE: five,
        FIVE_AGE: np.concatenate([five, age], axis=1),
        HISTORY: _with_history(found),
        DEBRIS: np.stack([found.debris_mg, found.age_h], axis=1),
    }
    return {
        CONSTANT: partial(_constant, found),
        AGE: partial(_by_age, found),
        **{name: partial(_trees, (values, found.rul_h), seed, QUANTILES) for name, values in seen.items()},
    }


def history_predictions(found: Inspections, seed: int) -> np.ndarray:
    """Return what `HISTORY` predicts alone, as of `baseline_predictions`."""
    return tree_predictions(_with_history(found), found, seed)


def _five(found: Inspections) -> np.ndarray:
    return np.concatenate(list(found.indicators.values()), axis=1)


def _with_history(found: Inspections) -> np.ndarray:
    five = _five(found)
    return np.concatenate([five, _changes(five, found.specimen), found.history, found.age_h[:, None]], axis=1)


@single_thread()
def tree_predictions(
    values: np.ndarray, found: Inspections, seed: int, quantiles: Sequence[float] = QUANTILES
) -> np.ndarray:
    """Return what trees predict that see some columns (n, k) alone, always by the other gearboxes.

    That is (n, quantiles) in hours.
    """
    return _by_folds(found, seed, partial(_trees, (values, found.rul_h), seed, quantiles))


def _by_folds(found: Inspections, seed: int, predict: Predictor) -> np.ndarray:
    folds = unit_folds(found.specimen, generator(seed, Purpose.FOLDS), FOLDS)
    rows = np.concatenate([np.flatnonzero(fold) for fold in folds])
    return np.concatenate([predict(~fold, fold) for fold in folds])[np.argsort(rows)]


def _changes(values: np.ndarray, specimen: np.ndarray) -> np.ndarray:
    """Return each value over that of the gearbox's first inspection, and over that of the one before (n, 2 columns)."""
    start = np.diff(specimen, prepend=-1) != 0  # inspections stand in the order of gearbox and age
    first = values[np.maximum.accumulate(np.where(start, np.arange(start.size), 0))]
    before = np.where(start[:, None], values, np.roll(values, 1, axis=0))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.concatenate([values / first, values / before], axis=1)


def _constant(found: Inspections, train: np.ndarray, test: np.ndarray) -> np.ndarray:
    """Return the quantiles of the training inspections for all others."""
    return np.tile(np.nanquantile(found.rul_h[train], QUANTILES), (int(test.sum()), 1))


def _by_age(found: Inspections, train: np.ndarray, test: np.ndarray) -> np.ndarray:
    return remaining_of_age(found.age_h[test], *_law_of_age(found, train))


def _by_network(found: Inspections, averages: AveragedRecords, seed: int) -> dict[str, np.ndarray]:
    """Return what the network predicts, under its name."""
    from diagnostics.training.average_rows import average_rows
    from diagnostics.training.life_network import LifeSequences, network_quantiles

    rows = average_rows(averages)

    def predict(train: np.ndarray, test: np.ndarray) -> np.ndarray:
        of_age_h = remaining_of_age(found.age_h, *_law_of_age(found, train))
        known = LifeSequences(rows, found.specimen, found.age_h, found.rul_h, of_age_h)
        return network_quantiles(known, seed, train, test)

    return {NETWORK: _by_folds(found, seed, predict)}


def _law_of_age(found: Inspections, train: np.ndarray) -> tuple[float, float]:
    """Return slope and scale of the Weibull law of the training gearboxes."""
    _, first = np.unique(found.specimen[train], return_index=True)
    life_h = (found.age_h + found.rul_h)[train][first]
    failed = np.isfinite(life_h)
    return weibull_lives(life_h[failed], found.observed_h[train][first][~failed])


def weibull_lives(failed_h: np.ndarray, taken_out_h: np.ndarray) -> tuple[float, float]:
    """Return slope and scale of the likeliest Weibull law of lives, of which some are only known to be longer."""
    from scipy.stats import CensoredData, weibull_min

    slope, _, scale_h = weibull_min.fit(CensoredData(failed_h, right=taken_out_h), floc=0.0)
    return float(slope), float(scale_h)


def remaining_of_age(age_h: np.ndarray, slope: float, scale_h: float) -> np.ndarray:
    """Return the quantiles of the remaining life, (n, 3), of gearboxes that run at an age; from a Weibull law."""
    used = (age_h[:, None] / scale_h) ** slope
    return np.asarray(scale_h * (used - np.log1p(-np.asarray(QUANTILES))) ** (1.0 / slope) - age_h[:, None])


def _trees(
    known: tuple[np.ndarray, np.ndarray], seed: int, quantiles: Sequence[float], train: np.ndarray, test: np.ndarray
) -> np.ndarray:
    values, rul_h = known
    rows = train & np.isfinite(rul_h)
    defined = np.isfinite(values[rows]).any(axis=0)
    fitted = [_model(q, seed).fit(values[rows][:, defined], rul_h[rows]) for q in quantiles]
    # three fits know nothing of each other: sorted, none crosses another
    return np.sort(np.stack([model.predict(values[test][:, defined]) for model in fitted], axis=1), axis=1)


def _model(quantile: float, seed: int) -> Any:
    from sklearn.ensemble import HistGradientBoostingRegressor

    # small trees: some hundred inspections of some dozen gearboxes carry no deeper ones
    return HistGradientBoostingRegressor(
        loss="quantile",
        quantile=quantile,
        max_iter=60,
        max_leaf_nodes=6,
        min_samples_leaf=10,
        early_stopping=False,
        random_state=seed,
    )
