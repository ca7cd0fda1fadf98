"""The table of definitions in docs/understand/indicators.md is that of the registry."""

from __future__ import annotations

from pathlib import Path

from diagnostics.indicators.registry import ALL, definition_table

PAGE = Path(__file__).resolve().parents[3] / "docs" / "understand" / "indicators.md"


def test_table_of_definitions_is_the_registrys() -> None:
    assert definition_table() in PAGE.read_text(encoding="utf-8")
    for definition in ALL:
        assert all((definition.title, definition.signal, definition.formula, definition.known, definition.undefined))
