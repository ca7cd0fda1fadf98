"""The choices of the stiffness model: the tooth, the gear body under it, and the contact between two teeth."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from siggen.mesh.beams import BEAMS

TOOTH_MODELS = (*BEAMS, "calibrated")
FOUNDATIONS = ("sainsot", "none")
FOUNDATION_ANGLES = ("auto", "profile", "rack")
HERTZ_LAWS = ("linear", "weber_banaschek")
COUPLINGS = ("none", "body")


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
    foundation_angle : str
        Tooth root that the foundation sees: 'profile', 'rack', or 'auto' (rack for a rack-cut tooth, else profile);
        'calibrated' holds with 'rack' only.
    hertz : str
        Contact law, see `siggen.mesh.hertz`: 'linear' or 'weber_banaschek'; the
        latter for comparisons with finite elements.
    hertz_force_n : float or None
        Normal force at which a load-dependent contact law is taken [N]; None for 'linear'.
    coupling : str
        'none': pairs in contact are springs side by side; 'body': loaded teeth of one gear deflect each other
        (`siggen.mesh.body_coupling`), which needs the foundation.

    Raises
    ------
    ValueError
        For an unknown name, a combination that 'calibrated' was not made for, or a force that the law lacks or does
        not know.
    """

    beam: str = "calibrated"
    foundation: str = "sainsot"
    foundation_angle: str = "auto"
    hertz: str = "linear"
    hertz_force_n: float | None = None
    coupling: str = "none"

    def __post_init__(self) -> None:
        """Refuse unknown names and combinations that mean nothing."""
        for name, allowed in (
            ("beam", TOOTH_MODELS),
            ("foundation", FOUNDATIONS),
            ("foundation_angle", FOUNDATION_ANGLES),
            ("hertz", HERTZ_LAWS),
            ("coupling", COUPLINGS),
        ):
            if getattr(self, name) not in allowed:
                raise ValueError(f"received {name} {getattr(self, name)!r}; allowed: {', '.join(allowed)}")
        self._refuse_conflicts()

    @property
    def shape(self) -> str:
        """Cantilever whose integrals are taken; the calibrated tooth is a scaled 'rack_trochoid'."""
        return "rack_trochoid" if self.beam == "calibrated" else self.beam

    @property
    def root_reading(self) -> str:
        """Tooth root of the foundation, 'profile' or 'rack', with 'auto' resolved."""
        if self.foundation_angle != "auto":
            return self.foundation_angle
        return "rack" if self.shape == "rack_trochoid" else "profile"

    def _refuse_conflicts(self) -> None:
        if self.beam == "calibrated" and (self.foundation != "sainsot" or self.foundation_angle == "profile"):
            raise ValueError(
                f"received beam 'calibrated' with foundation {self.foundation!r}, foundation_angle "
                f"{self.foundation_angle!r}; allowed: 'sainsot' with 'auto' or 'rack', which its factor belongs to"
            )
        if self.coupling == "body" and self.foundation == "none":
            raise ValueError(
                "received coupling 'body' with foundation 'none'; allowed: 'sainsot', the teeth's own body"
            )
        force = self.hertz_force_n
        if self.hertz == "linear" and force is not None:
            raise ValueError(f"received hertz_force_n {force!r} with hertz 'linear'; allowed: None")
        if self.hertz != "linear" and (force is None or not (isfinite(force) and force > 0.0)):
            raise ValueError(f"received hertz_force_n {force!r} with hertz {self.hertz!r}; allowed: above 0 N")
