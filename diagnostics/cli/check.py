"""`siggen-diagnostics check`: whether a machine has changed against its healthy recordings."""

from __future__ import annotations

import re
from dataclasses import asdict, replace
from pathlib import Path
from typing import Annotated

import typer

from diagnostics.cli.recording_options import Rig, recordings_of, said_by
from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json

READ_AS = re.compile(r"(?<![\w-])--(?!rig|load)[a-z]")
"""Options in messages about files that `check` has not: it reads files as the machine's first ones."""


def check(
    machine: Annotated[
        Path, typer.Argument(metavar="MACHINE", help="Folder that `baseline` wrote.", show_default=False)
    ],
    new: Annotated[
        list[str],
        typer.Argument(
            metavar="NEW...", help="Recordings to judge, as those of `baseline`, the same channels.", show_default=False
        ),
    ],
    rig: Rig = None,
    load: Annotated[
        float | None, typer.Option("--load", help="Load, in the unit of `baseline --load`; not after `--load slip`.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Say of every recording: unchanged, changed, other load or speed, or cannot tell. No fault is named.

    Writes a page with the trend into the machine's folder. Exit codes: 0 all are unchanged, 4 something has changed, 2
    a file cannot be read, 3 a recording cannot be compared.

    Example: siggen-diagnostics check rig august.csv september.csv
    """
    from diagnostics.base.extras import require_packages
    from diagnostics.base.progress import terminal_stage
    from diagnostics.machine.check import (
        CANNOT_TELL,
        CHANGED,
        UNCHANGED,
        check_recording,
        load_sentence,
        past_checks,
        rate_sentence,
        with_checks,
        write_history,
    )
    from diagnostics.machine.machine import load_machine
    from diagnostics.machine.machine_page import write_machine_page
    from diagnostics.recordings.channel_factor import UNKNOWN_UNIT
    from diagnostics.recordings.measured_recording import read_recording
    from siggen.errors import EXIT_MISMATCH, EXIT_OK, EXIT_RECORDS_FAILED, EXIT_USAGE, UsageError

    require_packages("the page of a machine", "matplotlib")
    known = load_machine(machine)
    load_note = load_sentence(known, load)
    sources = recordings_of(new)
    read = said_by(rig, sources[0]).over(known.facts)
    if known.facts.unit == UNKNOWN_UNIT != read.unit:
        raise UsageError(
            f"{rig}: unit: received {read.unit}; the references of {machine} state none, so levels cannot be compared. "
            "Leave it out, or make the machine again with it"
        )
    results, unread = [], {}
    with terminal_stage("recordings", len(sources)) as advance:
        for path, row in sources:
            facts = replace(read, row=row)
            name = path.name if row is None else f"{path.name}:{row}"
            try:
                results.append(check_recording(known, read_recording(path, known.channels, facts), name, load))
            except UsageError as error:
                unread[name] = _in_words_of_check(str(error).removeprefix(f"{path}: "), machine)
            advance()
    if unread and not results:
        raise UsageError("\n".join(f"{name}: {reason}" for name, reason in unread.items()))
    history = with_checks(past_checks(machine), results)
    if as_json:
        echo_json({"machine": str(machine), "checks": [asdict(result) for result in results], "refused": unread})
    else:
        for result in results:
            echo(f"{result.recording}: {result.verdict}: {result.reason}{result.turning}")
        for name, reason in unread.items():
            echo(f"{name}: {CANNOT_TELL}: {reason}")
    used = [result.used for result in results if result.score is not None]
    if used:
        echo(rate_sentence(min(used), known.false_alarms), err=True)
    for note in [*(f"doubtful: {doubt}" for doubt in known.doubts), *([load_note] if load_note else [])]:
        echo(note, err=True)
    page = write_machine_page(known, machine, results, history)
    write_history(machine, history)  # last: a call that fails and is given again is in it once
    echo(str(page), err=as_json)
    verdicts = {result.verdict for result in results}
    without_change = EXIT_USAGE if unread else EXIT_OK if verdicts == {UNCHANGED} else EXIT_RECORDS_FAILED
    raise typer.Exit(EXIT_MISMATCH if CHANGED in verdicts else without_change)


def _in_words_of_check(message: str, machine: Path) -> str:
    """Return why a file cannot be read, and where `check` is told what other commands take as options."""
    if not READ_AS.search(message):
        return message
    return (
        f"{message.rstrip('.')}. Options named here are those of `siggen-diagnostics baseline`, which says how files "
        f"of "
        f"{machine} are read; what differs in newer files `check` takes from a rig file: --rig rig.yaml"
    )
