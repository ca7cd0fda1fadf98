"""Which teeth of a gear are damaged: a number of neighbours, or their indices."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from siggen.config.problems import received_text, refusal
from siggen.errors import Problem


class TeethParser:
    """Parser of `teeth`: a whole number from 1, or a list of different indices from 0."""

    allowed_text = (
        "how many neighbouring teeth (a whole number from 1), or a list of different tooth indices such as [0, 1]"
    )

    def parse(self, value: object) -> int | tuple[int, ...]:
        """Return the number of teeth or their indices, or raise a refusal."""
        if isinstance(value, (list, tuple)):
            whole = [item for item in value if isinstance(item, int) and not isinstance(item, bool) and item >= 0]
            if whole and len(whole) == len(value) == len(set(whole)):
                return tuple(whole)
            listed = ", ".join(received_text(item) for item in value)
            raise refusal([Problem("", f"[{listed}]", f"allowed: {self.allowed_text}")])
        if isinstance(value, int) and not isinstance(value, bool) and value >= 1:
            return value
        raise refusal([Problem("", received_text(value), f"allowed: {self.allowed_text}")])

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Parse with `parse`; the schema for readers of the file shows both forms."""
        documented: Any = Annotated[int, Field(ge=1)] | list[Annotated[int, Field(ge=0)]]
        return core_schema.no_info_plain_validator_function(
            self.parse, json_schema_input_schema=handler.generate_schema(documented)
        )


Teeth = Annotated[int | tuple[int, ...], TeethParser()]
