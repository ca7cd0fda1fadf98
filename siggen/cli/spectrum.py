"""`siggen inspect spectrum`: order spectra of one gearbox in its states, mesh lines and sidebands marked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from siggen.cli.option_groups import grouped
from siggen.cli.picture_option import PictureOptions
from siggen.cli.working import working

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@grouped
def spectrum(
    config: Annotated[
        Path, typer.Argument(metavar="CONFIG", help="YAML file of a set, or a preset such as quickstart.")
    ],
    *,
    picture: PictureOptions,
    states: Annotated[
        list[str] | None, typer.Option("--state", help="State to draw, again for others over it; else the first.")
    ] = None,
    channel: Annotated[str, typer.Option("--channel", help="Channel; else the first.")] = "",
    around: Annotated[
        int | None, typer.Option("--around", min=1, help="Harmonic of the mesh to draw alone, with its sidebands.")
    ] = None,
    specimen: Annotated[int, typer.Option("--specimen", min=0, help="Number of the gearbox in the set, from 0.")] = 0,
    overrides: Annotated[
        list[str] | None, typer.Option("--set", help="Replace a value, such as gears.module_mm=3.5.")
    ] = None,
) -> None:
    """Simulate records of one gearbox and draw their order spectra, with mesh lines and sidebands marked.

    Example: siggen inspect spectrum quickstart --state healthy --state severe --around 1 --png spectrum.png
    """
    from siggen.checks.loading import load_config
    from siggen.errors import UsageError
    from siggen.library.gearbox import draw
    from siggen.library.running import run
    from siggen.views.pictures import save_figure

    png = picture.place("spectrum")
    if png is None:
        raise UsageError("siggen inspect spectrum: nothing to draw; give --png spectrum.png, or --open to see it")
    gearbox = draw(load_config(config, overrides or ()), specimen)
    shown = states or [gearbox.states[0].name]
    with working("simulating the records"):
        found = [run(gearbox, state).spectrum(channel) for state in shown]

    def drawn() -> Figure:
        axes: Any = None
        for state, one in zip(shown, found, strict=True):
            axes = one.plot(axes, around=around, label=f"{state}, {one.channel}")
        figure: Figure = axes.figure
        return figure

    save_figure(drawn, png)
    picture.drawn(png)
