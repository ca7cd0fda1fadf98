"""What the audit says of clean sets: `python docs/scripts/shams.py SET ...`.

Prints Markdown, a row for each set: the traps that are found, and, where the set has shams, the largest AUC of all
attackers on them, alone and beside a healthy record, with what the largest of them stays below in 95 % of 499
permutations, and the p-value. The networks count, though they are not permuted.
"""

from __future__ import annotations

import sys
import time

import siggen
from diagnostics.audit.audit_report import sham_sides
from diagnostics.audit.measured_set import measured_set
from diagnostics.audit.separability_findings import separability_findings
from diagnostics.audit.sham import ShamFound, sham_traps, shams_found
from diagnostics.audit.signal_attackers import signal_attackers
from diagnostics.base.single_thread import single_thread


def cell(found: ShamFound) -> str:
    """Return what one sham gave."""
    law = found.chance
    beside = f", chance {law.auc:.2f}, p {law.p_value:.2f}" if law else ""
    return f"{found.state}, {found.side}: {found.auc.value:.2f} by {found.attacker}{beside}"


def row(path: str) -> str:
    """Return the row of a set."""
    dataset = siggen.open(path)
    measured = measured_set(dataset)
    shams = shams_found(measured, sham_sides(measured, signal_attackers(measured, 0, lambda: None)), 0)
    traps = [finding.trap for finding in [*separability_findings(measured), *sham_traps(shams)]]
    gearboxes = len(set(measured.labels["specimen_id"].tolist()))
    said = "; ".join(map(cell, shams)) or "no sham"
    return f"| {dataset.path.name} | {gearboxes} | {len(measured.healthy)} | {', '.join(traps) or 'none'} | {said} |"


@single_thread
def main(paths: list[str]) -> None:
    """Print the table."""
    begin = time.process_time()
    print("| set | gearboxes | records | traps | largest AUC on shams |\n|---|---|---|---|---|")
    for path in paths:
        print(row(path), flush=True)
    print(f"\n{time.process_time() - begin:.0f} s of CPU")


if __name__ == "__main__":
    main(sys.argv[1:])
