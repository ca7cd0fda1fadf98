"""The transfer path of a sensor: random modes of the housing, or a measured frequency response."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from siggen.config.number import Number, Within
from siggen.config.section import Section
from siggen.config.wording import AllowedText


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


TransferPath: TypeAlias = ModalPath | MeasuredPath

PATH = AllowedText("null, or a mapping with kind: modal or measured")
