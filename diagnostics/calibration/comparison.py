"""The page of a calibration from its files: recordings, gearboxes of the rig, gearboxes of the result."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from diagnostics.calibration.calibrated_files import data_folder
from diagnostics.calibration.calibration import Calibration
from diagnostics.calibration.calibration_page import write_calibration_page
from diagnostics.calibration.healthy_blocks import HealthyBlocks
from diagnostics.calibration.likeness import likeness, sample_of, simulated_blocks
from diagnostics.calibration.source_library import at_recordings


def calibration_page(
    found: Calibration,
    out: Path,
    held_out: HealthyBlocks | None,
    size: tuple[int, int],
    advance: Callable[[], None],
) -> Path:
    """Write the page and return it.

    Parameters
    ----------
    found : Calibration
    out : Path
        The calibrated configuration.
    held_out : HealthyBlocks, optional
        Recordings to judge by; those of the calibration without.
    size : (int, int)
        Gearboxes of each configuration, and the seed of the folds.
    advance : callable
        Told of every record.
    """
    names = found.blocks.channels
    read = found.blocks if held_out is None else held_out
    real = sample_of(read.blocks, found.teeth)
    before = simulated_blocks(at_recordings(found.rig, found.operating_point, read.fs_hz), names, size[0], advance)
    after = simulated_blocks(out, names, size[0], advance)
    compared = [likeness(real, sample_of(blocks, found.teeth), size[1]) for blocks in (before, after)]
    judged = 0 if held_out is None else len(held_out.blocks)
    return write_calibration_page(found, real, compared[0], compared[1], data_folder(out), judged)
