"""The one composition of plan, damage, stiffness, dynamics and sensing: planned records become records."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from math import gcd, pi

from siggen.config import Config
from siggen.damage_table import damage_rows
from siggen.dataset.plan import PlannedRecord, planned_record
from siggen.dataset.record import Record, RecordFailure
from siggen.dataset.specimen import OperatingPoint, Specimen, draw_operating_point, draw_specimen
from siggen.dynamics.drive import Drive
from siggen.dynamics.response import Response, response_of
from siggen.errors import SolverFailure
from siggen.gears.damage import Damage
from siggen.gears.geometry import GearPair
from siggen.gears.stiffness import StiffnessOptions
from siggen.gears.tables import mesh_tables
from siggen.record_labels import damage_labels, operating_labels
from siggen.seeding import Stage, generator
from siggen.sensor_channels import measured_channels
from siggen.specimen_instrument import Instrument, history_s, needs_forces, settle_s, specimen_instrument
from siggen.specimen_motion import SpecimenMesh, specimen_motion, teeth_missing
from siggen.specimen_physics import gear_pair, stiffness_options
from siggen.specimen_structure import structure
from siggen.state_damage import state_damage

__all__ = ["damage_rows", "record_response", "simulate", "simulate_specimen", "specimen_state", "start_angle_rad"]


@dataclass(frozen=True, slots=True)
class SpecimenState:
    """Everything that all records of one specimen and state share; built once for them."""

    pair: GearPair
    options: StiffnessOptions
    damage: Damage
    mesh: SpecimenMesh
    labels: dict[str, object]


def specimen_state(config: Config, specimen: Specimen, state_id: int) -> SpecimenState:
    """Return gears, damage, tables and structure of one specimen in one state.

    Raises
    ------
    SolverFailure
        If what was drawn cannot be built (named in the reason).
    """
    pair, options = gear_pair(specimen.gears), stiffness_options(specimen.stiffness)
    with _limits_of("impossible_damage"):
        damage = state_damage(config, specimen.specimen_id, pair, state_id)
        tables = mesh_tables(pair, damage, options, points=specimen.stiffness.table_points)
        labels = damage_labels(config.states[state_id], pair, damage, options)
    with _limits_of("outside_model"):
        missing = teeth_missing(specimen.dynamics, pair, specimen.stiffness.table_points)
        assembled = structure(specimen.dynamics, pair, specimen.sensors)
    return SpecimenState(pair, options, damage, SpecimenMesh(pair, assembled, tables, missing), labels)


@contextmanager
def _limits_of(status: str) -> Iterator[None]:
    """Turn a refusal of what was drawn, which names the model's limit, into a status of the record."""
    try:
        yield
    except ValueError as error:
        raise SolverFailure(status, str(error)) from error


def start_angle_rad(config: Config, pair: GearPair, record: PlannedRecord) -> float:
    """Return the pinion angle at the first sample [rad], uniform over the hunting period of the two gears."""
    owner = (record.specimen_id, record.state_id, record.operating_point_id, record.repeat)
    revolutions = pair.gear.teeth // gcd(pair.pinion.teeth, pair.gear.teeth)
    return float(generator(config.seed, Stage.START, *owner).random() * 2 * pi * revolutions)


def record_response(
    config: Config, specimen: Specimen, state: SpecimenState, record: PlannedRecord, *, internals: bool = False
) -> tuple[Response, OperatingPoint]:
    """Return the clean response of one record and its operating point.

    Raises
    ------
    SolverFailure
        If the integration did not stay finite and bounded, or a drawn number is beyond the model's limits.
    """
    point = draw_operating_point(config, record.specimen_id, record.operating_point_id)
    steps = specimen.dynamics.steps_per_sample
    with _limits_of("outside_model"):
        response = response_of(
            specimen_motion(specimen.dynamics, state.mesh, point, 1.0 / (config.fs_hz * steps)),
            Drive(point.speed_hz, start_angle_rad(config, state.pair, record)),
            fs_hz=config.fs_hz,
            samples=config.samples,
            steps_per_sample=steps,
            internals=internals,
            bearing_forces=internals or needs_forces(config),
            settle_s=settle_s(config),
            history_s=history_s(config),
        )
    if response.status != "ok":
        raise SolverFailure(response.status, response.reason)
    return response, point


def _simulated(
    config: Config, specimen: Specimen, instrument: Instrument, state: SpecimenState, planned: PlannedRecord
) -> Record:
    response, point = record_response(config, specimen, state, planned)
    channels, channel_labels = measured_channels(config, specimen, planned, response, instrument)
    labels = {
        **state.labels,
        **operating_labels(state.pair, point, response),
        "start_angle_rad": float(response.angle_rad[0]),
        "contact_loss_share": response.contact_loss_share,
        "status": response.status,
        **channel_labels,
    }
    return Record(planned=planned, labels=labels, channels=channels, tacho_s=response.tacho_s)


def _results(config: Config, records: Sequence[PlannedRecord]) -> Iterator[Record | RecordFailure]:
    specimen = draw_specimen(config, records[0].specimen_id)
    instrument = specimen_instrument(config, specimen)
    state_of = lru_cache(maxsize=1)(lambda state_id: specimen_state(config, specimen, state_id))
    for record in records:
        try:
            yield _simulated(config, specimen, instrument, state_of(record.state_id), record)
        except SolverFailure as failure:
            yield RecordFailure(record.record_id, failure.status, failure.reason)


def simulate_specimen(config: Config, record_ids: Sequence[int]) -> list[Record | RecordFailure]:
    """Simulate records of one specimen; stiffness tables are built once per state.

    Parameters
    ----------
    config : Config
    record_ids : sequence of int, all of one specimen, ascending

    Returns
    -------
    list of Record or RecordFailure, in the order of `record_ids`

    Raises
    ------
    ValueError
        If the records belong to more than one specimen.
    """
    records = [planned_record(config, i) for i in record_ids]
    if len({r.specimen_id for r in records}) != 1:
        raise ValueError(
            f"records of one specimen expected, received specimens {sorted({r.specimen_id for r in records})}"
        )
    return list(_results(config, records))


def simulate(config: Config, record_ids: Sequence[int]) -> list[Record | RecordFailure]:
    """Simulate any records; a record is a pure function of (config, record_id), so order and grouping do not matter."""
    by_specimen: dict[int, list[int]] = {}
    for record_id in record_ids:
        by_specimen.setdefault(planned_record(config, record_id).specimen_id, []).append(record_id)
    done = {
        record_id: result
        for ids in by_specimen.values()
        for record_id, result in zip(ids, simulate_specimen(config, ids), strict=True)
    }
    return [done[i] for i in record_ids]
