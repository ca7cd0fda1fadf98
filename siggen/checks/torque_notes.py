"""Sentences about operating points at which the motor does not drive the teeth: idle, and torques below 0."""

from __future__ import annotations

from collections.abc import Iterator

from siggen.config import Config
from siggen.keys.number import bounds
from siggen.specimen.contact import solves_across_the_face


def torque_notes(config: Config) -> tuple[str, ...]:
    """Return what torques of 0 and below mean for the records of a set."""
    return tuple(_notes(config))


def _notes(config: Config) -> Iterator[str]:
    torques = [bounds(point.torque_nm) for point in config.operating_points]
    damaged = any(state.damaged for state in config.states)
    if any(low <= 0.0 <= high for low, high in torques):
        behind = "springs without tilt, on the line of action of the drive flanks"
        also = f"; back flanks they meet are {behind}" if solves_across_the_face(config.dynamics) else ""
        idle = "a torque of 0 N m is idle: flanks rattle within the backlash, and no two integrators agree for long"
        yield f"{idle}{also}"
    if any(low < 0.0 for low, _ in torques):
        harmless = ", so damage of drive flanks changes nothing, and a missing tooth counts as whole" if damaged else ""
        yield f"torques below 0 N m load the back flanks: the gear drives the pinion{harmless}"
