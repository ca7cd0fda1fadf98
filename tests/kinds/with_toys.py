"""`python -m tests.kinds.with_toys`: commands from standard input, with a kind of damage, sensor and noise more."""

from __future__ import annotations

import json
import sys

from siggen.noise.kinds import SOURCES
from tests.blank_pictures import blank_pictures
from tests.command import command
from tests.noise.toy_drift import ToyDrift

PACKAGES = {"siggen": "siggen", "siggen-diagnostics": "diagnostics"}

if __name__ == "__main__":
    SOURCES.append(ToyDrift)  # before sensors are imported, whose keys sources are
    from siggen.damage import kinds as faults
    from siggen.sensors import kinds as sensors
    from tests.damage.toy_hinge import ToyHinge
    from tests.sensors.toy_strain_gauge import ToyStrainGauge

    faults.KINDS.append(ToyHinge)
    sensors.KINDS.append(ToyStrainGauge)
    lines = json.load(sys.stdin)
    with blank_pictures():
        json.dump([command(PACKAGES[program], *words) for program, *words in lines], sys.stdout)
