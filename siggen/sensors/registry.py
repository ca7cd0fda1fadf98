"""What follows from the list of kinds: the union that an entry of `sensors` parses, and what it is by default."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

from pydantic import BeforeValidator, Field

from siggen.sensors.kinds import KINDS
from siggen.sensors.sensor import SensorBase

DEFAULT_KIND = KINDS[0].kind_word()


def with_kind(entry: Any) -> Any:
    """Return an entry of `sensors` with its kind."""
    return {"kind": DEFAULT_KIND, **entry} if isinstance(entry, Mapping) else entry


if TYPE_CHECKING:
    SensorSection: TypeAlias = SensorBase
elif len(KINDS) == 1:
    SensorSection = Annotated[KINDS[0], BeforeValidator(with_kind)]
else:
    SensorSection = Annotated[reduce(or_, KINDS), Field(discriminator="kind"), BeforeValidator(with_kind)]
