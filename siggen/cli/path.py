"""`siggen inspect path`: what lies between the bearings and each channel of one gearbox, as a table and a picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.option_groups import grouped
from siggen.cli.picture_option import PictureOptions
from siggen.cli.working import working

if TYPE_CHECKING:
    from rich.table import Table

    from siggen.drivetrain.box import Box
    from siggen.views.path import PathCurves


SHOWN = 12
"""Modes that are printed; --json has all."""


@grouped
def path(
    config: Annotated[
        Path, typer.Argument(metavar="CONFIG", help="YAML file of a set, or a preset such as quickstart.")
    ],
    *,
    out: Annotated[Path | None, typer.Option("--out", help="Table to write: .csv or .parquet.")] = None,
    picture: PictureOptions,
    specimen: Annotated[int, typer.Option("--specimen", min=0, help="Number of the gearbox in the set, from 0.")] = 0,
    overrides: Annotated[
        list[str] | None, typer.Option("--set", help="Replace a value, such as housing.wall_mm=12.")
    ] = None,
    modes: Annotated[
        Path | None, typer.Option("--modes", help="CSV of the housing's modes, for housing.kind: modal.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Print the transfer paths from bearing forces to channels: modes, damping and level.

    The table of --out has one row per frequency and two columns per channel and bearing force, in the form that a
    sensor's measured path reads.

    Example: siggen inspect path quickstart --png path.png
    """
    from siggen.checks.loading import load_config
    from siggen.dataset.table_file import check_table_file, write_table_file

    if out is not None:
        check_table_file(out)
    from siggen.views.path import path_curves

    png = picture.place("path")
    with working("computing transfer paths"):
        loaded = load_config(config, overrides or ())
        found = path_curves(loaded.gearbox(specimen), loaded.config.mesh_harmonics)
    if as_json:
        echo_json(_facts(found))
    else:
        from rich.console import Console

        Console().print(_printed(found))
    if out is not None:
        write_table_file(found.table, out)
        echo(str(out), err=as_json)
    if modes is not None:
        _write_modes(found, modes)
        echo(str(modes), err=as_json)
    if png is not None:
        with working("drawing the picture", compiles=False):
            from siggen.views.path import save_path_figure

            save_path_figure(found, png)
        picture.drawn(png, err=as_json)


def _write_modes(found: PathCurves, path: Path) -> None:
    from siggen.errors import UsageError
    from siggen.file_writing import write_file
    from siggen.views.exported_model import exported_modes

    if found.housing is None:
        raise UsageError("no sensor stands on a housing that gives way: allowed is housing.kind: plates")
    write_file(path, exported_modes(found.housing).text)


def _facts(found: PathCurves) -> dict[str, object]:
    """Return what is printed, in numbers."""
    channels = []
    for channel in found.channels:
        largest, at_hz = found.peak(channel)
        facts = {"channel": channel.name, "modes": channel.path_modes, "rms_m_s2_per_n": channel.path_rms_m_s2_per_n}
        channels.append({**facts, "largest_m_s2_per_n": largest, "largest_at_hz": at_hz})
    modes = () if found.housing is None else found.housing.pairs
    housing = [{"frequency_hz": frequency, "damping_ratio": damping} for frequency, damping in modes]
    return {"gearbox": found.specimen_id, "channels": channels, "housing_modes": housing}


def _printed(found: PathCurves) -> Table:
    """Return number of modes, range of their frequencies and damping, and the level of every channel with a path."""
    from rich.table import Table

    table = Table(title=f"transfer paths of gearbox {found.specimen_id}", title_justify="left")
    for name in ("channel", "modes", "rms accelerance [m/s2/N]", "largest [m/s2/N]", "at [Hz]"):
        table.add_column(name, justify="left" if name == "channel" else "right")
    for channel in found.channels:
        largest, at_hz = found.peak(channel)
        rms = f"{channel.path_rms_m_s2_per_n:.3g}"
        table.add_row(channel.name, str(channel.path_modes or "-"), rms, f"{largest:.3g}", f"{at_hz:.0f}")
    if found.housing is not None:
        first = ", ".join(f"{f:.0f} Hz ({100 * d:.1f} %)" for f, d in found.housing.pairs[:SHOWN])
        table.caption = f"{_body_text(found.housing.box)}; its lowest modes: {first}"
        table.caption_justify = "left"
    return table


def _body_text(box: Box | None) -> str:
    if box is None:
        return "housing by its modes"
    size = " x ".join(f"{1e3 * length:.0f}" for length in box.size_m)
    return f"housing of {box.mass_kg:.1f} kg, {size} mm"
