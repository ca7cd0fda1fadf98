"""`siggen show`: one record of a finished set, as a table of labels or as a picture."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from siggen.cli.echo import cell
from siggen.cli.option_groups import grouped
from siggen.cli.picture_option import PictureOptions
from siggen.cli.working import working

if TYPE_CHECKING:
    from rich.table import Table
    from rich.text import Text

    from siggen.columns.record import ChannelColumn
    from siggen.dataset.reading import Dataset


@grouped
def show(
    folder: Annotated[Path, typer.Argument(help="Folder or s3://... of a finished set.", metavar="DIR")],
    record: Annotated[int, typer.Option("--record", min=0, help="Id of the record (column record_id).")],
    *,
    picture: PictureOptions,
    channel: Annotated[str | None, typer.Option("--channel", help="Channel to draw; by default the first.")] = None,
) -> None:
    """Show the labels and damage of one record, or draw its waveform and its spectrum around the mesh harmonics.

    Example: siggen show runs/quickstart --record 3 --png record3.png
    """
    from siggen.dataset.reading import open as open_set

    dataset = open_set(folder)
    found = dataset.record(record)
    if (png := picture.place("show")) is not None:
        with working("drawing the picture", compiles=False):
            from siggen.views.record import save_record_figure

            save_record_figure(found, _channel(dataset, channel), dataset.fs_hz, png)
        picture.drawn(png)
        return
    from rich.console import Console

    console = Console()
    console.print(_labels(dataset, found))
    if found["damage_count"]:
        console.print(_damage(dataset, found))


def _channel(dataset: Dataset, name: str | None) -> ChannelColumn:
    from siggen.errors import UsageError

    known = {channel.name: channel for channel in dataset.channels}
    if name is not None and name not in known:
        raise UsageError(f"--channel {name}: {dataset.path} has the channels {', '.join(known)}")
    return dataset.channels[0] if name is None else known[name]


def _labels(dataset: Dataset, record: Mapping[str, Any]) -> Table:
    from rich.table import Table

    from siggen.errors import counted

    title = cell(f"Record {record['record_id']} of {dataset.path}")
    table = Table("label", "value", "unit", title=title, title_justify="left")
    schema = dataset.labels(columns=None).schema
    for field in schema:
        unit = (field.metadata or {}).get(b"unit", b"").decode(errors="replace")
        table.add_row(cell(field.name), _text(record[field.name]), cell(unit))
    for channel in dataset.channels:
        signal = record[channel.column]
        rms, peak = float((signal.astype(float) ** 2).mean() ** 0.5), float(abs(signal).max())
        told = f"{counted(len(signal), 'sample')}, RMS {rms:.4g}, peak {peak:.4g}"
        table.add_row(cell(channel.column), told, cell(channel.unit))
    table.add_row("tacho_s", counted(len(record["tacho_s"]), "pulse"), "s")
    return table


def _damage(dataset: Dataset, record: Mapping[str, Any]) -> Table:
    import pyarrow as pa
    import pyarrow.compute as pc
    from rich.table import Column, Table

    rows = dataset.damage(record["split"])
    own = rows.filter(pc.equal(rows["record_id"], record["record_id"])).drop_columns(["record_id"])
    names = [field.name for field in own.schema if not pa.types.is_list(field.type)]
    table = Table(*(Column(cell(name)) for name in names), title="Damage", title_justify="left")
    for row in own.select(names).to_pylist():
        table.add_row(*(_text(row[name]) for name in names))
    return table


def _text(value: object) -> Text:
    return cell(f"{value:.6g}" if isinstance(value, float) else value)
