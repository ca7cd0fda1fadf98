"""The error of a task that raised, with the task's name and the place in the code."""

from __future__ import annotations

import traceback

from siggen.errors import EngineError


def failure_text(error: BaseException) -> str:
    """Return an exception with its traceback as text, since not every exception survives the way between processes."""
    return "".join(traceback.format_exception(error)).rstrip()


def task_error(task: object, text: str) -> EngineError:
    """Return the error that names the task, with the exception's last line first and its traceback below."""
    return EngineError(f"{task} raised {text.splitlines()[-1]}\n{text}")
