"""Mutated configurations: accepted or refused in words, never a traceback or a hang; 2,000 of them in `benchmarks`."""

from __future__ import annotations

from pathlib import Path

from tests.faults.mutated_configurations import judged_configuration, load_presets, mutated


def test_mutated_configurations_end_in_words(tmp_path: Path) -> None:
    load_presets()
    cases = [judged_configuration(text, tmp_path) for text in mutated(25, seed=4)]
    wrong = [f"{case.outcome}\n{case.message}" for case in cases if case.outcome not in ("accepted", "refused")]
    assert not wrong, wrong[0]
    assert {case.outcome for case in cases} == {"accepted", "refused"}


def test_a_fault_of_the_program_would_be_seen(tmp_path: Path, monkeypatch) -> None:
    from tests.faults import mutated_configurations

    monkeypatch.setattr(mutated_configurations, "load_config", lambda file: 1 / 0)
    assert judged_configuration("name: a", tmp_path).outcome == "traceback"
    monkeypatch.setattr(mutated_configurations, "LIMIT_S", 0.05)
    monkeypatch.setattr(mutated_configurations, "load_config", lambda file: [None for _ in iter(int, 1)])
    assert judged_configuration("name: a", tmp_path).outcome == "hang"
