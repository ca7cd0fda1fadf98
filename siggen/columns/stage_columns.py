"""Columns of sets whose gearboxes have several meshes: teeth and frequencies of those behind the first one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.keys.column import HERTZ, Column, Role, in_role, list_of

if TYPE_CHECKING:
    from siggen.config import Config


def stage_columns(config: Config) -> tuple[Column, ...]:
    """Return the columns of the further meshes; none for gearboxes with one."""
    every = (column for stage in config.stages for column in _columns(stage.name))
    return in_role(Role.CONDITION, *every, section="stages")


def _columns(name: str) -> Iterator[Column]:
    for gear in ("pinion", "gear"):
        yield Column(
            f"faulty_teeth_{name}_{gear}",
            list_of(pa.int32()),
            "",
            f"indices of the damaged teeth of {name}.{gear}",
            Role.TARGET,
        )
    for gear in ("pinion", "gear"):
        yield Column(f"teeth_{name}_{gear}", pa.int32(), "", f"number of teeth of {name}.{gear}")
    yield Column(f"mesh_{name}_hz", pa.float64(), HERTZ, f"tooth mesh frequency of {name}")
    yield Column(f"{name}_shaft_hz", pa.float64(), HERTZ, f"rotation frequency of the shaft of {name}.gear")
