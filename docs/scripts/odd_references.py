"""How often `baseline` doubts healthy references, and finds a wrong one: `odd_references.py FOLDER`; 4 minutes.

16 gearboxes of `bench`, recorded three times under each of seven conditions: one speed with 20, 40, 70 and 100 % of the
load, and full load at 18, 23 and 29 Hz. FOLDER is where the set is made, or was made before. References are drawn of
one gearbox; then one of them is taken from another gearbox, with its channels exchanged, or in g.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

import siggen
from diagnostics.machine.odd_references import USED_BAND, odd_references, third_octave_levels
from diagnostics.recordings.measured_recording import MeasuredRecording

GEARBOXES, REPEATS, DRAWS, FS_HZ = 16, 3, 40, 25_600.0
CHANNELS = ("lid_vertical", "side_horizontal")
LOADS = [{"speed_hz": 35.0, "torque_nm": torque} for torque in (40.0, 8.0, 16.0, 28.0)]
SPEEDS = [{"speed_hz": speed, "torque_nm": 40.0} for speed in (18.0, 23.0, 29.0)]
HEALTHY = {
    "extends": "bench", "name": "healthy", "specimens": GEARBOXES, "repeats": REPEATS, "duration_s": 1.0,
    "operating_points": LOADS + SPEEDS, "states": [{"name": "healthy"}],
}  # fmt: skip
DRAWN = {
    "one speed and load": ((0,), 3),
    "one speed, loads 20 to 100 %": ((0, 1, 2, 3), 3),
    "the same loads": ((0, 1, 2, 3), 5),
    "speeds 18 to 35 Hz": ((0, 4, 5, 6), 10),
}
G_DB = 20.0 * np.log10(9.81)


def levels(folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """Return levels (gearboxes, conditions, repeats, channels, bands) and speeds (gearboxes, conditions, repeats)."""
    siggen.generate(siggen.load_config(HEALTHY), folder)
    found, speeds = {}, {}
    for batch in siggen.open(folder).records():
        for row in range(batch.num_rows):
            record = {name: batch.column(name)[row] for name in batch.schema.names}
            signals = [value.values.to_numpy() for name, value in record.items() if name.startswith("accel_")]
            recording = MeasuredRecording(folder, dict(zip(CHANNELS, signals, strict=True)), FS_HZ, None)
            key = record["record_id"].as_py()
            found[key] = third_octave_levels(recording, USED_BAND * FS_HZ, 1.0)
            speeds[key] = record["speed_hz"].as_py()
    shape = (GEARBOXES, len(LOADS) + len(SPEEDS), REPEATS)
    order = sorted(found)
    first = found[order[0]]
    return (
        np.array([found[k] for k in order]).reshape(*shape, *first.shape),
        np.array([speeds[k] for k in order]).reshape(shape),
    )


def wrong(drawn: np.ndarray, k: int, other: np.ndarray, how: str) -> np.ndarray:
    """Return levels of references of which number k is wrong in some way."""
    ways: dict[str, Callable[[], np.ndarray]] = {
        "another gearbox": lambda: other,
        "channels exchanged": lambda: drawn[k, ::-1],
        "in g": lambda: drawn[k] - G_DB,
    }
    found = drawn.copy()
    found[k] = ways[how]()
    return found


def rates(held: np.ndarray, speeds: np.ndarray, conditions: tuple[int, ...], count: int) -> list[float]:
    """Return the share of healthy sets with a doubt, and of sets whose wrong reference is the only one named."""
    rng = np.random.default_rng(0)
    found: list[list[bool]] = []
    for gearbox in range(GEARBOXES):
        for _ in range(DRAWS):
            of_set = [(c, r) for c in conditions for r in range(REPEATS)]
            chosen = [of_set[n] for n in rng.permutation(len(of_set))[:count]]
            drawn = np.array([held[gearbox, c, r] for c, r in chosen])
            speed = np.array([speeds[gearbox, c, r] for c, r in chosen])
            k = int(rng.integers(count))
            stranger = int(rng.choice(np.delete(np.arange(GEARBOXES), gearbox)))
            row = [bool(odd_references(drawn, speed, CHANNELS))]
            for how in ("another gearbox", "channels exchanged", "in g"):
                told = odd_references(wrong(drawn, k, held[stranger][chosen[k]], how), speed, CHANNELS)
                row.append([one.index for one in told] == [k])
            found.append(row)
    return [100.0 * share for share in np.mean(found, axis=0)]


def main() -> None:
    """Print the table."""
    held, speeds = levels(Path(sys.argv[1]))
    print("| references | healthy, doubted, % | another gearbox, % | channels exchanged, % | in g, % |")
    print("|---|---|---|---|---|")
    for name, (conditions, count) in DRAWN.items():
        print(f"| {count}, {name} | {' | '.join(f'{rate:.1f}' for rate in rates(held, speeds, conditions, count))} |")


if __name__ == "__main__":
    main()
