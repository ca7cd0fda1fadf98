"""Which gearbox of a set a command looks at, and which of its meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from siggen.gearbox.design import SetDesign
    from siggen.gearbox.specimen import Specimen


@dataclass(frozen=True, slots=True)
class GearboxChoice:
    """Which gearbox."""

    specimen: Annotated[int, typer.Option("--specimen", min=0, help="Number of the gearbox in the set, from 0.")] = 0
    stage: Annotated[
        str | None, typer.Option("--stage", help="Which mesh, by its name; by default the first one, of flanks all.")
    ] = None

    def drawn(self, design: SetDesign) -> tuple[Specimen, int]:
        """Return the gearbox, and the number of the chosen mesh, 0 for the first one.

        Raises
        ------
        UsageError
            If the gearbox has no stage of that name.
        """
        from siggen.views.chosen_mesh import chosen_mesh

        gearbox = design.gearbox(self.specimen)
        return gearbox, chosen_mesh(gearbox, self.stage, "--stage")
