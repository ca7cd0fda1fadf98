"""Labelled synthetic vibration records of spur gearboxes with tooth pitting and spalling.

The names below are loaded when they are first used, so that importing siggen, or reading a set, costs no physics.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from siggen.checks.loading import load_config
    from siggen.dataset.reading import open
    from siggen.dataset.spreadsheet import write_csv
    from siggen.planning.plan import plan
    from siggen.publication.publish import publish
    from siggen.record.simulation import simulate
    from siggen.sets.extension import extend
    from siggen.sets.generation import generate
    from siggen.sets.parts import generate_part, merge
    from siggen.sets.recorded_set import write_recorded_set
    from siggen.views.stiffness_curves import mesh_stiffness_curves, mesh_stiffness_meaning

__all__ = [
    "extend",
    "generate",
    "generate_part",
    "load_config",
    "merge",
    "mesh_stiffness_curves",
    "mesh_stiffness_meaning",
    "open",
    "plan",
    "publish",
    "simulate",
    "write_csv",
    "write_recorded_set",
]

_HOMES = {
    "generate_part": "siggen.sets.parts",
    "merge": "siggen.sets.parts",
    "extend": "siggen.sets.extension",
    "generate": "siggen.sets.generation",
    "load_config": "siggen.checks.loading",
    "mesh_stiffness_curves": "siggen.views.stiffness_curves",
    "mesh_stiffness_meaning": "siggen.views.stiffness_curves",
    "open": "siggen.dataset.reading",
    "plan": "siggen.planning.plan",
    "publish": "siggen.publication.publish",
    "simulate": "siggen.record.simulation",
    "write_csv": "siggen.dataset.spreadsheet",
    "write_recorded_set": "siggen.sets.recorded_set",
}


def __getattr__(name: str) -> Any:
    """Return a public name from the module that defines it, or the version."""
    if name == "__version__":
        return import_module("siggen.sources").installed_version()
    if name not in _HOMES:
        raise AttributeError(f"siggen has no {name!r}; it has {', '.join(__all__)}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """Return the public names, loaded or not, so that completion and `help` show them."""
    return sorted([*__all__, "__version__"])
