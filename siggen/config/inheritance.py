"""What `extends` stands for: a configuration that takes another one's values and states what differs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from siggen.config.dynamics import RATED, RATED_SPEED
from siggen.config.presets import config_file
from siggen.errors import ConfigError, Problem, UsageError
from siggen.keys.data_file import is_file
from siggen.keys.merging import merged
from siggen.keys.problems import received_text
from siggen.keys.yaml_source import read_yaml
from siggen.names import SHAFT_OF

EXTENDS = "extends"
REPLACED = ("gears", "planetary")
"""Sections that a machine takes the place of."""
REPLACED_OF_DYNAMICS = ("pinion", "gear", "shafts", RATED, RATED_SPEED)
SIZED: Mapping[str, Any] = {
    **{
        gear: {
            **dict.fromkeys(("mass_kg", "inertia_kg_m2")),
            "bearing": dict.fromkeys(("stiffness_n_per_m", "damping_n_s_per_m")),
        }
        for gear in ("pinion", "gear")
    },
    **dict.fromkeys((RATED_SPEED, "motor_inertia_kg_m2", "load_inertia_kg_m2", "input_coupling", "output_coupling")),
    "shafts": dict.fromkeys(SHAFT_OF.values(), dict.fromkeys(("bearing_span_mm", "diameter_mm"))),
}
"""Keys of `dynamics` that a rated torque takes the place of; None: a key, else those of a section."""
DEEPEST = 8
"""Files that may extend each other in a row."""


def inherited(raw: Mapping[str, Any], folder: Path = Path(), source: str = "configuration") -> dict[str, Any]:
    """Return a raw configuration in which `extends` is resolved; without that key, a copy.

    Mappings are merged key by key, states and sensors by name; one with `others: null` takes nothing over. Everything
    else replaces what it extends: numbers, lists, null, and mappings that have a `kind` of their own, are
    `like` something or stand for a number. A `machine` takes the place of gears and of their shafts, a rated
    torque that of the sizes that follow from it.

    Parameters
    ----------
    raw : mapping
    folder : Path
        That paths count from.
    source : str
        For messages.

    Raises
    ------
    ConfigError
        If `extends` is no text, leads nowhere or in a circle; or if the other file is no YAML.
    """
    return _resolved(raw, folder, source, ())


def extended_files(file: Path) -> tuple[Path, ...]:
    """Return a configuration's file and those that it extends, in the order in which a key is looked for.

    Raises
    ------
    ConfigError
        As `inherited`.
    """
    found: tuple[Path, ...] = (file,)
    while _has_word(found[-1]) and EXTENDS in (raw := read_yaml(found[-1])) and len(found) <= DEEPEST:
        found = (*found, _extended(raw[EXTENDS], found[-1].parent, str(found[-1])))
    return found


def _has_word(file: Path) -> bool:
    """Tell whether it is worth reading a file once more: a large one takes long."""
    return EXTENDS.encode() in file.read_bytes()


def _resolved(raw: Mapping[str, Any], folder: Path, source: str, seen: tuple[Path, ...]) -> dict[str, Any]:
    if EXTENDS not in raw:
        return dict(raw)
    file = _extended(raw[EXTENDS], folder, source)
    if file in seen or len(seen) >= DEEPEST:
        circle = "a circle" if file in seen else f"more than {DEEPEST} files in a row"
        raise ConfigError([Problem(EXTENDS, f"{received_text(raw[EXTENDS])}, {circle}", "allowed: a chain that ends")])
    base = _anchored(_resolved(read_yaml(file), file.parent, str(file), (*seen, file)), file.parent)
    own = {key: value for key, value in raw.items() if key != EXTENDS}
    base = _without_drivetrain(base) if own.get("machine") else base
    own_dynamics = own.get("dynamics")
    rated = own_dynamics.get(RATED) if isinstance(own_dynamics, Mapping) else None
    return merged(base if rated is None else without_sizes(base), own)


def without_sizes(base: Mapping[str, Any]) -> dict[str, Any]:
    """Return a raw configuration without what follows from a rated torque."""
    return _without(base, {"dynamics": SIZED})


def _without(value: Mapping[str, Any], keys: Mapping[str, Any]) -> dict[str, Any]:
    return {
        key: item if key not in keys or not isinstance(item, Mapping) else _without(item, keys[key])
        for key, item in value.items()
        if key not in keys or keys[key] is not None
    }


def _without_drivetrain(base: Mapping[str, Any]) -> dict[str, Any]:
    """Return what is extended without what a machine says itself: gears, and the shafts that they stand on."""
    rest = {key: value for key, value in base.items() if key not in REPLACED}
    if isinstance(dynamics := rest.get("dynamics"), Mapping):
        rest["dynamics"] = {key: value for key, value in dynamics.items() if key not in REPLACED_OF_DYNAMICS}
    return rest


def _extended(name: object, folder: Path, source: str) -> Path:
    """Return the file that `extends` names: one beside the configuration, or a preset."""
    allowed = "allowed: a preset such as bench, or the path of a YAML file, from the folder of this one"
    if not isinstance(name, str) or not name:
        raise ConfigError([Problem(EXTENDS, received_text(name), allowed)], source)
    try:
        beside = folder / name
        return (beside if is_file(beside) else config_file(name)).resolve()
    except UsageError as error:
        raise ConfigError([Problem(EXTENDS, received_text(name), f"{allowed} ({error})")], source) from None


def _anchored(value: Any, folder: Path) -> Any:
    """Return a value in which files of data, named by `file`, do not depend on their YAML file's folder."""
    match value:
        case Mapping():
            return {
                key: _beside(folder, item) if key == "file" else _anchored(item, folder) for key, item in value.items()
            }
        case list() | tuple():
            return [_anchored(item, folder) for item in value]
    return value


def _beside(folder: Path, names: Any) -> Any:
    if isinstance(names, (list, tuple)):
        return [_beside(folder, name) for name in names]
    return str(folder / names) if isinstance(names, str) else names
