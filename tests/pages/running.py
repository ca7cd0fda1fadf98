"""A page as a reader follows it: its blocks in order, in one folder, from what is installed.

Commands have processes of their own, and so have scripts that take long or other packages.

The folder holds what a checkout holds beside the packages; so `import siggen` finds the installed one.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import signal
import subprocess
import sys
import traceback
from collections.abc import Mapping, Sequence
from pathlib import Path

from tests.command import script
from tests.pages.blocks import ROOT, Block
from tests.pages.printed import difference

BESIDE = ("configs", "benchmarks", "docs", "tests", "examples")
LEFT_OUT = shutil.ignore_patterns("*.html", "*.png", "__pycache__")
DROPPED = ("PYTHONPATH", "VIRTUAL_ENV", "SIGGEN_TRACEBACK")
SHELL = "set -eu -o pipefail\n"


def reader_folder(folder: Path, blocks: Sequence[Block]) -> Path:
    """Fill a folder with what a reader of the pages has beside the installed programs, as far as blocks name it."""
    text = "\n".join(block.source for block in blocks)
    # scripts of one folder import from the others
    for name in BESIDE if re.search(r"\b(benchmarks|docs|tests|examples)\b", text) else ("configs",):
        shutil.copytree(ROOT / name, folder / name, ignore=LEFT_OUT)
    for name in ("docs/figures", "runs"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    return folder


def reader_environment(**more: str) -> dict[str, str]:
    """Return the environment of a block: the installed commands first, one numeric thread, no terminal, no screen."""
    kept = {name: value for name, value in os.environ.items() if name not in DROPPED and not name.startswith("PYTEST")}
    path = os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
    fixed = {"PATH": path, "OMP_NUM_THREADS": "1", "MPLBACKEND": "Agg", "COLUMNS": "120", "TERM": "dumb"}
    return {**kept, **fixed, **more}


def run_block(block: Block, folder: Path, environment: Mapping[str, str]) -> str | None:
    """Run a block, or write the file that it is; return None, or what is wrong."""
    if block.title is not None:
        (folder / block.title).write_text(block.source, encoding="utf-8")
        return None
    if block.language == "python":
        file = folder / f"block_{block.line}.py"
        file.write_text(block.source, encoding="utf-8")
        fresh = block.is_slow or block.marked("needs")
        ended = _ended(["python", file.name], folder, environment) if fresh else _ended_here(file)
    else:
        ended = _ended(["bash", "-c", SHELL + block.source], folder, environment)
    code, printed, said = ended
    wanted = [int(text) for text in block.marked("exit")] or [0]
    if code not in wanted:
        return f"exit code {code}\n{printed[-2000:]}\n{said[-4000:]}"
    return None if block.prints is None else difference(block.prints, printed, same_numbers=block.same_numbers)


def failing(blocks: Sequence[Block], folder: Path, environment: Mapping[str, str]) -> str:
    """Run blocks in their order up to the first that fails; return what is wrong with it, or nothing."""
    for block in blocks:
        wrong = run_block(block, folder, environment)
        if wrong is not None:
            return f"the block at line {block.line}:\n{block.source}\n{wrong}"
    return ""


def _ended_here(file: Path) -> tuple[int, str, str]:
    """Return code, output and messages of a script in this process."""
    with contextlib.chdir(file.parent):
        try:
            return 0, script(file), ""
        except Exception:
            return 1, "", traceback.format_exc()


def _ended(command: list[str], folder: Path, environment: Mapping[str, str]) -> tuple[int, str, str]:
    """Return code, output and messages of a command; whatever it started has ended."""
    process = subprocess.Popen(
        command, cwd=folder, env=dict(environment), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    try:
        printed, said = process.communicate()
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
    return process.returncode, printed, said
