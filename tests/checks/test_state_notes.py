"""Any word may name the fault of a changed machine; one next to a known word is pointed out."""

from __future__ import annotations

import pytest

from siggen.checks.loading import load_config
from siggen.checks.notes import state_notes
from siggen.errors import ConfigError
from tests.config.minimal import by_name, minimal

CHANGED = {"name": "changed", "severity": "moderate", "changes": {"dynamics.backlash_um": {"add": 40}}}


def notes(fault: str) -> tuple[str, ...]:
    states = by_name([{"name": "healthy"}, {**CHANGED, "fault": fault}])
    return tuple(state_notes(load_config(minimal(states=states)).possible))


def test_a_slip_is_pointed_out_and_a_word_of_ones_own_is_not() -> None:
    assert "did you mean 'misalignment'?" in notes("misalignement")[0]
    assert notes("misalignment") == ()
    assert notes("cavitation") == ()


def test_changes_alone_are_no_damage_and_need_a_word() -> None:
    with pytest.raises(ConfigError, match=r"states\.changed\.fault: .*pitting needs kind"):
        notes("pitting")
    with pytest.raises(ConfigError, match=r"states\.changed\.fault: received nothing"):
        load_config(minimal(states=by_name([{"name": "healthy"}, CHANGED])))
    with pytest.raises(ConfigError, match=r"states\.changed\.fault: received healthy, with changes"):
        notes("healthy")
