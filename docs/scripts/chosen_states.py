"""Some of the states of a configuration, for scripts that need no more."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from siggen.config.states import complete_states


def chosen_states(states: Mapping[str, Any], names: Collection[str]) -> dict[str, Any]:
    """Return states of these names with all of their keys; each grows from the nearest milder one that is left."""
    complete: Any = complete_states(states)[0]
    found = {}
    for name in (name for name in complete if name in names):
        milder = complete[name].get("grows")
        while milder is not None and milder not in names:
            milder = complete[milder].get("grows")
        found[name] = {**complete[name], "grows": milder}
    return found
