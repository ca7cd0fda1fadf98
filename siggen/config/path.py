"""The transfer path of a sensor: random modes of the housing, or a measured frequency response."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, model_validator

from siggen.errors import Problem
from siggen.keys.number import Number, Within
from siggen.keys.problems import refusal
from siggen.keys.section import Section
from siggen.keys.wording import AllowedText


class ModalPath(Section):
    """Bearing forces reach the sensor through the flexible modes of `housing`."""

    kind: Literal["modal"] = Field(description="random modes of the section housing")
    rigid: bool = Field(
        default=True,
        description="whether the motion of the rigid casing is added; needs dynamics.model: casing and a position",
    )
    delay_us: Annotated[Number, Within(least=0, most=5000)] = Field(
        default=0.0,
        description="from the bearings through the flexible modes to the sensor, drawn per gearbox and axis",
    )


class MeasuredPath(Section):
    """Bearing forces reach the sensor through a measured accelerance, which holds the rigid motion as well."""

    kind: Literal["measured"] = Field(description="frequency response from a file")
    file: str | None = Field(
        default=None, description="CSV, Parquet or npz; its path counts from the folder of the configuration"
    )
    sha256: str | None = Field(
        default=None, description="of the file, filled in when it is read; if given, the file must have it"
    )
    response: str | None = Field(
        default=None, description="the numbers of the file, filled in when it is read, so that the set needs no file"
    )
    files: Annotated[tuple[str, ...], Field(min_length=1)] | None = Field(
        default=None,
        description="several instead of `file`: every gearbox draws one of them; sensors with as many files draw the "
        "same number, since what one number says belongs together",
    )
    responses: Annotated[tuple[str, ...], Field(min_length=1)] | None = Field(
        default=None, description="the numbers of `files`, filled in when they are read"
    )

    @model_validator(mode="after")
    def _one_kind(self) -> MeasuredPath:
        if self.files is not None and self.file is not None:
            raise refusal([Problem("files", f"files beside file: {self.file}", "allowed: one of the two keys")])
        return self

    @property
    def family(self) -> tuple[str, ...]:
        """All responses that a gearbox may have; one unless `files` are given, none before they are read."""
        return self.responses or (() if self.response is None else (self.response,))


TransferPath: TypeAlias = ModalPath | MeasuredPath

PATH = AllowedText("null, or a mapping with kind: modal or measured")
