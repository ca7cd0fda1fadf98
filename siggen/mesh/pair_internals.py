"""What happens in every tooth contact, named with units: forces, friction, film, pressure; at output rate only.

Values are those of the table of pairs (`pair_places`). Film and film ratio (reference: standard literature, formulas
of `lubrication`) are computed from them: central film at the line load on what carries; rough
land enters by its mean square over what carries (derived). Hertz pressure: line contact. While a pair
does not touch, its forces, moments, damping and load share are 0, and what only a contact has (`contact_names`) is
NaN; a back flank that touches has force and friction, but neither film nor pressure.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.mesh.contact_names import PAIR_PREFIX, PER_CONTACT, PER_FILM
from siggen.mesh.lubrication import LubricatedMesh, central_film_m, film_ratio, hertz_pressure, relative_radius
from siggen.mesh.pair_columns import (
    ARM,
    ASPERITY_SHARE,
    CARRYING,
    COEFFICIENT,
    DAMPING,
    FLANK,
    FRICTION,
    NORMAL,
    PLACE,
    ROUGH,
    SLIDING,
    STIFFNESS,
)
from siggen.names import Side

MOMENTS = ("friction_moment_{0}_nm", "friction_moment_{1}_nm")
"""Of the driver and the driven gear."""
SUMS = (
    "mesh_force_n",
    "mesh_stiffness_n_per_m",
    "mesh_damping_n_s_per_m",
    "friction_force_n",
    *MOMENTS,
)
PER_PAIR = (
    "force_n",
    "load_share",
    "friction_n",
    "sliding_m_s",
    "position_m",
    *MOMENTS,
    "friction_coefficient",
    "damping_n_s_per_m",
)


@dataclass(frozen=True, slots=True)
class PairContact:
    """What pressure and film of the pairs follow from.

    `oil` is None without one; `roughness_m`: composite rms of healthy flanks and on rough land.
    """

    effective_modulus_pa: float
    face_width_m: float
    oil: LubricatedMesh | None = None
    roughness_m: tuple[float, float] = (0.0, 0.0)


def pair_internal_names(
    slots: int, contact: PairContact | None, gears: Sequence[str] = (Side.DRIVER, Side.DRIVEN)
) -> tuple[str, ...]:
    """Return the names of `pair_internals`; pair n of an engagement has the number n mod slots."""
    single = (*PER_PAIR, *_of_contact(contact))
    names = (*SUMS, *(f"{PAIR_PREFIX}{slot}_{name}" for slot in range(slots) for name in single))
    return tuple(name.format(*gears) for name in names)


def pair_internals(pairs: FloatArray, line_m: float, contact: PairContact | None) -> FloatArray:
    """Return the values named by `pair_internal_names` (k, names) of tables of pairs (k, slots, columns).

    Parameters
    ----------
    pairs : (k, slots, columns)
        Tables of `pair_places`, one per state.
    line_m : float
        Length T of the line of action [m].
    contact : PairContact or None
    """
    normal, friction, position = (pairs[:, :, column] for column in (NORMAL, FRICTION, PLACE))
    touching = pairs[:, :, FLANK] != 0.0
    total = normal.sum(axis=1)
    on_pinion = pairs[:, :, ARM]
    # Of slices at two places; the last bracket is 0 where all are at one.
    on_gear = (line_m - position) * friction + (position * friction - on_pinion)
    sums = [total, np.where(touching, pairs[:, :, STIFFNESS], 0.0).sum(axis=1), pairs[:, :, DAMPING].sum(axis=1)]
    sums += [friction.sum(axis=1), on_pinion.sum(axis=1), on_gear.sum(axis=1)]
    single = [normal, normal / np.where(total == 0.0, 1.0, total)[:, None], friction, pairs[:, :, SLIDING], position]
    coefficient = np.where(_drives(pairs), pairs[:, :, COEFFICIENT], np.nan)
    single += [on_pinion, on_gear, coefficient, pairs[:, :, DAMPING]]
    if contact is not None:
        single += _contact_values(pairs, line_m, contact)
    return np.concatenate([np.stack(sums, axis=1), np.stack(single, axis=2).reshape(len(pairs), -1)], axis=1)


def with_units(coordinates: Iterable[str]) -> tuple[str, ...]:
    """Return the names of coordinates with their units."""
    units = {True: "rad", False: "m"}
    turning = ("theta", "phi")
    return tuple(f"{name}_{units[name.startswith(turning)]}" for name in coordinates)


PIVOTS = "moment_pinion_nm", "moment_gear_nm"


def as_back_flanks(found: FloatArray, slots: int, line_m: float, contact: PairContact | None) -> FloatArray:
    """Return values of pairs of the mirrored pair, in which the gear is in front, as those of the pinion's back flanks.

    Forces are below 0 there; places count from the pinion's base tangent point on the other line of action.
    """
    names, told = pair_internal_names(slots, contact), found.copy()
    for column, name in enumerate(names):
        if name.endswith("force_n") and not name.startswith("friction"):
            told[:, column] = -found[:, column]
        elif name.endswith("position_m"):
            told[:, column] = line_m - found[:, column]
        for own, other in (PIVOTS, PIVOTS[::-1]):
            if name.endswith(own):
                told[:, column] = -found[:, names.index(f"{name.removesuffix(own)}{other}")]
    return told


def _of_contact(contact: PairContact | None) -> tuple[str, ...]:
    if contact is None:
        return ()
    return PER_CONTACT if contact.oil is None else (*PER_CONTACT, *PER_FILM)


def _drives(pairs: FloatArray) -> NDArray[np.bool_]:
    return (pairs[:, :, FLANK] > 0.0) & (pairs[:, :, NORMAL] > 0.0)


def _contact_values(pairs: FloatArray, line_m: float, contact: PairContact) -> list[FloatArray]:
    # An edge may touch outside of the line of action, where involutes have no radius. Where nothing touches any contact
    # will do: its values are replaced.
    touching = _drives(pairs) & (relative_radius(pairs[:, :, PLACE], line_m) > 0.0)
    position = np.where(touching, pairs[:, :, PLACE], 0.5 * abs(line_m))
    force = np.where(touching, pairs[:, :, NORMAL] / np.where(touching, pairs[:, :, CARRYING], 1.0), 1.0)
    radius = relative_radius(position, line_m)
    values = [hertz_pressure(force / contact.face_width_m, radius, contact.effective_modulus_pa)]
    if contact.oil is not None:
        healthy, pitted = contact.roughness_m
        roughness = np.sqrt(healthy**2 + np.where(touching, pairs[:, :, ROUGH], 0.0) * (pitted**2 - healthy**2))
        film = central_film_m(contact.oil.groups(position, force))
        values += [film, film_ratio(film, roughness), pairs[:, :, ASPERITY_SHARE]]
    return [np.where(touching, value, np.nan) for value in values]
