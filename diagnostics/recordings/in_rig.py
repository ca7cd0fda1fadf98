"""How messages name a line of the rig file, and how to come by one."""

from __future__ import annotations


def in_rig(line: str) -> str:
    """Return a line of a rig file in words of a message; `--rig` writes a file that is not there."""
    return f"`{line}` in the rig file (--rig rig.yaml; one that is not there is written, half filled)"
