"""A finding of the separability audit: what was measured, against which bound, and how to mend the configuration."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Finding:
    """One reason why scores on the set would not mean what they seem to.

    Attributes
    ----------
    trap : str
        Which trap: a fixed word, such as `state_tied_to_operation`.
    measured : str
        What was measured.
    bound : str
        What it was compared with.
    mend : str
        How to change the configuration.
    """

    trap: str
    measured: str
    bound: str
    mend: str

    def line(self) -> str:
        """Return the finding on one line."""
        return f"{self.trap}: {self.measured}. Bound: {self.bound}. To correct it: {self.mend}"
