"""The wheel, built and tried in a bare environment: `python docs/scripts/bare_wheel.py dist` (`make wheel`).

Builds a wheel into the folder, makes an environment that has nothing but Python beside the checkout, installs the wheel
there after what locks/siggen.txt pins with hashes, starts every command of both programs, and lets a small set be
generated from a preset and verified. The Python that runs this script is the one that all of it is tried with.
"""

from __future__ import annotations

import hashlib
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COMMANDS = re.compile(r"^#+ `(siggen[a-z -]*)`$", re.MULTILINE)
"""Headings of the page of commands, which has all of them: a test compares it with the programs."""
SMALL = ("--set", "specimens=1", "--set", "duration_s=0.2")


def built(folder: Path) -> Path:
    """Return the wheel of this checkout, the only one in the folder."""
    for old in folder.glob("*.whl"):
        old.unlink()
    run([sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", str(folder), str(ROOT)])
    (wheel,) = folder.glob("*.whl")
    return wheel


def tried(wheel: Path, place: Path) -> None:
    """Install a wheel with hashes and use it, away from the checkout."""
    run([sys.executable, "-m", "venv", str(place / "bare")])
    wanted = place / "wheel.txt"
    wanted.write_text(f"{wheel.resolve()} --hash=sha256:{hashlib.sha256(wheel.read_bytes()).hexdigest()}\n")
    install = [str(place / "bare/bin/python"), "-m", "pip", "install", "--quiet", "--require-hashes"]
    run([*install, "-r", str(ROOT / "locks/siggen.txt")])
    run([*install, "--no-deps", "-r", str(wanted)])
    for program, *words in map(str.split, COMMANDS.findall((ROOT / "docs/reference/commands.md").read_text())):
        run([str(place / "bare/bin" / program), *words, "--help"], place)
    siggen = str(place / "bare/bin/siggen")
    for command in (
        [siggen, "--version"],
        [siggen, "plan", "quickstart"],
        [siggen, "generate", "quickstart", "--out", "set", "--workers", "1", *SMALL],
        [siggen, "verify", "set", "--sample", "1"],
        [siggen, "show", "set", "--record", "0"],
    ):
        run(command, place)


def run(command: Sequence[str], place: Path | None = None) -> None:
    """Run a command that must succeed, with no code of the checkout in reach; print it with its time."""
    started_s = time.perf_counter()
    clean = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONHOME")}
    done = subprocess.run(command, cwd=place, env=clean, capture_output=True, text=True, check=False)
    line = " ".join(Path(part).name if part.startswith("/") else part for part in command)
    print(f"{time.perf_counter() - started_s:6.1f} s  {line}")
    if done.returncode != 0:
        sys.exit(f"exit code {done.returncode}\n{done.stdout}\n{done.stderr}")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        tried(built(Path(sys.argv[1])), Path(name))
