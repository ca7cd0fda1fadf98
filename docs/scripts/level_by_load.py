"""Table of docs/understand/methods.md: how healthy levels of quickstart grow with the load, and by which cause.

`python docs/scripts/level_by_load.py [GEARBOXES]`: rms at 54 over 6 N m and 30 Hz, geometric mean over two channels of
8 gearboxes; then the same with one cause switched off. A cause takes the share ln(all/without) of ln(all).
"""

from __future__ import annotations

import sys

import numpy as np

import siggen

TORQUES_NM, SPEED_HZ = (6.0, 54.0), 30.0
SOFT = "{log: [1.2e8, 2.6e8]}"
"""Both bearings of a shaft at any load, as far apart as those that follow it are at full load."""
CAUSES = {
    "friction of the flanks": ["dynamics.friction.model=off"],
    "bearings that stiffen": [f"dynamics.{wheel}.bearing.stiffness_n_per_m={SOFT}" for wheel in ("pinion", "gear")],
    "gears that tilt": ["dynamics.shafts=null"],
    "errors and waves of flanks": ["manufacture=null"],
    "background": ["background=null"],
}


def ratio(gearboxes: int, changes: list[str]) -> float:
    """Return the level at 90 % over that at 10 % of the load."""
    levels = []
    for torque_nm in TORQUES_NM:
        point = [f"operating_points.0.speed_hz={SPEED_HZ}", f"operating_points.0.torque_nm={torque_nm}"]
        design = siggen.load_config("configs/quickstart.yaml", [*point, "duration_s=1.0", *changes])
        records = (siggen.run(siggen.draw(design, number)) for number in range(gearboxes))
        levels.append([[np.log(np.std(signal)) for signal in one.channels.values()] for one in records])
    low, high = np.array(levels)
    return float(np.exp(np.mean(high - low)))


def main(gearboxes: int) -> None:
    """Print the table."""
    whole = ratio(gearboxes, [])
    print("| without | level at 54 over 6 N m | share of the rise |")
    print("|---|---|---|")
    print(f"| nothing | {whole:.2f} | |")
    shares = []
    for cause, changes in CAUSES.items():
        left = ratio(gearboxes, changes)
        shares.append(np.log(whole / left) / np.log(whole))
        print(f"| {cause} | {left:.2f} | {shares[-1]:.0%} |", flush=True)
    print(f"| sum of the shares | | {sum(shares):.0%} |")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 8)
