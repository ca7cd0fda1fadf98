"""What table and expansion in the tilt leave in the delivered acceleration: forces of records beside the solver's own.

Along the motion of a record, every pair that touches is solved at its place, its approach and its tilt. What the table
misses in force and in moment then acts on the same record as one more excitation: to first order the difference of the
delivered accelerations is the table's error.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.contact.record_case import SIGNAL_S, STEPS, RecordCase, record_case
from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.dynamics.drive.excitation import Turning
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.contact_spring import PairPlace, Spring, pair_spring
from siggen.dynamics.mesh.pair_columns import FLANK, PENETRATION, POSITION, ROW, TILT
from siggen.dynamics.mesh.pair_places import placed_contact, row_places
from siggen.gears.contact.force_curve import force_curve
from siggen.gears.contact.kind_row import KindRow, kind_row, pits_of_kind
from siggen.gears.contact.newton_matrix import solver_room
from siggen.gears.contact.table_columns import NO_ENERGY, TableSolver, row_faces, table_solver
from siggen.gears.contact.table_options import face_slices
from siggen.gears.stiffness.mesh_tables import TABLE_POINTS, pair_kinds
from siggen.specimen.contact import face_options, largest_force_n
from siggen.specimen.errors import specimen_errors

BEFORE_S = 0.01
"""Part of the time before the record that is reckoned with as well."""
SETTLE_S = 0.9
SHAFTS = {
    "parallel": ("dynamics.shafts=null",),
    "as shipped": (),
    "misaligned by 5 um, gears at 0.4 of thin shafts": (
        "manufacture.lead_misalignment_um=5",
        "dynamics.shafts={pinion: {bearing_span_mm: 100, gear_position: 0.4, diameter_mm: 25}, "
        "gear: {bearing_span_mm: 100, gear_position: 0.4, diameter_mm: 35}}",
    ),
}
STATES = ("healthy", "face_40", "face_80", "through_060", "through_100")


@dataclass(frozen=True, slots=True)
class DeliveredError:
    """Mean and largest tilt [rad], rms and largest error of the forces over their mean sum, of the accelerations."""

    shafts: str
    state: str
    gearbox: int
    tilt_mean_rad: float
    tilt_largest_rad: float
    force_rms: float
    force_largest: float
    acceleration: float


@dataclass(frozen=True, slots=True)
class Given:
    """Force and moment of the mesh that were missed, as an excitation: both with the signs of the equations."""

    time_s: FloatArray
    missed: FloatArray
    vectors: FloatArray

    def inputs(self, turning: Turning) -> FloatArray:
        """Return both at the times (k, 2), 0 outside."""
        return np.stack(
            [np.interp(turning.time_s, self.time_s, one, left=0.0, right=0.0) for one in self.missed.T], axis=1
        )


def delivered_errors(gearboxes: int = 2) -> Iterator[DeliveredError]:
    """Yield the errors of records with parallel and with tilting gears."""
    for shafts, overrides in SHAFTS.items():
        for gearbox in range(gearboxes):
            for state in STATES:
                yield replace(delivered_error(record_case(state, gearbox, *overrides), gearbox), shafts=shafts)


def delivered_error(case: RecordCase, gearbox: int) -> DeliveredError:
    """Return the errors of one record."""
    motion = case.motion()
    times, pitches, inputs = case.course(motion, STEPS, -SETTLE_S, SIGNAL_S)
    states = np.empty((times.size, 2 * len(motion.structure.coordinates)))
    states[0] = motion.start(pitches[0])
    motion.advance(pitches, inputs, states)
    seen = times >= -BEFORE_S
    pairs = motion.pairs(states[seen], pitches[seen], inputs[seen])[0]
    solver, rows = _solver(case, gearbox)
    missed, force = np.zeros((len(pairs), 2)), np.zeros(len(pairs))
    room = solver_room(solver.lead_m.size)
    for k, i in zip(*np.nonzero(pairs[:, :, FLANK] > 0.0), strict=True):
        read = _read(motion.law, pairs[k], i)
        face = row_faces(solver, rows[int(pairs[k, i, ROW])], np.array([_point(motion.law, pairs[k, i])]))[0]
        approach, tilt = pairs[k, i, PENETRATION], pairs[k, i, TILT]
        found = force_curve(face, np.array([approach]), tilt, np.zeros(solver.lead_m.size), room, NO_ENERGY)
        missed[k] += found.force_n[0] - read[0], found.moment_n_m[0] - read[1]
        force[k] += found.force_n[0]
    structure = motion.structure
    turn = np.zeros_like(structure.mesh.vector) if structure.mesh.tilt is None else structure.mesh.tilt
    given = Given(times[seen], missed, -np.stack([structure.mesh.vector, turn]))
    here, there = case.response(), case.response((given,))
    assert here.status == there.status == "ok", (here.reason, there.reason)
    errors = [
        float(np.sqrt(np.mean((there.acceleration_m_s2[name] - values) ** 2) / np.mean(values**2)))
        for name, values in here.acceleration_m_s2.items()
    ]
    tilts, scale = np.abs(pairs[:, 0, TILT]), force.mean()
    rms, largest = float(np.sqrt(np.mean(missed[:, 0] ** 2))) / scale, float(np.abs(missed[:, 0]).max()) / scale
    sizes = float(tilts.mean()), float(tilts.max()), rms, largest, float(np.median(errors))
    return DeliveredError("", case.name, gearbox, *sizes)


def _solver(case: RecordCase, gearbox: int) -> tuple[TableSolver, list[KindRow]]:
    """Return the solver with the record's lead, and all kinds of its pairs."""
    pair, damage, teeth = case.state.pair, case.state.damage, case.state.options
    options = face_options(case.specimen.dynamics, largest_force_n(case.config.operating_points, pair), pair)
    errors = specimen_errors(case.config, pair, gearbox, case.state_id)
    slices = face_slices(pair, options)
    lead = np.zeros(slices) if errors is None or errors.even else errors.lead_m(slices)
    healthy = kind_row(pair, teeth, options, TABLE_POINTS)
    rows = [
        healthy
        if kind == (-1, -1)
        else kind_row(pair, teeth, options, TABLE_POINTS, pits_of_kind(damage, kind), healthy)
        for kind in pair_kinds(pair, damage)
    ]
    return table_solver(pair, teeth, options, lead - lead.min()), rows


def _point(law: layout.PairLaw, pair: FloatArray) -> int:
    """Return the point of the fine grid that is nearest to a pair."""
    place = (pair[POSITION] - law.scalars[layout.START_M]) / law.scalars[layout.PITCH_M]
    last = int(law.places[layout.POINTS]) - 1
    return int(np.clip(round(place * law.scalars[layout.PER_PITCH]), 0, last))


def _read(law: layout.PairLaw, pairs: FloatArray, i: int) -> tuple[float, float]:
    """Return elastic force and moment of the table at that point."""
    found = _spring(law, int(pairs[i, ROW]), _point(law, pairs[i]), pairs[i, TILT], pairs[i, PENETRATION])
    return found.force, found.moment


@entry(error_model="numpy")
def _spring(law: layout.PairLaw, row: int, point: int, tilt: float, penetration_m: float) -> Spring:
    """Return the spring of a row of the tables at a point."""
    cell = min(point, law.places[layout.POINTS] - 2)
    _, touch_at, columns_at = row_places(law, row)
    touch, curves, share = placed_contact(law, touch_at, columns_at, cell, float(point - cell))
    return pair_spring(law, PairPlace(penetration_m, touch, curves, share, 0.0), tilt, penetration_m)
