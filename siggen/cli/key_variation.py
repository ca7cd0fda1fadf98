"""Curves of one state over values of one key: a study of places or sizes, as paper A makes in sections 3.3 and 3.4."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace

from siggen.errors import UsageError
from siggen.gearbox.design import SetDesign
from siggen.keys.problems import nearest
from siggen.views.stiffness import StiffnessCurve, stiffness_curves


def varied(text: str, design: SetDesign) -> Iterator[tuple[str, list[str], int]]:
    """Yield label, overrides and state of every value of `KEY=1,1.9,2.8`; the state keeps its keys, and grows no more.

    Raises
    ------
    UsageError
        If the text is none, or names a state that there is not.
    """
    key, _, listed = text.partition("=")
    values = [value.strip() for value in listed.split(",") if value.strip()]
    if not key or len(values) < 2:
        allowed = "KEY=VALUES with at least two values, such as states.moderate.damage.first_height_mm=1,1.9,2.8"
        raise UsageError(f"--vary: received '{text}'; allowed: {allowed}")
    states = design.state_names
    own = re.match(r"states\.([^.]+)\.", key)
    name = own[1] if own else states[-1]
    if name not in states:
        raise UsageError(f"--vary: received state '{name}'; allowed: {', '.join(states)}{nearest(name, states)}")
    state = states.index(name)
    milder = design.config.states[state].grows if own else None
    alone = [] if milder is None else [f"states.{name}.grows=null", f"states.{name}.like={milder}"]
    for value in values:
        yield f"{key}={value}", [*alone, f"{key}={value}"], state


def varied_curves(
    loaded: Iterable[tuple[str, SetDesign, int]], specimen_id: int, torque_nm: float, mesh: int
) -> list[StiffnessCurve]:
    """Return the curve of a mesh in the first state, then in the varied state at each value, under its label."""
    found: list[StiffnessCurve] = []
    for label, design, state in loaded:
        names = (*(() if found else design.state_names[:1]), design.state_names[state])
        curves = stiffness_curves(design.gearbox(specimen_id), torque_nm=torque_nm, states=names, mesh=mesh)
        found += [*curves[:-1], replace(curves[-1], state=label)]
    return found
