"""Refuses views that know pairs on two shafts, with or without further stages, and no carrier."""

from __future__ import annotations

from siggen.config import Config
from siggen.errors import UsageError


def refuse_planetary(config: Config, what: str) -> None:
    """Refuse `what`, which cannot be made of a planetary set.

    Raises
    ------
    UsageError
        For a set with a section `planetary`.
    """
    if config.planetary is not None:
        raise UsageError(
            f"planetary: received a section; allowed: null for {what}, which knows no carrier. `siggen simulate` "
            "writes the forces of all meshes of a record"
        )
