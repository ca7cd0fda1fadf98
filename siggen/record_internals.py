"""One record with what no sensor sees: clean accelerations, bearing forces, mesh force and stiffness."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

from siggen.config import Config, constant
from siggen.dataset.plan import planned_record
from siggen.dataset.specimen import Specimen, draw_specimen
from siggen.sensor_channels import measured_channels
from siggen.simulation import record_response, specimen_state


def internals_table(config: Config, record_id: int) -> pa.Table:
    """Return one row per sample: time, angle, what the sensors stored, and what they cannot see.

    Parameters
    ----------
    config : Config
    record_id : int

    Raises
    ------
    SolverFailure
        If the record cannot be simulated; says why.
    """
    record = planned_record(config, record_id)
    specimen = draw_specimen(config, record.specimen_id)
    state = specimen_state(config, specimen, record.state_id)
    response, point = record_response(config, specimen, state, record, internals=True)
    stored, _ = measured_channels(config, specimen, record, response)
    columns: dict[str, np.ndarray] = {
        "time_s": np.arange(config.samples) / config.fs_hz,
        "angle_rad": response.angle_rad,
        **{f"accel_{channel}_m_s2": signal for channel, signal in stored.items()},
        **{f"clean_accel_{_flat(place)}_m_s2": a for place, a in response.acceleration_m_s2.items()},
        **{f"bearing_force_{_flat(place)}_n": f for place, f in response.bearing_force_n.items()},
        **response.internals,
        "transmission_error_m": _transmission_error(response.internals["approach_m"], specimen),
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


def _transmission_error(approach_m: np.ndarray, specimen: Specimen) -> np.ndarray:
    """Return the dynamic transmission error on the line of action: the approach beyond the backlash that it closed.

    The linear mesh law counts the approach from the middle of the backlash, tooth pairs from the touching drive flank.
    """
    if specimen.dynamics.mesh.law == "pairs":
        return approach_m
    half_backlash_m = 0.5e-6 * constant(specimen.dynamics.backlash_um)
    return approach_m - np.sign(approach_m) * np.minimum(np.abs(approach_m), half_backlash_m)


def _flat(place: str) -> str:
    return place.replace("/", "_")
