"""Which gearbox of a set a command looks at, and which of its meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from siggen.config import Config


@dataclass(frozen=True, slots=True)
class GearboxChoice:
    """Which gearbox."""

    specimen: Annotated[int, typer.Option("--specimen", min=0, help="Number of the gearbox in the set, from 0.")] = 0
    stage: Annotated[
        str | None, typer.Option("--stage", help="Which mesh: the name of a further stage; by default the first one.")
    ] = None

    def mesh(self, config: Config) -> int:
        """Return the number of the chosen mesh, 0 for the first one.

        Raises
        ------
        UsageError
            If the gearbox has no stage of that name.
        """
        from siggen.views.chosen_mesh import chosen_mesh

        return chosen_mesh(config, self.stage, "--stage")
