"""Fits the coefficients of a notch's edge to finite elements again; about two minutes."""

from __future__ import annotations

from tests.reference.contact.notch_fit import fitted

if __name__ == "__main__":
    for name, value in fitted().items():
        print(f"{name} = {value:.3f}")
