"""Print the size of the explorer's page: `python docs/scripts/explorer_size.py`.

99 records of 33 gearboxes, 38,400 samples of two channels each: the set that the tests make in memory, made longer.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from diagnostics.explore.explorer import ExplorerOptions, write_explorer  # noqa: E402
from tests.diagnostics.conftest import memory_dataset  # noqa: E402

GEARBOXES = 33
DURATION_S = 3.0


def main() -> None:
    """Write both pages into a folder that is thrown away, and print their sizes."""
    dataset = memory_dataset(("train",) * GEARBOXES, duration_s=DURATION_S)
    with tempfile.TemporaryDirectory() as folder:
        for full in (False, True):
            path = write_explorer(dataset, Path(folder) / "page.html", ExplorerOptions(full=full))
            print(f"| {'`--full`' if full else 'as it comes'} | {path.stat().st_size / 1e6:.1f} MB |")


if __name__ == "__main__":
    main()
