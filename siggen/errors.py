"""Errors a user may meet, and the exit codes that the commands return for them."""

from __future__ import annotations

import errno
from collections.abc import Sequence
from dataclasses import dataclass

EXIT_OK = 0
EXIT_UNEXPECTED = 1
EXIT_USAGE = 2
EXIT_RECORDS_FAILED = 3
EXIT_MISMATCH = 4
EXIT_INTERRUPTED = 130

DISTRIBUTION = "siggen-gears"
"""Name under which siggen is installed. No package index has it, and `siggen` there is a program of somebody else:
whatever says how to install takes the words of `how_to_install`."""

LISTED_PROBLEMS = 100
"""Of a configuration; the others are counted."""


def counted(count: int, one: str, many: str = "") -> str:
    """Return a count with its noun for a message: "1 record", "2 records"; `many` where it is not `one` with an s."""
    return f"{count} {one if count == 1 else many or one + 's'}"


def how_to_install(extras: str) -> str:
    """Return how to install siggen with extras, given as "cnn" or "cnn,dask", for a message."""
    return (
        f"`pip install '.[{extras}]'` in a checkout, `pip install 'WHEEL[{extras}]'` with a wheel's file "
        "(docs/start/install.md)"
    )


class SiggenError(Exception):
    """Base of every error with a message meant for the user; `exit_code` is what a command returns."""

    exit_code = EXIT_UNEXPECTED


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing that is wrong in a configuration: its key, what came, what is allowed.

    `where` is the line of the file or the option of the command that the value comes from, where that is known.
    """

    path: str
    received: str
    allowed: str
    where: str = ""

    def __str__(self) -> str:
        """One line: path, what was received, what is allowed, where it stands."""
        where = f" ({self.where})" if self.where else ""
        return f"{self.path}: received {self.received}; {self.allowed}{where}"


class ConfigError(SiggenError):
    """A configuration that cannot be used; carries all problems at once, sorted by path."""

    exit_code = EXIT_USAGE

    def __init__(self, problems: Sequence[Problem], source: str = "configuration") -> None:
        self.problems = tuple(sorted(problems, key=lambda p: p.path))
        self.source = source
        more = len(self.problems) - LISTED_PROBLEMS
        lines = [f"  {problem}" for problem in self.problems[:LISTED_PROBLEMS]]
        lines += [f"  and {more} more"] if more > 0 else []
        super().__init__("\n".join([f"{source}: {counted(len(self.problems), 'problem')}", *lines]))


class UsageError(SiggenError):
    """A command or call that cannot be carried out as given (wrong folder, unknown record, bad option)."""

    exit_code = EXIT_USAGE


class DatasetError(SiggenError):
    """A folder that is not the set it should be (missing, incomplete, of another identity)."""

    exit_code = EXIT_USAGE


class VerificationError(SiggenError):
    """Files or re-simulated records that differ from what the manifest promises."""

    exit_code = EXIT_MISMATCH


class EngineError(SiggenError):
    """A task that raised, or workers that kept dying."""


class SolverFailure(SiggenError):  # noqa: N818 - a status of a record, not a fault of the program
    """A record that could not be simulated; becomes the record's status and reason, never a NaN."""

    def __init__(self, status: str, reason: str) -> None:
        self.status = status
        self.reason = reason
        super().__init__(f"{status}: {reason}")


def mm(length_m: float) -> str:
    """Return a length [m] as messages say it, in the unit of files: '2.8 mm'."""
    return f"{1e3 * length_m:.6g} mm"


def path_fault(error: Exception) -> str:
    """Return in words that a path given by the user can be none of a file; empty for every other error."""
    if isinstance(error, OSError) and error.errno in {errno.ENAMETOOLONG, errno.ELOOP}:
        text = str(error.filename)
        shown = text if len(text) <= 100 else f"{text[:40]}...{text[-40:]}"
        return f"{shown}: no file can have this path ({error.strerror}); give another one"
    return ""
