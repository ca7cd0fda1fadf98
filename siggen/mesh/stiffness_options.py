"""The choices of the stiffness model: the tooth, the gear body under it, and the contact between two teeth."""

from __future__ import annotations

from dataclasses import dataclass

from siggen.mesh.beams import BEAMS

TOOTH_MODELS = (*BEAMS, "calibrated")


@dataclass(frozen=True, slots=True)
class StiffnessOptions:
    """How a tooth pair's stiffness is modelled.

    Parameters
    ----------
    beam : str
        Tooth: a cantilever from 'base_circle' (paper A), 'root_circle' or 'rack_trochoid', or 'calibrated' (the
        trochoid's compliance times the finite-element factor of `siggen.mesh.calibration`).
    foundation : str
        'sainsot' or 'none'; 'calibrated' holds with 'sainsot' only.
    hertz : str
        Contact law, see `siggen.mesh.hertz`: 'linear' or 'weber_banaschek'; the
        latter for comparisons with finite elements.
    hertz_force_n : float or None
        Normal force at which a load-dependent contact law is taken [N]; None for 'linear'.
    coupling : str
        'none': pairs in contact are springs side by side; 'body': loaded teeth of one gear deflect each other
        (`siggen.mesh.body_coupling`), which needs the foundation.
    """

    beam: str = "calibrated"
    foundation: str = "sainsot"
    hertz: str = "linear"
    hertz_force_n: float | None = None
    coupling: str = "none"

    @property
    def shape(self) -> str:
        """Cantilever whose integrals are taken; the calibrated tooth is a scaled 'rack_trochoid'."""
        return "rack_trochoid" if self.beam == "calibrated" else self.beam

    @property
    def root_reading(self) -> str:
        """Tooth root that the foundation sees: 'rack' of a rack-cut tooth, else 'profile'."""
        return "rack" if self.shape == "rack_trochoid" else "profile"
