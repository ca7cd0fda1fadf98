"""False accusations of the audit: `python docs/scripts/permutations.py SET [TURNS] [STATE ...]`.

Takes a generated set, keeps its healthy records and those of the given states, and permutes the states with all that
follows from them among the records of every gearbox, TURNS times. So no label tells anything. Prints in how many turns
the audit accuses the set of a trap, and in how many the strongest attacker on the signals, the bank counted as one
test, lies above the limit that the audit would state. Only classifiers run again: the table of the set is kept.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from dataclasses import replace
from typing import Any

import numpy as np

import siggen
from diagnostics.attacks.chance import chance_maximum
from diagnostics.attacks.held_out import dealt_folds
from diagnostics.audit.audit_report import signal_attackers
from diagnostics.audit.bank_detections import chance_limit
from diagnostics.audit.measured_set import MeasuredSet, measured_set
from diagnostics.audit.separability_findings import separability_findings
from diagnostics.base.single_thread import single_thread

DAMAGE = ("state", "fault", "severity", "damage", "faulty", "mesh_stiffness", "land", "sink", "snr", "contact_loss")
"""Beginnings of the names of labels that follow from the state."""

FIRST_TURN = 1000
"""The limit itself uses turns from 0 on."""


def kept(found: MeasuredSet, rows: np.ndarray) -> MeasuredSet:
    """Return some records of a measured set."""
    places = np.flatnonzero(rows)
    lists = {name: [getattr(found, name)[k] for k in places] for name in ("waveforms", "sketches")}
    return replace(
        found,
        labels={name: values[rows] for name, values in found.labels.items()},
        values={name: values[rows] for name, values in found.values.items()},
        checksums=found.checksums[rows],
        **lists,
    )


def with_permuted_states(found: MeasuredSet, turn: int) -> MeasuredSet:
    """Return the set with states, and labels that follow from them, permuted within gearboxes."""
    rng, specimen = np.random.default_rng(turn), found.labels["specimen_id"]
    place = np.arange(specimen.size)
    for owner in np.unique(specimen):
        rows = np.flatnonzero(specimen == owner)
        place[rows] = rng.permutation(rows)
    moved = {name: values[place] for name, values in found.labels.items() if name.startswith(DAMAGE)}
    return replace(found, labels={**found.labels, **moved})


@single_thread
def main(path: str, turns: int, states: list[str]) -> None:
    """Print both shares."""
    every = measured_set(siggen.open(path))
    found = kept(every, every.healthy | np.isin(every.labels["state"], states))
    specimen = found.labels["specimen_id"]
    print(f"{specimen.size} records of {np.unique(specimen).size} gearboxes; states {', '.join(states)}", flush=True)
    begin = time.process_time()
    bank = [attacker for attacker in signal_attackers(found, 0, lambda: None) if attacker.permutable]
    limit = chance_limit(found, bank, 0, lambda: None).auc
    of_state = found.labels["state"] == states[0]
    rows = np.flatnonzero(found.healthy | of_state)
    folds = dealt_folds(specimen, 0)[:, rows]
    best = [
        chance_maximum(bank, rows, of_state[rows], specimen[rows], folds, 0, FIRST_TURN + turn) for turn in range(turns)
    ]
    above = int(np.sum(np.array(best) > limit))
    print(
        f"strongest of {len(bank)} attackers above its limit {limit:.2f}: {above} of {turns}; "
        f"{time.process_time() - begin:.0f} s of CPU",
        flush=True,
    )
    begin, named = time.process_time(), Counter[str]()
    accused = 0
    for turn in range(turns):
        traps = [finding.trap for finding in separability_findings(with_permuted_states(found, turn))]
        accused += bool(traps)
        named.update(traps)
    print(
        f"accused of a trap: {accused} of {turns} {dict(named)}; {time.process_time() - begin:.0f} s of CPU", flush=True
    )


if __name__ == "__main__":
    given: list[Any] = sys.argv[1:]
    main(given[0], int(given[1]) if len(given) > 1 else 200, given[2:] or ["slight", "face_20"])
