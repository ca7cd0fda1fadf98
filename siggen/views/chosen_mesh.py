"""One mesh of a gearbox, chosen by its name."""

from __future__ import annotations

from siggen.errors import UsageError
from siggen.gearbox.specimen import Specimen


def chosen_mesh(gearbox: Specimen, mesh: str | None, argument: str) -> int:
    """Return the number of a mesh; None: of the first one, 0. `argument` is what a refusal names.

    Raises
    ------
    UsageError
        If the gearbox has no mesh of that name.
    """
    names = [mesh.word for mesh in gearbox.names.meshes[: 1 + len(gearbox.behind)]]  # that of a pair is ""
    if mesh is not None and (not mesh or mesh not in names):
        raise UsageError(f"{argument}: received {mesh!r}; allowed: {_allowed(gearbox, [one for one in names if one])}")
    return 0 if mesh is None else names.index(mesh)


def _allowed(gearbox: Specimen, names: list[str]) -> str:
    if gearbox.planets is not None:
        return "none of a planetary set: what is shown is the mesh of the sun and the first planet"
    return ", ".join(names) or "none, the gearbox has one mesh"
