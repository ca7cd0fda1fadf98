"""A small circular network on one averaged revolution: the attacker that learns its own features.

Two circular convolutions, then the mean and the largest answer over the angle, so that it does not matter where the
revolution starts; channels share the network, their scores are averaged. It learns from all damaged states of the
gearboxes to learn from, one network per fold, a fixed number of steps. Source: standard literature; sizes derived by
what trains in seconds.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from diagnostics.attacks.trial import Attacker, Trial, Verdicts
from diagnostics.base.extras import missing_packages
from diagnostics.base.seeding import Purpose, generator

if TYPE_CHECKING:
    from diagnostics.attacks.pooled_network import PooledNetwork

STEPS, BATCH, RATE, DECAY = 300, 64, 3e-3, 1e-3


def circular_network(
    name: str, waves: np.ndarray, damaged: np.ndarray, specimen: np.ndarray, usable: np.ndarray, seed: int
) -> Attacker | None:
    """Return the attacker, or None without PyTorch.

    Parameters
    ----------
    name : str
    waves : (records, channels, steps) float32
        One revolution each, of comparable level.
    damaged : (records,) bool
    specimen : (records,) int
    usable : (records,) bool
        Records whose waves are defined in all channels.
    seed : int
        Of first weights and batches.
    """
    if missing_packages("torch"):
        return None
    kept: dict[bytes, np.ndarray] = {}

    def attack(trial: Trial) -> Verdicts:
        learnt = np.unique(trial.specimen[trial.train])
        key = learnt.tobytes()
        if key not in kept:
            rows = np.flatnonzero(usable & np.isin(specimen, learnt))
            kept[key] = _scores(waves, rows, damaged, seed)
        return Verdicts(kept[key][trial.rows[~trial.train]])

    return Attacker(name, attack, usable, waves.shape[-1], deals=1, permutable=False)


def _scores(waves: np.ndarray, rows: np.ndarray, damaged: np.ndarray, seed: int) -> np.ndarray:
    """Return the score of every record from a network that learnt from some rows."""
    import torch

    threads, state = torch.get_num_threads(), torch.random.get_rng_state()
    torch.set_num_threads(1)
    try:
        torch.manual_seed(int(generator(seed, Purpose.WINDOWS, 1000).integers(2**31)))
        network = _trained(waves, rows, damaged, seed)
        with torch.inference_mode():
            parts = [
                network(torch.from_numpy(part))
                for part in np.array_split(waves.reshape(-1, 1, waves.shape[-1]), max(len(waves) // 64, 1))
            ]
        found = torch.cat(parts).numpy().reshape(waves.shape[:2])
    finally:
        torch.set_num_threads(threads)
        torch.random.set_rng_state(state)
    return np.asarray(found.mean(axis=1), dtype=np.float64)


def _trained(waves: np.ndarray, rows: np.ndarray, damaged: np.ndarray, seed: int) -> PooledNetwork:
    import torch

    from diagnostics.attacks.pooled_network import PooledNetwork

    network = PooledNetwork()
    optimiser = torch.optim.AdamW(network.parameters(), lr=RATE, weight_decay=DECAY)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, RATE, total_steps=STEPS)
    classes = [rows[damaged[rows] == side] for side in (False, True)]
    rng = generator(seed, Purpose.WINDOWS, 1001)
    target = torch.cat([torch.zeros(BATCH // 2), torch.ones(BATCH // 2)])
    for _ in range(STEPS):
        chosen = np.concatenate([rng.choice(own, BATCH // 2) for own in classes])
        batch = waves[chosen, rng.integers(waves.shape[1], size=BATCH)] * rng.choice((-1.0, 1.0), (BATCH, 1))
        loss = torch.nn.functional.binary_cross_entropy_with_logits(
            network(torch.from_numpy(batch[:, None].astype(np.float32))), target
        )
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
    network.eval()
    return network
