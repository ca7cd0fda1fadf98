"""Section `stiffness`: how the mesh stiffness is computed."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from siggen.keys.section import Section


class Stiffness(Section):
    """Models of the tooth and of its neighbours; gear body after Sainsot (2004), contact linear."""

    beam: Literal["base_circle", "root_circle", "rack_trochoid", "calibrated"] = Field(
        default="calibrated",
        description=("where the tooth's cantilever begins; calibrated: rack_trochoid, scaled to finite elements"),
    )
    coupling: Literal["none", "body", "auto"] = Field(
        default="auto",
        description="body: neighbouring teeth deflect each other; none: the plain sum of pairs (paper A); "
        "auto: body for calibrated, else none",
    )

    @property
    def coupled_by(self) -> str:
        """The coupling that `coupling` stands for: body or none."""
        return self._brought_along if self.coupling == "auto" else self.coupling

    @property
    def _brought_along(self) -> str:
        return "body" if self.beam == "calibrated" else "none"

    def identity_value(self, key: str) -> Any:
        """Return what the value of a key stands for: a coupling that a beam brings along is the same when named."""
        same = key == "coupling" and self.coupling == self._brought_along
        return "auto" if same else super().identity_value(key)
