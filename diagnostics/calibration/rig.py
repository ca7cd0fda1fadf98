"""Rig: the configuration of the machine that is calibrated, and what its recordings must fit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

import siggen
from diagnostics.calibration.drivetrain import MeshOrder, TrainOrders, drivetrain
from diagnostics.calibration.healthy_blocks import HealthyBlock
from diagnostics.calibration.order_record import OrderRecord
from diagnostics.calibration.path_draws import number_limits
from diagnostics.recordings.in_rig import in_rig
from diagnostics.recordings.taken import RecordingFacts, Source, channel_names, take
from siggen.errors import UsageError

LINES, AROUND, LEAST_SHOWN = 10, 4, 0.25
"""Of a mesh. On four simulated machines 0.55 and more of the lines stood out, with wrong teeth 0.3 and less."""
SPEED_RATIO = 1.25
"""Between recordings and the rig's range of speed; beyond, a tacho elsewhere is likelier than another speed."""


@dataclass(frozen=True, slots=True)
class CalibratedRig:
    """A configuration whose paths, noise and lines recordings tell.

    Attributes
    ----------
    file : Path
    config : dict
        Resolved, in its user's words.
    drive : TrainOrders
    forces : tuple of str
        Its bearing forces as place/axis, in its user's words.
    """

    file: Path
    config: dict[str, Any]
    drive: TrainOrders
    forces: tuple[str, ...]

    @property
    def forces_in_columns(self) -> list[str]:
        """What parts of the names of columns call its bearing forces."""
        return ["_".join(force.split("/")) for force in self.forces]

    @property
    def sensors(self) -> dict[str, dict[str, Any]]:
        """Accelerometers by name: recordings of others have neither path nor noise that is fitted."""
        return {name: one for name, one in self.config["sensors"].items() if one["kind"] == "accelerometer"}

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of their channels."""
        return tuple(f"{name}_{axis}" for name, sensor in self.sensors.items() for axis in sensor["axes"])

    @property
    def shows_other_stages(self) -> bool:
        """Whether a comb of lines tells a stage that it does not list: tried on single spur pairs alone.

        A narrow resonance over multiples of a slow shaft passes for a comb, and so do errors beside weak helical lines.
        """
        return len(self.drive.meshes) == 1 and not any(force.endswith("/axial") for force in self.forces)

    @property
    def left_out(self) -> tuple[str, ...]:
        """Names of the other sensors."""
        return tuple(name for name, one in self.config["sensors"].items() if one["kind"] != "accelerometer")


def read_rig(file: Path) -> CalibratedRig:
    """Return the rig of a configuration.

    Raises
    ------
    UsageError
        If it has no accelerometers, it is a planetary set, or its gears are drawn.
    """
    design = siggen.load_config(file)
    train = siggen.draw(design).drivetrain
    if any(gear.places for gear in train.gears):
        raise UsageError(
            f"{file}: planetary: received a planetary set; forces of its planets turn with the carrier, so no path "
            "from bearings at rest carries its lines. Allowed: pairs and machines of several meshes. "
            f"`siggen-diagnostics baseline --teeth {file}` watches such machines by their recordings"
        )
    if design.pairs:
        raise UsageError(f"{file}: gears differ within the set; a calibration is of one machine of known teeth")
    found = CalibratedRig(file, design.canonical(), drivetrain(train), design.places.pressed)
    if not found.sensors:
        raise UsageError(f"{file}: sensors: received {', '.join(found.left_out)}; allowed: at least one accelerometer")
    return found


def rig_channels(rig: CalibratedRig, source: Source, facts: RecordingFacts) -> tuple[tuple[str, ...], dict[str, str]]:
    """Return the channels of a rig, and the column of each where it has another name.

    Parameters
    ----------
    rig : Rig
    source : (Path, int or None)
        First recording.
    facts : RecordingFacts
        How it is read; its columns by channel, as the user gave them.

    Raises
    ------
    UsageError
        If the recording has more or fewer channels than the rig.
    """
    names, said = rig.channels, facts.columns
    if said:
        if set(said) != set(names):
            raise UsageError(
                f"channels of the rig file: received {', '.join(said)}; the rig has the channels {', '.join(names)}"
            )
        return names, dict(said)
    found = channel_names(take(source[0], replace(facts, row=source[1], columns={}), say=False))
    if set(names) <= set(found):
        return names, {}
    if len(found) != len(names):
        raise UsageError(
            f"{source[0]}: {len(found)} channels ({', '.join(found)}), the rig has {len(names)} ({', '.join(names)}); "
            f"give {in_rig('channels: {NAME: COLUMN}')} for each, or a rig with as many sensors (siggen init --sensors)"
        )
    return names, dict(zip(names, found, strict=True))


def check_speeds(rig: CalibratedRig, blocks: Iterable[HealthyBlock]) -> None:
    """Refuse recordings at another speed than the rig's.

    Raises
    ------
    UsageError
        Naming the recording, its speed, and the rig's range.
    """
    points = [number_limits(point["speed_hz"]) for point in rig.config["operating_points"]]
    low, high = min(one[0] for one in points), max(one[1] for one in points)
    for block in blocks:
        if not low / SPEED_RATIO <= block.speed_hz <= high * SPEED_RATIO:
            first = rig.drive.shafts[0].words
            raise UsageError(
                f"{block.name}: {first} turns at {block.speed_hz:.4g} Hz; {rig.file} has operating_points.speed_hz "
                f"from {low:g} to {high:g}. Does the tacho stand on {first}, with `tacho_pulses` of the rig file per "
                f"turn? If "
                "the machine runs so, write its speed there"
            )


def check_meshes(rig: CalibratedRig, channels: Mapping[str, Sequence[OrderRecord]]) -> None:
    """Refuse a machine of several meshes of which recordings show one not: its teeth may be others.

    A mesh shows where its lines stand out of the shaft's multiples around them. Of other teeth one in nine does.

    Raises
    ------
    UsageError
        Naming the mesh and its teeth.
    """
    meshes = rig.drive.meshes
    for mesh in meshes if len(meshes) > 1 else ():
        shown = [one for records in channels.values() for record in records for one in _standing_out(record, mesh)]
        if sum(shown) <= LEAST_SHOWN * len(shown):
            first = rig.drive.shafts[0].words
            raise UsageError(
                f"{rig.file}: recordings do not show {mesh.words}: {sum(shown)} of {len(shown)} of its lines, at order "
                f"{mesh.order:.4g} of {first} and its multiples, stand out of those around them. Are these the teeth "
                "of the machine? If they are, recordings tell nothing of this mesh: leave it out"
            )


def _standing_out(record: OrderRecord, mesh: MeshOrder) -> Iterator[bool]:
    """Yield whether each of the first lines of a mesh is the highest of the driving shaft's multiples around it."""
    step = mesh.shafts[0].step
    for centre in (h * mesh.order for h in range(1, LINES + 1)):
        power = [record.line(centre + k * step)[0] for k in range(-AROUND, AROUND + 1)]
        if np.isfinite(power).all():
            yield int(np.argmax(power)) == AROUND
