"""Sentences about the words of states that are likely mistyped."""

from __future__ import annotations

from siggen.config import Config
from siggen.config.states import KNOWN_CHANGES
from siggen.faults.registry import FAULT_WORDS
from siggen.keys.problems import nearest


def state_notes(config: Config) -> tuple[str, ...]:
    """Return which faults of changed machines are next to a known word: any word is taken, so a slip is none."""
    known = (*KNOWN_CHANGES, *FAULT_WORDS)
    return tuple(
        f"state {state.name}: fault {state.fault} is a word of your own{near}"
        for state in config.states
        if state.fault not in known and (near := nearest(state.fault, known))
    )
