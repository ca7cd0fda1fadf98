"""docs/develop/physics_checks.md names tests that exist."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NAMED = re.findall(r"`([\w/]+\.py)::(\w+)`", (ROOT / "docs" / "develop" / "physics_checks.md").read_text())


def test_every_named_test_exists() -> None:
    assert len(NAMED) > 40
    missing = [(f, name) for f, name in NAMED if f"def {name}(" not in (ROOT / "tests" / f).read_text()]
    assert not missing
