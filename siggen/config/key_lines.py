"""Lines of YAML files that keys stand on, and problems of a configuration with the line or option they come from."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple, TypeAlias

import yaml

from siggen.errors import Problem
from siggen.keys.merging import REPLACING
from siggen.keys.yaml_source import yaml_node

MERGE = "tag:yaml.org,2002:merge"
Roots: TypeAlias = Sequence[tuple[str, yaml.Node | None]]
"""Names and contents of the files."""
MOST_MERGES = 20
"""Merged mappings within each other that are followed; a mapping may merge itself."""


class KeyLine(NamedTuple):
    """Where a path leads in a file: the line, from 1, of the last part that is there, and how many parts are there.

    `own`: whether what is missing is missing in this file, since nothing below is taken from a file that it extends:
    entries of lists, and mappings with a `kind` or that stand for a number.
    """

    line: int
    depth: int
    own: bool


def key_line(node: yaml.Node | None, path: str) -> KeyLine | None:
    """Return where a key such as `states.slight.damage.teeth` stands; None if not even its first part is there.

    A key that an anchor brings, or a state that another one names, stands where it is written. A key may hold dots
    itself, as those of `changes` do.
    """
    parts = path.split(".")
    found = _key_line(node, parts)
    for _ in range(MOST_MERGES if parts[0] == "states" else 0):
        named = _named_state(node, parts[1:2])
        if found is None or named is None or found.depth == len(parts):
            break
        parts[1] = named
        further = _key_line(node, parts)
        found = further if further is not None and further.depth > found.depth else found
    return found


def _named_state(node: yaml.Node | None, name: Sequence[str]) -> str | None:
    """Return the name of the state from which a state takes keys over."""
    for part in ("states", *name):
        _, node = _child(node, part) or (0, None)
    named = (_child(node, key) for key in ("grows", "like"))
    return next((other[1].value for other in named if other and isinstance(other[1], yaml.ScalarNode)), None)


def _key_line(node: yaml.Node | None, parts: Sequence[str]) -> KeyLine | None:
    found, own, depth = None, False, 0
    while depth < len(parts):
        named = ((end, _child(node, ".".join(parts[depth:end]))) for end in range(depth + 1, len(parts) + 1))
        depth, child = next(((end, child) for end, child in named if child is not None), (len(parts), None))
        if child is None:
            break
        line, node = child
        own |= not isinstance(node, yaml.MappingNode) or any(_child(node, word) is not None for word in REPLACING)
        found = KeyLine(line, depth, own)
    return found


def placed(problems: Iterable[Problem], files: Sequence[Path] = (), overrides: Sequence[str] = ()) -> list[Problem]:
    """Return problems that say where their value comes from: the last override that set it, else a line.

    `files`: the configuration's and those that it extends.
    """
    roots = [(file.name, yaml_node(file.read_text(encoding="utf-8"))) for file in files]
    return [one if one.where else replace(one, where=_where(one.path, roots, overrides)) for one in problems]


def _where(path: str, roots: Roots, overrides: Sequence[str]) -> str:
    keys = [override.partition("=")[0].strip() for override in reversed(overrides)]
    for own in _taken_from(path, roots):
        if (key := next((key for key in keys if f"{own}.".startswith(f"{key}.")), None)) is not None:
            return f"--set {key}"
    section = path.rpartition(".")[0] or path  # what goes with a key may be wrong instead
    beside = [f"--set {key}" for key in keys if key.startswith((f"{section}.", f"{path}."))]
    return ", beside ".join([*filter(None, [_line(path, roots)]), *beside[:1]])


def _taken_from(path: str, roots: Roots) -> Iterator[str]:
    """Yield where a key may be written: its path, then those of the states whose keys it takes over."""
    parts = path.split(".")
    for _ in range(MOST_MERGES):
        yield ".".join(parts)
        written = (_key_line(root, parts) for _, root in roots)
        named = (_named_state(root, parts[1:2]) for _, root in roots)
        further = next(filter(None, named), None) if parts[0] == "states" else None
        if further is None or any(one is not None and one.depth == len(parts) for one in written):
            return
        parts[1] = further


def _line(path: str, roots: Roots) -> str:
    best: KeyLine | None = None
    file = ""
    for name, root in roots:
        found = key_line(root, path)
        if found is not None and (best is None or found.depth > best.depth):
            best, file = found, name
        if best is not None and (best.own or best.depth == len(path.split("."))):
            break
    if best is None:
        return ""
    return f"line {best.line}" if file == roots[0][0] else f"line {best.line} of {file}, which this file extends"


def _child(node: yaml.Node | None, part: str, merges: int = 0) -> tuple[int, yaml.Node] | None:
    """Return line and value of a key of a mapping or an entry of a list; own keys go before merged ones."""
    if isinstance(node, yaml.SequenceNode) and part.isdecimal() and int(part) < len(node.value):
        entry = node.value[int(part)]
        return entry.start_mark.line + 1, entry
    if not isinstance(node, yaml.MappingNode) or merges > MOST_MERGES:
        return None
    merged: list[yaml.Node] = []
    for key, value in node.value:
        if key.tag == MERGE:
            merged += value.value if isinstance(value, yaml.SequenceNode) else [value]
        elif isinstance(key, yaml.ScalarNode) and key.value == part:
            return key.start_mark.line + 1, value
    found = (_child(one, part, merges + 1) for one in merged)
    return next((one for one in found if one is not None), None)
