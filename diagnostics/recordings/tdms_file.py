"""TDMS files of LabVIEW: scaled values of all channels of numbers; step and unit from the channels' properties."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from diagnostics.base.extras import require_packages
from diagnostics.recordings.recorded_columns import Columns
from diagnostics.recordings.stated_signals import StatedSignal, rate_from_increment, stated_columns
from siggen.errors import UsageError


def read_tdms(path: Path) -> Columns:
    """Read the channels of a TDMS file, called as there, with their group before them where names repeat.

    Raises
    ------
    UsageError
        If npTDMS is missing, or the last segment is incomplete.
    """
    require_packages(f"{path}: reading TDMS", "nptdms")
    from nptdms import TdmsFile

    file = TdmsFile.read(path)
    if file.file_status.incomplete_final_segment:
        raise UsageError(f"{path}: ends early: its last segment is incomplete. Copy the file again, or save it again.")
    signals = []
    for channel in (channel for group in file.groups() for channel in group.channels()):
        values = channel[:]
        if values.dtype.kind in "biuf" and values.size > 1:
            rate_hz = rate_from_increment(channel.properties.get("wf_increment"))
            unit = channel.properties.get("unit_string") or channel.properties.get("NI_UnitDescription")
            names = (channel.name, f"{channel.group_name}/{channel.name}")
            signals.append(StatedSignal(names, values.astype(np.float64), rate_hz, str(unit) if unit else None))
    return stated_columns(signals)
