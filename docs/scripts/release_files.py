"""The files of a release, and a trial of them: `python docs/scripts/release_files.py dist SET PAGE` (`make wheel`).

Builds the source archive, and from it the wheel, into a new folder. Beside them go a list of the locked dependencies
(CycloneDX), a finished set as an archive, its page, and the hashes of all files. An environment that has nothing but
Python beside the checkout then takes the wheel after what locks/siggen.txt pins with hashes, starts every command of
both programs, generates a small set from a preset, and verifies both sets. The Python that runs this script is the one
that all of it is tried with.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LOCK = ROOT / "locks" / "siggen.txt"
PINNED = ("-c", str(ROOT / "constraints.txt"))
COMMANDS = re.compile(r"^#+ `(siggen[a-z -]*)`$", re.MULTILINE)
"""Headings of the page of commands, which has all of them: a test compares it with the programs."""
SMALL = ("--set", "specimens=1", "--set", "duration_s=0.2")


def made(folder: Path, finished: Path, page: Path, tools: Path) -> None:
    """Write all files of a release into a folder; `tools` is where what builds them gets an environment of its own."""
    run([sys.executable, "-m", "venv", str(tools)])
    run([str(tools / "bin/python"), "-m", "pip", "install", "--quiet", *PINNED, "build", "cyclonedx-bom"])
    run([str(tools / "bin/python"), "-m", "build", "--outdir", str(folder), str(ROOT)])
    (archive,) = folder.glob("*.tar.gz")
    listed = folder / archive.name.replace(".tar.gz", ".cdx.json")
    options = ["--pyproject", str(ROOT / "pyproject.toml"), "--mc-type", "library", "--output-reproducible"]
    run([str(tools / "bin/cyclonedx-py"), "requirements", str(LOCK), *options, "--output-file", str(listed)])
    shutil.make_archive(str(folder / finished.name), "zip", finished.parent, finished.name)
    shutil.copy(page, folder / f"{finished.name}_report.html")
    sums = [f"{sha256(file)}  {file.name}\n" for file in sorted(folder.iterdir())]
    (folder / "SHA256SUMS").write_text("".join(sums), encoding="utf-8")


def tried(folder: Path, place: Path) -> None:
    """Install the wheel of a folder with hashes and use it, and its set, away from the checkout."""
    (wheel,), (finished,) = folder.glob("*.whl"), folder.glob("*.zip")
    run([sys.executable, "-m", "venv", str(place / "bare")])
    wanted = place / "wheel.txt"
    wanted.write_text(f"{wheel.resolve()} --hash=sha256:{sha256(wheel)}\n")
    install = [str(place / "bare/bin/python"), "-m", "pip", "install", "--quiet", "--require-hashes"]
    run([*install, "-r", str(LOCK)])
    run([*install, "--no-deps", "-r", str(wanted)])
    for program, *words in map(str.split, COMMANDS.findall((ROOT / "docs/reference/commands.md").read_text())):
        run([str(place / "bare/bin" / program), *words, "--help"], place)
    shutil.unpack_archive(finished, place)
    siggen = str(place / "bare/bin/siggen")
    for command in (
        [siggen, "--version"],
        [siggen, "plan", "quickstart"],
        [siggen, "generate", "quickstart", "--out", "set", "--workers", "1", *SMALL],
        [siggen, "verify", "set", "--sample", "1"],
        [siggen, "show", "set", "--record", "0"],
        [siggen, "verify", finished.stem, "--sample", "1"],
    ):
        run(command, place)


def sha256(file: Path) -> str:
    """Return the hash of a file as `sha256sum` prints it."""
    return hashlib.sha256(file.read_bytes()).hexdigest()


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
    dist, finished_set, its_page = map(Path, sys.argv[1:])
    dist.mkdir(parents=True)
    with tempfile.TemporaryDirectory() as name:
        made(dist, finished_set, its_page, Path(name) / "tools")
        tried(dist, Path(name))
