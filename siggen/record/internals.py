"""What no sensor sees of one record as a table, and which of these quantities a set stores."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

from siggen.arrays import FloatArray
from siggen.columns.record import channel_metadata, channels
from siggen.gearbox.plan import PlannedRecord
from siggen.gearbox.specimen import OperatingPoint, Specimen
from siggen.motion.response import Response
from siggen.record.channels import measured_channels
from siggen.record.drive import record_rotation
from siggen.record.instrument import specimen_instrument
from siggen.record.quantities import internal_quantities
from siggen.record.simulation import record_response
from siggen.record.specimen_state import SpecimenState, specimen_state


def internals_table(gearbox: Specimen, record: PlannedRecord, *, internals: bool = True) -> pa.Table:
    """Return one row per sample: time, angle, what the sensors stored, and what they cannot see.

    Parameters
    ----------
    gearbox : Specimen
    record : PlannedRecord
    internals : bool
        Without, only what the sensors stored.

    Raises
    ------
    SolverFailure
        If the record cannot be simulated; says why.
    """
    specimen, _, response, point = _simulated(gearbox, record, internals=internals)
    rotation, sampling = record_rotation(specimen, record), specimen.sampling
    stored, _ = measured_channels(specimen, record, rotation, response, specimen_instrument(specimen))
    columns: dict[str, np.ndarray] = {
        "time_s": np.arange(sampling.samples) / sampling.fs_hz,
        "angle_rad": response.angle_rad,
        **{channel.column: stored[channel.name] for channel in channels(specimen)},
        **(internal_quantities(specimen, response) if internals else {}),
    }
    facts = {
        "record_id": str(record.record_id),
        "state": specimen.states[record.state_id].name,
        "speed_hz": repr(point.speed_hz),
        "torque_nm": repr(point.torque_nm),
        "fs_hz": repr(sampling.fs_hz),
    }
    own_facts = {channel.column: channel_metadata(channel, sampling.fs_hz) for channel in channels(specimen)}
    fields = [field.with_metadata(own_facts.get(field.name)) for field in pa.table(columns).schema]
    return pa.table(columns, pa.schema(fields, metadata=facts))


def record_internals(
    gearbox: Specimen, record: PlannedRecord
) -> tuple[SpecimenState, OperatingPoint, FloatArray, dict[str, FloatArray]]:
    """Return state, operating point, angle of the pinion (n,) [rad] and quantities, name -> (n,), of one record.

    Raises
    ------
    SolverFailure
        If the record cannot be simulated; says why.
    """
    specimen, state, response, point = _simulated(gearbox, record, internals=True)
    return state, point, response.angle_rad, internal_quantities(specimen, response)


def _simulated(
    gearbox: Specimen, record: PlannedRecord, *, internals: bool
) -> tuple[Specimen, SpecimenState, Response, OperatingPoint]:
    drawn = gearbox.in_state(record.state_id)
    specimen = drawn.under(drawn.points[record.operating_point_id])
    state = specimen_state(specimen, record.state_id)
    return specimen, state, *record_response(specimen, state, record, internals=internals)
