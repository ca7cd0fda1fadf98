"""Trap: one specimen in two splits."""

from __future__ import annotations

from diagnostics.audit.finding import Finding
from diagnostics.audit.measured_set import MeasuredSet


def shared_specimens(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if a specimen occurs in more than one split."""
    owners: dict[int, set[str]] = {}
    for specimen, split in zip(measured.labels["specimen_id"].tolist(), measured.labels["split"].tolist(), strict=True):
        owners.setdefault(specimen, set()).add(split)
    shared = sorted(specimen for specimen, splits in owners.items() if len(splits) > 1)
    if not shared:
        return []
    shown = ", ".join(str(specimen) for specimen in shared[:5])
    return [
        Finding(
            "specimen_in_two_splits",
            f"{len(shared)} of {len(owners)} specimens ({shown}{', ...' if len(shared) > 5 else ''}) "
            "have records in more than one split",
            "allowed are none",
            "Split by `specimen_id`. siggen does so, so the `split` column was changed: write it again.",
        )
    ]
