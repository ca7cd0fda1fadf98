"""Which oil a gearbox runs in: one for the whole set, or a list from which each gearbox draws."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias, get_args

from pydantic import Field

from siggen.errors import Problem
from siggen.keys.parser import Parser
from siggen.keys.problems import nearest_word, received_text, refusal

OilName: TypeAlias = Literal[
    "ISO VG 32", "ISO VG 46", "ISO VG 68", "ISO VG 100", "ISO VG 150", "ISO VG 220", "ISO VG 320", "ISO VG 460",
    "ISO VG 680",
]  # fmt: skip
OIL_NAMES: tuple[str, ...] = get_args(OilName)
OilValue = str | tuple[str, ...]


class OilParser(Parser):
    """Parser of `oil`: a name, or a list of different names."""

    allowed_text = f"one of {', '.join(OIL_NAMES)}, or a list of some, from which each gearbox draws"
    documented: Any = OilName | Annotated[list[OilName], Field(min_length=1)]

    def parse(self, value: object) -> OilValue:
        """Return a name or several, or raise a refusal."""
        if isinstance(value, str) and value in OIL_NAMES:
            return value
        if isinstance(value, (list, tuple)):
            names = [name for name in value if isinstance(name, str) and name in OIL_NAMES]
            if names and len(names) == len(value) == len(set(names)):
                return tuple(names)
        meant = nearest_word(value, OIL_NAMES)
        raise refusal([Problem("", received_text(value), f"allowed: {self.allowed_text}{meant}")])


Oil = Annotated[OilValue, OilParser()]


def oils_of(oil: OilValue) -> tuple[str, ...]:
    """Return the oils that a gearbox may have."""
    return oil if isinstance(oil, tuple) else (oil,)
