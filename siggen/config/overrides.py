"""Overrides such as `states.slight.damage.count=3`: single values of a configuration set from a command line."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from typing import Any

from siggen.config.dynamics import RATED
from siggen.config.inheritance import without_sizes
from siggen.errors import ConfigError, Problem, UsageError
from siggen.keys.by_name import BY_NAME, named_entries
from siggen.keys.merging import BY_WORD, in_keys
from siggen.keys.problems import nearest, received_text
from siggen.keys.yaml_source import yaml_value

FORM = "allowed: a path and a value, such as gears.module_mm=3.5 or operating_points.0.speed_hz=25"


def apply_overrides(raw: Mapping[str, Any], overrides: Sequence[str]) -> dict[str, Any]:
    """Return a copy of a raw configuration with values replaced, later overrides last.

    The value is read as YAML. Entries of lists are addressed by their index. A key that the file leaves out is added;
    one that does not exist at all is refused when the configuration is parsed.

    Raises
    ------
    ConfigError
        If an override is not of the form `path=value` or leads through something that is not there; all at once.
    UsageError
        If one text stands for a list of them.
    """
    if isinstance(overrides, str):
        raise UsageError(
            f"overrides: received the text {overrides!r}; allowed: a list of texts, such as [{overrides!r}]"
        )
    changed = copy.deepcopy(dict(raw))
    problems = []
    for override in overrides:
        path, _, text = override.partition("=")
        if path.strip() == f"dynamics.{RATED}" and text.strip() != "null":
            changed = without_sizes(changed)
        try:
            _refuse_new_name(override, raw, changed)
            _apply(changed, override)
        except _Astray as astray:
            problems.append(Problem(f"--set {override}", astray.received, astray.allowed))
        except ConfigError as error:
            problems += [Problem(f"--set {override}", p.received, p.allowed) for p in error.problems]
    if problems:
        raise ConfigError(problems, "overrides")
    return changed


class _Astray(Exception):  # noqa: N818 - caught a few lines above, never seen outside
    def __init__(self, received: str, allowed: str) -> None:
        self.received, self.allowed = received, allowed


def _refuse_new_name(override: str, raw: Mapping[str, Any], changed: Mapping[str, Any]) -> None:
    """Refuse a key of a state or sensor that the file has not: a slip would add one."""
    section, *below = override.partition("=")[0].strip().split(".")
    if section in BY_NAME and len(below) > 1 and named_entries(section, raw):
        names = [*named_entries(section, changed)]
        if below[0] not in names:
            raise _Astray(
                f"'{below[0]}' as a name in {section}", f"allowed: {', '.join(names)}{nearest(below[0], names)}"
            )


def _apply(target: dict[str, Any], override: str) -> None:
    path, equals, text = override.partition("=")
    parts = path.strip().split(".")
    if not equals or not all(parts):
        raise _Astray("no path=value", FORM)
    value = yaml_value(text, override)
    place: Any = target
    for depth, part in enumerate(parts[:-1]):
        place = _below(place, part, ".".join(parts[:depth]))
    _put(place, parts[-1], value, ".".join(parts[:-1]))


def _below(place: Any, part: str, path: str) -> Any:
    if isinstance(place, list):
        return place[_index(place, part, path)]
    if not isinstance(place, dict):
        raise _not_a_container(place, path)
    if part == "0" and "kind" in place and path.endswith(".damage"):
        return place  # a single damage is the first of its state
    if place.get(part) is None:
        place[part] = {}
    if not path and part in BY_WORD:
        place[part] = in_keys(place[part])
    return place[part]


def _put(place: Any, part: str, value: Any, path: str) -> None:
    if isinstance(place, list):
        place[_index(place, part, path)] = value
    elif isinstance(place, dict):
        place[part] = value
    else:
        raise _not_a_container(place, path)


def _index(place: list[Any], part: str, path: str) -> int:
    if not (part.isascii() and part.isdigit() and int(part) < len(place)):
        allowed = f"an index from 0 to {len(place) - 1}" if place else "the whole list, which is empty so far"
        raise _Astray(f"'{part}' as an entry of {path}", f"allowed: {allowed}")
    return int(part)


def _not_a_container(place: Any, path: str) -> _Astray:
    return _Astray(f"{received_text(place)} at {path}", "allowed: a path through mappings and lists of the file")
