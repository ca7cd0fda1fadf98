"""The audit's strongest attacker beside three that are not its own: `python docs/scripts/attackers.py SET [STATE ...]`.

For damaged states of a generated set, all unless some are named: AUC on gearboxes that were not seen, of the strongest
of the audit's attackers on the signals and of three references, all on the same folds of gearboxes; alone and as
differences from the gearbox's healthy record.

* kurtosis: the kurtosis of the averaged residual in one band of orders, the best of all bands on the other gearboxes;
* MiniRocket: features of aeon 1.6.0 (`pip install aeon`, in an environment of its own), ridge regression of
  scikit-learn;
* network: a residual network (three blocks, Wang et al. 2017) on the averaged residual, PyTorch.

The audit's own networks take no part on its side.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import numpy as np
import torch
from torch import nn

import siggen
from diagnostics.audit.audit import REFERENCED
from diagnostics.audit.bank_detections import damaged_states
from diagnostics.audit.column_attackers import best_column
from diagnostics.audit.held_out import Attacker, Trial, Verdicts, dealt_folds, held_out_values, judged_rows
from diagnostics.audit.measured_set import MeasuredSet, measured_set, reference_records
from diagnostics.audit.residual_lines import band_bank, line_array, residual_lines
from diagnostics.audit.signal_attackers import over_channels, revolution, signal_attackers
from diagnostics.base.single_thread import single_thread

CHANNELS, EPOCHS, BATCH = (16, 32, 32), 12, 32
KURTOSIS, ROCKET, NETWORK = "kurtosis in bands", "MiniRocket and ridge", "residual network"
Scores = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Scores of all records from one that may be trained on and the damaged ones."""


class Block(nn.Module):
    """Three convolutions round the revolution beside a straight way."""

    def __init__(self, inside: int, outside: int) -> None:
        super().__init__()
        sizes = ((inside, 7), (outside, 5), (outside, 3))
        parts: list[nn.Module] = []
        for channels, width in sizes:
            turn = nn.Conv1d(channels, outside, width, padding=width // 2, padding_mode="circular", bias=False)
            parts += [turn, nn.BatchNorm1d(outside), nn.ReLU()]
        self.way = nn.Sequential(*parts[:-1])
        self.straight = nn.Sequential(nn.Conv1d(inside, outside, 1, bias=False), nn.BatchNorm1d(outside))

    def forward(self, waves: torch.Tensor) -> torch.Tensor:
        """Return the sum of both ways."""
        return torch.relu(self.way(waves) + self.straight(waves))


def residual_network(waves: np.ndarray) -> Scores:
    """Return what a network learns from records of all damaged states; channels are inputs of one network."""
    inputs = torch.from_numpy(np.ascontiguousarray(waves, dtype=np.float32))

    def scores(train: np.ndarray, damaged: np.ndarray) -> np.ndarray:
        torch.manual_seed(0)
        sizes = (waves.shape[1], *CHANNELS)
        blocks = [
            layer for k in range(3) for layer in (Block(sizes[k], sizes[k + 1]), nn.AvgPool1d(2) if k < 2 else None)
        ]
        body = nn.Sequential(*[layer for layer in blocks if layer], nn.AdaptiveMaxPool1d(1), nn.Flatten())
        network = nn.Sequential(body, nn.Linear(CHANNELS[-1], 1))
        optimiser = torch.optim.AdamW(network.parameters(), lr=2e-3)
        target, rows = torch.from_numpy(damaged.astype(np.float32)), torch.from_numpy(np.flatnonzero(train))
        weight = torch.where(target > 0, 0.5 / target[rows].mean(), 0.5 / (1.0 - target[rows].mean()))
        for _ in range(EPOCHS):
            for batch in rows[torch.randperm(rows.numel())].split(BATCH):
                turned = torch.roll(inputs[batch], int(torch.randint(inputs.shape[-1], ())), dims=-1)
                loss = nn.functional.binary_cross_entropy_with_logits(
                    network(turned)[:, 0], target[batch], weight[batch]
                )
                optimiser.zero_grad()
                loss.backward()
                optimiser.step()
        network.eval()
        with torch.no_grad():
            return np.concatenate([network(part)[:, 0].numpy() for part in inputs.split(128)])

    return scores


def network_reference(measured: MeasuredSet, waves: np.ndarray, usable: np.ndarray) -> Attacker:
    """Return an attacker that trains one network per fold, on all states, and is asked about each."""
    specimen, kept = measured.labels["specimen_id"], dict[bytes, np.ndarray]()
    learn = residual_network(np.where(usable[:, None, None], waves, 0.0))

    def attack(trial: Trial) -> Verdicts:
        learnt = np.unique(trial.specimen[trial.train])
        if learnt.tobytes() not in kept:
            kept[learnt.tobytes()] = learn(usable & np.isin(specimen, learnt), ~measured.healthy)
        return Verdicts(kept[learnt.tobytes()][trial.rows[~trial.train]][None])

    return Attacker(NETWORK, attack, usable, 0, deals=1)


def rocket_reference(waves: np.ndarray, usable: np.ndarray) -> Attacker:
    """Return an attacker of aeon's features and a ridge classifier whose penalty scikit-learn chooses."""
    from aeon.transformations.collection.convolution_based import MiniRocket
    from sklearn.linear_model import RidgeClassifierCV
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    values = np.full((usable.size, 1), np.nan)
    found = MiniRocket(random_state=0).fit_transform(waves[usable].astype(np.float32))
    values = np.full((usable.size, found.shape[1]), np.nan)
    values[usable] = found

    def attack(trial: Trial) -> Verdicts:
        train, held = trial.rows[trial.train], trial.rows[~trial.train]
        model = make_pipeline(StandardScaler(), RidgeClassifierCV(np.logspace(-3, 5, 9), class_weight="balanced"))
        model.fit(values[train], trial.positive[0, trial.train])
        return Verdicts(model.decision_function(values[held])[None])

    return Attacker(ROCKET, attack, usable, found.shape[1], deals=3)


def references(measured: MeasuredSet, lines: np.ndarray, level: np.ndarray) -> list[Attacker]:
    """Return the three attackers on residual lines, at the level of other lines."""
    values, names = over_channels(band_bank(lines))
    chosen = [name.startswith("kurtosis") for name in names]
    size = np.sqrt(np.square(revolution(level), dtype=np.float64).mean(axis=-1, keepdims=True))
    waves = revolution(lines) / size
    usable = np.isfinite(waves).all(axis=(1, 2))
    kurtosis = tuple(name for name, is_chosen in zip(names, chosen, strict=True) if is_chosen)
    return [
        best_column(KURTOSIS, values[:, chosen], kurtosis),
        rocket_reference(waves, usable),
        network_reference(measured, waves, usable),
    ]


def areas(measured: MeasuredSet, attackers: list[Attacker], state: str) -> dict[str, float]:
    """Return the AUC of every attacker on a state."""
    specimen, of_state = measured.labels["specimen_id"], np.asarray(measured.labels["state"] == state)
    folds, found = dealt_folds(specimen, 0), {}
    for attacker in attackers:
        rows = judged_rows(attacker, measured.healthy, of_state, specimen)
        if rows.size:
            states = of_state[None, rows]
            found[attacker.name] = float(held_out_values(attacker, rows, states, specimen[rows], folds[:, rows])[0])
    return found


@single_thread
def main(path: str, asked: list[str]) -> None:
    """Print both tables."""
    torch.set_num_threads(1)
    begin, measured = time.process_time(), measured_set(siggen.open(path))
    bank = [each for each in signal_attackers(measured, 0, lambda: None) if each.permutable]
    residual = residual_lines(line_array(measured.waveforms), measured.labels["teeth_pinion"])
    reference = reference_records(measured)
    known = np.where((reference >= 0)[:, None, None], residual[reference], np.nan)
    for title, lines, level, is_beside in (
        ("alone", residual, residual, False),
        ("with a healthy reference", residual - known, known, True),
    ):
        if is_beside and not (reference >= 0).any():
            continue
        own = [attacker for attacker in bank if attacker.name.endswith(REFERENCED) == is_beside]
        others = references(measured, lines, level)
        print(f"\n{title}\n\n| state | strongest of the audit | by | {' | '.join(each.name for each in others)} |")
        print(f"|{'---|' * (3 + len(others))}", flush=True)
        behind = {each.name: 0.0 for each in others}
        for state in asked or damaged_states(measured):
            ours, theirs = areas(measured, own, state), areas(measured, others, state)
            best = max(ours, key=lambda name, ours=ours: ours[name])
            for name, area in theirs.items():
                behind[name] = max(behind[name], area - ours[best])
            cells = " | ".join(f"{theirs[each.name]:.2f}" for each in others)
            print(f"| {state} | {ours[best]:.2f} | {best.removesuffix(REFERENCED)} | {cells} |", flush=True)
        print("\nthe audit is behind by at most:", ", ".join(f"{name} {by:.2f}" for name, by in behind.items()))
    print(f"\n{time.process_time() - begin:.0f} s of CPU")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
