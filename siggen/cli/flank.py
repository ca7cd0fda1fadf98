"""`siggen inspect flank`: the damage on the flanks of one gearbox, as a table and drawn to scale."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from siggen.cli.inspection import Inspection
from siggen.cli.working import working

if TYPE_CHECKING:
    from pyarrow import Table


def flank(asked: Inspection) -> None:
    """Write the damage of one gearbox, and draw its damaged flanks to scale with the zones of contact."""
    from siggen.errors import UsageError
    from siggen.views.flank import flank_damage_table, flank_views

    png = asked.png()
    with working("drawing damage"):
        drawn, mesh = asked.drawn(asked.design())
        of = None if asked.mesh is None else mesh
        table = flank_damage_table(drawn, asked.state, of)
        views = flank_views(drawn, asked.state, of) if png is not None else []
    if png is not None and not views:
        where = "" if asked.mesh is None else f" on {asked.mesh}"
        other = "leave out --png and --open" if asked.mesh is None else "leave out --mesh for all meshes"
        raise UsageError(f"{png}: there is no damage to draw{where} in {asked.state or 'any state'}; {other}")

    def draw(file: Path) -> None:
        from siggen.views.flank import save_flank_figure

        save_flank_figure(views, file)

    is_text = asked.out is not None and asked.out.suffix.lower() == ".csv"
    asked.hand_over(_without_lists(table) if is_text else table, draw, png, lambda: {"damage": table.to_pylist()})


def _without_lists(table: Table) -> Table:
    """Return the table with its lists written as text, such as [1.0, 2.5]: a CSV file holds none."""
    import json

    import pyarrow as pa

    for index, field in enumerate(table.schema):
        if pa.types.is_list(field.type):
            texts = [json.dumps(value) for value in table.column(index).to_pylist()]
            table = table.set_column(index, field.name, pa.array(texts, pa.string()))
    return table
