"""What may reach a channel: motions of the model, bearing forces, forces of the background."""

from __future__ import annotations

from typing import NamedTuple

MOTION, FORCE, BACKGROUND = "motion", "force", "background"


class Input(NamedTuple):
    """What reaches channels: a motion of the model, a bearing force, a force of the background."""

    kind: str
    name: str
