"""Sections `dynamics.mesh` and `dynamics.friction`: how the teeth push and rub."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from siggen.config.oil import Oil
from siggen.keys.distributions import Uniform
from siggen.keys.number import Number, Within
from siggen.keys.section import Section
from siggen.keys.usual import Usual

DAMPING_PARTS = (
    "parts of the mesh damping ratio with damping: asperity_share: always there, in a full oil film, where asperities "
    "carry all"
)


class MeshSection(Section):
    """The law of the mesh force; everything but `law` is used by the law pairs alone."""

    law: Literal["linear", "pairs"] = Field(
        default="pairs",
        description="linear: mesh stiffness times approach, damage lowers the stiffness (paper A); pairs: every tooth "
        "pair by itself, its contact solved across the face",
    )
    tip_relief_um: Annotated[Number, Within(least=0)] = Field(
        default=8.0, description="parabolic relief at the tips of both gears, over a quarter of a base pitch"
    )
    damage: Literal["all", "geometry"] = Field(
        default="all",
        description="how damage acts with law: pairs; geometry: lands carry, flanks sink where none is left, "
        "land beside it is rough, as far as it is wide, up to 0.5 mm; all: geometry, and weaker sections",
    )
    pit_edge_radius_mm: Annotated[Number, Within(least=0, most=1), Usual(0.005, 1)] = Field(
        default=0.1, description="rounding of the edges of damage (law: pairs)"
    )
    damping: Literal["constant", "asperity_share"] = Field(
        default="constant",
        description="constant: mesh_damping_ratio; asperity_share: structure + film (1 - La) + asperities La with the "
        "asperity share La of friction.model: mixed_ehl",
    )
    structure_damping_ratio: Annotated[Number, Within(least=0, most=0.5), Usual(0.002, 0.3)] = Field(
        default=0.04, description=DAMPING_PARTS
    )
    film_damping_ratio: Annotated[Number, Within(least=0, most=0.5), Usual(0.002, 0.3)] = Field(
        default=0.02, description=DAMPING_PARTS
    )
    asperity_damping_ratio: Annotated[Number, Within(least=0, most=0.5), Usual(0.002, 0.3)] = Field(
        default=0.05, description=DAMPING_PARTS
    )


class Friction(Section):
    """Friction between the flanks; needs the law pairs."""

    model: Literal["auto", "off", "constant", "mixed_ehl"] = Field(
        default="auto",
        description="mixed_ehl: asperities and oil film share the load by speed, load and roughness; auto: mixed_ehl "
        "with the law pairs, off with the law linear",
    )
    coefficient: Annotated[Number, Within(least=0, most=0.5), Usual(0.005, 0.3)] = Field(
        default=0.05, description="of the model constant"
    )
    oil: Oil = Field(
        default="ISO VG 220", description="mineral gear oil (mixed_ehl); a list: each gearbox draws one of them"
    )
    oil_temperature_c: Annotated[Number, Within(least=-20, most=150), Usual(5, 120)] = Field(
        default=50.0, description="at the inlet of the contact"
    )
    boundary_friction: Annotated[Number, Within(least=0, most=0.5), Usual(0.02, 0.3)] = Field(
        default=Uniform(low=0.07, high=0.11), description="friction coefficient of asperities, by the oil's additives"
    )
    roughness_um: Annotated[Number, Within(above=0, most=5)] = Field(
        default=Uniform(low=0.2, high=0.5), description="rms roughness of either flank, run in (mixed_ehl)"
    )
    pit_roughness_um: Annotated[Number, Within(above=0, most=5), Usual(0.1, 5)] = Field(
        default=2.0,
        description="rms roughness of a flank in damage and on the land beside it, as far as that is wide, up to "
        "0.5 mm (mixed_ehl)",
    )
