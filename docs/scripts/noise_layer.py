"""What the noise alone tells of the states of a set, by state: `python docs/scripts/noise_layer.py SET`.

Prints the largest AUC of the audit's attackers on the level of the noise, best column or all, as it is or as a change
from a healthy record, on gearboxes that were not seen.
"""

from __future__ import annotations

import sys

import siggen
from diagnostics.audit.bank_detections import damaged_states
from diagnostics.audit.condition_traps import NOISE, condition_attackers
from diagnostics.audit.held_out import dealt_folds, held_out, judged_rows
from diagnostics.audit.measured_set import measured_set


def main(path: str) -> None:
    """Print one row per state."""
    measured = measured_set(siggen.open(path))
    bank, specimen = condition_attackers(measured)[NOISE], measured.labels["specimen_id"]
    folds = dealt_folds(specimen, 0)
    print("| state | AUC | by |\n|---|---|---|")
    for state in damaged_states(measured):
        of_state, found = measured.labels["state"] == state, []
        for attacker in bank:
            rows = judged_rows(attacker, measured.healthy, of_state, specimen)
            if rows.size:
                auc = held_out(attacker, rows, of_state[rows], specimen[rows], folds[:, rows], 0).auc
                found.append((auc.value, f"{auc.value:.2f} ({auc.low:.2f} to {auc.high:.2f})", attacker.name))
        print(f"| {state} | {' | '.join(max(found)[1:])} |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1])
