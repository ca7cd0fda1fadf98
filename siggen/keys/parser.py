"""Parser: base of what reads a value of a file by a function of its own, put beside the type in `Annotated`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler, TypeAdapter
from pydantic_core import CoreSchema, core_schema


class Parser(ABC):
    """Reads with `parse`, and shows readers of the JSON Schema the type that is `documented`."""

    __slots__ = ()

    @property
    @abstractmethod
    def documented(self) -> Any:
        """All forms that the value may have in a file, as a type."""

    @abstractmethod
    def parse(self, value: object) -> Any:
        """Return what a value of a file stands for, or raise a refusal."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Read with `parse`; what is documented waits to be asked for: it takes longer than the rest of a section."""
        return core_schema.no_info_plain_validator_function(self.parse)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return what is documented."""
        return handler(TypeAdapter(self.documented).core_schema)
