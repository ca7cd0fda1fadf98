"""What may reach a channel: motions of the model, bearing forces, forces of the background."""

from __future__ import annotations

from typing import NamedTuple

MOTION, FORCE, BACKGROUND, FLOOR = "motion", "force", "background", "floor"


class Input(NamedTuple):
    """What reaches channels: a motion of the model, a bearing force, a force or floor noise of the background."""

    kind: str
    name: str
