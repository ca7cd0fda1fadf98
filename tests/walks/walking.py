"""Commands as a user gives them, in a folder of its own: in this process, or installed programs in a fresh one."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from contextlib import chdir
from pathlib import Path
from typing import Any

import numpy as np

from tests.command import Ended, command, script

PACKAGES = {"siggen": "siggen", "siggen-diagnostics": "diagnostics"}
PROGRAMS = Path(sys.executable).parent
CLEAN = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
FS_HZ = 12_800.0


def fresh(folder: Path, line: str, code: int = 0) -> None:
    """Run an installed program in a fresh process, with nothing of the checkout in reach."""
    program, *rest = shlex.split(line)
    environment = {**CLEAN, "OMP_NUM_THREADS": "1"}
    done = subprocess.run(
        [PROGRAMS / program, *rest], cwd=folder, env=environment, capture_output=True, text=True, timeout=500,
        check=False,
    )  # fmt: skip
    assert done.returncode == code, f"{line}: exit code {done.returncode}\n{done.stdout}{done.stderr}"
    assert "Traceback" not in done.stdout + done.stderr


def run(folder: Path, line: str) -> Ended:
    """Run a command in a folder, in this process: a start costs more than most commands."""
    program, *rest = shlex.split(line)
    with chdir(folder):
        return command(PACKAGES[program], *rest)


def walk(folder: Path, line: str, code: int = 0) -> str:
    """Run one command, or a script by `python FILE`; return all that it said."""
    if line.startswith("python "):
        with chdir(folder):
            return script(folder / line.removeprefix("python "))
    done = run(folder, line)
    assert done.returncode == code, f"{line}: exit code {done.returncode}\n{done.stderr}"
    return done.stdout + done.stderr


def printed(folder: Path, line: str, code: int = 0) -> dict[str, Any]:
    """Return the JSON object that a command prints, read from its standard output alone."""
    done = run(folder, f"{line} --json")
    assert done.returncode == code, f"{line}: exit code {done.returncode}\n{done.stderr}"
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def recorded(seed: int, depth: float) -> np.ndarray:
    """Return 4 s of a gearbox of 18 and 47 teeth near 30 Hz in g, (n,); one tooth carries less, by a depth."""
    rng = np.random.default_rng(seed)
    time_s = np.arange(round(4.0 * FS_HZ)) / FS_HZ
    turns = (30.0 + 0.05 * rng.standard_normal()) * time_s + 0.003 * np.sin(2 * np.pi * 0.8 * time_s)
    dip = 1.0 - depth * np.exp(-0.5 * (((turns + rng.uniform()) % 1.0 - 0.5) / 0.02) ** 2)
    shafts = 1.0 + 0.1 * np.cos(2 * np.pi * turns) + 0.1 * np.cos(2 * np.pi * turns * 18 / 47)
    mesh = sum(np.cos(2 * np.pi * (harmonic * 18 * turns + 0.1 * harmonic)) / harmonic for harmonic in (1, 2, 3))
    return np.asarray(dip * shafts * mesh + 0.05 * rng.standard_normal(time_s.size))
