"""Modes of a housing have the same bytes for any number of threads and on other processors."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = """
import hashlib
from siggen.drivetrain.housing_modes import housing_modes
from siggen.drivetrain.loose_foot import loosened
from tests.dynamics.housing.boxes import box_motions, iron_box
box = iron_box()
sound = housing_modes(box, 6000.0)
for found in (sound, loosened(sound, box, 0.1)):
    seats = list(box_motions(box, found.halves).values())
    parts = found.frequency_hz, found.bolt_share, found.shapes(seats), found.static_flexibility(seats, seats)
    print(hashlib.sha256(b"".join(part.tobytes() for part in parts)).hexdigest())
"""


def digest(**changed: str) -> str:
    environment = {**os.environ, "OMP_NUM_THREADS": "1", **changed}
    ran = subprocess.run([sys.executable, "-c", PROGRAM], cwd=ROOT, env=environment, capture_output=True, text=True,
                         check=True)  # fmt: skip
    return ran.stdout.strip()


def test_the_same_bytes_with_two_threads_of_an_older_processor() -> None:
    older = {"OPENBLAS_CORETYPE": "Nehalem", "NPY_DISABLE_CPU_FEATURES": "X86_V3"}
    assert digest() == digest(OMP_NUM_THREADS="2", OPENBLAS_NUM_THREADS="2", **older)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["generic", "haswell"])
def test_the_same_bytes_compiled_for_another_processor(name: str) -> None:
    assert digest() == digest(NUMBA_CPU_NAME=name)
