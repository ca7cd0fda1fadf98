"""`siggen inspect spectrum`: order spectra of one gearbox in its states, mesh lines and sidebands marked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from siggen.cli.inspection import Inspection
from siggen.cli.working import working

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def spectrum(asked: Inspection) -> None:
    """Simulate records of one gearbox and draw the order spectra of their first channel."""
    from siggen.library.gearbox import draw
    from siggen.library.running import run
    from siggen.views.pictures import save_figure

    png = asked.png()
    gearbox = draw(asked.design(), asked.gearbox)
    shown = asked.states or [gearbox.states[0].name]
    with working("simulating the records"):
        found = [run(gearbox, state).spectrum() for state in shown]

    def drawn() -> Figure:
        axes: Any = None
        for state, one in zip(shown, found, strict=True):
            axes = one.plot(axes, label=f"{state}, {one.channel}")
        figure: Figure = axes.figure
        return figure

    def save(file: Path) -> None:
        save_figure(drawn, file)

    asked.hand_over(
        None,
        save,
        png,
        lambda: {
            state: {
                "channel": one.channel,
                "unit": one.unit,
                "speed_hz": one.speed_hz,
                "order": one.order,
                "amplitude": one.amplitude,
            }
            for state, one in zip(shown, found, strict=True)
        },
    )
