"""How channels see forces that act on a gearbox beside those of its time loop: through the machine as it is linearised.

Bearing forces that follow pass on to the housing's modes that do not move with the gears. What presses on a seat or on
the housing itself does so at once, too.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from math import cos, pi, sin, sqrt

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.drivetrain.drivetrain import BASE, Place
from siggen.drivetrain.excitation import bearing_direction, bearing_places, shaft_direction, shaft_directions
from siggen.drivetrain.forced_motion import ForcedMotion, MeanMesh, forced_decay_per_s, forced_motion
from siggen.drivetrain.makers import on_base
from siggen.drivetrain.structure import Structure
from siggen.gearbox.background import DrawnBackground
from siggen.gearbox.specimen import Specimen
from siggen.gears.gear_pair import GearPair
from siggen.mesh.tooth_law import ToothLaw
from siggen.motion.motion import TRANSIENT_CAP_S
from siggen.names import MACHINES
from siggen.record.structure import linear_structure, linear_train
from siggen.sensing.inputs import FORCE, MOTION, SHAFT, Input
from siggen.sensing.responses import resonance_response

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


# The background of one specimen: what is drawn for its machine, and how its forces reach every channel.
#
# Forces act on the model linearised about its mean mesh, base included: along the line of action, between shafts and
# seats, on shafts, base and housing. What they do to bearing forces passes the flexible modes like the model's own.

DECAYS = 7.0
"""Decay times of the slowest mode before the first sample: forces begin there, and what rings from it must be gone."""
AXES = ("horizontal", "vertical")
SET_MESHES, EVEN = ("sun_meshes", "ring_meshes"), "even"
"""Of a planetary set, and the part of their push that has no direction."""
MESH_STIFFNESS_PA = 20e9
"""Mean stiffness of a mesh per face width that the forces meet (source: ISO 6336-1, steel)."""


@dataclass(frozen=True, slots=True)
class SpecimenBackground:
    """What acts on a gearbox besides its teeth, and channel -> response (inputs, k) to it in m/s² per N.

    Responses end before the sensor; those from bearings are per m/s of what moves in series with their springs.
    """

    inputs: tuple[str, ...]
    responses: Mapping[str, ComplexArray]


def background_history_s(specimen: Specimen, drawn: DrawnBackground) -> float:
    """Return the time before the first sample over which forces of the background must be followed [s].

    Whatever reads shafts sees them swing on their couplings, and what stands on a base sees that.
    """
    assembled = _linear(specimen, drawn)
    decay_per_s = forced_decay_per_s(assembled, mean_meshes(specimen, assembled))
    return min(TRANSIENT_CAP_S, DECAYS / decay_per_s) if decay_per_s > 0.0 else TRANSIENT_CAP_S


def _linear(specimen: Specimen, drawn: DrawnBackground) -> Structure:
    machine = linear_train(specimen)
    if drawn.base is not None and BASE in machine.body:
        machine = on_base(machine, drawn.base)
    return linear_structure(machine)


def specimen_background(
    specimen: Specimen, drawn: DrawnBackground, channels: Mapping[str, ChannelWay], frequency_hz: FloatArray
) -> SpecimenBackground:
    """Return how the background of a specimen reaches its channels, at frequencies (k,); the same for all records."""
    assembled = _linear(specimen, drawn)
    directions = _directions(assembled, drawn)
    if not directions:
        return SpecimenBackground((), {})
    names = tuple(directions)
    forcing = Forcing(directions, _pressed(assembled, drawn.angles_rad["auxiliary_drive"]))
    responses = forced_ways((assembled, mean_meshes(specimen, assembled)), forcing, channels, frequency_hz)
    for name, factor in _factors(assembled, drawn, frequency_hz).items():
        for response in responses.values():
            response[names.index(name)] *= factor
    return SpecimenBackground(names, responses)


def _factors(assembled: Structure, drawn: DrawnBackground, frequency_hz: FloatArray) -> dict[str, ComplexArray]:
    """Return input -> what lies between it and the force that acts on the model (k,)."""
    bearings = bearing_inputs(assembled) if drawn.bearings else ()
    found = {name: _per_velocity(assembled, name, frequency_hz) for name in bearings}
    for name, mesh in drawn.foreign.items():
        found[name] = resonance_response(frequency_hz, mesh.support_hz, mesh.support_damping)
    return found


def _per_velocity(assembled: Structure, name: str, frequency_hz: FloatArray) -> ComplexArray:
    """Return the force (k,) between a shaft and its seat per velocity of what lies between them: k_b/iω, 0 at rest."""
    stiffness = float(assembled.bearing_forces[name][0] @ shaft_direction(assembled, name))
    turning = np.where(frequency_hz > 0.0, 2.0 * pi * frequency_hz, np.inf)
    return np.asarray(-1j * stiffness / turning)


def mean_meshes(specimen: Specimen, assembled: Structure) -> list[MeanMesh]:
    """Return every mesh of a gearbox as a constant spring and damper."""
    count = 1 if specimen.planets is None else len(specimen.planets.teeth.places)
    pairs = [mesh.pair for mesh in specimen.meshes for _ in range(count)]
    return [mean_mesh(specimen.law, pair, mesh.mass_kg) for pair, mesh in zip(pairs, assembled.meshes, strict=True)]


def mean_mesh(law: ToothLaw, pair: GearPair, equivalent_mass_kg: float) -> MeanMesh:
    """Return the mesh as a constant spring and damper; no state may show in it, so it knows no damage."""
    stiffness = MESH_STIFFNESS_PA * pair.face_width_m
    return MeanMesh(stiffness, 2.0 * law.damping_ratio * sqrt(stiffness * equivalent_mass_kg))


def _directions(assembled: Structure, drawn: DrawnBackground) -> dict[str, FloatArray]:
    """Return input -> generalised force (n,) per newton, for the inputs that the background needs."""
    found: dict[str, FloatArray] = {}
    if drawn.rubbing is not None:
        found |= mesh_directions(assembled)
    if drawn.bearings:
        found |= {name: bearing_direction(assembled, *name.split("/")) for name in bearing_inputs(assembled)}
    if drawn.machines is not None:
        for name, place in MACHINES.items():
            found[name] = _turned(_stand(assembled, place), drawn.angles_rad[name])
    for shaft, place in zip(drawn.shafts, MACHINES.values(), strict=bool(drawn.shafts)):
        rows = _on_rotor(assembled, place) - _on_base(assembled)
        found |= {f"{shaft}_shaft/{axis}": row for axis, row in zip(AXES, rows, strict=True)}
    if drawn.shafts:
        found |= {f"base/{axis}": row for axis, row in zip(AXES, _on_base(assembled), strict=True)}
    if "second_stage" in drawn.foreign:
        found["second_stage"] = _entry(assembled, "second_stage")
    if "auxiliary_drive" in drawn.foreign:
        rows = np.array([_entry(assembled, f"auxiliary_drive/{axis}") for axis in AXES])
        found["auxiliary_drive"] = _turned(rows, drawn.angles_rad["auxiliary_drive"])
    return found


def mesh_directions(assembled: Structure) -> dict[str, FloatArray]:
    """Return what presses along lines of action: of the first mesh, or of all meshes of a planetary set as they turn.

    Derived: of N planets that stand evenly, one at the angle β in space moves central bodies as a + b cos β + c sin β,
    with a, b and c the mean over all planets, and twice those of p cos β and p sin β.
    """
    if not assembled.frame:
        return {"mesh": assembled.mesh.vector}
    count = len(assembled.meshes) // len(SET_MESHES)
    angle = 2.0 * pi * np.arange(count) / count
    waves = {EVEN: np.ones(count), AXES[0]: 2.0 * np.cos(angle), AXES[1]: 2.0 * np.sin(angle)}
    rows = np.array([mesh.vector for mesh in assembled.meshes]).reshape(len(SET_MESHES), count, -1)
    return {
        f"{mesh}/{wave}": (weights[:, None] * own).mean(axis=0)
        for mesh, own in zip(SET_MESHES, rows, strict=True)
        for wave, weights in waves.items()
    }


def bearing_inputs(assembled: Structure) -> tuple[str, ...]:
    """Return the bearings of every shaft, with their axes."""
    return tuple(f"{place}/{axis}" for place in bearing_places(assembled) for axis in AXES[::-1])


def _pressed(assembled: Structure, turn_rad: float) -> dict[str, dict[str, float]]:
    """Return what presses on a housing by itself: a force between shaft and seat the other way than on the shaft."""
    drive = dict(zip((f"auxiliary_drive/{axis}" for axis in AXES), (cos(turn_rad), sin(turn_rad)), strict=True))
    own = {name: {name: -1.0} for name in bearing_inputs(assembled)}
    return {**own, "second_stage": {"second_stage": 1.0}, "auxiliary_drive": drive}


def _entry(assembled: Structure, name: str) -> FloatArray:
    """Return the generalised force (n,) of 1 N where another machine presses on the housing; nothing without one."""
    machine = assembled.drivetrain
    return machine.way(machine.entries[name]) if name in machine.entries else np.zeros(len(assembled.coordinates))


def _turned(rows: FloatArray, angle: float) -> FloatArray:
    return np.asarray(cos(angle) * rows[0] + sin(angle) * rows[1])


def _on_rotor(assembled: Structure, place: int) -> FloatArray:
    return shaft_directions(assembled, bearing_places(assembled)[place])


def _on_base(assembled: Structure) -> FloatArray:
    """Return unit forces (2, n), horizontal and vertical, on the base; 0 if there is none."""
    machine = assembled.drivetrain
    if BASE not in machine.body:
        return np.zeros((len(AXES), len(assembled.coordinates)))
    return np.array([machine.row(Place(BASE), axis) for axis in AXES])


def _stand(assembled: Structure, place: int) -> FloatArray:
    """Return where a machine presses: on the base, or on its shaft of a gearbox without one."""
    base = assembled.drivetrain.body.get(BASE)
    return _on_base(assembled) if base is not None and base.coordinates else _on_rotor(assembled, place)
