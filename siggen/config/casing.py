"""Section `dynamics.casing`: a rigid casing on bolts, and where the shafts run in it.

Positions are [horizontal, vertical] from the casing's centre of gravity; horizontal counts from gear to pinion.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from siggen.errors import Problem
from siggen.keys.number import Number, Within
from siggen.keys.problems import refusal
from siggen.keys.section import Position, Section


class Bolts(Section):
    """The bolts between casing and ground, all alike."""

    shear_stiffness_n_per_m: Annotated[Number, Within(above=0)] = Field(default=8e7, description="horizontal, each")
    axial_stiffness_n_per_m: Annotated[Number, Within(above=0)] = Field(default=1.5e8, description="vertical, each")
    damping_ratio: Annotated[Number, Within(least=0, below=1)] = Field(
        default=0.04, description="of a bolt that carries its share of the casing's mass"
    )
    positions_mm: Annotated[tuple[Position, ...], Field(min_length=2)] = Field(
        default=((90.0, 0.0), (90.0, 0.0), (-90.0, 0.0), (-90.0, 0.0)), description="[horizontal, vertical] of each"
    )

    @model_validator(mode="after")
    def _support(self) -> Bolts:
        if len(set(self.positions_mm)) < 2:
            received = f"all bolts at {list(self.positions_mm[0])}"
            allowed = "allowed: at least two different places; about a single one the casing would turn freely"
            raise refusal([Problem("positions_mm", received, allowed)])
        return self


class Casing(Section):
    """A rigid body that carries the bearings: two translations and rocking."""

    mass_kg: Annotated[Number, Within(above=0)] = Field(default=20.0, description="without the gears and shafts")
    inertia_kg_m2: Annotated[Number | None, Within(above=0, words=(None,))] = Field(
        default=0.25,
        description="about its centre of gravity; null: the mass times the square of 1.15 centre distances (derived)",
    )
    bolts: Bolts = Field(default=Bolts(), description="between casing and ground")
