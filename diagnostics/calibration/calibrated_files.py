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

from diagnostics.calibration.calibration import Calibration, ChannelFit
from diagnostics.calibration.healthy_blocks import FEWEST_RECORDINGS
from diagnostics.calibration.noise_fit import NoiseFit
from diagnostics.calibration.own_lines import OwnLine
from diagnostics.calibration.path_draws import PathDraw
from diagnostics.calibration.source_library import sampled_as
from diagnostics.statistics.evaluation import Interval
from siggen.errors import UsageError
from siggen.file_writing import write_file
from siggen.plain_json import json_text

FACTS = "calibration.json"
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
            if table := _lines(channel):
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


def _lines(channel: ChannelFit) -> tuple[OwnLine, ...]:
    """Return all lines of a channel that no gear of the simulation makes."""
    return (*channel.own, *(one.line for one in channel.stage))


def calibrated_text(found: Calibration, out: Path) -> str:
    """Return the configuration's text."""
    low, high = found.random_rms
    point = found.operating_point
    lines = [
        f"# Made by `siggen-diagnostics calibrate` from {len(found.blocks.blocks)} healthy recordings. It differs from",
        "# the rig in what recordings tell; what they leave open is drawn per gearbox. Intervals and what was not",
        f"# identified: {data_folder(out).name}/{FACTS}. Data of your recordings are in it: keep it to yourself.",
        "",
        f"name: {_set_name(out)}",
        f"extends: {_beside(found.rig.file, out)}",
        *(f"{key}: {value!r}" for key, value in sampled_as(found.rig, point, found.blocks.fs_hz).items()),
        "operating_points:",
        f"  - speed_hz: {_number(point['speed_hz'])}    # of the recordings",
        f"    torque_nm: {_number(point['torque_nm'])}    # not seen in recordings: of the machine, or torque_nm of "
        f"the rig file",
        f"variation: {{speed: {{random_rms: {_range(0.7 * low, 1.4 * high)}}}}}",
        "background: null              # noise and lines are those of the recordings",
        "dynamics: {unbalance: {grade_mm_s: 0.0}}    # among the lines of the recordings",
        *_manufacture(found.rig.config),
        "sensors:",
        "  others: null",
    ]
    for channel, (name, axis) in zip(found.channels, sensor_axes(found), strict=True):
        lines += _sensor(channel, (name, axis), data_folder(out).name)
    return "\n".join(lines) + "\n"


def _manufacture(config: dict[str, Any]) -> Iterable[str]:
    """Yield the line that switches waves of the flanks off, where the rig has them."""
    if (config.get("manufacture") or {}).get("flank_waves") == "on":
        yield "manufacture: {flank_waves: 'off'}    # among the lines of the recordings"


def _sensor(channel: ChannelFit, called: tuple[str, str], folder: str) -> Iterable[str]:
    (name, axis), noise, sensor = called, channel.noise, channel.sensor
    yield f"  {name}:                # column or channel {channel.name}"
    yield "    place: casing"
    yield f"    axes: [{axis}]"
    yield f"    range_m_s2: {sensor.range_m_s2:.6g}"
    yield f"    bits: {'null' if sensor.bits is None else sensor.bits}"
    files = ", ".join(f"{folder}/{_path_file(name, number)}" for number in range(len(channel.paths)))
    yield f"    path: {{kind: measured, file: [{files}]}}"
    ratio = 10.0 ** (noise.spread_db / 20.0)
    level = noise.level_db
    yield f"    noise_spectrum:             # {level.value:.1f} dB re 1 (m/s2)2 in all, {_interval(level)}"
    yield f"      file: {folder}/noise_{name}.csv"
    yield f"      factor: {_range(1.0 / ratio, ratio, log=True)}"
    depths = dict(zip(DEPTHS, noise.depths, strict=True)) | {"level_std": noise.level_std}
    inner = ", ".join(f"{key}: {_depth(value)}" for key, value in depths.items())
    yield f"      modulation: {{{inner}}}"
    if table := _lines(channel):
        widest = max(line.spread for line in table)
        usual = float(np.median([line.spread for line in table]))
        stage = f", {len(channel.stage)} of the second stage" if channel.stage else ""
        yield f"    lines:                      # {len(channel.own)} beside the mesh{stage}"
        yield f"      file: {folder}/lines_{name}.csv"
        yield f"      factor: {_range(1.0 / usual, usual, log=True)}    # the widest differs by {widest:.2g}"


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
        "not_identified": list(not_identified(found)),
    }


def not_identified(found: Calibration) -> tuple[str, ...]:
    """Return what the recordings of a calibration do not tell, a sentence each."""
    left = found.rig.left_out
    others = (f"sensors that are no accelerometers: {', '.join(left)}; the new configuration has none",) if left else ()
    several = SEVERAL_MESHES if len(found.rig.drive.meshes) > 1 else ()
    stage = NO_STAGE if found.stage is None else WEAK_STAGE_LINES
    return (*ALWAYS_OPEN, *others, *several, stage if found.rig.shows_other_stages else NOT_SOUGHT)


def stage_sentence(found: Calibration) -> str:
    """Return what was found of a second stage."""
    drive = found.rig.drive
    if not found.rig.shows_other_stages:
        return f"Simulated: {', '.join(mesh.words for mesh in drive.meshes)}. Other stages were not looked for."
    if found.stage is None:
        return "No second stage was found."
    counts = ", ".join(f"{len(channel.stage)} lines on {channel.name}" for channel in found.channels)
    words = {shaft.name: shaft.words for shaft in drive.shafts}
    return (
        f"A second stage: {found.stage.teeth} teeth on {words[found.stage.shaft]}, order {found.stage.order:.4g} per "
        f"turn of {drive.shafts[0].words}; {counts}."
    )


NO_STAGE = (
    "a second stage: no comb of whole teeth on either shaft has two lines that stand out of what errors of the teeth "
    "make. A weaker one is not excluded; its lines count as errors of the teeth"
)
SEVERAL_MESHES = (
    "paths of the meshes apart: one path carries the lines of all, in a direction under which all of them fit",
    "noise that further shafts than the first two modulate: it is steady",
)
NOT_SOUGHT = "stages that the configuration does not list: not looked for, their lines count as errors of the teeth"
WEAK_STAGE_LINES = (
    "lines of the second stage at the gears' own mesh lines, two shaft orders beside them, or less than 6 dB above the "
    "errors of the teeth: they count as these errors"
)
ALWAYS_OPEN = (
    "path and source apart: only their product shows at a line. Paths are drawn: direction of the bearing forces, "
    "simulated gearboxes and recordings differ from path to path",
    "phase of the path: minimum phase is assumed",
    "level of the gears' errors: sidebands depend on it, but as much on relief, load and path; as wide as in the rig, "
    "give an accuracy class if you know it",
    "structure and tip relief: as wide as in the rig",
    "torque and its variation: as in the machine's configuration, or torque_nm of the rig file",
    "lines at multiples of a shaft's order above the fourth that stand out by less than 6 dB: they count as errors of "
    "the teeth, which are simulated",
    "correlation time of the noise's level: 1 to 8 ms",
    "range of the sensor: four times the largest value",
    "other gearboxes of this type: one assembly was measured",
)


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


def _range(low: float, high: float, log: bool = False) -> str:
    text = f"[{low:.4g}, {high:.4g}]"
    return f"{{log: {text}}}" if log else text
