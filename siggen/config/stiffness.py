"""Section `stiffness`: how the mesh stiffness is computed."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from siggen.keys.section import Section


class Stiffness(Section):
    """Model of the tooth; gear body after Sainsot (2004), contact linear."""

    beam: Literal["base_circle", "root_circle", "rack_trochoid", "calibrated"] = Field(
        default="calibrated",
        description=(
            "where the tooth's cantilever begins: pairs are springs side by side (paper A); calibrated: rack_trochoid "
            "scaled to finite elements, and neighbours deflect each other through the gear body"
        ),
    )
