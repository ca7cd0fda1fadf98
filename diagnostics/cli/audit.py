"""`siggen-diagnostics audit`: what makes a set trivially separable, how real it looks, what can be found in it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from diagnostics.cli.set_options import OwnIndicators, Seed
from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json


def audit(
    directory: Annotated[
        Path, typer.Argument(metavar="SET", help="Folder or s3://... of a finished set.", show_default=False)
    ],
    *,
    strict: Annotated[
        bool,
        typer.Option("--strict", help="End with exit code 4 after a leak, or with too few gearboxes to tell."),
    ] = False,
    reference: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            help="Compare with your own healthy recordings, a file or subfolder each; 4 or more for a verdict. "
            "Each must state its sampling rate.",
            show_default=False,
        ),
    ] = None,
    indicator: OwnIndicators = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="DIR", help="Folder, by default SET_audit.", show_default=False),
    ] = None,
    seed: Seed = 0,
    as_json: AsJson = False,
) -> None:
    """Check whether scores on a set measure the damage, and write audit.html and audit.json.

    A leak is a property of the set that makes scores meaningless. Healthy records are compared with the ranges of
    measured healthy gearboxes.

    Exit codes: 0 done, 2 no finished set, 4 with --strict if a leak was found or gearboxes are too few to tell.

    Example: siggen-diagnostics audit runs/quickstart --strict
    """
    import json

    from diagnostics.audit.audit_page import audit_summary
    from diagnostics.audit.audit_report import audit_set, write_audit
    from diagnostics.base.beside import beside
    from diagnostics.base.progress import terminal_stage
    from diagnostics.indicators.own_indicator import load_indicators
    from diagnostics.page.wording import counted
    from diagnostics.records.record_classes import refuse_lives
    from siggen.dataset.reading import open as open_set
    from siggen.errors import VerificationError

    own_indicators = load_indicators(indicator)
    dataset = open_set(directory)
    refuse_lives(dataset)
    audited = audit_set(dataset, seed, reference, own_indicators, terminal_stage)
    with terminal_stage("page", 1):
        page = write_audit(audited, dataset, out or beside(dataset.path, "_audit"))
    if as_json:
        echo_json(json.loads((page.parent / "audit.json").read_text(encoding="utf-8")))
    else:
        for sentence in (*audit_summary(audited), *(f"- {finding.line()}" for finding in audited.findings)):
            echo(sentence)
    for note in audited.notes:
        echo(f"note: {note}", err=True)
    echo(str(page), err=as_json)
    if strict and audited.findings:
        raise VerificationError(f"{directory}: {counted(len(audited.findings), 'leak')} found (--strict)")
    if strict and audited.tells_too_little:
        raise VerificationError(f"{directory}: not passed (--strict). {audited.verdict}")
