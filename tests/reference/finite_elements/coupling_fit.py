"""Fit of the coupling of neighbouring teeth to finite elements: sampling plan, fit, held-out gears, table file."""

from __future__ import annotations

from importlib.metadata import version
from itertools import product
from math import log
from pathlib import Path

import numpy as np
from numpy.polynomial import chebyshev

from siggen.gears.gear_pair import SpurGear
from siggen.mesh.body_coupling import TERMS, load_terms, ring_torsion
from siggen.mesh.calibration import RADIUS_RATIO_RANGE, TEETH_RANGE, unit_coordinates
from tests.reference.finite_elements.calibration import ToothShape, chebyshev_nodes
from tests.reference.finite_elements.neighbour_compliance import coupled_compliance

COMMAND = "python -m tests.reference.finite_elements couple"
TARGET = Path(__file__).resolve().parents[3] / "siggen" / "gears" / "stiffness" / "coupling_table.py"
NODES = (6, 6)
DEGREES = (3, 3)
APART = 2
PLACES = np.linspace(0.04, 0.97, 5)
"""On the flank from the start of the involute (0) to the tip (1), on every tooth: pairs of places are independent."""
FIT_SIZE = 0.05
"""Edge length in modules; 0.03 changes no compliance by more than 0.04 %."""


def place_rolls(gear: SpurGear, place: np.ndarray = PLACES) -> np.ndarray:
    """Roll angles (k,) [rad] of places on the flank."""
    start, tip = gear.involute_start_roll_rad, gear.tip_roll_rad
    return np.asarray(start + place * (tip - start))


def cross_samples(shape: ToothShape) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Load terms (k^2, TERMS), rest beyond the twist (APART, k^2) and the teeth's own compliance (k^2,), times E L."""
    gear = shape.gear()
    roll = place_rolls(gear)
    full = coupled_compliance(gear, np.stack([roll] * (APART + 1)), FIT_SIZE)
    lower, upper = (a.ravel() for a in np.meshgrid(roll, roll, indexing="ij"))
    rest = np.stack([full[0, :, apart].ravel() for apart in range(1, APART + 1)]) - ring_torsion(gear, 0.3)
    own = np.diag(full[0, :, 0])
    return load_terms(gear, lower, upper).T, rest, np.sqrt(np.multiply.outer(own, own)).ravel()


def _basis(shape: ToothShape) -> np.ndarray:
    u, v, _ = unit_coordinates(shape.teeth, shape.radius_ratio, np.zeros(1))
    return np.multiply.outer(chebyshev.chebvander(u, DEGREES[0])[0], chebyshev.chebvander(v, DEGREES[1])[0])


def fit_coupling() -> np.ndarray:
    """Coefficients (APART, TERMS, DEGREES + 1): least squares of the error relative to the teeth's own compliance."""
    teeth = 1 / chebyshev_nodes(1 / TEETH_RANGE[1], 1 / TEETH_RANGE[0], NODES[0])
    ratio = np.exp(chebyshev_nodes(log(RADIUS_RATIO_RANGE[0]), log(RADIUS_RATIO_RANGE[1]), NODES[1]))
    rows, rests = [], []
    for shape in (ToothShape(z, h) for z, h in product(teeth, ratio)):
        terms, rest, own = cross_samples(shape)
        basis = _basis(shape)
        rows.append((terms[:, :, None, None] * basis / own[:, None, None, None]).reshape(len(own), -1))
        rests.append(rest / own)
    found = np.linalg.lstsq(np.vstack(rows), np.hstack(rests).T, rcond=None)[0]
    return np.asarray(found.T.reshape(APART, TERMS, DEGREES[0] + 1, DEGREES[1] + 1))


def couple() -> dict[str, str | float]:
    """Run the fit, write the table and return its metadata (about two minutes)."""
    metadata = {
        "command": COMMAND,
        "method": "quadratic triangles, three teeth on a ring, bore clamped, unit forces along the line of action",
        "plane": "stress",
        "poisson_ratio": 0.3,
        "edge_length_modules": FIT_SIZE,
        "nodes": " x ".join(map(str, NODES)),
        "scikit_fem": version("scikit-fem"),
        "gmsh": version("gmsh"),
    }
    TARGET.write_text(_module(metadata, fit_coupling()))
    return metadata


def _module(metadata: dict[str, str | float], table: np.ndarray) -> str:
    lines = "\n".join(f"    {k!r}: {v!r},".replace("'", '"') for k, v in metadata.items())
    blocks = []
    for apart in table:
        entries = []
        for entry in apart:
            rows = "\n".join("                [" + ", ".join(f"{x:.6f}" for x in row) + "]," for row in entry)
            entries.append(f"            [\n{rows}\n            ],")
        blocks.append("        [\n" + "\n".join(entries) + "\n        ],")
    return f'''"""Coefficients of the coupling of neighbouring teeth, made by `{COMMAND}`."""

from __future__ import annotations

import numpy as np

METADATA: dict[str, str | float] = {{
{lines}
}}

COUPLING_COEFFICIENTS = np.array(
    [
{chr(10).join(blocks)}
    ]
)
"""(teeth apart - 1, entry of B, degree in 1/z, degree in ln h_f); entries in the order of `load_terms`."""
COUPLING_COEFFICIENTS.setflags(write=False)
'''
