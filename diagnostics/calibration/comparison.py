"""The page of a calibration from its files: recordings, gearboxes of the rig, gearboxes of the result."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from diagnostics.calibration.calibrated_files import data_folder
from diagnostics.calibration.calibration import Calibration
from diagnostics.calibration.calibration_page import write_calibration_page
from diagnostics.calibration.healthy_blocks import Source, healthy_blocks
from diagnostics.calibration.likeness import likeness, sample_of, simulated_blocks
from diagnostics.calibration.source_library import at_recordings
from diagnostics.recordings.measured_recording import RecordingFacts


def calibration_page(
    found: Calibration,
    out: Path,
    held_out: Sequence[Source],
    facts: RecordingFacts,
    speed_range_hz: tuple[float, float] | None,
    size: tuple[int, int],
    advance: Callable[[], None],
) -> Path:
    """Write the page and return it.

    Parameters
    ----------
    found : Calibration
    out : Path
        The calibrated configuration.
    held_out : sequence of (Path, int or None)
        Recordings to judge by; those of the calibration if empty.
    facts, speed_range_hz : how they are read
    size : (int, int)
        Gearboxes of each configuration, and the seed of the folds.
    advance : callable
        Told of every record.
    """
    names = found.blocks.channels
    read = healthy_blocks(held_out, names, facts, found.teeth, speed_range_hz) if held_out else found.blocks
    real = sample_of(read.blocks, found.teeth)
    before = simulated_blocks(at_recordings(found.rig, found.operating_point, read.fs_hz), names, size[0], advance)
    after = simulated_blocks(out, names, size[0], advance)
    compared = [likeness(real, sample_of(blocks, found.teeth), size[1]) for blocks in (before, after)]
    return write_calibration_page(found, real, compared[0], compared[1], data_folder(out), len(held_out))
