"""Mesh stiffness curves of one specimen in all its states, over the engagement of the damaged teeth."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from pathlib import Path

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from siggen.config import Config
from siggen.dataset.specimen import Specimen, draw_specimen
from siggen.gears.damage import Damage
from siggen.gears.geometry import GearPair
from siggen.gears.stiffness import mesh_stiffness
from siggen.loading import load_config
from siggen.specimen_physics import gear_pair, stiffness_options
from siggen.state_damage import state_damage

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class StiffnessCurve:
    """Mesh stiffness of one state against the pinion angle; angle 0: the first damaged tooth enters contact.

    Attributes
    ----------
    state : name of the state
    angle_rad : (k,)
    mesh_stiffness_n_per_m : (k,)
    """

    state: str
    angle_rad: FloatArray
    mesh_stiffness_n_per_m: FloatArray


def damaged_engagements(pair: GearPair, damage: Damage) -> tuple[int, int]:
    """Return first and last engagement, counted from angle 0, that meets damage; (0, 0) without any."""
    teeth = sorted({p.tooth for p in damage if p.gear == "pinion"}) or sorted({p.tooth for p in damage})
    count = pair.pinion.teeth if any(p.gear == "pinion" for p in damage) else pair.gear.teeth
    if not teeth:
        return 0, 0
    # Neighbours may run over the index 0: start behind the widest gap, so that they stay together.
    gaps = [(b - a) % count for a, b in zip(teeth, [*teeth[1:], teeth[0] + count], strict=True)]
    start = int(np.argmax(gaps)) + 1
    ordered = [*teeth[start:], *(t + count for t in teeth[:start])]
    return ordered[0], ordered[-1]


def stiffness_curves(config: Config, specimen_id: int = 0, points_per_pitch: int = 400) -> list[StiffnessCurve]:
    """Return the curve of every state of one specimen, from one pitch before the damage to two pitches behind it.

    Parameters
    ----------
    config : Config
    specimen_id : int
    points_per_pitch : int, samples over one angular pitch of the pinion

    Raises
    ------
    ValueError
        If the drawn damage cannot be computed by the stiffness model (the message names it).
    """
    specimen = draw_specimen(config, specimen_id)
    pair = gear_pair(specimen.gears)
    damages = [state_damage(config, specimen_id, pair, i) for i in range(len(config.states))]
    first, last = damaged_engagements(pair, max(damages, key=len))
    steps = np.arange(-points_per_pitch, (last - first + 2) * points_per_pitch + 1) / points_per_pitch
    angle = steps * 2 * pi / pair.pinion.teeth
    offset = first * 2 * pi / pair.pinion.teeth
    return [
        _curve(specimen, pair, state.name, damage, angle, offset)
        for state, damage in zip(config.states, damages, strict=True)
    ]


def _curve(
    specimen: Specimen, pair: GearPair, state: str, damage: Damage, angle: FloatArray, offset: float
) -> StiffnessCurve:
    stiffness = mesh_stiffness(pair, angle + offset, stiffness_options(specimen.stiffness), damage)
    return StiffnessCurve(state, angle, stiffness)


def curve_table(curves: list[StiffnessCurve]) -> pa.Table:
    """Return the curves as a table: the angle in degrees, and one column `<state>_n_per_m` for every state."""
    columns = {"angle_deg": np.degrees(curves[0].angle_rad)}
    columns |= {f"{curve.state}_n_per_m": curve.mesh_stiffness_n_per_m for curve in curves}
    return pa.table(columns)


def mesh_stiffness_curves(
    config: Config | Path | str, specimen_id: int = 0
) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Return state -> (angle in degrees (k,), mesh stiffness in N/m (k,)) of one specimen.

    Parameters
    ----------
    config : Config, or path of a YAML file
    specimen_id : int
    """
    usable = config if isinstance(config, Config) else load_config(config)
    return {c.state: (np.degrees(c.angle_rad), c.mesh_stiffness_n_per_m) for c in stiffness_curves(usable, specimen_id)}
