"""What decides whether bits can be equal is named, and does not change within a run."""

from __future__ import annotations

import json

from siggen.dataset.environment import PACKAGES, environment, host_facts, peak_memory_bytes


def test_the_environment_names_versions_system_and_cpu_and_is_stable() -> None:
    facts = environment()
    assert facts == environment()
    assert set(facts) == {"siggen", *PACKAGES, "python", "system", "libc", "cpu", "sources", "fingerprint"}
    assert all(facts.values())
    assert "not installed" not in facts.values()


def test_facts_of_the_host_fit_into_json() -> None:
    assert json.loads(json.dumps(host_facts())) == host_facts()
    assert peak_memory_bytes()["parent"] > 10_000_000  # a Python process with numpy has more than 10 MB
