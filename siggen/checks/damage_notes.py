"""Sentences about damage that is idealised, faults that are words of one's own, and torques of 0 and below."""

from __future__ import annotations

from collections.abc import Iterator

from siggen.faults.registry import FAULT_WORDS, KNOWN_CHANGES
from siggen.gearbox.possible import PossibleGearbox
from siggen.keys.number import bounds
from siggen.keys.problems import nearest


def torque_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield what torques of 0 and below mean for the records of a set."""
    config = gearbox.config
    torques = [bounds(point.torque_nm) for point in config.operating_points]
    damaged = any(state.damaged for state in config.states)
    if any(low <= 0.0 <= high for low, high in torques):
        behind = "springs without tilt, on the line of action of the drive flanks"
        also = f"; back flanks they meet are {behind}" if config.dynamics.mesh.law == "pairs" else ""
        idle = "a torque of 0 N m is idle: flanks rattle within the backlash, and no two integrators agree for long"
        yield f"{idle}{also}"
    if any(low < 0.0 for low, _ in torques):
        harmless = ", so damage of drive flanks changes nothing, and a missing tooth counts as whole" if damaged else ""
        yield f"torques below 0 N m load the back flanks: the driven gear drives{harmless}"


def state_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield which faults of changed machines are next to a known word: any word is taken, so a slip is none."""
    known = (*KNOWN_CHANGES, *FAULT_WORDS)
    for state in gearbox.config.states:
        if state.fault not in known and (near := nearest(state.fault, known)):
            yield f"state {state.name}: fault {state.fault} is a word of your own{near}"


def damage_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield what to know about the shapes of damage in a set.

    A spall through the face whose edges are exactly parallel to the axis takes the whole contact line at once; with
    edges skewed by 0.1 to 1 mm over the face the line crosses them bit by bit, as lines of helical teeth always do.
    """
    pairs = gearbox.meshes[0].pairs
    width_mm = 1e3 * min(pair.face_width_m for pair in pairs)
    damages = (one for state in gearbox.config.states if state.damaged for one in state.damages)
    found = [edges for one in damages if (edges := one.straight_edges(width_mm)) is not None]
    straight = all(parallel for parallel, _ in found) and any(through for _, through in found)
    if straight and not any(pair.helix_rad for pair in pairs):
        yield (
            "all spalls are idealised: their edges are exactly parallel to the axis, so the whole contact line enters "
            "a spall across the face at once; edges of real spalls are skewed and wavy (damage kind: irregular, "
            "docs/understand/methods.md)"
        )
