"""Draws docs/figures/irregular_flanks.png, three severities on two gearboxes: `docs/scripts/irregular_spalls.py`.

What such spalls do to a record, by skew and share of the face: `detectability.py`.
"""

from __future__ import annotations

from pathlib import Path

import siggen
from siggen.config.yaml_source import read_yaml
from siggen.views.flank_figure import save_flank_figure
from siggen.views.flank_views import flank_views

GROWN = {"slight": (0.6, 0.25), "moderate": (1.0, 0.6), "severe": (1.6, 1.0)}
"""State of the picture: length along the profile [mm] and share of the face."""
FIGURE = Path("docs/figures/irregular_flanks.png")


def main() -> None:
    """Draw the flanks of two gearboxes in all states of `GROWN`."""
    grown = [
        {"name": name, "damage": {"kind": "irregular", "profile_length_mm": length, "face_share": share}}
        for name, (length, share) in GROWN.items()
    ]
    config = siggen.load_config({**read_yaml("configs/bench.yaml"), "states": [{"name": "healthy"}, *grown]})
    save_flank_figure([view for specimen in range(2) for view in flank_views(config, specimen)], FIGURE)


if __name__ == "__main__":
    main()
