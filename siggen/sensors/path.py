"""The transfer path of a sensor: a measured frequency response in place of the housing."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, JsonValue

from siggen.errors import Problem
from siggen.keys.parser import Parser
from siggen.keys.problems import received_text, refusal
from siggen.keys.section import Section
from siggen.keys.wording import AllowedText

DIRECTIONS = ("vertical", "horizontal", "axial")
"""Directions along which a sensor on the casing may look."""


class TextParser(Parser):
    """Parser of a text, or of a list of some."""

    allowed_text = "a text, or a list of at least one"
    documented: Any = str | Annotated[list[str], Field(min_length=1)] | None

    def parse(self, value: object) -> str | tuple[str, ...] | None:
        """Return the text, the texts or None, or raise a refusal."""
        if value is None or isinstance(value, str):
            return value
        texts = tuple(one for one in value if isinstance(one, str)) if isinstance(value, (list, tuple)) else ()
        if texts and isinstance(value, (list, tuple)) and len(texts) == len(value):
            return texts
        raise refusal([Problem("", received_text(value), f"allowed: {self.allowed_text}")])


OneOrMore = Annotated[str | tuple[str, ...], TextParser()]

FILLED_IN: dict[str, JsonValue] = {"readOnly": True}
"""Of keys that siggen writes into the file of a set; no user has to."""

KIND = AllowedText("measured; a sensor on a place of a housing of plates needs no path")


class MeasuredPath(Section):
    """Bearing forces reach the sensor through a measured accelerance, which holds the rigid motion as well."""

    understood_kind: ClassVar[bool] = True

    kind: Annotated[Literal["measured"], KIND] = Field(default="measured", description="frequency response from a file")
    file: OneOrMore | None = Field(
        default=None,
        description=(
            "CSV, Parquet or npz, from the folder of the configuration; of a list every gearbox draws one, "
            "alike for all sensors"
        ),
    )
    sha256: str | None = Field(
        default=None,
        description="of a single file, filled in when it is read; if given, the file must have it",
        json_schema_extra=FILLED_IN,
    )
    response: OneOrMore | None = Field(
        default=None,
        description="the numbers of `file`, filled in when they are read, so that the set needs no file",
        json_schema_extra=FILLED_IN,
    )

    @property
    def family(self) -> tuple[str, ...]:
        """All responses that a gearbox may have; one unless `file` is a list, none before they are read."""
        return self.response if isinstance(self.response, tuple) else tuple(filter(None, (self.response,)))

    @property
    def is_family(self) -> bool:
        """Whether gearboxes draw one of a list of files."""
        return isinstance(self.file, tuple)


PATH = AllowedText("null, or a mapping with file: a measured frequency response")
