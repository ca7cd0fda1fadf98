"""The attacker that learns its own features: the circular network of `report`, on the averages of the audit.

One network per fold learns from all damaged states of the gearboxes to learn from, and is asked about each state of the
others. It is trained on a fixed number of records in all, some passes over a small set, few over a large one, so that
its cost does not grow with the set.
"""

from __future__ import annotations

import numpy as np

from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.audit.trial import Attacker, Trial, Verdicts
from diagnostics.base.extras import missing_packages
from diagnostics.training.average_rows import AveragedRecords, padded_lines
from diagnostics.training.splits import SpecimenSplit

SHOWN, FEWEST_EPOCHS = 4500, 4
"""Records that a network is shown in all, and passes at least: some 5 s of CPU."""


def network_attacker(name: str, measured: MeasuredSet, reference: np.ndarray | None, seed: int) -> Attacker | None:
    """Return the attacker, or None without PyTorch.

    Parameters
    ----------
    name : str
    measured : MeasuredSet
    reference : (records,) int, optional
        Healthy record of the same gearbox that each stands beside, -1 without one; None: every record stands alone.
    seed : int
        Of first weights, order and changed paths.
    """
    if missing_packages("torch"):
        return None
    usable = np.array([all(lines.size for lines in row) for row in measured.waveforms], dtype=bool)
    lines = padded_lines(measured.waveforms)
    beside = None
    if reference is not None:
        usable &= (reference >= 0) & usable[reference]
        beside = lines[reference]
    records = AveragedRecords(lines, measured.labels["teeth_pinion"], measured.channels, beside)
    specimen, kept = measured.labels["specimen_id"], dict[bytes, np.ndarray]()

    def attack(trial: Trial) -> Verdicts:
        learnt = np.unique(trial.specimen[trial.train])
        key = learnt.tobytes()
        if key not in kept:
            train = usable & np.isin(specimen, learnt)
            kept[key] = _scores(records, train, ~measured.healthy, seed)
        return Verdicts(kept[key][trial.rows[~trial.train]][None])

    return Attacker(name, attack, usable, records.rows * 2 * lines.shape[2], deals=1, permutable=False)


def _scores(records: AveragedRecords, train: np.ndarray, damaged: np.ndarray, seed: int) -> np.ndarray:
    """Return the probability of damage of every record from a network that learnt from some."""
    from diagnostics.training.circular_network import CircularSettings, circular_probability, train_circular

    nobody = np.zeros_like(train)
    split = SpecimenSplit(train, nobody, nobody, ("healthy", "damaged"))
    settings = CircularSettings(most_epochs=max(FEWEST_EPOCHS, round(SHOWN / max(int(train.sum()), 1))))
    trained = train_circular(records, damaged.astype(np.int64), split, seed, settings)
    return circular_probability(trained.network, records)[:, 1]
