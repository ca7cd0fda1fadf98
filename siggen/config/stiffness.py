"""Section `stiffness`: how the mesh stiffness is computed."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from siggen.config.section import Section, Whole


class Stiffness(Section):
    """Models of the tooth and of the gear body below it."""

    beam: Literal["base_circle", "root_circle", "rack_trochoid"] = Field(
        default="rack_trochoid", description="where the tooth's cantilever begins; base_circle is the choice of paper A"
    )
    foundation: Literal["sainsot", "none"] = Field(default="sainsot", description="compliance of the gear body")
    foundation_angle: Literal["auto", "profile", "rack"] = Field(
        default="auto", description="reading of the tooth's root angle; auto: rack for rack_trochoid, profile otherwise"
    )
    table_points: Annotated[Whole, Field(ge=65, le=1_000_000)] = Field(
        default=2049, description="points of a stiffness table over one path of contact"
    )
