"""Print how stiff a ball bearing of the default numbers is, by load and clearance.

python docs/scripts/bearing_stiffness.py
"""

from __future__ import annotations

from math import degrees

import numpy as np

from siggen.dynamics.bearings.loaded_bearing import loaded_bearing
from siggen.faults.ball_geometry import BallGeometry

FORCES_N = (50.0, 1200.0)
CLEARANCES_UM = (0.0, 10.0, 30.0, 100.0)


def main() -> None:
    """Print one row for each force and clearance."""
    print("| force N | clearance µm | along, 1e6 N/m | across, 1e6 N/m | half zone ° | passing, along; across µm |")
    print("|---|---|---|---|---|---|")
    for force_n in FORCES_N:
        for clearance_um in CLEARANCES_UM:
            bearing = BallGeometry(clearance_um=clearance_um).bearing()
            found = loaded_bearing(bearing, np.array([force_n, 0.0]))
            along, across = 1e6 * np.abs(found.passing_m).max(axis=0)
            print(
                f"| {force_n:.0f} | {clearance_um:.0f} | {1e-6 * found.along_n_per_m:.0f} | "
                f"{1e-6 * found.across_n_per_m:.1f} | {degrees(found.half_zone_rad):.0f} | {along:.2f}; {across:.2f} |"
            )


if __name__ == "__main__":
    main()
