"""A user's own indicator: how it is found by its reference, what it may return, and what is said where it cannot be."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from diagnostics.indicators.own_indicator import GearFacts, OwnIndicator, load_indicator, named_once
from siggen.errors import UsageError

GEARS = GearFacts(18, 47, 12_800.0, 30.0, 60.0)


@pytest.mark.parametrize(
    ("returned", "text"),
    [
        (None, "NoneType"),
        (np.array([1.0, 2.0]), "returned ndarray (2,), not one number"),
        ([1.0], "returned list (1,), not one number"),
        ("1.0", "returned str (), not one number"),
        (1j, "complex"),
        (math.inf, "infinite"),
    ],
)
def test_what_an_own_indicator_may_not_return(returned: Any, text: str) -> None:
    with pytest.raises(UsageError, match="one float") as caught:
        OwnIndicator("own", lambda signal, tacho, gears: returned).value(np.ones(3), np.ones(2), GEARS)
    assert text in str(caught.value)


@pytest.mark.parametrize(("returned", "value"), [(2, 2.0), (np.float32(1.5), 1.5), (np.array(3.0), 3.0), (True, 1.0)])
def test_any_single_number_will_do_and_nan_is_undefined(returned: Any, value: float) -> None:
    assert OwnIndicator("own", lambda signal, tacho, gears: returned).value(np.ones(3), np.ones(2), GEARS) == value
    assert math.isnan(OwnIndicator("own", lambda signal, tacho, gears: math.nan).value(np.ones(3), np.ones(2), GEARS))


MODULES = {
    "good_module": "def level(signal, tacho, gears):\n    return float(abs(signal).max())\n",
    "not_python": "def level(signal, tacho, gears)\n",
    "asks_for_more": "import no_such_package_at_all\n",
    "breaks": "raise ValueError('not today')\n",
    "leaves": "import sys\nsys.exit(3)\n",
    "statistics": "def level(signal, tacho, gears):\n    return 1.0\n",
    "shapes": "number = 3\ndef two(signal, tacho): return 1.0\ndef four(signal, tacho, gears, more): return 1.0\n"
    "def by_name(*, signal, tacho, gears): return 1.0\ndef many(*anything): return 1.0\ndef rms(s, t, g): return 1.0\n"
    "def fm0_pinion_h5(s, t, g): return 1.0\n"
    "class Meter:\n    def __call__(self, s, t, g): return 1.0\nmeter = Meter()\n",
}


@pytest.fixture
def in_modules(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Work in a folder that holds the modules, as a user would; forget them afterwards."""
    for name, text in MODULES.items():
        (tmp_path / f"{name}.py").write_text(text)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    for name in set(MODULES) - {"statistics"}:
        monkeypatch.delitem(sys.modules, name, raising=False)


@pytest.mark.usefixtures("in_modules")
@pytest.mark.parametrize("reference", ["good_module:level", "shapes:many", "shapes:meter"])
def test_indicator_is_loaded_from_a_module_in_the_current_folder(reference: str) -> None:
    assert load_indicator(reference).name == reference.split(":")[1]


@pytest.mark.usefixtures("in_modules")
@pytest.mark.parametrize(
    ("reference", "text"),
    [
        ("good_module.level", "allowed is package.module:function"),
        ("good_module:", "allowed is package.module:function"),
        (":level", "allowed is package.module:function"),
        ("no_such_module:f", "PYTHONPATH"),
        ("..good_module:level", "TypeError"),
        ("not_python:level", "SyntaxError"),
        ("asks_for_more:level", "No module named 'no_such_package_at_all'"),
        ("breaks:level", "ValueError: not today"),
        ("leaves:level", "SystemExit: 3"),
        ("good_module:nothing", "no attribute 'nothing'; it was found at"),
        ("statistics:level", "If another file of that name was meant"),
        ("shapes:number", "is a int, not a function"),
        ("shapes:two", "too many positional arguments"),
        ("shapes:four", "missing a required argument: 'more'"),
        ("shapes:by_name", "too many positional arguments"),
        ("shapes:rms", "one of the package's own"),
        ("shapes:fm0_pinion_h5", "one of the package's own"),
    ],
)
def test_reference_that_names_no_indicator_says_why(reference: str, text: str) -> None:
    with pytest.raises(UsageError) as caught:
        load_indicator(reference)
    assert text in str(caught.value)


@pytest.mark.parametrize("name", ["Peak", "fm4_gear", "a__b", "fm4"])
def test_names_that_a_column_cannot_start_with_are_refused(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "own_names.py").write_text(f"def {name}(signal, tacho, gears):\n    return 1.0\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "own_names", raising=False)
    with pytest.raises(UsageError, match="indicator name"):
        load_indicator(f"own_names:{name}")


def level(signal: np.ndarray, tacho_s: np.ndarray, gears: GearFacts) -> float:
    return 1.0


def test_two_indicators_of_one_name_are_refused() -> None:
    mine = OwnIndicator("mine", level)
    assert named_once([mine]) == (mine,)
    with pytest.raises(UsageError, match=r"the names \['mine'\] came twice"):
        named_once([mine, OwnIndicator("mine", level)])
