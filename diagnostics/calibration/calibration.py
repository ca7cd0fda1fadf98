"""Calibration: what healthy recordings tell about the machine of a configuration, and what they leave open.

Order of fitting: speed and angle, floor and noise, lines, library of bearing forces at the recordings' speed, one path
per draw of what path and source share. Source: derived.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.calibration.drivetrain import TrainOrders
from diagnostics.calibration.healthy_blocks import FEWEST_RECORDINGS, HealthyBlocks, jackknife
from diagnostics.calibration.noise_fit import UNKNOWN_SPREAD_DB, NoiseFit, SensorFit, noise_fit, sensor_fit
from diagnostics.calibration.order_record import (
    HIGHEST_SHARE,
    LineGroup,
    OrderRecord,
    group_levels,
    line_groups,
    order_record,
)
from diagnostics.calibration.own_lines import OwnLine, own_lines
from diagnostics.calibration.path_draws import CEPSTRUM_POINTS, ChannelLines, PathDraw, drawn_path, unlike_db
from diagnostics.calibration.rig import CalibratedRig, check_meshes
from diagnostics.calibration.second_stage import SecondStage, StageLine, second_stage, stage_lines, wave_lines
from diagnostics.calibration.shaft_multiples import Multiples, machine_multiples
from diagnostics.calibration.source_library import SourceLibrary, source_library
from diagnostics.statistics.evaluation import Interval
from siggen.errors import UsageError

GRID_STEPS = 1024
LEAST_LINE_SHARE = 0.3
"""Of a group's energy above the floor; below, it is no line that has a level."""
FEWEST_GROUPS, SURE_SHARE = 2, 0.75
"""Mesh lines that a channel must show: four times the floor, which noise hardly ever reaches twice."""
SPEED_MARGIN = 0.01
SLOW_TURNS = 5
LARGEST_RANDOM_RMS = 0.05
TRIED_DIRECTIONS = 32
MOST_LINES = 400
"""Of a channel of a set."""


@dataclass(frozen=True, slots=True)
class ChannelFit:
    """One channel: levels [dB re 1 (m/s²)²] of its groups of lines, noise, own lines, recorder, possible paths.

    `stage` holds the lines of a second stage, none where none was found.
    """

    name: str
    levels: tuple[Interval, ...]
    lines: ChannelLines
    noise: NoiseFit
    own: tuple[OwnLine, ...]
    stage: tuple[StageLine, ...]
    sensor: SensorFit
    paths: tuple[PathDraw, ...]

    @property
    def lines_of_its_own(self) -> tuple[OwnLine, ...]:
        """All lines that no gear of the simulation makes."""
        return (*self.own, *(one.line for one in self.stage))


@dataclass(frozen=True, slots=True)
class Calibration:
    """All of it.

    Attributes
    ----------
    rig : Rig
    operating_point : dict
        Speed range of the recordings, torque of the rig.
    random_rms : (float, float)
        Slow variation of the speed, lowest and highest.
    grid_hz : (k,) float64
        Of the paths.
    channels : tuple of ChannelFit
    library : SourceLibrary
    blocks : HealthyBlocks
    stage : SecondStage or None
        A pair beside those of the rig on one of its shafts, where the recordings show it.
    """

    rig: CalibratedRig
    operating_point: dict[str, Any]
    random_rms: tuple[float, float]
    grid_hz: np.ndarray
    channels: tuple[ChannelFit, ...]
    library: SourceLibrary
    blocks: HealthyBlocks
    stage: SecondStage | None


def calibrated(
    rig: CalibratedRig,
    blocks: HealthyBlocks,
    torque_nm: tuple[float, float] | None,
    gearboxes: int,
    paths: int,
    seed: int,
    advance: Callable[[], None],
) -> Calibration:
    """Return the calibration of a rig to healthy recordings.

    Parameters
    ----------
    rig : Rig
    blocks : HealthyBlocks
    torque_nm : (float, float), optional
        Of the recordings; otherwise that of the rig.
    gearboxes, paths : int
        Sizes of the library and of the family of paths.
    seed : int
    advance : callable
        Told of every gearbox of the library.

    Raises
    ------
    UsageError
        If a recording shows no lines of a mesh.
    """
    drive = rig.drive
    point = {"speed_hz": _speeds(blocks), "torque_nm": _torque(rig.config, torque_nm)}
    records = {name: _records(name, blocks, drive) for name in blocks.channels}
    check_meshes(rig, records)
    multiples = machine_multiples(records, drive)
    stage = second_stage(multiples, drive) if rig.shows_other_stages else None
    foreign = {name: _foreign(name, multiples, stage, drive) for name in records}
    orders = tuple(dict.fromkeys(order for one in foreign.values() for order in one.orders))
    top = HIGHEST_SHARE * blocks.fs_hz / max(block.speed_hz for block in blocks.blocks)
    groups = line_groups(drive, top, orders)
    seen = {name: _seen(name, blocks, own, groups, foreign[name]) for name, own in records.items()}
    library = source_library(rig, point, blocks.fs_hz, groups, gearboxes, advance)
    draws = _Draws.of(len(blocks.blocks), library.energy_n2.shape[0], paths, seed)
    grid_hz = np.linspace(0.0, 0.5 * blocks.fs_hz, GRID_STEPS + 1)
    channels = tuple(
        _channel(one, number, blocks, library, draws, grid_hz, drive, line_groups(drive, top))
        for number, one in enumerate(seen.values())
    )
    return Calibration(rig, point, _random_rms(blocks), grid_hz, channels, library, blocks, stage)


def _records(name: str, blocks: HealthyBlocks, drive: TrainOrders) -> tuple[OrderRecord, ...]:
    return tuple(order_record(one.channels[name], one.fs_hz, one.pulses_s, drive) for one in blocks.blocks)


@dataclass(frozen=True, slots=True)
class _Foreign:
    """Lines of one channel at whole orders of a shaft that errors from tooth to tooth do not make."""

    stage: tuple[StageLine, ...]
    waves: tuple[OwnLine, ...]

    @property
    def orders(self) -> tuple[float, ...]:
        return tuple(line.order for line in (*(one.line for one in self.stage), *self.waves))


def _foreign(name: str, multiples: Multiples, stage: SecondStage | None, drive: TrainOrders) -> _Foreign:
    lines = stage_lines(stage, multiples[stage.shaft][name]) if stage and name in multiples[stage.shaft] else ()
    return _Foreign(lines, wave_lines(multiples, drive, name, tuple(one.line.order for one in lines)))


@dataclass(frozen=True, slots=True)
class _Draws:
    """Blocks and gearboxes of every path, (paths, n), and the generator's seed of the directions."""

    blocks: np.ndarray
    gearboxes: np.ndarray
    seed: int

    @staticmethod
    def of(blocks: int, gearboxes: int, paths: int, seed: int) -> _Draws:
        rng = generator(seed, Purpose.PATHS)
        of_blocks = rng.integers(blocks, size=(paths, blocks))
        return _Draws(of_blocks, rng.integers(gearboxes, size=(paths, 1)), seed)


@dataclass(frozen=True, slots=True)
class _Seen:
    """Spectra of one channel, one per block, its lines, and those that are not of the gears' errors."""

    name: str
    records: tuple[OrderRecord, ...]
    lines: ChannelLines
    foreign: _Foreign


def _seen(
    name: str,
    blocks: HealthyBlocks,
    records: tuple[OrderRecord, ...],
    groups: tuple[LineGroup, ...],
    foreign: _Foreign,
) -> _Seen:
    points_hz = np.linspace(0.0, 0.5 * blocks.fs_hz, CEPSTRUM_POINTS)
    hz, energy, floors, sure = [], [], [], []
    for record in records:
        level, share = group_levels(record, groups)
        hz.append([group.centre * record.speed_hz for group in groups])
        energy.append(10.0 * np.log10(np.maximum(level, 1e-30)))
        sure.append(int((share[[group.is_line for group in groups]] > SURE_SHARE).sum()))
        density = np.interp(points_hz, np.arange(record.floor.size) * record.bin_hz, record.floor / record.bin_hz)
        floors.append(10.0 * np.log10(np.maximum(density, 1e-30)))
    lines = ChannelLines(np.array(hz), np.array(energy), np.array(floors))
    _check_lines(name, blocks, sure)
    return _Seen(name, records, lines, foreign)


def _check_lines(name: str, blocks: HealthyBlocks, counts: list[int]) -> None:
    for block, count in zip(blocks.blocks, counts, strict=True):
        if count < FEWEST_GROUPS:
            raise UsageError(
                f"{block.name}: channel {name} shows {count} mesh lines above its floor; a path needs {FEWEST_GROUPS}. "
                "Are these the teeth of the machine, and is it loaded?"
            )


def _channel(
    seen: _Seen,
    number: int,
    blocks: HealthyBlocks,
    library: SourceLibrary,
    draws: _Draws,
    grid_hz: np.ndarray,
    drive: TrainOrders,
    groups: tuple[LineGroup, ...],
) -> ChannelFit:
    rng = generator(draws.seed, Purpose.PATHS, 1 + number)
    directions = _directions(seen.lines, library, draws, rng)
    gains = path_gains(len(draws.blocks), len(blocks.blocks), rng)
    paths = tuple(
        PathDraw(gain * drawn_path(seen.lines, library.level_db(w, chosen), picked, grid_hz, blocks.fs_hz), w)
        for gain, w, chosen, picked in zip(gains, directions, draws.gearboxes, draws.blocks, strict=True)
    )
    return ChannelFit(
        seen.name,
        _levels(seen.records, groups),
        seen.lines,
        noise_fit(seen.records, blocks.blocks, seen.name, drive.teeth),
        _strongest((*own_lines(seen.records, drive), *seen.foreign.waves), MOST_LINES - len(seen.foreign.stage)),
        seen.foreign.stage,
        sensor_fit(blocks.blocks, seen.name),
        paths,
    )


def _directions(lines: ChannelLines, library: SourceLibrary, draws: _Draws, rng: np.random.Generator) -> np.ndarray:
    """Return the direction of every path, (paths, forces), of unit length.

    One mesh fits any direction with a path of its own. Of several, lines lie side by side, so a few are drawn and the
    one that leaves least between them is taken.
    """
    tried = TRIED_DIRECTIONS if len({group.mesh for group in library.groups}) > 1 else 1
    drawn = rng.standard_normal((len(draws.blocks), tried, library.energy_n2.shape[-1]))
    drawn /= np.linalg.norm(drawn, axis=-1, keepdims=True)
    best = [
        np.argmin(unlike_db(lines, np.array([library.level_db(w, chosen) for w in directions]), picked))
        for directions, chosen, picked in zip(drawn, draws.gearboxes, draws.blocks, strict=True)
    ]
    return np.asarray(drawn[np.arange(len(best)), best])


def _strongest(lines: Iterable[OwnLine], most: int) -> tuple[OwnLine, ...]:
    return tuple(sorted(lines, key=lambda line: -line.amplitude)[:most])


def _levels(records: tuple[OrderRecord, ...], groups: tuple[LineGroup, ...]) -> tuple[Interval, ...]:
    """Return the level of every group with all of its lines, foreign ones too; NaN where it stands out not always."""
    levels = [group_levels(record, groups) for record in records]
    energy = np.array([10.0 * np.log10(np.maximum(level, 1e-30)) for level, _ in levels])
    visible = np.array([share > LEAST_LINE_SHARE for _, share in levels]).all(axis=0)
    return tuple(jackknife(column) for column in np.where(visible, energy, np.nan).T)


def path_gains(paths: int, recordings: int, rng: np.random.Generator) -> np.ndarray:
    """Return factors (paths,) on paths: too few recordings do not tell how their level differs from day to day."""
    if recordings >= FEWEST_RECORDINGS:
        return np.ones(paths)
    return np.asarray(10.0 ** (rng.uniform(-UNKNOWN_SPREAD_DB, UNKNOWN_SPREAD_DB, paths) / 20.0))


def _speeds(blocks: HealthyBlocks) -> list[float]:
    speeds = [block.speed_hz for block in blocks.blocks]
    return [min(speeds) * (1.0 - SPEED_MARGIN), max(speeds) * (1.0 + SPEED_MARGIN)]


def _torque(config: dict[str, Any], said: tuple[float, float] | None) -> Any:
    """Return the torque of the recordings as said, or the first of the rig."""
    if said is None:
        return config["operating_points"][0]["torque_nm"]
    return said[0] if said[0] == said[1] else list(said)


def _random_rms(blocks: HealthyBlocks) -> tuple[float, float]:
    """Return lowest and highest relative deviation of the speed from turn groups to turn groups."""
    deviations = []
    for block in blocks.blocks:
        turns = np.diff(block.pulses_s[::SLOW_TURNS])
        deviations.append(float(turns.std() / turns.mean()) if turns.size > 2 else 0.0)
    return min(max(min(deviations), 1e-6), LARGEST_RANDOM_RMS), min(max(*deviations, 1e-5), LARGEST_RANDOM_RMS)
