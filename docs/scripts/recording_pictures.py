"""Pictures of docs/start/from_a_file.md: `python docs/scripts/recording_pictures.py`.

A hidden machine without a tacho: four healthy recordings are references, three more and one with a spall through the
face are checked. The pictures are those of the pages that `indicators` and `check` write; they go to docs/figures.
"""

from __future__ import annotations

import base64
import json
import re
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from hidden_machine import CHANNELS, FS_HZ, STATES, machine
from page_pictures import FIGURES

import siggen

GEARS = ("--fs", f"{FS_HZ:g}", "--rig", "reading.yaml")
READING = {"unit": "m/s2", "teeth": [18, 47], "speed": [33, 37]}
REFERENCES, HEALTHY, DURATION_S = 4, 7, 4.0
PICTURE = re.compile(r"data:image/png;base64,([A-Za-z0-9+/=]+)")


def recorded(folder: Path) -> list[str]:
    """Write the recordings, healthy ones first; return their files."""
    raw = machine(1, folder)
    changes = {
        "specimens": 1,
        "repeats": HEALTHY,
        "duration_s": DURATION_S,
        "states": {name: STATES[name] for name in ("healthy", "through")},
    }
    gearbox = siggen.draw(siggen.load_config({**raw, **changes}))
    files = [f"{k}.npz" for k in range(1, HEALTHY + 2)]
    for file, record in zip(files, siggen.runs(gearbox, gearbox.cases[: HEALTHY + 1]), strict=True):
        np.savez(folder / file, **dict(zip(CHANNELS, record.channels.values(), strict=True)))
    return files


def main() -> None:
    """Write the pictures and print their sizes."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        files = recorded(folder)
        (folder / "reading.yaml").write_text(json.dumps(READING), encoding="utf-8")
        for line in (
            ("indicators", files[0], *GEARS, "--out", "indicators"),
            ("baseline", *files[:REFERENCES], *GEARS, "--out", "rig"),
            ("check", "rig", *files[REFERENCES:]),
        ):
            subprocess.run(["siggen-diagnostics", *line], cwd=folder, check=line[0] != "check")
        for page, name in (("indicators/indicators.html", "angle_evidence"), ("rig/machine.html", "machine_trend")):
            shown = PICTURE.search((folder / page).read_text(encoding="utf-8"))
            if shown is not None:
                (FIGURES / f"{name}.png").write_bytes(base64.b64decode(shown[1]))
                print(f"{name}.png: {(FIGURES / f'{name}.png').stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
