"""A command line run to its end: what slips, errors and interruptions turn into, in the words of all messages."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from typing import Any

import typer

from siggen.cli.echo import echo
from siggen.errors import EXIT_INTERRUPTED, EXIT_OK, EXIT_UNEXPECTED, EXIT_USAGE, SiggenError, path_fault

TRACEBACK_VARIABLE = "SIGGEN_TRACEBACK"
STAYS = "no file is half written; the same command begins again"


def run_program(app: typer.Typer, name: str, stays: Mapping[str, str]) -> None:
    """Run a command line; what goes wrong becomes a message and its exit code, no traceback.

    Parameters
    ----------
    app : Typer
    name : str
        Of the program.
    stays : mapping of str to str
        By command, what stays on disk when it ends early, and how to go on; `STAYS` for the others.
    """
    commands = {str(getattr(known.callback, "__name__", "")) for known in app.registered_commands}
    command = next((word for word in sys.argv[1:] if word in commands), "")
    early = stays.get(command, STAYS)
    try:
        code = app(prog_name=name, standalone_mode=False)  # an interrupted command returns its exit code here
        if code == EXIT_INTERRUPTED:
            raise KeyboardInterrupt
    except SiggenError as error:
        _end(f"{name}: {error}", error.exit_code)
    except typer.TyperException as error:
        _end(_slip_words(error, f"{name} {command}".rstrip()), EXIT_USAGE)
    except BrokenPipeError:  # the reader of a pipe, such as head, has seen enough
        sys.stdout = None
    except (KeyboardInterrupt, typer.Abort):
        _end(f"{name}: interrupted; {early}", EXIT_INTERRUPTED)
    except MemoryError:
        _end(f"{name}: not enough memory; {early}", EXIT_UNEXPECTED)
    except Exception as error:
        if words := path_fault(error):
            _end(f"{name}: {words}", EXIT_USAGE)
        if os.environ.get(TRACEBACK_VARIABLE):
            raise
        kind = type(error).__name__
        again = f"run again with {TRACEBACK_VARIABLE}=1 for details"
        _end(f"{name}: unexpected {kind}: {error}; {again}", EXIT_UNEXPECTED)
    else:
        sys.exit(code or EXIT_OK)


def _end(message: str, code: int) -> None:
    if message:
        echo(message, err=True)
    sys.exit(code)


def _slip_words(error: Any, command: str) -> str:
    """Return what is wrong with the options and arguments that were given; empty where the help was printed."""
    parameter, option = getattr(error, "param", None), getattr(error, "option_name", "")
    known = getattr(getattr(getattr(error, "ctx", None), "command", None), "commands", {})
    if not error.message and parameter is None:
        return ""
    if parameter is not None:
        words = _parameter_words(error, parameter)
    elif hasattr(error, "possibilities"):
        near = " or ".join(error.possibilities or ())
        words = f"{option}: no such option{f'; did you mean {near}?' if near else ''}"
    elif option:
        words = (
            f"{option}: {'a value is missing' if 'requires' in error.message else 'received a value; it takes none'}"
        )
    elif known:
        words = f"{error.message.split(chr(39))[1]}: no such command; allowed: {', '.join(known)}"
    else:
        words = f"received more than it takes: {error.message.rpartition('(')[2].rstrip(')')}"
    return f"{command}: {words} (`{command} -h` explains)"


def _parameter_words(error: Any, parameter: Any) -> str:
    shown = parameter.opts[0] if parameter.param_type_name == "option" else parameter.metavar or parameter.name.upper()
    found = parameter.type_descriptor
    choices = ", ".join(str(getattr(choice, "value", choice)) for choice in found.choices or ())
    if not error.message:
        return f"{shown} is missing: {choices or (parameter.help or '').rstrip('.')}"
    details: list[dict[str, Any]] = getattr(error.__cause__, "errors", list)()
    if not details:
        return f"{shown}: {error.message.rstrip('.')}"
    low, high = parameter.min, parameter.max
    whole = "whole number" if "int" in str(found.annotation) else "number"
    bounds = f" from {low:g} to {high:g}" if None not in (low, high) else f" from {low:g} on" if low is not None else ""
    return f"{shown}: received {details[0]['input']}; allowed: {choices or f'a {whole}{bounds}'}"
