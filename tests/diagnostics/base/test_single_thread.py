"""A package that is not installed is missing at once, however deep; other imports, and those afterwards, stay."""

from __future__ import annotations

import importlib
import sys
from importlib.util import find_spec

import pytest

from diagnostics.base.single_thread import known_to_be_missing

NOBODYS = "no_package_has_this_name"


def test_a_missing_package_is_missed_at_once_in_nested_calls_too() -> None:
    with known_to_be_missing(NOBODYS), known_to_be_missing(NOBODYS):
        with pytest.raises(ModuleNotFoundError, match=NOBODYS):
            importlib.import_module(NOBODYS)
        assert find_spec(NOBODYS) is None  # who only searches for it, as PyTorch does, is told so
        assert importlib.import_module("json").loads("1") == 1
    assert NOBODYS not in sys.modules


def test_a_package_that_is_there_stays_there() -> None:
    with known_to_be_missing("numpy"):
        assert importlib.import_module("numpy").ones(2).sum() == 2.0
