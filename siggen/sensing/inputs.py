"""What may reach a channel: motions of the model, bearing forces, readings of shafts, forces of the background."""

from __future__ import annotations

from typing import NamedTuple

MOTION, FORCE, SHAFT, BACKGROUND = "motion", "force", "shaft", "background"


class Input(NamedTuple):
    """A kind of what reaches channels, and which one."""

    kind: str
    name: str
