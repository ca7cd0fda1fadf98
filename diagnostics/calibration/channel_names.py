"""Which column of a recording is which channel of the rig."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from diagnostics.recordings.file_channels import file_channels
from siggen.errors import UsageError


def rig_channels(
    config: Mapping[str, Any], source: tuple[Path, int | None], said: Mapping[str, str], tacho: str | None
) -> tuple[tuple[str, ...], dict[str, str]]:
    """Return the channels of a rig, and the column of each where it has another name.

    Parameters
    ----------
    config : mapping
        Resolved configuration.
    source : (Path, int or None)
        First recording.
    said : mapping
        Column by channel, as the user gave it.
    tacho : str, optional

    Raises
    ------
    UsageError
        If the recording has more or fewer channels than the rig.
    """
    names = tuple(f"{sensor['name']}_{axis}" for sensor in config["sensors"] for axis in sensor["axes"])
    if said:
        if set(said) != set(names):
            raise UsageError(f"--channel: received {', '.join(said)}; the rig has the channels {', '.join(names)}")
        return names, dict(said)
    found = file_channels(source[0], tacho, source[1])
    if set(names) <= set(found):
        return names, {}
    if len(found) != len(names):
        raise UsageError(
            f"{source[0]}: {len(found)} channels ({', '.join(found)}), the rig has {len(names)} ({', '.join(names)}); "
            "give --channel NAME=COLUMN for each, or a rig with as many sensors (siggen init --sensors)"
        )
    return names, dict(zip(names, found, strict=True))
