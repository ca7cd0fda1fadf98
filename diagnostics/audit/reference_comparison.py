"""How a set's healthy records lie against measured healthy recordings: what gives the set away, and what lies inside.

One feature alone: AUC over windows, every recording and every gearbox counting alike. All together: ridge regression,
judged on recordings and gearboxes that it was not shown. Whether a recording lies within the spread of the gearboxes:
the rms of its features' distances from the gearboxes' median, over their spread, against the same of every channel of
every gearbox.
Source: derived.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.audit.held_out import dealt_folds, wins
from diagnostics.audit.reference_folder import WindowSet
from diagnostics.audit.ridge_scores import products, ridge_scores
from diagnostics.signal.window_features import FEATURES

FEWEST_RECORDINGS, FEWEST_GEARBOXES = 4, 8
"""Fewer recordings do not tell what all measured machines share from what one of them is."""

TELLING_AUC = 0.9
INSIDE = (0.025, 0.975)
NORMAL_IQR = 1.349


@dataclass(frozen=True, slots=True)
class FeatureGap:
    """One feature: AUC of measured against synthetic windows, medians of both, and share of synthetic inside the real.

    `synthetic_spread` is the standard deviation between channels of gearboxes that the quartiles of their medians give.
    """

    name: str
    auc: float
    measured: float
    synthetic: float
    synthetic_spread: float
    inside: float


@dataclass(frozen=True, slots=True)
class RecordingPlace:
    """One recording: its distance from the gearboxes over their spread, the share of these that lie farther, windows.

    Median over its channels; the gearboxes' channels stand each for themselves.
    """

    name: str
    distance: float
    farther: float
    windows: int


@dataclass(frozen=True, slots=True)
class ReferenceComparison:
    """The whole comparison.

    Attributes
    ----------
    gaps : tuple of FeatureGap
        The most telling first.
    places : tuple of RecordingPlace
    discriminator_auc : float
        On recordings and gearboxes that were not shown; NaN with fewer than four recordings or eight gearboxes.
    inside : float
        Share of synthetic values inside 95 % of the measured ones, mean over the features.
    gearbox_distance : float
        Median of the distances of the gearboxes' own channels.
    recordings, gearboxes : int
    """

    gaps: tuple[FeatureGap, ...]
    places: tuple[RecordingPlace, ...]
    discriminator_auc: float
    inside: float
    gearbox_distance: float
    recordings: int
    gearboxes: int

    @property
    def telling(self) -> int:
        """How many features alone reach an AUC of 0.9."""
        return sum(gap.auc >= TELLING_AUC for gap in self.gaps)


def reference_comparison(measured: WindowSet, synthetic: WindowSet, seed: int) -> ReferenceComparison:
    """Return the comparison; the seed deals folds."""
    (real, owner), (own, gearbox) = measured.medians(), synthetic.medians()
    names = tuple(dict.fromkeys(owner.tolist()))
    middle = np.median(own, axis=0)
    spread = np.subtract(*np.quantile(own, [0.75, 0.25], axis=0)) / NORMAL_IQR
    spread = np.where(spread > 0.0, spread, np.abs(middle) * 1e-6 + 1e-12)
    each, others = _rms((real - middle) / spread), _rms((own - middle) / spread)
    distance = [float(np.median(each[owner == name])) for name in names]
    gaps = _gaps(measured, synthetic, middle, spread)
    return ReferenceComparison(
        gaps=tuple(sorted(gaps, key=lambda gap: -gap.auc)),
        places=tuple(
            RecordingPlace(name, far, float(np.mean(others >= far)), int(np.sum(measured.owner == name)))
            for name, far in zip(names, distance, strict=True)
        ),
        discriminator_auc=discriminator_auc(measured, synthetic, seed),
        inside=float(np.mean([gap.inside for gap in gaps])),
        gearbox_distance=float(np.median(others)),
        recordings=len(names),
        gearboxes=int(np.unique(gearbox).size),
    )


def _rms(values: np.ndarray) -> np.ndarray:
    """Return the rms over features, one wild feature limited to ten spreads."""
    return np.asarray(np.sqrt(np.mean(np.square(np.clip(values, -10.0, 10.0)), axis=1)))


def _weights(owner: np.ndarray) -> np.ndarray:
    """Return weights with which every source counts alike, sum one."""
    _, index, count = np.unique(owner, return_inverse=True, return_counts=True)
    return np.asarray(1.0 / count[index.ravel()] / count.size)


def _gaps(measured: WindowSet, synthetic: WindowSet, middle: np.ndarray, spread: np.ndarray) -> list[FeatureGap]:
    real_weight, own_weight = _weights(measured.owner), _weights(synthetic.owner)
    found = []
    for k, name in enumerate(FEATURES):
        real, own = measured.values[:, k], synthetic.values[:, k]
        area = float(real_weight @ (0.5 + 0.5 * np.sign(real[:, None] - own)) @ own_weight)
        low, high = np.quantile(real, INSIDE)
        inside = float(own_weight @ ((own >= low) & (own <= high)))
        found.append(
            FeatureGap(name, max(area, 1.0 - area), float(np.median(real)), float(middle[k]), float(spread[k]), inside)
        )
    return found


def discriminator_auc(measured: WindowSet, synthetic: WindowSet, seed: int) -> float:
    """Return the AUC of all features together on sources that were not shown; NaN with too few of them.

    Channels stand for their windows: one row of medians each.
    """
    (real, owner), (own, gearbox) = measured.medians(), synthetic.medians()
    if np.unique(owner).size < FEWEST_RECORDINGS or np.unique(gearbox).size < FEWEST_GEARBOXES:
        return float("nan")
    values = np.concatenate([real, own])
    is_real = np.arange(len(values)) < len(real)
    source = np.unique(np.concatenate([np.char.add("r", owner), np.char.add("g", gearbox)]), return_inverse=True)[1]
    product = products(values)
    total = np.zeros((2, 1))
    # recordings and gearboxes are dealt apart, so that every fold holds both
    folds = np.concatenate([dealt_folds(source[is_real], seed), dealt_folds(source[~is_real], seed)], axis=1)
    for fold in folds:
        for held in np.unique(fold[is_real]):
            out = fold == held
            score = ridge_scores(product, is_real[None], source, ~out)[0]
            total += wins(score, is_real[out], source[out], np.ones((1, int(out.sum()))))
    return float(total[0, 0] / total[1, 0]) if total[1, 0] > 0.0 else float("nan")
