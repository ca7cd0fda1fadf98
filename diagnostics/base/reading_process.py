"""Files of strangers read in a process apart: what a damaged one does to the libraries that parse it stays there.

One process is started for all files: recordings, predictions, models. It loads the libraries once and forks for every
file, within limits of memory and time. What was read comes back as arrays in a file, never as objects.
"""

from __future__ import annotations

import atexit
import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from pathlib import Path
from typing import Any

from siggen.errors import UsageError

MEMORY_BYTES, MEMORY_PER_BYTE = 4 << 30, 64
"""Address space of one reading beside the libraries; compressed and text files grow when they are read."""

CPU_S, BYTES_PER_CPU_S = 60, 1 << 20

_started: dict[int, subprocess.Popen[str]] = {}
"""Process id of the asking process -> its reading process: one that was forked starts its own."""


@contextmanager
def read_apart(path: Path, work: str, *, size: int | None = None, **more: Any) -> Iterator[Path]:
    """Give the folder with what a function left of a file, called in another process where the system can fork.

    Parameters
    ----------
    path : Path
        A regular file.
    work : str
        MODULE:FUNCTION, called with the path, the folder and what is given beside; its module, and what that names in
        `LOADED_ONCE`, is loaded once.
    size : int, optional
        Bytes that the limits follow; that of the file.

    Raises
    ------
    UsageError
        As of the function, or if reading ended the process, in words.
    """
    if path.exists() and not path.is_file():
        raise UsageError(f"{path}: is no file that can be read through; allowed: a regular file")
    with tempfile.TemporaryDirectory(prefix="siggen-reading-") as name:
        folder = Path(name)
        if hasattr(os, "fork"):
            here = path.anchor or str(Path.cwd())
            question = {"path": str(path), "here": here, "to": name, "work": work, "size": size}
            answer = _asked({**question, "more": more})
            if "refused" in answer:
                raise UsageError(answer["refused"])
            if answer["ended"]:
                raise UsageError(f"{path}: cannot be read: it is damaged, or far too large ({answer['ended']})")
        else:
            _function(work)(path, folder, **more)
        yield folder


def _function(work: str) -> Callable[..., None]:
    module, _, name = work.partition(":")
    found: Callable[..., None] = getattr(import_module(module), name)
    return found


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
    command = [sys.executable, "-P", "-c", "from diagnostics.base.reading_process import serve; serve()"]
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
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the asking process decides what it means
    for line in sys.stdin:
        question = json.loads(line)
        with suppress(Exception):  # the child says it
            _function(question["work"])
            for name in getattr(sys.modules[question["work"].partition(":")[0]], "LOADED_ONCE", ()):
                import_module(name)
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
    """Read one file, leave what was asked for or a sentence, and end the process."""
    path, folder = Path(question["path"]), Path(question["to"])
    try:
        os.chdir(question["here"])
        own = path.stat().st_size if path.exists() else 0  # the function says that there is none
        _limit(own if question["size"] is None else question["size"])
        _function(question["work"])(path, folder, **question["more"])
    except UsageError as error:
        (folder / "refused").write_text(str(error), encoding="utf-8", errors="replace")
    except BaseException:
        os._exit(1)
    os._exit(0)


def _limit(size: int) -> None:
    import resource

    memory = _address_space_bytes() + MEMORY_BYTES + MEMORY_PER_BYTE * size
    seconds = CPU_S + size // BYTES_PER_CPU_S
    for limit, asked in ((resource.RLIMIT_AS, memory), (resource.RLIMIT_CPU, seconds), (resource.RLIMIT_CORE, 0)):
        # never above what this process was started with: asking for more is refused
        given = [bound for bound in resource.getrlimit(limit) if bound != resource.RLIM_INFINITY]
        resource.setrlimit(limit, (min([asked, *given]),) * 2)


def _address_space_bytes() -> int:
    """Return what this process holds before it reads: loaded libraries; 0 where the system does not say."""
    pages = Path("/proc/self/statm")
    return int(pages.read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE") if pages.is_file() else 0
