"""Numbers that no file sets, set by a test."""

from __future__ import annotations

import pytest

from siggen.keys.section import Section


def fix(monkeypatch: pytest.MonkeyPatch, numbers: type[Section], **values: float) -> None:
    """Give numbers of a section these values in place of what is drawn for them."""
    for name, value in values.items():
        monkeypatch.setattr(numbers.model_fields[name], "default", value)
