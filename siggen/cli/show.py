"""`siggen show`: one record as labels, as a picture, or simulated again with what no sensor sees."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from siggen.cli.echo import cell, echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.option_groups import grouped
from siggen.cli.picture_option import PictureOptions
from siggen.cli.working import working
from siggen.errors import UsageError, counted

if TYPE_CHECKING:
    from rich.table import Table
    from rich.text import Text

    from siggen.columns.record import ChannelColumn
    from siggen.dataset.reading import Dataset

MODEL_ENDING = ".npz"
LONGEST_NAME = 48
"""Of a label that stands on one line."""
SIDE_BY_SIDE = 3
"""Single damages in one table, so that it fits 80 columns."""


@grouped
def show(
    source: Annotated[
        Path,
        typer.Argument(help="Folder or s3://... of a finished set; with --out a YAML file too.", metavar="DIR|CONFIG"),
    ],
    record: Annotated[int, typer.Option("--record", min=0, help="Id of the record (column record_id).")],
    *,
    picture: PictureOptions,
    channel: Annotated[str | None, typer.Option("--channel", help="Channel to draw; by default the first.")] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            help="Simulate the record again: its signals to .parquet or .csv, its equations of motion to .npz.",
        ),
    ] = None,
    internals: Annotated[
        bool,
        typer.Option(
            "--internals",
            help="Add mesh force, mesh stiffness, bearing forces and others to the signals.",
        ),
    ] = False,
    overrides: Annotated[
        list[str] | None,
        typer.Option("--set", help="Replace a value of what is simulated, such as duration_s=0.5."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Show labels and damage of a record, draw its waveform and spectrum, or simulate it again into a file.

    docs/reference/exported_model.md describes every key of an .npz file: matrices, mesh law, start state, time grid.

    Example: siggen show runs/quickstart --record 3

    Example: siggen show runs/quickstart --record 3 --png record3.png

    Example: siggen show quickstart --record 3 --internals --out record3.parquet

    Example: siggen show quickstart --record 3 --out model3.npz
    """
    png = picture.place("show")
    _check(out, internals=internals, overrides=overrides)
    if out is not None:
        _simulated(source, record, out, overrides or (), internals=internals)
        echo(str(out), err=as_json)
        if png is None and not as_json:
            return
    from siggen.dataset.reading import open as open_set

    dataset = open_set(source)
    found, drawn = dataset.record(record), _channel(dataset, channel)
    if channel is not None and png is None:
        raise UsageError(f"--channel {channel}: which channel a picture shows; add --png FILE or --open")
    if png is not None:
        with working("drawing the picture", compiles=False):
            from siggen.views.record import save_record_figure

            save_record_figure(found, drawn, dataset.fs_hz, png)
        picture.drawn(png, err=as_json)
    if as_json:
        echo_json(_facts(dataset, found))
    elif png is None:
        from rich.console import Console

        console = Console()
        console.print(_labels(dataset, found))
        for table in _damage_tables(_damage(dataset, found)):
            console.print(table)


def _check(out: Path | None, *, internals: bool, overrides: Sequence[str] | None) -> None:
    """Refuse options that would change nothing, and a file that cannot be written, before long work."""
    from siggen.dataset.table_file import ENDINGS, check_table_file
    from siggen.views.exported_model import check_model_file

    if out is None:
        if wanted := [option for option, on in (("--internals", internals), ("--set", overrides)) if on]:
            raise UsageError(f"{wanted[0]}: what a set holds is shown as it is; add --out FILE to simulate the record")
    elif out.suffix.lower() == MODEL_ENDING:
        check_model_file(out)
        if internals:
            raise UsageError(f"--internals: {out} holds the equations of motion; leave it out, or give --out a table")
    elif out.suffix.lower() in ENDINGS:
        check_table_file(out)
    else:
        allowed = ", ".join((*ENDINGS, MODEL_ENDING))
        raise UsageError(f"--out {out}: received the ending {out.suffix!r}; allowed are {allowed}")


def _simulated(source: Path, record: int, out: Path, overrides: Sequence[str], *, internals: bool) -> None:
    """Simulate the record again and write its signals, or its equations of motion."""
    import json

    from siggen.cli.record_choice import chosen_record
    from siggen.dataset.table_file import write_table_file

    with working("simulating the record"):
        design, drawn, planned = chosen_record(source, record, overrides)
        if out.suffix.lower() == MODEL_ENDING:
            from siggen.views.exported_model import exported_model, write_model

            text = json.dumps(design.canonical(), sort_keys=True)
            write_model(exported_model(drawn, planned, identity=design.identity, configuration=text), out)
            return
        from siggen.record.internals import internals_table

        table = internals_table(drawn, planned, internals=internals)
        write_table_file(table.replace_schema_metadata({**table.schema.metadata, "identity": design.identity}), out)


def _channel(dataset: Dataset, name: str | None) -> ChannelColumn:
    known = {channel.name: channel for channel in dataset.channels}
    if name is not None and name not in known:
        raise UsageError(f"--channel {name}: {dataset.path} has the channels {', '.join(known)}")
    return dataset.channels[0] if name is None else known[name]


def _facts(dataset: Dataset, record: Mapping[str, Any]) -> dict[str, Any]:
    """Return what is printed, in numbers."""
    return {
        "labels": {name: record[name] for name in dataset.labels(columns=None).schema.names},
        "channels": {
            channel.column: {
                "unit": channel.unit,
                "samples": len(record[channel.column]),
                "rms": _rms(record[channel.column]),
                "peak": float(abs(record[channel.column]).max()),
            }
            for channel in dataset.channels
        },
        "tacho_pulses": len(record["tacho_s"]),
        "damage": _damage(dataset, record),
    }


def _rms(signal: Any) -> float:
    return float((signal.astype(float) ** 2).mean() ** 0.5)


def _labels(dataset: Dataset, record: Mapping[str, Any]) -> Table:
    from rich.table import Column, Table

    title = cell(f"Record {record['record_id']} of {dataset.path}")
    schema = dataset.labels(columns=None).schema
    longest = max(map(len, (*schema.names, *(channel.column for channel in dataset.channels))))
    names = Column("label", overflow="fold", no_wrap=longest <= LONGEST_NAME)
    value, units = (Column(name, overflow="fold") for name in ("value", "unit"))
    table = Table(names, value, units, title=title, title_justify="left")
    for field in schema:
        unit = (field.metadata or {}).get(b"unit", b"").decode(errors="replace")
        table.add_row(cell(field.name), _text(record[field.name]), cell(unit))
    for channel in dataset.channels:
        signal = record[channel.column]
        told = f"{counted(len(signal), 'sample')}, RMS {_rms(signal):.4g}, peak {float(abs(signal).max()):.4g}"
        table.add_row(cell(channel.column), told, cell(channel.unit))
    table.add_row("tacho_s", counted(len(record["tacho_s"]), "pulse"), "s")
    return table


def _damage(dataset: Dataset, record: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the single damages of a record, each by its columns."""
    import pyarrow.compute as pc

    if not record["damage_count"]:
        return []
    rows = dataset.damage(record["split"])
    own: list[dict[str, Any]] = (
        rows.filter(pc.equal(rows["record_id"], record["record_id"])).drop_columns(["record_id"]).to_pylist()
    )
    return own


def _damage_tables(rows: list[dict[str, Any]]) -> Iterator[Table]:
    """Yield tables of some damages each, a column for each damage; what none of them has is left out, lists too."""
    from rich.table import Column, Table

    for first in range(0, len(rows), SIDE_BY_SIDE):
        some = rows[first : first + SIDE_BY_SIDE]
        heads = (f"{first + i + 1} of {len(rows)}" for i in range(len(some)))
        columns = (Column(head, overflow="fold") for head in heads)
        table = Table(Column("", overflow="fold"), *columns, title="Damage", title_justify="left")
        for name in some[0]:
            values = [row[name] for row in some]
            if any(value is not None and not isinstance(value, list) for value in values):
                table.add_row(cell(name), *(cell("") if value is None else _text(value) for value in values))
        yield table


def _text(value: object) -> Text:
    return cell(f"{value:.6g}" if isinstance(value, float) else value)
