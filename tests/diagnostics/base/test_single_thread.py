"""A package that is not installed is missing at once, however deep; other imports, and those afterwards, stay."""

from __future__ import annotations

import importlib
import sys

import pytest

from diagnostics.base.single_thread import known_to_be_missing

NOBODYS = "no_package_has_this_name"


def test_a_missing_package_is_missed_at_once_in_nested_calls_too() -> None:
    before = list(sys.meta_path)
    with known_to_be_missing(NOBODYS), known_to_be_missing(NOBODYS):
        assert len(sys.meta_path) == len(before) + 1
        with pytest.raises(ModuleNotFoundError, match=f"No module named '{NOBODYS}'"):
            importlib.import_module(NOBODYS)
        assert importlib.import_module("json").loads("1") == 1
    assert sys.meta_path == before


def test_a_package_that_is_there_stays_there() -> None:
    before = list(sys.meta_path)
    with known_to_be_missing("numpy"):
        assert sys.meta_path == before
