"""Labelled synthetic vibration records of spur gearboxes with tooth pitting and spalling.

The names below are loaded when they are first used, so that importing siggen, or reading a set, costs no physics.
"""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from siggen.dataset.card_section import write_card_section
    from siggen.dataset.plan import plan
    from siggen.dataset.reading import open
    from siggen.generation import generate
    from siggen.loading import load_config
    from siggen.simulation import simulate
    from siggen.stiffness_curves import mesh_stiffness_curves

__all__ = ["generate", "load_config", "mesh_stiffness_curves", "open", "plan", "simulate", "write_card_section"]

_HOMES = {
    "generate": ("siggen.generation", "generate"),
    "load_config": ("siggen.loading", "load_config"),
    "mesh_stiffness_curves": ("siggen.stiffness_curves", "mesh_stiffness_curves"),
    "open": ("siggen.dataset.reading", "open"),
    "plan": ("siggen.dataset.plan", "plan"),
    "simulate": ("siggen.simulation", "simulate"),
    "write_card_section": ("siggen.dataset.card_section", "write_card_section"),
}


def __getattr__(name: str) -> Any:
    """Return a public name from the module that defines it, or the version."""
    if name == "__version__":
        return version("siggen")
    if name not in _HOMES:
        raise AttributeError(f"siggen has no {name!r}; it has {', '.join(__all__)}")
    module, attribute = _HOMES[name]
    return getattr(import_module(module), attribute)
