"""A copy of a configuration with some of its states: `python docs/scripts/chosen_states.py CONFIG OUT STATE ...`.

A state whose damage began in a state that is left out begins with an intact gear instead.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import yaml


def chosen(states: list[dict[str, Any]], names: list[str]) -> list[dict[str, Any]]:
    """Return the named states in their order, each growing from the nearest one that is left of its own growth."""
    found: list[dict[str, Any]] = []
    begins_anew = False
    for state in states:
        begins_anew = begins_anew or state.get("grows_from") == "none"
        if state["name"] in names:
            found.append({**state, "grows_from": "none"} if begins_anew and state.get("damage") else state)
            begins_anew = begins_anew and not state.get("damage")
    return found


def main(source: str, target: str, *names: str) -> None:
    """Write the copy."""
    content = yaml.safe_load(Path(source).read_text(encoding="utf-8"))
    content["states"] = chosen(content["states"], list(names))
    Path(target).write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
