"""What no sensor sees of one record as a table, and which of these quantities a set stores."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

from siggen.config import Config, corners
from siggen.dataset.plan import planned_record
from siggen.dataset.record import Column
from siggen.dataset.specimen import draw_operating_point, draw_specimen
from siggen.errors import ConfigError, Problem
from siggen.gears.geometry import GearPair
from siggen.gears.tables import mesh_tables
from siggen.internal_quantities import internal_quantities, quantity_column, quantity_names
from siggen.sensor_channels import measured_channels
from siggen.simulation import record_response, specimen_state
from siggen.specimen_motion import SpecimenMesh, specimen_motion, teeth_missing
from siggen.specimen_physics import gear_pair, stiffness_options
from siggen.specimen_structure import structure


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
    specimen = draw_specimen(config, record.specimen_id)
    state = specimen_state(config, specimen, record.state_id)
    response, point = record_response(config, specimen, state, record, internals=internals)
    stored, _ = measured_channels(config, specimen, record, response)
    columns: dict[str, np.ndarray] = {
        "time_s": np.arange(config.samples) / config.fs_hz,
        "angle_rad": response.angle_rad,
        **{f"accel_{channel}_m_s2": signal for channel, signal in stored.items()},
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
    return pa.table(columns).replace_schema_metadata(facts)


def stored_quantities(config: Config) -> tuple[Column, ...]:
    """Return the columns of `internals/` that a configuration asks for; none without the section `internals`.

    They follow from the configuration alone: the gears of the ranges with the longest path of contact have as many
    pairs in reach as any.

    Raises
    ------
    ConfigError
        If the section names quantities that the model does not have.
    """
    if config.internals is None:
        return ()
    available = _available(config)
    asked = available if config.internals.stores_all else config.internals.quantities
    unknown = [name for name in asked if name not in available]
    if unknown:
        received, allowed = ", ".join(unknown), f"allowed with this model: [all], or any of {', '.join(available)}"
        raise ConfigError([Problem("internals.quantities", received, allowed)])
    return tuple(quantity_column(name) for name in dict.fromkeys(asked))


def _available(config: Config) -> tuple[str, ...]:
    specimen, point = draw_specimen(config, 0), draw_operating_point(config, 0, 0)
    pair = max((gear_pair(corner) for corner in corners(config.gears)), key=_contact_ratio)
    points = specimen.stiffness.table_points
    mesh = SpecimenMesh(
        pair,
        structure(specimen.dynamics, pair, specimen.sensors),
        mesh_tables(pair, (), stiffness_options(specimen.stiffness), points=points),
        teeth_missing(specimen.dynamics, pair, points),
    )
    step_s = 1.0 / (config.fs_hz * specimen.dynamics.steps_per_sample)
    motion = specimen_motion(specimen.dynamics, mesh, point, step_s)
    return quantity_names(motion.structure, motion.internal_names)


def _contact_ratio(pair: GearPair) -> float:
    return (pair.contact_end_m - pair.contact_start_m) / pair.base_pitch_m
