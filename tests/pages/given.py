"""What lies in a reader's folder before a page begins: sets smaller than those of their names, recordings of a machine.

They are made once and copied.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Sequence
from pathlib import Path

from nptdms import ChannelObject, TdmsWriter

import siggen
from tests.diagnostics.calibration.hidden_machine import FS_HZ, write_recording
from tests.publication.conftest import facts_file

QUICKSTART = Path(__file__).parents[2] / "configs" / "quickstart.yaml"
SET, SMALLER = "runs/quickstart", ("specimens=10", "splits={train: 10, validation: 5, test: 5}")
READ_ALONE = ("specimens=1", "duration_s=0.5", "splits={train: 10, validation: 5, test: 5}")
"""What is smaller where blocks only read the set: those that evaluate it are slow ones."""
PAIRS = {"18/47": (4242, 3.0, 34.0, True), "25/56": (4243, 2.0, 22.0, False)}
"""Recorded pair -> seed, module [mm], speed [Hz], and whether there is a tacho."""
FACTS = "publication.yaml"
STORE = "an object store"
"""An empty bucket `sets`, to which the environment leads."""
MONTHS = ("april", "may", "june", "july", "august", "september")


class Given:
    """Makes what pages begin with, each thing once."""

    def __init__(self, cache: Path) -> None:
        self._cache = cache

    def put(self, name: str, folder: Path, changes: Sequence[str] = SMALLER) -> None:
        """Copy a thing of this name into a folder; `changes` are what is smaller of a set.

        Raises
        ------
        ValueError
            If nothing of this name is known.
        """
        made = self._cache / re.sub(r"\W+", "_", " ".join((name, *changes)))
        if name == SET:
            if not made.exists():
                siggen.generate(siggen.load_config(QUICKSTART, changes), made, workers=0)
            shutil.copytree(made, folder / name)
        elif name.startswith("recordings "):
            if not made.exists():
                record(name.removeprefix("recordings "), made)
            shutil.copytree(made, folder, dirs_exist_ok=True)
        elif name == FACTS:
            facts_file(folder)
        elif name != STORE:
            raise ValueError(f"nothing is known of the given {name!r}")


def record(pair: str, folder: Path) -> None:
    """Write five healthy recordings of a machine with a pair, and one with a spalled tooth."""
    seed, module_mm, speed_hz, tacho = PAIRS[pair]
    pinion, gear = (int(teeth) for teeth in pair.split("/"))
    raw = {
        "extends": "quickstart",
        "name": "hidden",
        "seed": seed,
        "specimens": 1,
        "repeats": 5,
        "gears": {"module_mm": module_mm, "pinion": {"teeth": pinion}, "gear": {"teeth": gear}},
        "states": {"others": None, "healthy": {}},
        "operating_points": [{"speed_hz": speed_hz, "torque_nm": 40.0}],
        # a spall across the whole face strikes with 900 m/s2, beyond the 500 m/s2 of laboratory sensors
        "sensors": {name: {"range_m_s2": 2000.0} for name in ("lid", "side")},
    }
    spall = {"kind": "irregular", "gear": "pinion", "teeth": 1, "profile_length_mm": 0.5 * module_mm, "face_share": 1.0}
    damaged = {**raw, "states": {"others": None, "spalled": {"severity": "severe", "damage": spall}}}
    sound, worn = (siggen.draw(siggen.load_config(one)) for one in (raw, damaged))
    records = [siggen.run(sound, repeat=k) for k in (4, 0, 1, 2, 3)]  # the last one is the oddest
    records.append(siggen.run(worn, "spalled", repeat=1))
    folder.mkdir()
    for month, found in zip(MONTHS, records, strict=True):
        write_recording(found, folder / f"{month}.csv", tacho=tacho)
    signals = {f"ch{k + 1}": signal for k, signal in enumerate(records[4].channels.values())}
    facts = {"wf_increment": 1.0 / FS_HZ, "unit_string": "m/s^2"}
    with TdmsWriter(folder / "august.tdms") as file:
        file.write_segment([ChannelObject("recorder", *item, properties=facts) for item in signals.items()])
