"""States to judge: damaged ones by name beside all healthy ones, in the order of the set."""

from __future__ import annotations

from typing import Any

import pytest

from diagnostics.records.state_classes import chosen_states
from siggen.errors import UsageError


@pytest.mark.parametrize(
    ("names", "taken"),
    [((), ("healthy", "slight", "severe")), (("severe",), ("healthy", "severe"))],
)
def test_healthy_states_are_always_taken(names: tuple[str, ...], taken: tuple[str, ...], dataset: Any) -> None:
    assert chosen_states(dataset, names) == taken


@pytest.mark.parametrize(
    ("names", "text"),
    [
        (("healthy",), "state healthy is healthy and taken anyway; .* of which the set has slight, severe"),
        (("severe", "healthy"), "state healthy is healthy"),
        (("grave",), "has no state grave; it has healthy, slight, severe"),
    ],
)
def test_healthy_and_unknown_names_are_refused(names: tuple[str, ...], text: str, dataset: Any) -> None:
    with pytest.raises(UsageError, match=text):
        chosen_states(dataset, names)
