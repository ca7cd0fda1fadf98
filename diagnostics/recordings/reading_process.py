"""Recorded files read in a process apart: what a damaged file does to the libraries that parse it stays there.

One process is started for all files. It loads the libraries once and forks for every file, within limits of memory and
time. The columns come back as arrays in a file, never as objects.
"""

from __future__ import annotations

import atexit
import json
import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.recordings.recorded_columns import Columns, refuse_many
from siggen.errors import UsageError

MEMORY_BYTES, MEMORY_PER_BYTE = 4 << 30, 64
"""Address space of one reading, of which libraries reserve most; compressed and text files grow when they are read."""

CPU_S, BYTES_PER_CPU_S = 60, 1 << 20

_started: dict[int, subprocess.Popen[str]] = {}
"""Process id of the asking process -> its reading process: one that was forked starts its own."""


def columns_read_apart(path: Path, row: int | None = None) -> Columns:
    """Return `file_columns` of a file, read in another process where the system can fork.

    Raises
    ------
    UsageError
        As of `file_columns`, or if reading ended the process, in words.
    """
    if not hasattr(os, "fork"):
        from diagnostics.recordings.file_columns import file_columns

        return file_columns(path, row)
    with tempfile.TemporaryDirectory(prefix="siggen-reading-") as folder:
        answer = _asked({"path": str(path.absolute()), "shown": str(path), "row": row, "to": folder})
        if "refused" in answer:
            raise UsageError(answer["refused"])
        if answer["ended"]:
            raise UsageError(f"{path}: cannot be read: it is damaged, or far too large ({answer['ended']})")
        return _columns(Path(folder))


def _asked(question: dict[str, Any]) -> dict[str, Any]:
    process = _started.get(os.getpid())
    if process is None or process.poll() is not None:
        process = _started[os.getpid()] = _start()
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.write(json.dumps(question) + "\n")
    process.stdin.flush()
    answer: dict[str, Any] = json.loads(process.stdout.readline() or '{"ended": "its process was ended"}')
    return answer


def _start() -> subprocess.Popen[str]:
    command = [sys.executable, "-P", "-c", "from diagnostics.recordings.reading_process import serve; serve()"]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    process = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=environment
    )
    atexit.register(_stop, process)
    return process


def _stop(process: subprocess.Popen[str]) -> None:
    if process.stdin is not None and process.stdout is not None:
        process.stdin.close()
        process.stdout.close()
    process.kill()
    process.wait()


def serve() -> None:
    """Read files as lines of stdin name them, until it is closed: the side of the reading process."""
    import scipy.io  # noqa: F401 - loaded before it forks

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the asking process decides what it means
    for line in sys.stdin:
        question = json.loads(line)
        child = os.fork()
        if child == 0:
            _read(question)
        answer = _answer(os.waitpid(child, 0)[1], Path(question["to"]))
        sys.stdout.write(json.dumps(answer) + "\n")
        sys.stdout.flush()


def _answer(status: int, folder: Path) -> dict[str, Any]:
    refused = folder / "refused"
    if refused.is_file():
        return {"refused": refused.read_text(encoding="utf-8")}
    code = os.waitstatus_to_exitcode(status)
    if code == -signal.SIGXCPU:
        return {"ended": "reading it took too long"}
    return {"ended": f"signal {-code}" if code < 0 else f"exit code {code}" if code else ""}


def _read(question: dict[str, Any]) -> None:
    """Read one file, leave its columns or a sentence, and end the process."""
    from diagnostics.recordings.file_columns import file_columns

    path, folder = Path(question["path"]), Path(question["to"])
    try:
        _limit(path.stat().st_size)
        found = file_columns(path, question["row"])
        refuse_many(path, len(found.values))
        _keep(found, folder)
    except UsageError as error:
        text = str(error).replace(question["path"], question["shown"])
        (folder / "refused").write_text(text, encoding="utf-8", errors="replace")
    except BaseException:
        os._exit(1)
    os._exit(0)


def _limit(size: int) -> None:
    import resource

    memory, seconds = MEMORY_BYTES + MEMORY_PER_BYTE * size, CPU_S + size // BYTES_PER_CPU_S
    for limit, asked in ((resource.RLIMIT_AS, memory), (resource.RLIMIT_CPU, seconds), (resource.RLIMIT_CORE, 0)):
        # never above what this process was started with: asking for more is refused
        given = [bound for bound in resource.getrlimit(limit) if bound != resource.RLIM_INFINITY]
        resource.setrlimit(limit, (min([asked, *given]),) * 2)


def _keep(found: Columns, folder: Path) -> None:
    facts = {
        "fs_hz": found.fs_hz,
        "full_scale": found.full_scale,
        "simulated": found.simulated,
        "units": dict(found.units),
        "own": dict(found.own),
    }
    (folder / "facts.json").write_text(json.dumps({**facts, "names": list(found.values)}), encoding="utf-8")
    for number, column in enumerate(found.values.values()):
        np.save(folder / f"{number}.npy", np.asarray(column, dtype=np.float64), allow_pickle=False)


def _columns(folder: Path) -> Columns:
    facts = json.loads((folder / "facts.json").read_text(encoding="utf-8"))
    names = facts.pop("names")
    return Columns({name: np.load(folder / f"{number}.npy") for number, name in enumerate(names)}, **facts)
