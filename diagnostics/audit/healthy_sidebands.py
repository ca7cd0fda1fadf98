"""Trap: healthy records without sidebands, as gears without manufacturing errors give them."""

from __future__ import annotations

import numpy as np

from diagnostics.audit.finding import Finding
from diagnostics.audit.measured_set import MeasuredSet

WEAKEST_DB = -40.0
"""10 dB below the weakest first sideband of the measured healthy gearboxes."""

SHARE_ALLOWED = 0.2


def healthy_sidebands(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if more than a fifth of the healthy channel-records has no visible sideband at mesh 1-3."""
    strongest = measured.values["strongest_sideband_db"][measured.healthy]
    strongest = strongest[~np.isnan(strongest)]
    if strongest.size == 0:
        return []
    share = float(np.mean(strongest < WEAKEST_DB))
    if share <= SHARE_ALLOWED:
        return []
    return [
        Finding(
            "healthy_without_sidebands",
            f"{share:.0%} of the healthy channel-records have no pinion sideband of mesh 1-3 above {WEAKEST_DB:g} dB "
            "of its mesh line and 10 dB above the noise",
            f"at most {SHARE_ALLOWED:.0%} are allowed, measured healthy gearboxes have -30 to -8 dB",
            "Give the gears manufacturing errors (section `manufacture`), drawn anew for every specimen.",
        )
    ]
