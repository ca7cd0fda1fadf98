"""How channels see forces that act on a gearbox beside those of its time loop: through the machine as it is linearised.

Bearing forces that follow pass on to the housing's modes that do not move with the gears. What presses on a seat or on
the housing itself does so at once, too.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import reduce

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.dynamics.structure.forced_motion import ForcedMotion, MeanMesh, forced_motion
from siggen.dynamics.structure.structure import Structure
from siggen.sensing.inputs import FORCE, MOTION, SHAFT, Input

BLOCK = 8192
"""Frequencies at a time: the responses of all motions and forces are ten times those of a channel."""
ENTRIES = ("second_stage", "auxiliary_drive/horizontal", "auxiliary_drive/vertical")
"""Where other machines press on a housing."""


@dataclass(frozen=True, slots=True)
class ChannelWay:
    """How a channel sees forces that act beside the model's own.

    Attributes
    ----------
    shown : motions, forces and readings of shafts; of a housing of plates those of the modes that move with the gears
    accelerance : (forces, k) beyond those motions, m/s² per N from bearing forces; None for none
    entries : (`ENTRIES`, k) the same from where other machines press on the housing
    """

    shown: Mapping[Input, float]
    accelerance: ComplexArray | None
    entries: ComplexArray | None
    forces: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Forcing:
    """Forces on a linear machine: name -> generalised force (n,) per unit.

    `pressed`: name -> how much of it presses on bearings' seats and on `ENTRIES` by itself, by their names.
    """

    directions: Mapping[str, FloatArray]
    pressed: Mapping[str, Mapping[str, float]]


def forced_ways(
    machine: tuple[Structure, Sequence[MeanMesh]],
    forcing: Forcing,
    channels: Mapping[str, ChannelWay],
    frequency_hz: FloatArray,
) -> dict[str, ComplexArray]:
    """Return channel -> response (forces, k) at frequencies (k,), before its sensor.

    Raises
    ------
    ValueError
        If a channel shows what the machine does not have.
    """
    assembled, meshes = machine
    names, rows = tuple(forcing.directions), np.array(list(forcing.directions.values()))
    ways = {name: _in_model(way, assembled) for name, way in channels.items()}
    seen, readings = (_named(ways.values(), kind) for kind in (MOTION, SHAFT))
    found = {name: np.empty((len(names), frequency_hz.size), dtype=np.complex128) for name in channels}
    for first in range(0, frequency_hz.size, BLOCK):
        block = slice(first, first + BLOCK)
        forced = forced_motion(assembled, meshes, rows, seen, frequency_hz[block], readings)
        for name, way in ways.items():
            try:
                found[name][:, block] = _response([forcing.pressed.get(one, {}) for one in names], forced, way, block)
            except KeyError as error:
                raise ValueError(f"sensor of {name}: shows {error}, which the background does not reach") from error
    return found


def _named(ways: Iterable[ChannelWay], kind: str) -> tuple[str, ...]:
    """Return the names of one kind of input that channels show, each once."""
    return tuple(dict.fromkeys(one.name for way in ways for one in way.shown if one.kind == kind))


def _in_model(way: ChannelWay, assembled: Structure) -> ChannelWay:
    """Return a way that shows motions of the model alone: without those that it does not have, such as axial ones."""
    shown = {
        one: weight
        for one, weight in way.shown.items()
        if one.kind != MOTION or one.name in assembled.motions or not one.name.endswith("/axial")
    }
    return replace(way, shown=shown)


def _response(
    pressed: Sequence[Mapping[str, float]], forced: ForcedMotion, way: ChannelWay, block: slice
) -> ComplexArray:
    """Return the response (forces, k) of one channel at a block of its frequencies."""
    total = np.zeros_like(next(iter(forced.bearing_force.values())))
    found = {FORCE: forced.bearing_force, MOTION: forced.acceleration, SHAFT: forced.shaft}
    for one, weight in way.shown.items():
        total += weight * found[one.kind][one.name]
    if way.accelerance is not None:
        for name, row in zip(way.forces, way.accelerance[:, block], strict=True):
            total += row * forced.bearing_force[name]
            for i, share in ((i, own[name]) for i, own in enumerate(pressed) if name in own):
                total[i] += share * row
    if way.entries is not None:
        rows = dict(zip(ENTRIES, way.entries[:, block], strict=True))
        for i, own in enumerate(pressed):
            direct = [share * rows[name] for name, share in own.items() if name in rows]
            if direct:
                total[i] += reduce(np.add, direct)
    return total
