"""States with the keys that they take over from those that they grow from or are like."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from siggen.errors import Problem
from siggen.keys.merging import merged
from siggen.keys.problems import nearest_word, received_text

OF_ACTING_DAMAGE = ("fault", "severity")
"""Labels that a sham does not take over."""


def complete_states(states: Mapping[str, object]) -> tuple[dict[str, object], list[Problem]]:
    """Return states with all of their keys, and the problems of those that take over what is not there.

    What a state says itself goes before what it takes over; mappings are merged key by key, as in a file that extends
    another one. States with a problem are left out, and those that take over from them.

    Parameters
    ----------
    states : mapping
        Name -> state as a file has it, none of them null.
    """
    complete: dict[str, object] = {}  # None: left out
    problems: list[Problem] = []
    for name in states:
        chain: dict[str, None] = {}
        following: str | None = name
        while following is not None and following not in complete and following not in chain:
            chain[following] = None
            if problem := _problem(states, following):
                problems.append(problem)
                complete[following], following = None, None
            else:
                following = source_of(states[following])
        if following in chain:
            circle = [*chain][[*chain].index(following) :]
            problems.append(_circle([*circle, following], states[following]))
            complete |= dict.fromkeys(circle)
        for one in reversed(chain):
            source = source_of(states[one])
            if one not in complete:
                complete[one] = states[one] if source is None else _with_keys_of(complete.get(source), states[one])
    return {name: complete[name] for name in states if complete[name] is not None}, problems


def source_of(entry: object) -> str | None:
    """Return the name of the state whose keys a state of a file takes over, None if it says all itself."""
    given = (entry.get("grows"), entry.get("like")) if isinstance(entry, Mapping) else ()
    return next((name for name in given if isinstance(name, str)), None)


def _with_keys_of(source: object, entry: object) -> object:
    if not (isinstance(source, Mapping) and isinstance(entry, Mapping)):
        return None
    left_out = ("grows", "like", *(OF_ACTING_DAMAGE if entry.get("acts") is False else ()))
    taken = {key: value for key, value in source.items() if key not in left_out}
    return merged(taken, {key: value for key, value in entry.items() if key != "like"})


def _problem(states: Mapping[str, object], name: str) -> Problem | None:
    entry: Any = states[name] if isinstance(states[name], Mapping) else {}
    given = {key: entry[key] for key in ("grows", "like") if entry.get(key) is not None}
    if not given:
        return None
    (key, other), *more = given.items()
    path = f"states.{name[:200]}.{key}"
    if more:
        return Problem(path, f"'{other}' beside like: {more[0][1]}", "allowed: grows or like, one of them")
    if isinstance(other, str) and other in states and other != name:
        return None
    others = [one for one in states if one != name]
    known = f"{', '.join(one[:60] for one in others[:20])}{', ...' if len(others) > 20 else ''}"
    allowed = f"allowed: the name of another state: {known}{nearest_word(other, others)}"
    return Problem(path, "the state itself" if other == name else received_text(other), allowed)


def _circle(names: list[str], entry: object) -> Problem:
    key = "grows" if isinstance(entry, Mapping) and entry.get("grows") is not None else "like"
    shown = " from ".join(name[:60] for name in names[:8]) + (" from ..." if len(names) > 8 else "")
    return Problem(f"states.{names[0][:200]}.{key}", f"a circle: {shown}", "allowed: a chain that ends")
