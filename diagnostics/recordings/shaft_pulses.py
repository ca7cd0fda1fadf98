"""Pulse times of the first shaft of a recording: from its tacho, or from the mesh lines of all channels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.recordings.in_rig import in_rig
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.records.gear_train import Planets, meshes_of
from diagnostics.signal.order_domain import geared_pulses
from diagnostics.signal.shaft_angle import ShaftAngle, shaft_angle
from siggen.columns.drivetrain import GearTrain
from siggen.errors import UsageError

FEWEST_REVOLUTIONS = 2


@dataclass(frozen=True, slots=True)
class ShaftPulses:
    """Pulse times (k,) [s] of the first shaft, and where they come from.

    `angle`: what the mesh lines gave; None with a tacho. Where they gave the speed only, there are no pulses. Of a
    planetary set pulses are those of the sun against its carrier, `turns` per turn of its shaft.
    """

    times_s: np.ndarray
    turns: float = 1.0
    angle: ShaftAngle | None = None

    @property
    def outcome(self) -> str:
        """What is known: `angle` or `speed only`."""
        return "angle" if self.angle is None else self.angle.outcome

    @property
    def agreement_pitches(self) -> float | None:
        """How far two halves of the mesh lines differ at most [pitches]; None with a tacho."""
        return None if self.angle is None else self.angle.halves.apart

    @property
    def pulses_hz(self) -> float:
        """Mean rate of the pulses."""
        if self.times_s.size < 2 and self.angle is not None:
            return self.angle.speed_hz
        return float((self.times_s.size - 1) / (self.times_s[-1] - self.times_s[0]))

    @property
    def speed_hz(self) -> float:
        """Mean speed of the first shaft."""
        return self.pulses_hz / self.turns

    @property
    def origin(self) -> str:
        """Where the pulses come from, in words."""
        return "tacho" if self.angle is None else self.angle.words

    @property
    def facts(self) -> dict[str, str | float | None]:
        """Outcome, agreement of the halves [pitches] and evidence [nats], for programs; None with a tacho."""
        nats = None if self.angle is None else self.angle.nats
        return {"angle": self.outcome, "halves_pitches": self.agreement_pitches, "evidence_nats": nats}


def shaft_pulses(
    recording: MeasuredRecording,
    train: GearTrain,
    speed_range_hz: tuple[float, float] | None,
    *,
    speed_alone: bool = False,
) -> ShaftPulses:
    """Return the pulses of the first shaft.

    Parameters
    ----------
    recording : MeasuredRecording
        With or without a tacho.
    train : GearTrain
        The gearbox, with teeth; of a planetary set with the tacho on the shaft of the sun.
    speed_range_hz : (float, float), optional
        Slowest and fastest speed of the first shaft; needed without a tacho or a column of speed, and not left.
    speed_alone : bool
        Whether a speed without an angle is an answer too.

    Raises
    ------
    UsageError
        Naming the file: no tacho and no range, no angle that is certain, or fewer than two revolutions of either shaft.
    """
    mesh = meshes_of(train)[0]
    teeth = mesh.teeth
    if mesh.planets is not None:
        found = _against_carrier(recording, mesh.planets)
    elif recording.tacho_s is not None:
        found = ShaftPulses(recording.tacho_s)
        low, high = speed_range_hz or (0.0, np.inf)
        if recording.tacho_hz is not None and not low <= recording.tacho_hz <= high:
            raise UsageError(
                f"{recording.path}: the tacho gives {recording.tacho_hz:.4g} Hz of the first shaft, outside of {low:g} "
                f"to {high:g} Hz. Is it on this shaft, with as many pulses per turn (`tacho_pulses` of the rig file), "
                f"and is the sampling rate right, {recording.fs_hz:g} Hz (`fs_hz`)?"
            )
    elif (span := speed_range_hz or recording.speed_span_hz) is None:
        raise UsageError(
            f"{recording.path}: neither tacho nor speed; name the tacho's column, {in_rig('tacho: COLUMN')}, the "
            f"speed with "
            "--speed, or the range the first shaft can have run in with --speed LOW,HIGH"
        )
    else:
        found = _by_mesh_lines(recording, teeth, span)
        if found.outcome != "angle":
            if speed_alone:
                return found
            raise UsageError(
                f"{recording.path}: {found.speed_hz:.4g} Hz, {found.origin}. Averages need the angle: record longer or "
                "with more channels, or give a tacho."
            )
    turns = found.times_s.size - 1
    if min(turns, turns * teeth[0] / teeth[1]) < FEWEST_REVOLUTIONS:
        needed = int(np.ceil(FEWEST_REVOLUTIONS * max(1.0, teeth[1] / teeth[0])))
        raise UsageError(
            f"{recording.path}: {turns} whole turns of the first shaft; averages of both shafts need {needed}. Record "
            "longer."
        )
    return found


def _by_mesh_lines(
    recording: MeasuredRecording, teeth: tuple[int, int], speed_range_hz: tuple[float, float]
) -> ShaftPulses:
    try:
        angle = shaft_angle(recording.channels, recording.fs_hz, teeth, speed_range_hz)
    except UsageError as error:
        raise UsageError(f"{recording.path}: {error}") from error
    return ShaftPulses(angle.pulses_s if angle.given else np.empty(0), angle=angle)


def _against_carrier(recording: MeasuredRecording, planets: Planets) -> ShaftPulses:
    if recording.tacho_s is None:
        raise UsageError(
            f"{recording.path}: no tacho; the speed of planetary sets is not searched in lines, since passing planets "
            f"move them. Name the column of a tacho on the sun's shaft: {in_rig('tacho: COLUMN')}"
        )
    pulses = geared_pulses(recording.tacho_s, planets.sun_turns)
    if pulses.size < 2:
        raise UsageError(f"{recording.path}: no whole turn of the sun against the carrier. Record longer.")
    return ShaftPulses(pulses, float(planets.sun_turns))
