"""`siggen verify`: a set against its manifest, and a sample of records simulated again."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.working import working


def verify(
    folder: Annotated[Path, typer.Argument(help="Folder or s3://... of a finished set.", metavar="DIR")],
    sample: Annotated[int, typer.Option("--sample", min=0, help="Records to simulate again.")] = 4,
    physics: Annotated[
        int,
        typer.Option(
            "--physics",
            min=0,
            metavar="K",
            help="Integrate K records, spread over all states, again with fine Runge-Kutta steps, and report "
            "the error by state. Costs fifteen times the records, or more.",
        ),
    ] = 0,
    as_json: AsJson = False,
) -> None:
    """Compare every file with its hash in the manifest, and some records with a new simulation.

    With --physics the numerical error is measured and kept in physics.json beside the set; no other file changes.

    Exit codes: 0 all as promised, 2 no finished set, 4 something differs or an error is above the set's tolerance
    and its label does not say so.

    Example: siggen verify runs/quickstart --sample 10 --physics 8
    """
    from dataclasses import asdict

    from siggen.cli.run_display import run_shown
    from siggen.errors import EXIT_MISMATCH, counted
    from siggen.sets.precision import measure_precision, precision_lines
    from siggen.sets.verification import HASHES_ALONE, problem_lines
    from siggen.sets.verification import verify as verify_set

    with working("comparing files with their hashes, and records with a new simulation", compiles=sample > 0):
        found = verify_set(folder, sample)
    precision = None
    if physics and not found.mismatches:
        with run_shown() as shown:
            precision = measure_precision(folder, physics, shown.progress)
    ok = not found.mismatches and (precision is None or precision.within)
    if as_json:
        measured = {} if precision is None else {"physics": asdict(precision)}
        echo_json({**asdict(found), **measured, "ok": ok})
    else:
        echo(f"{found.path}: {counted(found.files, 'file')}, {found.bytes / 1e6:.1f} MB")
        again = f"{counted(len(found.records), 'record')} simulated again, compared "
        again = again if found.records else "records simulated again: "
        echo(("" if found.comparison.startswith(HASHES_ALONE) else again) + found.comparison)
        if found.made_by:
            same = "as this one" if found.made_by == found.here else f"this is {found.here}"
            echo(f"made by {found.made_by}; {same}")
        for line in problem_lines(found):
            echo(line, err=True)
        echo("differs from its manifest" if found.mismatches else "as its manifest promises")
        for line in precision_lines(precision) if precision is not None else ():
            echo(line)
        if physics and precision is None:
            echo("no record integrated again, since files differ", err=True)
    if not ok:
        raise typer.Exit(EXIT_MISMATCH)
