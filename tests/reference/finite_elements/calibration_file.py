"""Writes the fitted calibration as the Python module that siggen reads; the physics floor opens no files."""

from __future__ import annotations

from importlib.metadata import version
from pathlib import Path

import numpy as np

from tests.reference.finite_elements.calibration import (
    CALIBRATION_SIZE,
    CORRECTION_NODES,
    MAIN_NODES,
    evaluate,
    fit_corrections,
    fit_main,
    held_out_shapes,
    largest_error,
)

COMMAND = "python -m tests.reference.finite_elements calibrate"
TARGET = Path(__file__).resolve().parents[3] / "siggen" / "gears" / "stiffness" / "calibration_table.py"
HELD_OUT_GEARS = 20
HELD_OUT_PLACES = np.linspace(0.002, 0.998, 15)
NAMES = ("MAIN_COEFFICIENTS", "SHIFT_COEFFICIENTS", "SHIFT_SQUARED_COEFFICIENTS", "ANGLE_COEFFICIENTS")
HEADER = '''"""Coefficients of the finite-element calibration, made by `{command}`."""

from __future__ import annotations

import numpy as np

METADATA: dict[str, str | float | int] = {{
{metadata}
}}
"""How the coefficients were made; `held_out_error` is the largest deviation on gears that were not fitted."""

'''


def calibrate() -> dict[str, str | float | int]:
    """Run the whole calibration, write the table and return its metadata."""
    main = fit_main()
    corrections = fit_corrections(main)
    shapes = held_out_shapes(HELD_OUT_GEARS)
    errors = [
        largest_error(s, evaluate(main, corrections, s, HELD_OUT_PLACES), HELD_OUT_PLACES, CALIBRATION_SIZE)
        for s in shapes
    ]
    metadata = _metadata(max(errors))
    TARGET.write_text(_module(metadata, [main, *corrections]))
    return metadata


def _metadata(error: float) -> dict[str, str | float | int]:
    return {
        "command": COMMAND,
        "method": "quadratic triangles, one tooth on its ring, bore clamped, unit force along the line of action",
        "plane": "stress",
        "poisson_ratio": 0.3,
        "edge_length_modules": CALIBRATION_SIZE,
        "reference_model": "rack_trochoid beam, Sainsot foundation, rack root angle",
        "main_nodes": " x ".join(map(str, MAIN_NODES)),
        "correction_nodes": " x ".join(map(str, CORRECTION_NODES)),
        "scikit_fem": version("scikit-fem"),
        "gmsh": version("gmsh"),
        "numpy": version("numpy"),
        "held_out_gears": HELD_OUT_GEARS,
        "held_out_error": round(error, 5),
    }


def _module(metadata: dict[str, str | float | int], tables: list[np.ndarray]) -> str:
    lines = "\n".join(f'    "{k}": {_literal(v)},' for k, v in metadata.items())
    parts = [HEADER.format(command=COMMAND, metadata=lines)]
    for name, table in zip(NAMES, tables, strict=True):
        parts += [f"{name} = np.array(\n    [\n{_rows(table)}\n    ]\n)\n", f"{name}.setflags(write=False)\n"]
    return "".join(parts)


def _literal(value: str | float) -> str:
    return f'"{value}"' if isinstance(value, str) else repr(value)


def _rows(table: np.ndarray) -> str:
    blocks = []
    for block in table:
        rows = ",\n".join("            [" + ", ".join(f"{x:.6f}" for x in row) + "]" for row in block)
        blocks.append(f"        [\n{rows},\n        ],")
    return "\n".join(blocks)
