"""Labelled synthetic vibration records of spur gearboxes with tooth pitting and spalling.

The names below are loaded when they are first used, so that importing siggen, or reading a set, costs no physics.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from siggen.uncollected import uncollected

if TYPE_CHECKING:
    from siggen.checks.loading import load_config
    from siggen.dataset.reading import open
    from siggen.dataset.spreadsheet import write_csv
    from siggen.gearbox.plan import plan
    from siggen.gears.gear_pair import Gear, GearPair
    from siggen.library.damage import BearingSpall, Chip, Crack, Damage, Pit, Spall, Wear, pits_in_layers, random_pits
    from siggen.library.gearbox import Case, Gearbox, Point, State, draw
    from siggen.library.machines import machine, planetary
    from siggen.library.makers import single_stage
    from siggen.library.pairs import Curve, flank_picture, mesh_stiffness
    from siggen.library.record import LineOrders, Record, Spectrum
    from siggen.library.running import run, runs
    from siggen.library.sensors import Channel, Reading, Sensor
    from siggen.publication.publish import publish
    from siggen.sets.chosen_records import simulate_records
    from siggen.sets.generation import generate
    from siggen.sets.recorded_set import write_recorded_set
    from siggen.sets.streaming import stream

__all__ = [
    "BearingSpall", "Case", "Channel", "Chip", "Crack", "Curve", "Damage", "Gear", "GearPair", "Gearbox",
    "LineOrders", "Pit", "Point", "Reading", "Record", "Sensor", "Spall", "Spectrum", "State", "Wear", "draw",
    "flank_picture", "generate", "load_config", "machine", "mesh_stiffness",
    "open", "pits_in_layers", "plan", "planetary", "publish",
    "random_pits", "run", "runs", "simulate_records", "single_stage", "stream", "write_csv", "write_recorded_set",
]  # fmt: skip

_NAMES = {
    "siggen.checks.loading": "load_config",
    "siggen.dataset.reading": "open",
    "siggen.dataset.spreadsheet": "write_csv",
    "siggen.gears.gear_pair": "Gear GearPair",
    "siggen.library.damage": "BearingSpall Chip Crack Damage Pit Spall Wear pits_in_layers random_pits",
    "siggen.library.gearbox": "Case Gearbox Point State draw",
    "siggen.library.machines": "machine planetary",
    "siggen.library.makers": "single_stage",
    "siggen.library.pairs": "Curve flank_picture mesh_stiffness",
    "siggen.library.record": "LineOrders Record Spectrum",
    "siggen.library.running": "run runs",
    "siggen.library.sensors": "Channel Reading Sensor",
    "siggen.gearbox.plan": "plan",
    "siggen.publication.publish": "publish",
    "siggen.sets.chosen_records": "simulate_records",
    "siggen.sets.generation": "generate",
    "siggen.sets.recorded_set": "write_recorded_set",
    "siggen.sets.streaming": "stream",
}
"""Module -> public names that it defines."""
_HOMES = {name: module for module, names in _NAMES.items() for name in names.split()}


def __getattr__(name: str) -> Any:
    """Return a public name from the module that defines it, or the version."""
    if name == "__version__":
        return import_module("siggen.sources").installed_version()
    if name not in _HOMES:
        raise AttributeError(f"siggen has no {name!r}; it has {', '.join(__all__)}")
    with uncollected():
        return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """Return the public names, loaded or not, so that completion and `help` show them."""
    return sorted([*__all__, "__version__"])
