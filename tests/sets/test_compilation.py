"""Whoever waits for the first record on a machine is told why."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

from siggen.dynamics.mesh import pair_forces
from siggen.dynamics.mesh.pair_forces import static_force
from siggen.dynamics.mesh.pair_places import pair_table
from siggen.sets.compilation import compilation_text, is_compiled
from tests.dynamics.pair_runs import law


def test_an_empty_cache_is_told_and_a_filled_one_is_not(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    static_force(law(), 1e-6, 0.3, pair_table(law()))  # compiles the forces, or finds them compiled
    assert is_compiled()
    assert compilation_text() == ""
    empty = SimpleNamespace(stats=SimpleNamespace(cache_path=str(tmp_path / "nothing")))
    monkeypatch.setattr(pair_forces, "write_forces", empty)
    assert "compiling the simulation once: about 40 s of CPU per worker" in compilation_text()
