"""Sentences about bearings whose stiffness follows the load: what it is at each operating point, and in which state."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees

from siggen.checks.bearing_problems import STIFFNESSES
from siggen.config import Config
from siggen.gearbox.configured import state_config
from siggen.gearbox.draw import draw_specimen
from siggen.specimen.loaded_bearings import BEARINGS
from siggen.specimen.structure import specimen_bearings


def bearing_notes(config: Config) -> tuple[str, ...]:
    """Return the stiffness of both bearings of each such shaft of gearbox 0, and that of states that change it."""
    found = dict(_of(config))
    notes = [*_unused(config), *(f"{key}: {text}" for key, text in found.items())]
    for index, state in enumerate(config.states):
        if state.changes:
            changed = _of(state_config(config, 0, index))
            notes += [f"{key}, state {state.name}: {text}" for key, text in changed if found.get(key) != text]
    return tuple(notes)


def _unused(config: Config) -> Iterator[str]:
    """Yield given stiffnesses that a given bearing replaces; a preset that a file extends may have given them."""
    for which in ("pinion", "gear"):
        rotor = getattr(config.dynamics, which)
        given = [key for key in STIFFNESSES if key in rotor.model_fields_set]
        if rotor.bearing is not None and given:
            at = config.names.own_path(f"dynamics.{which}.bearing").removesuffix(".bearing")
            yield (
                f"{' and '.join(f'{at}.{key}' for key in given)}: not used: {at}.bearing has a stiffness by load; "
                f"{at}.bearing: null takes the given one"
            )


def _of(config: Config) -> Iterator[tuple[str, str]]:
    specimen = draw_specimen(config, 0)
    for point in specimen.points:
        for which, one in specimen_bearings(specimen.under(point)).items():
            balls = f"{one.bearing.balls} balls of {1e3 * one.bearing.ball_diameter_m:.3g} mm"
            clearance_um = 1e6 * one.bearing.clearance_m
            text = (
                f"{BEARINGS * one.along_n_per_m:.3g} N/m along the load, {BEARINGS * one.across_n_per_m:.3g} across; "
                f"{balls} bear it over {degrees(one.half_zone_rad):.0f} degrees to either side (clearance "
                f"{clearance_um:.3g} um)"
            )
            shaft = next(one.called for one in config.names.shafts if one.inner == which)
            yield f"both bearings of {shaft} under {point.torque_nm:.3g} N m (gearbox 0)", text
