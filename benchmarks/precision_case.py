"""A record of a preset, ready to be integrated in many ways."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.shipped import QUICKSTART, shipped
from siggen.arrays import FloatArray
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import planned_record
from siggen.gearbox.specimen import OperatingPoint, Specimen
from siggen.motion.equations import no_inputs
from siggen.motion.motion import Motion
from siggen.motion.response import Response, SampleGrid, Wanted, response_of
from siggen.record.drive import RecordDrive, record_drive
from siggen.record.motion import specimen_motion
from siggen.record.specimen_state import SpecimenState, specimen_state
from siggen.record.step_choice import TimeGrid, exponential_grid, rule_grid

SIGNAL_S, LOOP_S = 0.3, 1.0


@dataclass(frozen=True, slots=True)
class Case:
    """A record, ready to be integrated in many ways."""

    config: SetDesign
    specimen: Specimen
    state: SpecimenState
    point: OperatingPoint
    driven: RecordDrive

    def motion(self, integrator: str, steps: int) -> Motion:
        """Return a motion with so many steps of integration per sample."""
        law, grid = (
            self.specimen.law.by_reference() if integrator == "runge_kutta" else self.specimen.law,
            state_grid(integrator, steps),
        )
        step_s = 1.0 / (self.config.fs_hz * grid.per_sample)
        return specimen_motion(law, self.state.mesh, self.point, step_s, self.driven, stride=grid.stride)

    @property
    def method(self) -> str:
        """The integrator of the configuration."""
        return self.specimen.law.method

    def own_steps(self) -> int:
        """Return the steps of integration per sample that the rule takes."""
        return rule_grid(self.config.fs_hz, self.specimen.law, self.state.mesh, self.point).steps

    def response(self, integrator: str, steps: int, settle_s: float = 0.0) -> Response:
        """Return the response to SIGNAL_S, behind the transient or what is discarded if that is longer."""
        return response_of(
            self.motion(integrator, steps), self.driven.rotation,
            SampleGrid(
                self.config.fs_hz, round(SIGNAL_S * self.config.fs_hz), state_grid(integrator, steps).per_sample
            ),
            wanted=Wanted(bearing_forces=False), excitation=self.driven.excitation, settle_s=settle_s,
        )  # fmt: skip

    def driven_steps(self, motion: Motion, per_sample: int, duration_s: float) -> tuple[FloatArray, FloatArray]:
        """Return the angles in base pitches and the inputs at so many steps per sample from sample 0 on."""
        rate_hz = self.config.fs_hz * per_sample
        times = np.arange(round(duration_s * rate_hz) + 1) / rate_hz
        turned = self.driven.rotation.angle_rad(times) * motion.teeth / (2.0 * np.pi)
        pitches = turned + motion.structure.mesh.flanks.ahead_pitches
        excitation = self.driven.excitation
        inputs = no_inputs(pitches) if excitation is None else excitation.inputs(times, self.driven.rotation)
        return pitches, inputs

    def loop_s(self, integrator: str, steps: int, rounds: int = 3) -> float:
        """Return the CPU time of the loop per second of signal, the median of some rounds."""
        motion = self.motion(integrator, steps)
        pitches, inputs = self.driven_steps(motion, state_grid(integrator, steps).per_sample, LOOP_S)
        path = np.empty((pitches.size, 2 * len(motion.structure.coordinates)))
        found = []
        for _ in range(rounds + 1):
            path[0] = motion.start(pitches[0])
            begin = time.process_time()
            motion.advance(pitches, inputs, path)
            found.append((time.process_time() - begin) / LOOP_S)
        return float(np.median(found[1:]))  # the first one compiles


def state_grid(integrator: str, steps: int) -> TimeGrid:
    """Return where states are with so many steps per sample."""
    return exponential_grid(steps) if integrator == "exponential" else TimeGrid(steps, 1)


def precision_case(preset: Path, gearbox: int, state: int, *, tilt: bool = True) -> Case:
    """Return a record of a preset of a state, negative from the last one on, ready to be integrated in many ways."""
    rigid = () if tilt else ("dynamics.shafts=null",)
    return _case(shipped(preset, f"duration_s={SIGNAL_S}", *rigid), gearbox, state)


def linear_case(gearbox: int, state: int) -> Case:
    """Return a record of linear_pits: eight coordinates, mesh stiffness times approach."""
    return _case(shipped(QUICKSTART, f"duration_s={SIGNAL_S}"), gearbox, state)


def _case(config: SetDesign, gearbox: int, state: int) -> Case:
    state_id = state % len(config.config.states)
    record = next(
        one
        for one in (
            planned_record(config, gearbox * config.records_per_specimen + i)
            for i in range(config.records_per_specimen)
        )
        if one.state_id == state_id
    )
    specimen = config.gearbox(gearbox)
    made = specimen_state(specimen, state_id)
    point = specimen.points[record.operating_point_id]
    driven = record_drive(specimen, made.mesh.structure, record)
    return Case(config, specimen, made, point, driven)
