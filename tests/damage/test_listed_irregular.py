"""Irregular spalls that are listed by their very edges (`states.NAME.damage.outlines`)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.damage.part import on_teeth
from siggen.errors import ConfigError
from siggen.mesh.sections import union_area_m2
from siggen.record.teeth import all_teeth
from tests.config.minimal import minimal

EDGES = [[4.0, 2.0, 2.0], [6.0, 1.5, 2.5], [9.0, 2.0, 2.0]]


def listed(**changes: Any) -> dict[str, Any]:
    """Return a configuration with one listed outline, heights as arcs."""
    one = {"tooth": 3, "edges_mm": EDGES, "depth_mm": 0.1, "edge_radius_mm": 0.05, **changes}
    damage = {"kind": "list", "outlines": [one]}
    return minimal(states={"healthy": {}, "slight": {"damage": damage}})


def test_its_area_is_that_of_the_edges_that_are_written() -> None:
    config = load_config(listed())
    pair = config.gearbox(0).pair
    damage = on_teeth(all_teeth(config.gearbox(0))[0].damage(1))
    assert [(one.gear, one.tooth, one.depth_m) for one in damage] == [("pinion", 3, 1e-4)]
    # edges are straight in height, given as arcs here: 1 % between stations of 2 and 3 mm
    assert union_area_m2(pair.pinion, damage, pair.face_width_m) == pytest.approx(2.5e-6, rel=0.01)
    assert config.config.states[1].fault == "spalling"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"edges_mm": EDGES[::-1]}, "outlines.0.edges_mm.1: received 6 mm; allowed: beyond 9 mm"),
        ({"edges_mm": [[4.0, 2.0, 1.0], *EDGES[1:]]}, "a lower edge at 2 mm above the upper one at 1 mm"),
        ({"edges_mm": np.add(EDGES, [0.0, 20.0, 20.0]).tolist()}, "outlines.0.edges_mm: received"),
        ({"depth_mm": 3.0}, "outlines.0.depth_mm: received"),
        ({"tooth": 18}, "outlines.0.tooth: received tooth 18"),
        ({"edge_radius_mm": 2.0}, "outlines.0.edge_radius_mm"),
    ],
)
def test_what_cannot_be_is_refused_by_its_key(changes: dict[str, Any], said: str) -> None:
    with pytest.raises(ConfigError) as error:
        load_config(listed(**changes))
    assert said in str(error.value)
