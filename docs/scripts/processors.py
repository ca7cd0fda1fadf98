"""By how much records differ between processors: `python docs/scripts/processors.py [CONFIG] [GEARBOXES]`.

Generates the first gearboxes in fresh processes whose libraries are told another processor, and prints how many
channels are equal to the bit, and the largest rms of a difference over the rms of its channel. Takes minutes.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from pyarrow import parquet

PROCESSORS = {
    "numba for haswell": {"NUMBA_CPU_NAME": "haswell"},
    "numba for any x86-64": {"NUMBA_CPU_NAME": "generic"},
    "numpy without AVX2": {"NPY_DISABLE_CPU_FEATURES": "X86_V3"},
    "OpenBLAS for Nehalem": {"OPENBLAS_CORETYPE": "Nehalem"},
}


def channels(config: str, gearboxes: int, folder: Path, processor: dict[str, str]) -> dict[tuple[int, str], np.ndarray]:
    """Return every channel of every record, by record and name, made in a process of its own."""
    command = [str(Path(sys.executable).parent / "siggen"), "generate", config, "--out", str(folder)]
    environment = {**os.environ, "OMP_NUM_THREADS": "1", **processor}
    subprocess.run([*command, "--set", f"specimens={gearboxes}"], check=True, env=environment, capture_output=True)
    found = {}
    for file in sorted(folder.glob("data/*.parquet")):
        table = parquet.read_table(file)
        for name in (name for name in table.column_names if name.startswith("accel_")):
            for record, signal in zip(table["record_id"].to_pylist(), table[name].to_pylist(), strict=True):
                found[record, name] = np.asarray(signal, dtype=np.float64)
    return found


def main(config: str, gearboxes: int) -> None:
    """Print one line per processor."""
    with tempfile.TemporaryDirectory() as folder:
        here = channels(config, gearboxes, Path(folder) / "here", {})
        for number, (name, processor) in enumerate(PROCESSORS.items()):
            there = channels(config, gearboxes, Path(folder) / str(number), processor)
            wrong = [float(np.sqrt(np.mean((there[key] - own) ** 2) / np.mean(own**2))) for key, own in here.items()]
            print(f"{name}: {wrong.count(0.0)} of {len(wrong)} channels equal, {max(wrong):.1e} of the rms at most")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "configs/quickstart.yaml", int(sys.argv[2]) if len(sys.argv) > 2 else 2)
