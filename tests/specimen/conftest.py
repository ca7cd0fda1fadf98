"""What tests of gearboxes share."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from siggen.specimen.housing import housing_settle_s, specimen_housing
from siggen.specimen.structure import specimen_body


@pytest.fixture
def made_anew() -> Iterator[Callable[[], None]]:
    """Forget the housings of gearboxes, which are made once: with other bounds they are others."""

    def forget() -> None:
        for once in (specimen_housing, housing_settle_s, specimen_body):
            once.cache_clear()

    yield forget
    forget()
