"""`siggen export-model`: the equations of motion of one record, for integration with other tools."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.echo import echo
from siggen.cli.working import working


def export_model(
    source: Annotated[Path, typer.Argument(metavar="CONFIG|DIR", help="YAML file of a set, or the folder of a set.")],
    record: Annotated[int, typer.Option("--record", min=0, help="Index of the record (column record_id).")],
    out: Annotated[Path, typer.Option("--out", help="File to write: .npz.")],
    overrides: Annotated[
        list[str] | None, typer.Option("--set", help="Replace a value, such as duration_s=0.5.")
    ] = None,
) -> None:
    """Write matrices, mesh law, start state and time grid of one record.

    docs/reference/exported_model.md describes every key.

    Example: siggen export-model configs/paper_a.yaml --record 1 --out model.npz
    """
    import json

    from siggen.cli.record_choice import chosen_record
    from siggen.views.exported_model import check_model_file, exported_model, write_model

    check_model_file(out)
    with working("simulating the record"):
        design, drawn, planned = chosen_record(source, record, overrides or ())
        text = json.dumps(design.canonical(), sort_keys=True)
        model = exported_model(drawn, planned, identity=design.identity, configuration=text)
    write_model(model, out)
    echo(str(out))
