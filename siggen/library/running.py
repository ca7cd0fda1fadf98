"""Records of a gearbox: `run` for one of them, `runs` for many."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import floor

import numpy as np

from siggen.checks.loading import load_config
from siggen.columns.record import RecordFailure, SimulatedRecord
from siggen.config import Config
from siggen.config.consistency import SAMPLES_PER_PERIOD, SIDEBANDS, carried_mesh_harmonics
from siggen.config.planetary import pitches_per_turn
from siggen.config.stage_problems import most_teeth_per_turn
from siggen.config.stages import turned
from siggen.keys.number import constant
from siggen.library.arguments import finite, of_kind, one_of, refused, saying
from siggen.library.gearbox import Gearbox, Point
from siggen.library.record import LineOrders, Record
from siggen.record.simulation import simulate_specimen
from siggen.rig.rating import bearable_torque_nm

__all__ = ["Case", "run", "runs"]

MESH_HARMONICS = 10
"""That a record carries where no sampling rate is given."""
FASTEST_HZ, LONGEST_S = 1000.0, 86_400.0
KEYS = {
    "operating_points.0.speed_hz": "speed_hz", "operating_points.0.torque_nm": "torque_nm", "fs_hz": "fs_hz",
    "duration_s": "duration_s", "internals.quantities": "truth",
}  # fmt: skip
"""Key of a file -> argument that it comes from."""


@dataclass(frozen=True)
class Case:
    """State, point and repeat of one record; repeats differ in noise, start and varying speed."""

    state: str
    point: Point
    repeat: int = 0


def run(
    gearbox: Gearbox,
    state: str = "healthy",
    speed_hz: float | None = None,
    torque_nm: float | None = None,
    *,
    duration_s: float | None = None,
    fs_hz: float | None = None,
    repeat: int = 0,
    truth: Sequence[str] = (),
) -> Record:
    """Return what the sensors of a gearbox record.

    Parameters
    ----------
    gearbox : Gearbox
    state : str
        One of its states.
    speed_hz, torque_nm : float
        Of the first shaft [Hz, N m]. Of a gearbox that `draw` returned the first of its points where both are left out;
        its record then is that of the set, sample by sample.
    duration_s : float
        Length [s]; default 1, of a gearbox of a set that of the set.
    fs_hz : float
        Sampling rate [Hz]; default: the least of 25,600, 51,200 ... that carries ten mesh harmonics, or that of the
        set.
    repeat : int
        From 0: the same again with other noise, start and variation of speed.
    truth : sequence of str
        What no sensor sees, such as `mesh_force_n`; "all" for everything.

    Returns
    -------
    Record
        The same for the same arguments.

    Raises
    ------
    UsageError
        If an argument cannot be: names it, what came and what is allowed. Also where the record cannot be simulated.
    """
    of_kind("gearbox", gearbox, Gearbox, "what single_stage, machine, planetary and draw return")
    given = speed_hz is not None or torque_nm is not None
    point = _point(gearbox, speed_hz, torque_nm) if given or not gearbox.points else None
    config = _config_of(gearbox, point, duration_s, fs_hz, truth)
    return next(_records(gearbox, config, [(state, repeat)]))


def runs(
    gearbox: Gearbox, cases: Sequence[Case], *, duration_s: float | None = None, fs_hz: float | None = None
) -> Iterator[Record]:
    """Yield the records of cases in their order, each the same as `run` returns.

    Parameters as of `run`. Neighbours at one point share what their states do not change, so sort cases by point.

    Raises
    ------
    UsageError
        As `run`.
    """
    of_kind("gearbox", gearbox, Gearbox, "what single_stage, machine, planetary and draw return")
    for case in cases:
        of_kind("cases", case, Case, "objects of Case")
    for point, group in groupby(cases, key=lambda case: case.point):
        config = _config_of(gearbox, _point(gearbox, point.speed_hz, point.torque_nm), duration_s, fs_hz, ())
        yield from _records(gearbox, config, [(case.state, case.repeat) for case in group])


def _point(gearbox: Gearbox, speed_hz: float | None, torque_nm: float | None) -> Point:
    if speed_hz is None or torque_nm is None:
        missing, what = ("speed_hz", "Hz") if speed_hz is None else ("torque_nm", "N m")
        raise refused(missing, "nothing", f"a number in {what} of the first shaft; this gearbox has none of its own")
    speed = finite("speed_hz", speed_hz, f"above 0 up to {FASTEST_HZ:g}, turns of the first shaft per second",
                   1e-3, FASTEST_HZ)  # fmt: skip
    most = _bearable_nm(gearbox)
    allowed = f"-{most:.4g} to {most:.4g}, where flank or root reach the limits of ISO 6336-5 (1500 MPa, 860 MPa)"
    return Point(speed, finite("torque_nm", torque_nm, allowed, -most, most))


def _bearable_nm(gearbox: Gearbox) -> float:
    """Return the largest torque on the first shaft that all teeth bear."""
    specimen, turning = gearbox._specimen, 1.0
    shared = 1 if specimen.planetary is None else len(specimen.planetary.positions_deg)
    found = []
    for pair, behind in zip(gearbox._pairs, turned(specimen.gears, specimen.stages), strict=True):
        teeth = (pair.pinion.teeth, pair.gear.teeth)
        sizes = (constant(one) for one in (pair.module_mm, pair.face_width_mm, pair.pressure_angle_deg))
        found.append(bearable_torque_nm(teeth, *sizes) * turning * shared)
        turning = float(behind)
    return min(found)


def _config_of(
    gearbox: Gearbox, point: Point | None, duration_s: float | None, fs_hz: float | None, truth: Sequence[str]
) -> Config:
    """Return the configuration of a run, checked as every file is."""
    base = gearbox._config
    speed_hz = gearbox.points[0].speed_hz if point is None else point.speed_hz
    teeth = most_teeth_per_turn({name: getattr(base, name) for name in type(base).model_fields})
    highest_hz = speed_hz * base.variation.speed_ratios[1]
    rate = _rate_hz(gearbox, fs_hz, teeth, highest_hz)
    seconds = duration_s if duration_s is not None else base.duration_s if gearbox.points else 1.0
    finite("duration_s", seconds, f"above 0 up to {LONGEST_S:g} s", 1e-9, LONGEST_S)
    samples = floor(seconds * rate + 0.5)
    if samples < rate / speed_hz:
        raise refused("duration_s", f"{seconds:g} ({samples} samples at {rate:g} Hz)",
                      f"at least {1.0 / speed_hz:.4g} s, one turn of the first shaft")  # fmt: skip
    harmonics = min(carried_mesh_harmonics(rate, teeth, highest_hz), base.mesh_harmonics)
    changes: dict[str, object] = {"fs_hz": rate, "duration_s": samples / rate, "mesh_harmonics": harmonics}
    if point is not None:
        changes["operating_points"] = [{"speed_hz": point.speed_hz, "torque_nm": point.torque_nm}]
    if truth:
        if not isinstance(truth, Sequence):
            raise refused("truth", repr(truth), "names such as mesh_force_n, or all")
        changes["internals"] = {"quantities": [truth] if isinstance(truth, str) else list(truth)}
    with saying(KEYS):
        return gearbox._with_passed(load_config({**base.canonical(), **changes}))


def _rate_hz(gearbox: Gearbox, fs_hz: float | None, teeth: float, highest_hz: float) -> float:
    needed, most = (SAMPLES_PER_PERIOD * (n * teeth + SIDEBANDS) * highest_hz for n in (1, MESH_HARMONICS))
    if fs_hz is not None:
        return finite(
            "fs_hz", fs_hz, f"{needed:.0f} to 1e7 Hz, for the first mesh line with its sidebands", needed, 1e7
        )
    rate = 25_600.0
    if gearbox.points:
        rate, most = gearbox._config.fs_hz, needed
    while rate < most:
        rate *= 2.0
    return rate


def _records(gearbox: Gearbox, config: Config, wanted: Sequence[tuple[str, int]]) -> Iterator[Record]:
    """Yield the records of states and repeats at the first point of a configuration."""
    names, each = [one.name for one in gearbox.states], len(config.operating_points)
    ids, repeats = [], max((repeat for _, repeat in wanted), default=0) + 1
    for state, repeat in wanted:
        if not isinstance(repeat, int) or repeat < 0:
            raise refused("repeat", repr(repeat), "0, 1, 2 and so on")
        index = names.index(one_of("state", state, names))
        ids.append(((gearbox.number * config.state_count + index) * each) * repeats + repeat)
    many = config.model_copy(update={"repeats": repeats})
    with saying(KEYS):
        for record_id in ids:
            for found in simulate_specimen(many, [record_id]):
                if isinstance(found, RecordFailure):
                    raise refused("state", found.reason, "a record that can be simulated")
                yield _record(gearbox, config, found)


def _record(gearbox: Gearbox, config: Config, found: SimulatedRecord) -> Record:
    units = {name: sensor.quantity.shown_unit for sensor in config.sensors for name, _ in sensor.channels}
    channels = {name: np.asarray(values, dtype=np.float64) for name, values in found.channels.items()}
    truth = {name: np.asarray(values, dtype=np.float64) for name, values in (found.internals or {}).items()}
    speed_hz, torque_nm = (float(str(found.labels[name])) for name in ("speed_hz", "torque_nm"))
    return Record(str(found.labels["state"]), speed_hz, torque_nm, config.fs_hz, channels, units, dict(found.labels),
                  np.asarray(found.tacho_s, dtype=np.float64), truth, _lines(gearbox))  # fmt: skip


def _lines(gearbox: Gearbox) -> tuple[LineOrders, ...]:
    specimen, names = gearbox._specimen, gearbox._config.names
    sun, planet = specimen.gears.pinion.teeth, specimen.gears.gear.teeth
    if specimen.planetary is not None:
        ring = specimen.planetary.ring_teeth
        carrier = sun / (sun + ring)
        return (LineOrders("", pitches_per_turn(sun, ring), {"carrier": carrier, "planet": carrier * ring / planet}),)
    shafts = dict(names.shafts) or {"pinion": "pinion", "gear": "gear"}
    found, turning, front = [], 1.0, shafts["pinion"]
    meshes = ("", *(stage.name for stage in specimen.stages))
    for mesh, pair, behind in zip(meshes, gearbox._pairs, turned(specimen.gears, specimen.stages), strict=True):
        back = shafts.get(mesh or "gear", f"{mesh} gear")
        found.append(LineOrders(names.mesh(mesh), turning * pair.pinion.teeth, {front: turning, back: float(behind)}))
        turning, front = float(behind), back
    return tuple(found)
