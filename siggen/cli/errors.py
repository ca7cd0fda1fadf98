"""`siggen inspect errors`: the manufacturing errors of one gearbox, tooth by tooth, as a table and a picture."""

from __future__ import annotations

from pathlib import Path

from siggen.cli.inspection import Inspection
from siggen.cli.working import working


def errors(asked: Inspection) -> None:
    """Write pitch and profile deviations of every tooth, as a machine would measure them about the shaft's axis."""
    from siggen.views.errors import deviation_table, gear_charts

    png = asked.png()
    with working("drawing the errors of the teeth"):
        drawn, mesh = asked.drawn(asked.design())
        charts = gear_charts(drawn, asked.state, mesh)

    def draw(file: Path) -> None:
        from siggen.views.errors import save_error_figure

        save_error_figure(charts, file)

    table = deviation_table(charts)
    asked.hand_over(table, draw, png, lambda: {"teeth": table.to_pylist()})
