"""What no sensor sees of one record as a table, and which of these quantities a set stores."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

from siggen.arrays import FloatArray
from siggen.checks.quantity_names import available_quantities, quantity_problems
from siggen.columns.record import channel_metadata, channels
from siggen.config import Config
from siggen.dynamics.time.response import Response
from siggen.errors import ConfigError
from siggen.gearbox.configured import state_config
from siggen.gearbox.draw import draw_specimen
from siggen.gearbox.specimen import OperatingPoint, Specimen
from siggen.keys.column import Column
from siggen.planning.plan import PlannedRecord, planned_record
from siggen.record.channels import measured_channels
from siggen.record.quantities import internal_quantities, quantity_column
from siggen.record.simulation import record_response
from siggen.record.specimen_state import SpecimenState, specimen_state
from siggen.specimen.drive import record_rotation
from siggen.specimen.instrument import specimen_instrument


def internals_table(config: Config, record_id: int, *, internals: bool = True) -> pa.Table:
    """Return one row per sample: time, angle, what the sensors stored, and what they cannot see.

    Parameters
    ----------
    config : Config
    record_id : int
    internals : bool
        Without, only what the sensors stored.

    Raises
    ------
    SolverFailure
        If the record cannot be simulated; says why.
    """
    record = planned_record(config, record_id)
    own = state_config(config, record.specimen_id, record.state_id)
    specimen, _, response, point = _simulated(own, record, internals=internals)
    rotation = record_rotation(specimen, record)
    stored, _ = measured_channels(specimen, record, rotation, response, specimen_instrument(specimen))
    columns: dict[str, np.ndarray] = {
        "time_s": np.arange(config.samples) / config.fs_hz,
        "angle_rad": response.angle_rad,
        **{channel.column: stored[channel.name] for channel in channels(own)},
        **(internal_quantities(specimen, response) if internals else {}),
    }
    facts = {
        "record_id": str(record_id),
        "identity": config.identity,
        "state": config.states[record.state_id].name,
        "speed_hz": repr(point.speed_hz),
        "torque_nm": repr(point.torque_nm),
        "fs_hz": repr(config.fs_hz),
    }
    own_facts = {channel.column: channel_metadata(channel, own.fs_hz) for channel in channels(own)}
    fields = [field.with_metadata(own_facts.get(field.name)) for field in pa.table(columns).schema]
    return pa.table(columns, pa.schema(fields, metadata=facts))


def record_internals(
    config: Config, record: PlannedRecord
) -> tuple[SpecimenState, OperatingPoint, FloatArray, dict[str, FloatArray]]:
    """Return state, operating point, angle of the pinion (n,) [rad] and quantities, name -> (n,), of one record.

    Raises
    ------
    SolverFailure
        If the record cannot be simulated; says why.
    """
    own = state_config(config, record.specimen_id, record.state_id)
    specimen, state, response, point = _simulated(own, record, internals=True)
    return state, point, response.angle_rad, internal_quantities(specimen, response)


def _simulated(
    config: Config, record: PlannedRecord, *, internals: bool
) -> tuple[Specimen, SpecimenState, Response, OperatingPoint]:
    drawn = draw_specimen(config, record.specimen_id)
    specimen = drawn.under(drawn.points[record.operating_point_id])
    state = specimen_state(specimen, record.state_id)
    return specimen, state, *record_response(specimen, state, record, internals=internals)


def stored_quantities(config: Config) -> tuple[Column, ...]:
    """Return the columns of `internals/` that a configuration asks for; none without the section `internals`.

    Raises
    ------
    ConfigError
        If the section names quantities that the model does not have.
    """
    if config.internals is None:
        return ()
    problems = quantity_problems(config)
    if problems:
        raise ConfigError(problems)
    asked = available_quantities(config) if config.internals.stores_all else config.internals.quantities
    return tuple(quantity_column(name, config.names) for name in dict.fromkeys(asked))
