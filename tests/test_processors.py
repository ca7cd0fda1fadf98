"""Numbers hold on other processors: numeric tests again, each in a fresh process whose libraries are told another one.

The variables must be set before numpy, numba and torch are imported. Kernels that cannot run here are skipped.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
FILM = "test_scipy_gives_the_motion_with_film_and_damping_by_asperity_share[none]"
FEW = (
    f"tests/views/test_exported_model.py::{FILM}",
    "tests/diagnostics/training/test_cnn.py::test_the_network_learns_within_few_epochs_and_computes_in_float32_alone",
)
NUMERIC = (
    "tests/views/test_exported_model.py",
    "tests/diagnostics/training/test_cnn.py",
    "tests/dynamics/time/test_equations.py",
    "tests/dynamics/time/test_response.py",
    "tests/dynamics/structure/test_casing_structure.py",
)
OLD = {"OPENBLAS_CORETYPE": "Nehalem", "NPY_DISABLE_CPU_FEATURES": "X86_V3", "ONEDNN_MAX_CPU_ISA": "SSE41"}
PROCESSORS = (
    *({"OPENBLAS_CORETYPE": name} for name in ("Haswell", "Zen", "SkylakeX")),
    *({"NUMBA_CPU_NAME": name} for name in ("generic", "haswell")),
    *({"ONEDNN_MAX_CPU_ISA": name} for name in ("AVX2", "DEFAULT")),
)
"""Setting of a process -> which kernels OpenBLAS takes, what numba compiles for, the most that oneDNN may use."""


def run(arguments: list[str], processor: dict[str, str]) -> subprocess.CompletedProcess[str]:
    changed = {**os.environ, "OMP_NUM_THREADS": "1", **processor}
    return subprocess.run(
        [sys.executable, *arguments], cwd=ROOT, env=changed, capture_output=True, text=True, check=False
    )


def check_on(processor: dict[str, str], tests: tuple[str, ...]) -> None:
    blas = "import numpy, scipy.linalg; scipy.linalg.inv(numpy.eye(40) @ numpy.ones((40, 40)) + numpy.eye(40))"
    if run(["-c", blas], processor).returncode == -signal.SIGILL:
        pytest.skip(f"this processor has not what {processor} takes")
    found = run(["-m", "pytest", "-p", "no:cacheprovider", "-p", "no:xdist", *tests], processor)
    assert found.returncode == 0, found.stdout[-4000:] + found.stderr[-2000:]


@pytest.mark.slow
def test_a_record_and_a_network_hold_on_a_processor_of_2008() -> None:
    check_on(OLD, FEW)


@pytest.mark.slow
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("processor", PROCESSORS, ids=lambda found: "-".join(*found.items()))
def test_numbers_hold_on_another_processor(processor: dict[str, str]) -> None:
    check_on(processor, NUMERIC)
