"""One mesh of a gearbox, chosen by its name."""

from __future__ import annotations

from siggen.config import Config
from siggen.errors import UsageError
from siggen.planning.specimen import draw_specimen
from siggen.planning.stages import first_mesh, stage_config


def chosen_mesh(config: Config, specimen_id: int, mesh: str | None, argument: str) -> Config:
    """Return the configuration of a mesh alone; None: the first one. `argument` is what a refusal names.

    Raises
    ------
    UsageError
        If the gearbox has no mesh of that name.
    """
    names = [mesh.word for mesh in config.names.meshes[: 1 + len(config.stages)]]  # that of a pair is ""
    if mesh is not None and (not mesh or mesh not in names):
        raise UsageError(f"{argument}: received {mesh!r}; allowed: {_allowed(config, [one for one in names if one])}")
    number = 0 if mesh is None else names.index(mesh)
    return stage_config(config, draw_specimen(config, specimen_id), number - 1) if number else first_mesh(config)


def _allowed(config: Config, names: list[str]) -> str:
    if config.planetary is not None:
        return "none of a planetary set: what is shown is the mesh of the sun and the first planet"
    return ", ".join(names) or "none, the gearbox has one mesh"
