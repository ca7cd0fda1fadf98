"""Base of every part of a configuration: frozen, and closed to unknown keys."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import BaseModel, ConfigDict, Field

from siggen.keys.wording import AllowedText


class Section(BaseModel):
    """A mapping of the YAML file; keys are the attributes."""

    understood_kind: ClassVar[bool] = False
    """Whether its `kind` is what the same section without one is; then it counts in no identity."""

    key_field: ClassVar[str] = ""
    """The field that a file gives as the key under which the section stands, such as the name of a state."""

    # Built with the first file that is read: workers, which get a design that was read, never build one.
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, defer_build=True)


Real = Annotated[float, Field(strict=True)]
"""A number that is never drawn (a setting, not a physical quantity of a specimen)."""

Whole = Annotated[int, Field(strict=True)]
"""A whole number: counts and indices; neither 18.0 nor true."""

Position = Annotated[
    tuple[Real, Real], AllowedText("two numbers, [horizontal, vertical] in mm from the casing's centre of gravity")
]
"""A place on the casing."""
