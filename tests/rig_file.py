"""A rig file: how recordings of a machine are read, as a command takes it."""

from __future__ import annotations

from pathlib import Path

import yaml


def rig_file(folder: Path, **keys: object) -> tuple[str, str]:
    """Write a rig file with these keys into a folder and return the option that names it."""
    name = "-".join(("reading", *keys))
    file = folder / f"{name[:80]}.yaml"
    file.write_text(yaml.safe_dump(keys, sort_keys=False), encoding="utf-8")
    return "--rig", str(file)
