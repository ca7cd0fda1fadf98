"""`siggen inspect life`: one gearbox that runs to failure, inspection by inspection, or as a file of states."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.working import working

if TYPE_CHECKING:
    from siggen.gearbox.design import SetDesign


def life(
    config: Annotated[Path, typer.Argument(help="YAML file with a section life, or a preset such as fleet.")],
    specimen: Annotated[int, typer.Option("--specimen", min=0, help="Number of the gearbox in the set, from 0.")] = 0,
    overrides: Annotated[
        list[str] | None,
        typer.Option("--set", help="Replace a value, such as life.interval_h=2.5.", metavar="PATH=VALUE"),
    ] = None,
    as_states: Annotated[
        Path | None,
        typer.Option(
            "--as-states",
            metavar="FILE",
            help="Write the same configuration with this gearbox's inspections as listed states in place of life; "
            "never a file that exists.",
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Print what a gearbox shows at each inspection: age, phase, pitted teeth, area, remaining life.

    With --as-states the records of this gearbox have the same bytes in a set of that file as in the set of lives.

    Example: siggen inspect life fleet --specimen 3 --as-states runs/gearbox_3.yaml
    """
    from siggen.checks.loading import load_config

    with working("running a gearbox to its end"):
        loaded = load_config(config, overrides or ())
        found = _content(loaded, specimen)
    if as_states is not None:
        _write(as_states, loaded, specimen)
        echo(f"wrote {as_states}: inspections of gearbox {specimen} as states", err=True)
    if as_json:
        echo_json(found)
        return
    _print(found)


def _content(design: SetDesign, specimen: int) -> dict[str, Any]:
    """Return the unit and its inspections, each with its pitted teeth.

    Raises
    ------
    UsageError
        If the set has no lives, or not so many gearboxes.
    """
    from siggen.errors import UsageError
    from siggen.sets.drawn import life_rows

    if not design.lives:
        raise UsageError(f"{design.name} has no section life; allowed: a configuration with one, such as fleet")
    if specimen >= design.specimens:
        raise UsageError(f"--specimen {specimen}: allowed: 0 to {design.specimens - 1}")
    rows = life_rows(design, specimen)
    inspections = [
        {**row, "teeth": [one for one in rows["teeth"] if one["inspection"] == row["inspection"]]}
        for row in rows["inspections"]
    ]
    return {"unit": rows["units"][0], "inspections": inspections}


def _write(file: Path, design: SetDesign, specimen: int) -> None:
    from siggen.errors import UsageError
    from siggen.file_writing import write_file

    if file.exists():
        raise UsageError(f"--as-states {file}: is there already; give a new file")
    write_file(file, design.listed(specimen).text)


def _print(found: dict[str, Any]) -> None:
    from rich.console import Console
    from rich.table import Table

    unit = found["unit"]
    table = Table(
        "inspection", "age", "phase", "pitted teeth", "worst tooth", "share", "remaining life",
        title=f"Gearbox {unit['specimen_id']}: {unit['event']} at {unit['observed_h']:.4g} h", title_justify="left",
    )  # fmt: skip
    for row in found["inspections"]:
        worst = max(row["teeth"], key=lambda one: one["area_share"], default=None)
        left = f"{row['rul_h']:.4g} h" if row["rul_h"] is not None else f"at least {row['rul_at_least_h']:.4g} h"
        place = "" if worst is None else f"{worst['gear']} {worst['tooth']}"
        share = "" if worst is None else f"{worst['area_share']:.2%}"
        cells = (str(row["inspection"]), f"{row['age_h']:.4g} h", row["phase"], str(len(row["teeth"])))
        table.add_row(*cells, place, share, left)
    Console().print(table)
