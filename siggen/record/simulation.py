"""The one composition of plan, damage, stiffness, dynamics and sensing: planned records become records."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from siggen.columns.labels import OIL_TEMPERATURE
from siggen.columns.record import RecordFailure, SimulatedRecord, label_columns
from siggen.errors import SolverFailure
from siggen.gearbox.plan import PlannedRecord
from siggen.gearbox.specimen import OperatingPoint, Specimen
from siggen.motion.motion import Motion, both_settled_s
from siggen.motion.response import (
    Piece,
    Response,
    ResponsePieces,
    ResponseStream,
    SampleGrid,
    Wanted,
    collected_response,
    response_stream,
)
from siggen.record.channels import measured_channels
from siggen.record.drive import RecordDrive, record_drive, variation_labels
from siggen.record.instrument import Instrument, history_s
from siggen.record.labels import operating_labels, planetary_labels, stage_operating_labels
from siggen.record.quantities import StreamedInternals
from siggen.record.quantity_names import acceleration_name
from siggen.record.specimen_state import RecordedMachine, SpecimenState, machines, refused_as, specimen_state
from siggen.record.stage_times import stage
from siggen.record.step_choice import stepped_motion
from siggen.record.structure import structure
from siggen.sensing.filters import AHEAD
from siggen.sensing.inputs import FORCE, SHAFT


def record_response(
    specimen: Specimen,
    state: SpecimenState,
    record: PlannedRecord,
    *,
    internals: bool = False,
) -> tuple[Response, OperatingPoint]:
    """Return the clean response of one record, with the accelerations of all motions, and its operating point.

    Raises
    ------
    SolverFailure
        If the integration did not stay finite and bounded, or a drawn number is beyond the model's limits.
    """
    with refused_as("outside_model"):
        specimen, state = at_point(specimen, state, record)
        driven = state_drive(specimen, state, record)
        stream, _ = _stream(specimen, state, record, driven, internals=internals)
        with stage("loop"):
            response = collected_response(stream)
    if response.status != "ok":
        raise SolverFailure(response.status, response.reason)
    return response, specimen.points[record.operating_point_id]


def at_point(specimen: Specimen, state: SpecimenState, record: PlannedRecord) -> tuple[Specimen, SpecimenState]:
    """Return a specimen and its state at the point of a record; the structure of bearings of one stiffness stays."""
    found = specimen.under(specimen.points[record.operating_point_id])
    if found.bearing_point is None:
        return found, state
    return found, replace(state, mesh=state.mesh.on(structure(found)))


def state_drive(specimen: Specimen, state: SpecimenState, record: PlannedRecord) -> RecordDrive:
    """Return how a record is driven in a state, whose damage pushes too.

    Raises
    ------
    ValueError
        As `record_drive`.
    """
    return record_drive(specimen, state.mesh.structure, record, state.parts, state.parts_behind)


def _stream(
    specimen: Specimen,
    state: SpecimenState,
    record: PlannedRecord,
    driven: RecordDrive,
    *,
    internals: bool = False,
    motions: Collection[str] | None = None,
) -> tuple[ResponseStream, dict[str, object]]:
    """Return the response of one record before it is stepped, and labels of how it is stepped."""
    point, sampling = specimen.points[record.operating_point_id], specimen.sampling
    with stage("loop"):
        grid, motion, error, error_of = stepped_motion(sampling, specimen.law, state.mesh, point, driven)
        stream = response_stream(
            motion,
            driven.rotation,
            SampleGrid(sampling.fs_hz, sampling.samples, grid.per_sample),
            wanted=Wanted(
                internals,
                internals or specimen.passes_forces or specimen.reads(FORCE),
                motions,
                specimen.reads(SHAFT),
            ),
            excitation=driven.excitation,
            settle_s=_settle_s(specimen, motion),
            history_s=history_s(specimen),
            ahead=AHEAD,
        )
    return stream, {} if error is None else {"integration_error": error, "integration_error_of": error_of}


def _settle_s(specimen: Specimen, motion: Motion) -> float:
    """Return the least time before the record, in which motion and filters forget the start."""
    return both_settled_s(motion.transient_s, history_s(specimen))


def simulated(
    specimen: Specimen,
    instrument: Instrument,
    state: SpecimenState,
    planned: PlannedRecord,
    others: Sequence[RecordedMachine] = (),
) -> Iterator[SimulatedRecord]:
    """Yield one record of a specimen in a state, and its renewals: what `others`, its sensors anew, made of its motion.

    Raises
    ------
    SolverFailure
        As `record_response`.
    """
    with_internals = specimen.stored is not None
    with refused_as("outside_model"), stage("inputs"):
        specimen, state = at_point(specimen, state, planned)
        driven = state_drive(specimen, state, planned)
    measuring = instrument, *(other.instrument for other in others)
    seen = {motion for one in measuring for channel in one.channels for motion in channel.motions}
    if with_internals:
        seen |= {motion for motion in state.mesh.structure.motions if specimen.stores(acceleration_name(motion))}
    with refused_as("outside_model"):
        stream, stepped = _stream(specimen, state, planned, driven, internals=with_internals, motions=seen)
    response: _RefusedPieces | StreamedInternals = _RefusedPieces(stream)
    if with_internals:
        response = StreamedInternals(specimen, stream, response)
    kept = _KeptPieces(response) if others else response
    with stage("sensing"):
        channels, channel_labels = measured_channels(specimen, planned, driven.rotation, kept, instrument)
    sampling, point = specimen.sampling, specimen.points[planned.operating_point_id]
    ends_rad = driven.rotation.angle_rad(np.array([0, sampling.samples - 1]) / sampling.fs_hz)
    with refused_as("outside_model"):
        operating = operating_labels(state.pair, point, ends_rad, sampling, state.static)
    of_motion = {
        **state.labels,
        **operating,
        **stage_operating_labels(specimen, operating, [one.static for one in state.behind]),
        **({OIL_TEMPERATURE.name: specimen.law.friction.oil_temperature_c} if specimen.oiled else {}),
        **stepped,
        **variation_labels(sampling, driven),
        "start_angle_rad": float(ends_rad[0]),
        "contact_loss_share": response.contact_loss_share,
        "status": "ok",
    }
    internals = None
    if isinstance(response, StreamedInternals):
        internals = response.quantities()
    tacho_s = driven.rotation.tacho_s(sampling.samples / sampling.fs_hz)
    labels = planetary_labels(specimen, {**of_motion, **channel_labels}, state.at_rest)
    yield SimulatedRecord(planned, labels, channels, tacho_s, internals)
    for number, other in enumerate(others, start=1):
        renewal = replace(planned, renewal=number)
        measured = replace(specimen, channels=other.specimen.channels)
        with stage("sensing"):
            channels, channel_labels = measured_channels(measured, renewal, driven.rotation, kept, other.instrument)
        labels = planetary_labels(specimen, {**of_motion, **channel_labels}, state.at_rest)
        yield SimulatedRecord(renewal, labels, channels, tacho_s, internals)


class _RefusedPieces:
    """A stream that is stepped while its pieces are taken; what the model refuses becomes a status of the record."""

    def __init__(self, stream: ResponseStream) -> None:
        self._stream = stream
        self.motions, self.places, self.before = stream.motions, stream.places, stream.before
        self.readings = stream.readings

    @property
    def contact_loss_share(self) -> float:
        return self._stream.contact_loss_share

    def pieces(self) -> Iterator[Piece]:
        pieces = self._stream.pieces()
        while True:
            with refused_as("outside_model"), stage("loop"):
                piece = next(pieces, None)
            if piece is None:
                return
            yield piece


class _KeptPieces:
    """Pieces that are kept when they were taken, and then given as often as asked for."""

    def __init__(self, response: ResponsePieces) -> None:
        self._response = response
        self._kept: list[Piece] = []
        self.motions, self.places, self.before = response.motions, response.places, response.before
        self.readings = response.readings

    def pieces(self) -> Iterator[Piece]:
        if not self._kept:
            for piece in self._response.pieces():
                self._kept.append(piece)
                yield piece
            return
        yield from self._kept


def simulate_specimen(
    gearbox: Specimen, records: Sequence[PlannedRecord], renewals: int = 0
) -> Iterator[SimulatedRecord | RecordFailure]:
    """Yield records of one gearbox in their order, simulated or failed; stiffness tables are built once per state.

    Each is followed by so many renewals of it, or failures.
    """
    machine_of, columns = machines(gearbox), label_columns(gearbox)
    named = {column.label: column.name for column in columns if column.label}
    state_of = lru_cache(maxsize=1)(lambda state_id: _staged_state(machine_of(state_id), state_id))
    loaded = lru_cache(maxsize=2)(lambda state_id, point_id: machine_of(state_id).at_point(point_id))
    other = lru_cache(maxsize=2)(
        lambda state_id, point_id: [loaded(state_id, point_id).renewed(i + 1) for i in range(renewals)]
    )
    for record in records:
        given = 0
        try:
            drawn = gearbox.states[record.state_id]
            place = None if drawn.changed is None else record.state_id, record.operating_point_id
            machine, state = loaded(*place), state_of(record.state_id)
            for made in simulated(machine.specimen, machine.instrument, state, record, other(*place)):
                labels = {**made.labels, **machine.labels, **{one.name: value for one, value in drawn.labels.items()}}
                labels |= {"faulty_gear": gearbox.names.gear(str(labels["faulty_gear"]))}
                given += 1
                yield replace(made, labels={named.get(label, label): value for label, value in labels.items()})
        except SolverFailure as failure:
            yield from [RecordFailure(record.record_id, failure.status, failure.reason)] * (1 + renewals - given)


def _staged_state(machine: RecordedMachine, state_id: int) -> SpecimenState:
    with stage("tables"):
        return specimen_state(machine.specimen, state_id, (machine.teeth, machine.structure))
