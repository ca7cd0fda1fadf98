"""`siggen inspect life`: one gearbox that runs to failure, inspection by inspection, or as a file of states."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from siggen.cli.echo import echo
from siggen.cli.inspection import Inspection
from siggen.cli.json_output import echo_json
from siggen.cli.working import working

if TYPE_CHECKING:
    from siggen.gearbox.design import SetDesign


def life(asked: Inspection) -> None:
    """Print what a gearbox shows at each inspection: age, phase, pitted teeth, area, remaining life.

    The file of --out is the same configuration with these inspections as states in place of life; records of this
    gearbox have the same bytes in a set of it as in the set of lives. It is never one that exists.
    """
    asked.png(prints=True, endings=(".yaml", ".yml"))
    with working("running a gearbox to its end"):
        loaded = asked.design()
        found = _content(loaded, asked.gearbox)
    if asked.out is not None:
        _write(asked.out, loaded, asked.gearbox)
        echo(f"wrote {asked.out}: inspections of gearbox {asked.gearbox} as states", err=True)
    if asked.as_json:
        echo_json(found)
        return
    _print(found)


def _content(design: SetDesign, specimen: int) -> dict[str, Any]:
    """Return the unit and its inspections, each with its pitted teeth.

    Raises
    ------
    UsageError
        If the set has no lives.
    """
    from siggen.errors import UsageError
    from siggen.sets.drawn import life_rows

    if not design.lives:
        raise UsageError(f"{design.name} has no section life; allowed: a configuration with one, such as fleet")
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
        raise UsageError(f"--out {file}: is there already; give a new file")
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
