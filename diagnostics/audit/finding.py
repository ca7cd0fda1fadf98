"""A finding of the separability audit: what was measured, against which bound, and how to mend the configuration.

Which label columns must not tell the state, and how a tie of the state to one is mended: by role and section, which the
set says of every column. A column of which it says nothing is a condition.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from siggen.keys.column import Role

TOLD_BY_NOTHING = (Role.CONDITION, Role.PROVENANCE)
"""Roles whose columns must not tell the state; damage and what follows from it may, names of records do."""

MENDS = {
    "duration_s": "Give all records the same length. Do not pad.",
    "operating_points": "Use the same operating points for all states of a specimen, and draw start angles per record.",
    "sensors": "Draw path and noise by one law for all states of a specimen, not from the level of the record.",
    "manufacture": "Draw the errors per specimen and keep them in all its states, or draw them anew in every state.",
}
"""By the section of the configuration that draws a column."""
MEND = "Draw this quantity by one law for all states, or say that it follows from the damage (its role)."


LARGEST_AUC = 0.9
"""What one number, or chance, may reach."""


def must_not_tell(roles: Mapping[str, Role], name: str) -> bool:
    """Return whether a label column must not tell the state."""
    return roles.get(name, Role.CONDITION) in TOLD_BY_NOTHING


@dataclass(frozen=True, slots=True)
class Finding:
    """One reason why scores on the set would not mean what they seem to.

    Attributes
    ----------
    leak : str
        Which leak: a fixed word, such as `state_tied_to_sensors`.
    measured : str
        What was measured.
    bound : str
        What it was compared with.
    mend : str
        How to change the configuration.
    """

    leak: str
    measured: str
    bound: str
    mend: str

    def line(self) -> str:
        """Return the finding on one line."""
        return f"{self.leak}: {self.measured}. Bound: {self.bound}. To correct it: {self.mend}"
