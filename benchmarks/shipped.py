"""The configurations that the benchmarks run: shipped ones and the quickest of the tests, some with values replaced."""

from __future__ import annotations

from pathlib import Path

from siggen.checks.loading import load_config
from siggen.gearbox.design import SetDesign

ROOT = Path(__file__).resolve().parents[1]
QUICKSTART = ROOT / "tests" / "configs" / "linear_pits.yaml"


def shipped(path: Path, *overrides: str) -> SetDesign:
    """Return a shipped configuration with overrides such as `specimens=12`."""
    return load_config(path, overrides)
