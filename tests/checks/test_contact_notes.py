from __future__ import annotations

from siggen.checks.contact_notes import contact_notes
from siggen.checks.loading import load_config


def notes(*overrides: str) -> str:
    return "\n".join(contact_notes(load_config("tests/configs/casing.yaml", overrides)))


def test_roughness_beyond_the_fit_is_noted_for_the_lands_inside_damage() -> None:
    # 2 µm and 0.6 µm on a relative radius of 1.5 to 8 mm: up to 1.5e-3, fitted up to 1e-4.
    assert "lands inside damage: oil film: roughness over R_e" in notes()
    smooth = notes("dynamics.friction.pit_roughness_um=0.3", "dynamics.friction.roughness_um=0.05")
    assert "lands inside damage: oil film: roughness" in smooth


def test_a_set_without_oil_has_no_notes() -> None:
    assert notes("dynamics.friction.model=constant", "dynamics.mesh.damping=constant") == ""
