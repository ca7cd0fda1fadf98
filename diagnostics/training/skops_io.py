"""skops.io, imported without torch, which takes seconds and is of no use to classifiers on indicators.

skops lists all estimators of scikit-learn. On that way lies a package that wraps torch. While the list is made, an
empty one stands in its place.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType

WRAPPER = "sklearn.externals.array_api_compat.torch"


def _imported() -> ModuleType:
    if {"torch", WRAPPER} & sys.modules.keys():
        return import_module("skops.io")
    empty = ModuleType(WRAPPER)
    empty.__path__ = []
    sys.modules[WRAPPER] = empty
    try:
        return import_module("skops.io")
    finally:
        del sys.modules[WRAPPER]


skops_io = _imported()
