"""`siggen inspect modes`: natural frequencies of one gearbox and what they consist of, as a table and a picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from siggen.cli.inspection import Inspection
from siggen.cli.working import working

if TYPE_CHECKING:
    from rich.table import Table

    from siggen.views.modes import SpecimenModes


def modes(asked: Inspection) -> None:
    """Print the undamped natural modes at the mean mesh stiffness; the one at 0 Hz is free rotation."""
    png = asked.png(prints=True)
    from siggen.views.modes import specimen_modes

    with working("computing natural modes"):
        found = specimen_modes(asked.design().gearbox(asked.gearbox))
    if not asked.as_json:
        from rich.console import Console

        Console().print(_printed(found))

    def draw(file: Path) -> None:
        from siggen.views.modes import save_modes_figure

        save_modes_figure(found, file)

    asked.hand_over(
        found.table,
        draw,
        png,
        lambda: {"mesh_stiffness_n_per_m": found.mesh_stiffness_n_per_m, "modes": found.table.to_pylist()},
    )


def _printed(found: SpecimenModes) -> Table:
    """Return frequency, share of the mesh and the two degrees of freedom that hold most of the kinetic energy."""
    from rich.table import Table

    from siggen.views.modes import kinetic_shares

    means = found.mesh_stiffness_n_per_m.items()
    stiffness = ", ".join(f"{value:.3g}{f' ({mesh})' if len(means) > 1 else ''}" for mesh, value in means)
    table = Table(title=f"natural modes at a mean mesh stiffness of {stiffness} N/m")
    for name in ("mode", "frequency [Hz]", "mesh strain energy [%]"):
        table.add_column(name, justify="right")
    table.add_column("moves most (share of kinetic energy)")
    shares = kinetic_shares(found)
    for i, frequency in enumerate(found.modes.frequency_hz):
        first, second = sorted(range(len(found.coordinates)), key=lambda j, i=i: -shares[i, j])[:2]  # type: ignore[misc]
        moving = ", ".join(f"{found.coordinates[j]} {100 * shares[i, j]:.0f} %" for j in (first, second))
        table.add_row(str(i), f"{frequency:.1f}", f"{100 * found.modes.mesh_share[i]:.1f}", moving)
    return table
