"""Public names are loaded when they are used; until then completion, `dir` and `help` show them all the same."""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module

import pytest

PACKAGES = ("siggen", "diagnostics", "diagnostics.loader")


@pytest.mark.parametrize("package", PACKAGES)
def test_a_fresh_package_shows_every_public_name_and_loads_none(package: str) -> None:
    code = f"import sys, {package} as it; print(*dir(it)); print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    shown, loaded = (line.split() for line in done.stdout.splitlines())
    public = import_module(package).__all__
    assert set(shown) - {"__version__"} == set(public)
    assert "numpy" not in loaded


@pytest.mark.parametrize("package", PACKAGES)
def test_every_public_name_is_there_and_has_its_help(package: str) -> None:
    module = import_module(package)
    for name in module.__all__:
        assert getattr(module, name).__doc__, name
    with pytest.raises(AttributeError, match=f"{package} has no 'simulat'; it has "):
        module.simulat  # noqa: B018 - the access is what is tested
