"""Which gearbox of a set a command looks at, and which of its meshes."""

from __future__ import annotations

from collections.abc import Sequence
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

    def of(self, config: Config) -> Config:
        """Return the configuration of the chosen mesh alone.

        Raises
        ------
        UsageError
            If the gearbox has no stage of that name.
        """
        from siggen.errors import UsageError
        from siggen.planning.specimen import draw_specimen
        from siggen.planning.stages import first_mesh, stage_config

        if self.stage is None:
            return first_mesh(config)
        names = [config.names.mesh(""), *(one.name for one in config.stages)]  # in the short form the first is ""
        if not self.stage or self.stage not in names:
            raise UsageError(f"--stage {self.stage}: allowed: {_allowed(config, [one for one in names if one])}")
        number = names.index(self.stage)
        return stage_config(config, draw_specimen(config, self.specimen), number - 1) if number else first_mesh(config)


def _allowed(config: Config, names: Sequence[str]) -> str:
    if config.planetary is not None:
        return "none with a section planetary: what is shown is the mesh of the sun and the first planet"
    return ", ".join(names) or "none, the gearbox has one mesh"
