"""Labelled synthetic vibration records of spur gearboxes with tooth pitting and spalling.

The names below are loaded when they are first used, so that importing siggen, or reading a set, costs no physics.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from siggen.checks.loading import load_config
    from siggen.dataset.card_section import write_card_section
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
    "write_card_section",
    "write_csv",
    "write_recorded_set",
]

_HOMES = {
    "generate_part": ("siggen.sets.parts", "generate_part"),
    "merge": ("siggen.sets.parts", "merge"),
    "extend": ("siggen.sets.extension", "extend"),
    "generate": ("siggen.sets.generation", "generate"),
    "load_config": ("siggen.checks.loading", "load_config"),
    "mesh_stiffness_curves": ("siggen.views.stiffness_curves", "mesh_stiffness_curves"),
    "mesh_stiffness_meaning": ("siggen.views.stiffness_curves", "mesh_stiffness_meaning"),
    "open": ("siggen.dataset.reading", "open"),
    "plan": ("siggen.planning.plan", "plan"),
    "publish": ("siggen.publication.publish", "publish"),
    "simulate": ("siggen.record.simulation", "simulate"),
    "write_card_section": ("siggen.dataset.card_section", "write_card_section"),
    "write_csv": ("siggen.dataset.spreadsheet", "write_csv"),
    "write_recorded_set": ("siggen.sets.recorded_set", "write_recorded_set"),
}


def __getattr__(name: str) -> Any:
    """Return a public name from the module that defines it, or the version."""
    if name == "__version__":
        return import_module("siggen.sources").installed_version()
    if name not in _HOMES:
        raise AttributeError(f"siggen has no {name!r}; it has {', '.join(__all__)}")
    module, attribute = _HOMES[name]
    return getattr(import_module(module), attribute)
