"""One record of bench, ready to be stepped through time in many ways."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from benchmarks.shipped import ROOT, shipped
from siggen.arrays import FloatArray
from siggen.config import Config, by_reference
from siggen.dynamics.drive.excitation import Excitation, Source
from siggen.dynamics.time.pair_motion import PairMotion
from siggen.dynamics.time.response import Response, SampleGrid, Wanted, response_of
from siggen.planning.plan import planned_record
from siggen.planning.specimen import OperatingPoint, Specimen, draw_operating_point, draw_specimen
from siggen.record.simulation import start_angle_rad
from siggen.record.specimen_state import SpecimenState, specimen_state
from siggen.specimen.drive import RecordDrive, record_drive
from siggen.specimen.motion import specimen_motion

STEPS, SIGNAL_S = 4, 0.06
"""Two revolutions of the pinion, so that every tooth is met."""


@dataclass(frozen=True, slots=True)
class RecordCase:
    """A record with everything that its motion needs."""

    config: Config
    specimen: Specimen
    state: SpecimenState
    point: OperatingPoint
    driven: RecordDrive
    state_id: int

    @property
    def name(self) -> str:
        """Name of the state."""
        return self.config.states[self.state_id].name

    def motion(
        self, integrator: str = "runge_kutta", steps: int = STEPS, more: tuple[Source, ...] = (), stride: int = 1
    ) -> PairMotion:
        """Return the motion; `more` acts besides what drives the record."""
        own = self.specimen.dynamics
        dynamics = by_reference(own) if integrator == "runge_kutta" else own
        found = specimen_motion(
            dynamics,
            self.state.mesh,
            self.point,
            1.0 / (self.config.fs_hz * steps),
            self.with_sources(more),
            stride=stride,
        )
        assert isinstance(found, PairMotion)
        return found

    def with_sources(self, more: tuple[Source, ...]) -> RecordDrive:
        """Return what drives the record with `more` besides."""
        if not more:
            return self.driven
        before = () if self.driven.excitation is None else self.driven.excitation.sources
        return replace(self.driven, excitation=Excitation((*before, *more)))

    def response(self, more: tuple[Source, ...] = ()) -> Response:
        """Return the delivered response to SIGNAL_S."""
        driven = self.with_sources(more)
        return response_of(
            self.motion(more=more), driven.rotation,
            SampleGrid(self.config.fs_hz, round(SIGNAL_S * self.config.fs_hz), STEPS),
            wanted=Wanted(bearing_forces=False), excitation=driven.excitation,
        )  # fmt: skip

    def course(self, motion: PairMotion, steps: int, first_s: float, last_s: float) -> tuple[FloatArray, ...]:
        """Return times, pinion angles in base pitches and inputs of the steps from one time to another."""
        count = round((last_s - first_s) * self.config.fs_hz * steps)
        times = first_s + np.arange(count + 1) / (self.config.fs_hz * steps)
        turned = self.driven.rotation.angle_rad(times) * motion.teeth / (2.0 * np.pi)
        pitches = turned + motion.structure.mesh.flanks.ahead_pitches
        excitation = self.driven.excitation
        inputs = np.empty((times.size, 0)) if excitation is None else excitation.inputs(times, self.driven.rotation)
        return times, pitches, inputs


def record_case(state: str, gearbox: int, *overrides: str) -> RecordCase:
    """Return the record of a gearbox of bench in a named state."""
    config = shipped(ROOT / "configs" / "bench.yaml", f"duration_s={SIGNAL_S}", *overrides)
    state_id = [one.name for one in config.states].index(state)
    records = range(gearbox * config.records_per_specimen, (gearbox + 1) * config.records_per_specimen)
    record = next(one for one in (planned_record(config, i) for i in records) if one.state_id == state_id)
    specimen = draw_specimen(config, gearbox)
    made = specimen_state(config, specimen, state_id)
    point = draw_operating_point(config, gearbox, record.operating_point_id)
    angle = start_angle_rad(config, specimen, record)
    driven = record_drive(config, specimen, made.mesh.structure, point, record, angle)
    return RecordCase(config, specimen, made, point, driven, state_id)
