"""What is limited to one thread can still import, search and call as before."""

from __future__ import annotations

from importlib.util import find_spec

import pytest

from diagnostics.base.single_thread import single_thread


@pytest.mark.skipif(find_spec("pandas") is not None, reason="pandas is installed here")
def test_a_missing_package_can_be_searched_for_and_its_import_is_refused_at_once() -> None:
    """PyTorch searches for pandas when a first optimiser is made, and takes no exception for it."""

    @single_thread
    def inner() -> str:
        find_spec("pandas")
        with pytest.raises(ModuleNotFoundError, match="No module named 'pandas'"):
            import pandas  # noqa: F401
        return "done"

    assert single_thread(inner)() == "done"
    assert find_spec("pandas") is None
