"""Rig: the few numbers by which a user describes a machine."""

from __future__ import annotations

from dataclasses import dataclass
from math import gcd

from siggen.errors import UsageError

Pair = tuple[float, float]

LIMITS = {
    "module": (0.3, 50.0, "mm"),
    "face-width": (1.0, 500.0, "mm"),
    "speed": (0.05, 500.0, "Hz, of the pinion"),
    "torque": (0.01, 1e6, "N m, on the pinion"),
    "pressure-angle": (14.5, 30.0, "degrees"),
    "fs": (100.0, 1e7, "Hz"),
    "shift": (-1.0, 1.5, "modules"),
}
"""Smallest, largest and unit of what `siggen init` takes."""
LARGEST_SENSORS = 8
DAMAGES = ("spalls", "pits")
"""What `siggen init` writes: one spall that grows over the face, or a cluster of pits that grows in number."""
MOST_SEVERITIES = 12


@dataclass(frozen=True, slots=True)
class RigDesign:
    """What a maker chooses for shafts and bearings; by default the middle of what gearboxes of a set draw (`Sizing`).

    Parameters
    ----------
    torque_factor : float
        Torque that shafts and bearings are made for, over the largest of the rig.
    shear_n_per_mm2 : float
        Allowed in the shaft end.
    length_factor : float
        Length of a shaft over the distance of its bearings.
    series : int
        Of the bearings, as far as balls of it last and stand side by side.
    """

    torque_factor: float = 1.375
    shear_n_per_mm2: float = 18.5
    length_factor: float = 1.2
    series: int = 62


@dataclass(frozen=True, slots=True)
class Rig:
    """A single-stage spur gearbox.

    Parameters
    ----------
    teeth : (pinion, gear)
    module_mm, face_width_mm, pressure_angle_deg : float
    speed_hz, torque_nm : (lowest, highest) of the pinion's shaft, equal where there is one
    sensors : int
        Number of accelerometers.
    bores_mm : (pinion, gear) or None
        Diameters of the bores, which are those of the shafts; None: from the torque.
    accuracy_classes : tuple of int
        Flank tolerance classes of ISO 1328-1, equally likely for each gear.
    fs_hz : float or None
        Sampling rate; None: what carries ten mesh harmonics.
    shifts : (pinion, gear)
        Profile shifts in modules.
    damage : str
        A key of `DAMAGES`.
    severities : int
        Sizes of damage.
    spans_mm : (pinion, gear)
        Distances of the bearings where they are given.
    design : RigDesign
        What its maker chose.
    """

    teeth: tuple[int, int]
    module_mm: float
    face_width_mm: float
    speed_hz: Pair
    torque_nm: Pair
    sensors: int = 2
    pressure_angle_deg: float = 20.0
    bores_mm: Pair | None = None
    accuracy_classes: tuple[int, ...] = (5, 6, 7)
    fs_hz: float | None = None
    shifts: Pair = (0.0, 0.0)
    damage: str = "spalls"
    severities: int = 3
    spans_mm: tuple[float | None, float | None] = (None, None)
    design: RigDesign = RigDesign()

    @property
    def hunting_turns(self) -> int:
        """Turns of the pinion after which the same two teeth meet again: z2/gcd(z1, z2)."""
        return self.teeth[1] // gcd(*self.teeth)


def checked_rig(rig: Rig) -> Rig:
    """Return a rig whose numbers lie within LIMITS.

    Raises
    ------
    UsageError
        If one does not; names the option, what came, what is allowed.
    """
    given = {
        "module": (rig.module_mm,),
        "face-width": (rig.face_width_mm,),
        "speed": rig.speed_hz,
        "torque": rig.torque_nm,
        "pressure-angle": (rig.pressure_angle_deg,),
        "fs": () if rig.fs_hz is None else (rig.fs_hz,),
        "shift": rig.shifts,
    }
    for name, values in given.items():
        low, high, unit = LIMITS[name]
        if not all(low <= value <= high for value in values):
            raise UsageError(f"--{name}: received {_listed(values)}; allowed: {low:g} to {high:g} {unit}")
        if len(values) == 2 and name != "shift" and values[0] > values[1]:
            raise UsageError(f"--{name}: received {_listed(values)}; allowed: the lowest value first")
    if not all(5 <= z <= 1000 for z in rig.teeth):
        raise UsageError(f"--teeth: received {_listed(rig.teeth)}; allowed: 5 to 1000 teeth of pinion and gear")
    if not 1 <= rig.sensors <= LARGEST_SENSORS:
        raise UsageError(f"--sensors: received {rig.sensors}; allowed: 1 to {LARGEST_SENSORS}")
    if rig.damage not in DAMAGES:
        raise UsageError(f"--damage: received {rig.damage!r}; allowed: {' or '.join(DAMAGES)}")
    if not 1 <= rig.severities <= MOST_SEVERITIES:
        raise UsageError(f"--severities: received {rig.severities}; allowed: 1 to {MOST_SEVERITIES}")
    return rig


def _listed(values: tuple[float, ...]) -> str:
    return ",".join(f"{value:g}" for value in values)
