"""`siggen-diagnostics audit`: what makes a set trivially separable, how real it looks, what can be found in it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from diagnostics.cli.set_options import OwnIndicators
from siggen.cli.echo import echo
from siggen.cli.option_groups import grouped


class Speed(StrEnum):
    """Kind of machine whose speed variation is compared with."""

    bench = "bench"
    variable = "variable"


@dataclass(frozen=True, slots=True)
class RealismOptions:
    """How real the set looks."""

    realism: Annotated[
        bool, typer.Option("--realism", help="Compare healthy records with the ranges of measured healthy gearboxes.")
    ] = False
    speed: Annotated[Speed, typer.Option(help="Kind of machine to compare the speed variation with.")] = Speed.bench
    reference: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            help="Compare with your own healthy recordings: one file or one subfolder each, 4 or more for a verdict.",
            show_default=False,
        ),
    ] = None
    reference_fs: Annotated[
        float | None,
        typer.Option(metavar="HZ", help="Sampling frequency of recordings that do not state it.", show_default=False),
    ] = None


@grouped
def audit(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder or s3://... of a finished set.", show_default=False)
    ],
    *,
    strict: Annotated[
        bool,
        typer.Option(
            "--strict", help="End with exit code 4 unless passed: after a trap, or with too few gearboxes to tell."
        ),
    ] = False,
    paired: Annotated[
        bool, typer.Option("--paired", help="Also judge the differences from the specimen's own healthy record.")
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", metavar="DIR2", help="Folder for the report. Default: DIR_audit.", show_default=False
        ),
    ] = None,
    indicator: OwnIndicators = None,
    realism: RealismOptions,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the permutations, the folds and the bootstrap.")] = 0,
) -> None:
    """Check whether scores on a set measure the damage, and write audit.html and audit.json.

    A trap is a property of the set that makes scores meaningless.

    Exit codes: 0 done, 2 no finished set, 4 with --strict if a trap was found or gearboxes are too few to tell.

    Example: siggen-diagnostics audit runs/quickstart --strict --realism
    """
    from diagnostics.audit.audit_page import audit_summary
    from diagnostics.audit.audit_report import AuditOptions, audit_set, write_audit
    from diagnostics.base.beside import beside
    from diagnostics.base.progress import terminal_stage
    from diagnostics.indicators.own_indicator import load_indicators
    from diagnostics.page.wording import counted
    from diagnostics.records.record_classes import refuse_lives
    from siggen.dataset.reading import open as open_set
    from siggen.errors import VerificationError

    own = load_indicators(indicator)
    dataset = open_set(directory)
    refuse_lives(dataset)
    folder = out or beside(dataset.path, "_audit")
    wanted = AuditOptions(
        seed=seed,
        paired=paired,
        with_realism=realism.realism,
        speed=realism.speed.value,
        reference=realism.reference,
        reference_fs_hz=realism.reference_fs,
    )
    found = audit_set(dataset, wanted, own, terminal_stage)
    for sentence in audit_summary(found):
        echo(sentence)
    for finding in found.findings:
        echo(f"- {finding.line()}")
    for note in found.notes:
        echo(f"note: {note}", err=True)
    with terminal_stage("page", 1):
        page = write_audit(found, dataset, folder)
    echo(str(page))
    if strict and found.findings:
        raise VerificationError(f"{directory}: {counted(len(found.findings), 'trap')} found (--strict)")
    if strict and found.tells_too_little:
        raise VerificationError(f"{directory}: not passed (--strict). {found.verdict}")
