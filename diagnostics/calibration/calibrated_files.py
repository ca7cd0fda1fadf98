"""The files of a calibration: a short configuration that extends the rig, and a folder of data beside it."""

from __future__ import annotations

import csv
import shutil
from collections.abc import Iterable, Sequence
from dataclasses import astuple
from io import BytesIO, StringIO
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.calibration.calibration import Calibration
from diagnostics.calibration.healthy_blocks import FEWEST_RECORDINGS
from diagnostics.calibration.noise_fit import HEADROOM, NoiseFit
from diagnostics.calibration.path_draws import PathDraw
from diagnostics.calibration.source_library import sampled_as
from diagnostics.page.sentences import Sentences, filled, listed
from diagnostics.statistics.evaluation import Interval
from siggen.errors import UsageError
from siggen.file_writing import write_file
from siggen.plain_json import json_text

FACTS = "calibration.json"
TEMPLATES = Path(__file__).with_name("templates")
CALIBRATED = Sentences(TEMPLATES / "calibration.txt")
DEPTHS = "driver_depth", "driven_depth"
"""Keys of `noise_spectrum.modulation` for the first two shafts."""


def data_folder(out: Path) -> Path:
    """Return the folder beside the configuration."""
    return out.with_name(f"{out.stem}_data")


TOO_FEW = f"no interval: fewer than {FEWEST_RECORDINGS} recordings; ranges are wide instead"


def check_new(out: Path, inject: Path | None) -> None:
    """Refuse what would be overwritten: configuration, its folder of data, and the folder of injected recordings.

    Raises
    ------
    UsageError
        If one of them is there already; names it.
    """
    places = [(out, "--out a new name"), (data_folder(out), "--out a new name")]
    for path, how in [*places, *([(inject, "--inject a new folder")] if inject else [])]:
        if path.exists():
            raise UsageError(f"{path}: is there already; give {how}")


def write_calibration(found: Calibration, out: Path) -> Path:
    """Write configuration and data; return the configuration.

    Raises
    ------
    UsageError
        If either is there already.
    """
    check_new(out, None)
    folder = data_folder(out)
    try:
        sensors = sensor_axes(found)
        for channel, (name, axis) in zip(found.channels, sensors, strict=True):
            _write_table(folder / f"noise_{name}.csv", ("frequency_hz", "density"), _noise_rows(channel.noise))
            if table := channel.lines_of_its_own:
                rows = [(line.order, line.frequency_hz, line.amplitude) for line in table]
                _write_table(folder / f"lines_{name}.csv", ("order", "frequency_hz", "amplitude_m_s2"), rows)
            for number in range(len(channel.paths)):
                _write_path(folder / _path_file(name, number), found, axis, channel.paths[number])
        write_file(folder / FACTS, json_text(calibration_facts(found)))
        write_file(out, calibrated_text(found, out))
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)  # the same command may come again
        raise
    return out


def sensor_axes(found: Calibration) -> list[tuple[str, str]]:
    """Return name and axis of the sensor that stands for each channel; sensors of several axes become several."""
    axes = [(name, axis, len(one["axes"])) for name, one in found.rig.sensors.items() for axis in one["axes"]]
    return [(name if count == 1 else f"{name}_{axis}", axis) for name, axis, count in axes]


def calibrated_text(found: Calibration, out: Path) -> str:
    """Return the configuration's text."""
    return filled(
        TEMPLATES / "calibrated.yaml",
        recordings=len(found.blocks.blocks),
        folder=data_folder(out).name,
        name=_set_name(out),
        extends=_beside(found.rig.file, out),
        sampling=sampled_as(found.rig, found.operating_point, found.blocks.fs_hz),
        point=found.operating_point,
        random_rms=found.random_rms,
        has_waves=(found.rig.config.get("manufacture") or {}).get("flank_waves") == "on",
        sensors=[(channel, *called) for channel, called in zip(found.channels, sensor_axes(found), strict=True)],
        number=_number,
        range=_range,
        interval=_interval,
        depth=_depth,
        path_file=_path_file,
        median=np.median,
    )


def calibration_facts(found: Calibration) -> dict[str, Any]:
    """Return what was fitted, with intervals, and what was not identified."""
    groups = [group.name for group in found.library.groups]
    return {
        "rig": str(found.rig.file),
        "recordings": [block.name for block in found.blocks.blocks],
        "speed_hz": [block.speed_hz for block in found.blocks.blocks],
        "speed_random_rms": list(found.random_rms),
        "interval": TOO_FEW
        if len(found.blocks.blocks) < FEWEST_RECORDINGS
        else "90 %, from leaving recordings out (jackknife, Student's t)",
        "second_stage": None
        if found.stage is None
        else {"shaft": found.stage.shaft, "teeth": found.stage.teeth, "order": found.stage.order},
        "channels": {
            channel.name: {
                "line_level_db": {
                    name: astuple(level)
                    for name, level in zip(groups, channel.levels, strict=True)
                    if np.isfinite(level.value)
                },
                "noise_level_db": astuple(channel.noise.level_db),
                **dict(zip(DEPTHS, map(astuple, channel.noise.depths), strict=True)),
                "level_std": astuple(channel.noise.level_std),
                "lines_beside_the_mesh": len(channel.own),
                "second_stage_level_db": {one.name: astuple(one.level_db) for one in channel.stage},
                "step_m_s2": channel.sensor.step_m_s2,
            }
            for channel in found.channels
        },
        "gearboxes_simulated": int(found.library.energy_n2.shape[0]),
        "not_identified": not_identified(found),
    }


def not_identified(found: Calibration) -> list[str]:
    """Return what the recordings of a calibration do not tell, a sentence each."""
    return listed(TEMPLATES / "not_identified.txt", rig=found.rig, stage=found.stage, headroom=HEADROOM)


def _interval(value: Interval) -> str:
    return f"90 % [{value.low:.1f}, {value.high:.1f}]" if np.isfinite(value.low) else TOO_FEW


def _depth(value: Interval) -> str:
    """Return the range of a depth: its interval; where unknown, half to twice its value, up to 0.1 at least."""
    low = max(value.low, 0.0) if np.isfinite(value.low) else 0.5 * value.value
    high = min(value.high if np.isfinite(value.high) else max(2.0 * value.value, 0.1), 1.0)
    return _range(low, max(high, low + 1e-3))


def _noise_rows(noise: NoiseFit) -> Iterable[Sequence[float]]:
    return zip(noise.frequency_hz.tolist(), noise.density.tolist(), strict=True)


def _write_table(file: Path, head: Sequence[str], rows: Iterable[Sequence[float]]) -> None:
    lines = StringIO(newline="")
    writer = csv.writer(lines)
    writer.writerow(head)
    writer.writerows([f"{value:.7g}" for value in row] for row in rows)
    write_file(file, lines.getvalue())


def _path_file(sensor: str, number: int) -> str:
    return f"path_{sensor}_{number:02d}.npz"


def _write_path(file: Path, found: Calibration, axis: str, draw: PathDraw) -> None:
    columns = {"frequency_hz": found.grid_hz}
    for weight, force in zip(draw.direction, found.rig.forces_in_columns, strict=True):
        stem = f"{axis}_from_{force}"
        curve = weight * draw.accelerance
        columns |= {f"{stem}_real_m_s2_per_n": curve.real, f"{stem}_imag_m_s2_per_n": curve.imag}
    archive = BytesIO()
    np.savez(archive, allow_pickle=False, **columns)
    write_file(file, archive.getvalue())


def _beside(rig: Path, out: Path) -> str:
    """Return how the configuration names the rig: by its way from there, or a preset by its name."""
    if not rig.is_file():
        return str(rig)
    import os

    return Path(os.path.relpath(rig.resolve(), out.resolve().parent)).as_posix()


def _set_name(out: Path) -> str:
    kept = "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "_" for c in out.stem.lower())
    return kept.lstrip("_-") or "calibrated"


def _number(value: Any) -> str:
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key}: {_number(item)}' for key, item in value.items())}}}"
    return f"[{', '.join(map(_number, value))}]" if isinstance(value, (list, tuple)) else f"{value:.6g}"


def _range(low: float, high: float) -> str:
    return f"[{low:.4g}, {high:.4g}]"
