"""Records of a gearbox: `run` for one of them, `runs` for many."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from math import degrees, floor

import numpy as np

from siggen.checks.loading import load_config
from siggen.columns.record import RecordFailure, SimulatedRecord
from siggen.errors import SolverFailure
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import PlannedRecord
from siggen.gearbox.specimen import Specimen
from siggen.library.arguments import finite, of_kind, one_of, refused, saying
from siggen.library.gearbox import Case, Gearbox, Point
from siggen.library.record import LineOrders, Record
from siggen.record.simulation import simulate_specimen
from siggen.rig.rating import bearable_torque_nm

__all__ = ["run", "runs"]

MESH_HARMONICS = 10
"""That a record carries where no sampling rate is given."""
FASTEST_HZ, LONGEST_S, HALF = 1000.0, 86_400.0, 0.5
KEYS = {
    "operating_points.0.speed_hz": "speed_hz", "operating_points.0.torque_nm": "torque_nm", "fs_hz": "fs_hz",
    "duration_s": "duration_s", "internals.quantities": "truth",
}  # fmt: skip
"""Key of a file -> argument that it comes from."""


def run(
    gearbox: Gearbox,
    state: str = "healthy",
    speed_hz: float | None = None,
    torque_nm: float | None = None,
    *,
    duration_s: float | None = None,
    fs_hz: float | None = None,
    point: int = 0,
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
        Of the first shaft [Hz, N m]; of a gearbox that `draw` returned, those of its `point` where both are left out.
    duration_s : float
        Length [s]; default 1, of a gearbox of a set that of the set.
    fs_hz : float
        Sampling rate [Hz]; default: the least of 25,600, 51,200 ... that carries ten mesh harmonics, or that of the
        set.
    point, repeat : int
        From 0. Point: which of the gearbox's points, where speed and torque are left out. Repeat: the same again with
        other noise, start and variation of speed.
    truth : sequence of str
        What no sensor sees, such as `mesh_force_n`; "all" for everything.

    Returns
    -------
    Record
        The same for the same arguments. Of a gearbox that `draw` returned it is that of the set, sample by sample:
        `run(draw(config, specimen_id), state, point=operating_point_id, repeat=repeat)`, after the set's columns.

    Raises
    ------
    UsageError
        If an argument cannot be: names it, what came and what is allowed.
    SolverFailure
        If the record cannot be simulated.
    """
    of_kind("gearbox", gearbox, Gearbox, "what single_stage, machine, planetary and draw return")
    given = speed_hz is not None or torque_nm is not None
    at = Point(speed_hz, torque_nm) if given or not gearbox.points else point  # type: ignore[arg-type]
    at = _point(gearbox, at)
    return next(_records(gearbox, _design_of(gearbox, at, duration_s, fs_hz, truth), [Case(state, at, repeat)]))


def runs(
    gearbox: Gearbox, cases: Sequence[Case], *, duration_s: float | None = None, fs_hz: float | None = None
) -> Iterator[Record]:
    """Yield the records of cases, each as `run` returns it.

    Parameters as of `run`; `gearbox.cases` are those of its set. Neighbours at one speed and torque share what their
    states do not change, and all that are drawn points do.

    Raises
    ------
    UsageError, SolverFailure
        As `run`.
    """
    of_kind("gearbox", gearbox, Gearbox, "what single_stage, machine, planetary and draw return")
    for case in cases:
        of_kind("cases", case, Case, "objects of Case")
    placed = [replace(case, point=_point(gearbox, case.point)) for case in cases]
    for point, group in groupby(placed, key=lambda case: case.point if isinstance(case.point, Point) else 0):
        yield from _records(gearbox, _design_of(gearbox, point, duration_s, fs_hz, ()), list(group))


def _point(gearbox: Gearbox, point: Point | int) -> Point | int:
    """Return a point that the teeth bear, or the index of a drawn one."""
    if not isinstance(point, Point):
        last = len(gearbox.points) - 1
        allowed = f"an index of its points, 0 to {last}" if last >= 0 else "a Point; this gearbox has none of its own"
        return int(finite("point", of_kind("point", point, int, allowed), allowed, 0, last))
    speed_hz, torque_nm = point.speed_hz, point.torque_nm
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
    specimen = gearbox._specimen
    meshes, shared = specimen.meshes, 1
    if specimen.planets is not None:  # by the meshes of the sun
        meshes, shared = meshes[:1], len(specimen.planets.teeth.places)
    found = []
    for mesh, turning in zip(meshes, specimen.shaft_turns, strict=False):
        pair = mesh.pair
        sizes = 1e3 * pair.driver.module_m, 1e3 * pair.face_width_m, degrees(pair.driver.pressure_angle_rad)
        found.append(bearable_torque_nm((pair.pinion.teeth, pair.gear.teeth), *sizes) * float(turning) * shared)
    return min(found)


def _design_of(
    gearbox: Gearbox, point: Point | int, duration_s: float | None, fs_hz: float | None, truth: Sequence[str]
) -> SetDesign:
    """Return the design of a run, checked as every file is."""
    base = gearbox._design
    if isinstance(point, int) and duration_s is None and fs_hz is None and not truth:
        return gearbox._with_passed(base)
    speed_hz = (point if isinstance(point, Point) else max(gearbox.points, key=lambda one: one.speed_hz)).speed_hz
    rate = _rate_hz(gearbox, fs_hz, speed_hz)
    seconds = duration_s if duration_s is not None else base.duration_s if gearbox.points else 1.0
    finite("duration_s", seconds, f"above 0 up to {LONGEST_S:g} s", 1e-9, LONGEST_S)
    samples = floor(seconds * rate + 0.5)
    if samples < rate / speed_hz:
        raise refused("duration_s", f"{seconds:g} ({samples} samples at {rate:g} Hz)",
                      f"at least {1.0 / speed_hz:.4g} s, one turn of the first shaft")  # fmt: skip
    harmonics = base.carried_harmonics(rate, speed_hz)
    changes: dict[str, object] = {"fs_hz": rate, "duration_s": samples / rate, "mesh_harmonics": harmonics}
    if isinstance(point, Point):
        _refuse_stalling(gearbox._specimen, point.torque_nm or 0.0)
        changes["operating_points"] = [{"speed_hz": point.speed_hz, "torque_nm": point.torque_nm}]
    if truth:
        if not isinstance(truth, Sequence):
            raise refused("truth", repr(truth), "names such as mesh_force_n, or all")
        changes["internals"] = {"quantities": [truth] if isinstance(truth, str) else list(truth)}
    with saying(KEYS):
        return gearbox._with_passed(load_config({**base.canonical(), **changes}))


def _rate_hz(gearbox: Gearbox, fs_hz: float | None, speed_hz: float) -> float:
    needed, most = (gearbox._design.least_rate_hz(n, speed_hz) for n in (1, MESH_HARMONICS))
    if fs_hz is not None:
        return finite(
            "fs_hz", fs_hz, f"{needed:.0f} to 1e7 Hz, for the first mesh line with its sidebands", needed, 1e7
        )
    rate = 25_600.0
    if gearbox.points:
        rate, most = gearbox._design.fs_hz, needed
    while rate < most:
        rate *= 2.0
    return rate


def _records(gearbox: Gearbox, design: SetDesign, cases: Sequence[Case]) -> Iterator[Record]:
    """Yield the records of cases, all at points of a design."""
    names, allowed, planned = [one.name for one in gearbox.states], "0, 1, 2 and so on", []
    for case in cases:
        repeat = int(finite("repeat", of_kind("repeat", case.repeat, int, allowed), allowed, 0))
        state, place = one_of("state", case.state, names), case.point if isinstance(case.point, int) else 0
        planned.append(PlannedRecord(0, gearbox.number, names.index(state), place, repeat, ""))
    with saying(KEYS):
        drawn = replace(design.gearbox(gearbox.number), rated_nm=gearbox._specimen.rated_nm)
        for found in simulate_specimen(drawn, planned):
            if isinstance(found, RecordFailure):
                raise SolverFailure(found.status, found.reason)
            yield _record(gearbox, design, found)


def _refuse_stalling(gearbox: Specimen, torque_nm: float) -> None:
    """Refuse a torque at which a motor turns at less than half its speed."""
    for point in gearbox.points[:1]:
        slip = 0.0 if point.variation is None else point.variation.speed.slip * torque_nm / gearbox.rated_nm
        if slip >= HALF:
            received = f"{torque_nm:g}, a slip of {slip:.0%}"
            most = HALF / slip * torque_nm
            raise refused("torque_nm", received, f"below {most:.4g}, at which the motor slips by half its speed")


def _record(gearbox: Gearbox, design: SetDesign, found: SimulatedRecord) -> Record:
    units = {name: sensor.quantity.shown_unit for sensor in design.sensors for name, _ in sensor.channels}
    channels = {name: np.asarray(values, dtype=np.float64) for name, values in found.channels.items()}
    truth = {name: np.asarray(values, dtype=np.float64) for name, values in (found.internals or {}).items()}
    speed_hz, torque_nm = (float(str(found.labels[name])) for name in ("speed_hz", "torque_nm"))
    return Record(str(found.labels["state"]), speed_hz, torque_nm, design.fs_hz, channels, units, dict(found.labels),
                  np.asarray(found.tacho_s, dtype=np.float64), truth, _lines(gearbox))  # fmt: skip


def _lines(gearbox: Gearbox) -> tuple[LineOrders, ...]:
    specimen, names = gearbox._specimen, gearbox._design.names
    if specimen.planets is not None:
        teeth, carrier = specimen.planets.teeth, float(specimen.planets.teeth.carrier_turns)
        shafts = {"carrier": carrier, "planet": carrier * teeth.ring / teeth.planet}
        return (LineOrders("", teeth.pitches_per_turn, shafts),)
    found, orders = [], [float(turns) for turns in specimen.shaft_turns]
    for place, (mesh, one) in enumerate(zip(names.meshes, specimen.meshes, strict=True)):
        shafts = {names.shafts[end].word: orders[end] for end in (place, place + 1)}
        found.append(LineOrders(mesh.word, orders[place] * one.pair.pinion.teeth, shafts))
    return tuple(found)
