"""Checks across sections that need no gear physics; each looks only at the sections that are valid."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from difflib import SequenceMatcher
from fractions import Fraction
from typing import Any

from siggen.config.helical_limits import helical_problems
from siggen.config.housing import ModalHousing, PlateHousing
from siggen.config.life import life_problems
from siggen.config.machine import most_teeth_per_turn, names_in, pair_of, shaft_orders, stage_problems, stages_of
from siggen.config.planetary import sets_problems
from siggen.config.states import SEVERITIES, StateSection
from siggen.damage.fault import Fault
from siggen.damage.registry import COMBINED, HEALTHY, kinds_called
from siggen.errors import Problem
from siggen.keys.by_name import BY_NAME, named_entries
from siggen.keys.number import bounds
from siggen.keys.problems import nearest
from siggen.keys.teeth import most_teeth
from siggen.sensors.places import MODAL, PLATES, Places

SIDEBANDS = 8
"""Lines beside a mesh harmonic, one shaft frequency apart, that the band must carry too."""

SAMPLES_PER_PERIOD = 2.56
"""Sampling rate over the highest frequency of interest; usual for vibration analysers, leaves room for the filter."""


def consistency_problems(sections: Mapping[str, Any], raw: Mapping[str, object]) -> list[Problem]:
    """Return what is contradictory between the valid sections of a configuration."""
    checks: list[Callable[[Mapping[str, Any], Mapping[str, object]], Iterable[Problem]]] = [
        life_problems,
        _names_alike,
        _sample_count,
        _band,
        _growth,
        _fault_names,
        _severities,
        _tooth_indices,
        _sensor_places,
        _sensors_beside,
        _sensor_turns,
        _mesh_law,
        helical_problems,
        _flank_shapes,
        _manufacture,
        _housing,
        _background,
        _splits,
        stage_problems,
        sets_problems,
    ]
    return [problem for check in checks for problem in check(sections, raw)]


def _names_alike(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    """Yield states and sensors whose names differ from another one's in case alone."""
    for key in BY_NAME:
        names = list(sections.get(key, {}))
        for index, name in enumerate(names):
            if alike := [other for other in names[:index] if other.lower() == name.lower()]:
                allowed = "allowed: names that differ by more than their case: readers of columns may not tell"
                yield Problem(f"{key}.{name}", f"'{name}' beside '{alike[0]}'", allowed)


def _sample_count(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    if "fs_hz" not in sections or "duration_s" not in sections:
        return
    samples = sections["fs_hz"] * sections["duration_s"]
    if round(samples) < 2 or not math.isclose(samples, round(samples), rel_tol=1e-9):
        received = f"{sections['duration_s']} s at {sections['fs_hz']} Hz = {samples:.10g} samples"
        yield Problem("duration_s", received, "allowed: a whole number of at least 2 samples")


def _band(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    if not {"fs_hz", "mesh_harmonics", "gears", "operating_points"} <= sections.keys():
        return
    teeth, harmonics = most_teeth_per_turn(sections), sections["mesh_harmonics"]
    speed_hz = max(bounds(point.speed_hz)[1] for point in sections["operating_points"])
    if "variation" in sections:
        speed_hz *= sections["variation"].speed_ratios[1]
    needed_hz = SAMPLES_PER_PERIOD * (harmonics * teeth + SIDEBANDS) * speed_hz
    if sections["fs_hz"] < needed_hz:
        allowed = (
            f"allowed: at least {needed_hz:.6g} Hz for mesh harmonic {harmonics} (mesh_harmonics) with its sidebands "
            f"at the highest speed, {speed_hz:g} Hz with {teeth} teeth; or lower mesh_harmonics or the speed"
        )
        yield Problem("fs_hz", repr(sections["fs_hz"]), allowed)


def carried_mesh_harmonics(fs_hz: float, teeth: float, speed_hz: float) -> int:
    """Return how many mesh harmonics of so many teeth per turn a sampling rate carries with their sidebands."""
    return math.floor((fs_hz / (SAMPLES_PER_PERIOD * speed_hz) - SIDEBANDS) / teeth)


ON_BODY = ("base", "second_stage", "auxiliary_drive")
"""Parts of the background that press on what carries the bearings."""


def _sensor_places(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    places = places_of(sections)
    for index, sensor in sections.get("sensors", {}).items() if places is not None else ():
        for problem in sensor.model_problems(places):
            yield Problem(f"sensors.{index}.{problem.path}", problem.received, problem.allowed)


def places_of(sections: Mapping[str, Any]) -> Places | None:
    """Return what there is for sensors; None where sections that say so are wrong themselves."""
    if "dynamics" not in sections:
        return None
    model, stages = sections["dynamics"].model, stages_of(sections["machine"])
    housing, planetary = sections.get("housing"), sections.get("planetary") is not None
    names = names_in(sections["machine"], planetary=planetary)
    if model == "casing" and isinstance(housing, ModalHousing):
        model = MODAL
    if planetary or stages:  # other models and housings are refused
        return Places(model if model in {MODAL, "casing"} else "8dof", names, planetary=planetary)
    helical = "gears" in sections and bounds(sections["gears"].helix_deg) != (0.0, 0.0)
    if model == "casing" and isinstance(housing, PlateHousing):
        return Places(PLATES, names, helical=helical)
    return None if model == "casing" and housing is None else Places(model, names, helical=helical)


def _sensors_beside(sections: Mapping[str, Any], raw: Mapping[str, object]) -> Iterator[Problem]:
    sensors = sections.get("sensors", {})
    if len(named_entries("sensors", raw)) > len(sensors):  # one may be missing that is wrong itself
        return
    places = places_of(sections)
    for index, sensor in sensors.items() if places is not None else ():
        for problem in sensor.beside_problems({one.name: one for one in sensors.values()}, places):
            yield Problem(f"sensors.{index}.{problem.path}", problem.received, problem.allowed)


def _sensor_turns(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    """Yield sensors that read nothing of a record in which shafts turn as little as they may."""
    if not {"duration_s", "gears", "operating_points"} <= sections.keys():
        return
    pinion = sections["duration_s"] * min(bounds(point.speed_hz)[0] for point in sections["operating_points"])
    gears = sections["gears"]
    slowest = Fraction(min(gears.teeth_of("pinion")), max(gears.teeth_of("gear")))
    names = names_in(sections["machine"], planetary=sections.get("planetary") is not None)
    orders = names.of_turning(shaft_orders(slowest, stages_of(sections["machine"])))
    turns = {name: pinion * order for name, order in orders.items()}
    for index, sensor in sections.get("sensors", {}).items():
        for problem in sensor.duration_problems(turns):
            yield Problem(f"sensors.{index}.{problem.path}", problem.received, problem.allowed)


def _housing(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    """Yield a housing for a model that has none; that of files without the section is no choice of anybody."""
    model = sections["dynamics"].model if "dynamics" in sections else "casing"
    if model != "casing" and sections.get("housing", PlateHousing()) != PlateHousing():
        yield Problem("housing", "a section", f"allowed: none, or dynamics.model: casing (it is {model})")


def _background(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    """Yield a base without a casing on it, and forces on a casing without one."""
    section = sections.get("background")
    if section is None or "dynamics" not in sections:
        return
    model = sections["dynamics"].model
    for part in ON_BODY if model != "casing" else ():
        if getattr(section, part) is not None:
            yield Problem(
                f"background.{part}", "a section", f"allowed: null, or dynamics.model: casing (it is {model})"
            )


def _splits(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    if "gears" in sections and "splits" in sections and sections["splits"].by == "pair" and not sections["gears"].pairs:
        yield Problem("splits.by", "'pair'", "allowed: gearbox, or a list gears.pairs")


def _mesh_law(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    if "dynamics" not in sections:
        return
    dynamics = sections["dynamics"]
    if dynamics.mesh.law == "linear" and dynamics.friction.model not in {"auto", "off"}:
        allowed = "allowed: auto or off, or dynamics.mesh.law: pairs"
        yield Problem("dynamics.friction.model", f"'{dynamics.friction.model}'", allowed)
    if dynamics.mesh.damping == "asperity_share" and dynamics.rubbing != "mixed_ehl":
        allowed = "allowed: constant, or dynamics.friction.model: mixed_ehl, which the asperity share comes from"
        yield Problem("dynamics.mesh.damping", "'asperity_share'", allowed)


def _flank_shapes(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    if "dynamics" not in sections or sections["dynamics"].mesh.law != "linear":
        return
    for index, state in sections.get("states", {}).items():
        for where, one in state.placed(f"states.{index}"):
            if one.needs_pairs:
                allowed = (
                    "allowed: another kind with dynamics.mesh.law: linear, whose flanks have no shape; or law: pairs"
                )
                yield Problem(f"{where}.kind", f"'{one.kind_word()}'", allowed)


def _manufacture(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    if "dynamics" not in sections:
        return
    if sections.get("manufacture") is None:
        for which in ("pinion", "gear"):
            if bounds(given := getattr(sections["dynamics"], which).eccentricity_um)[1] > 0.0:
                allowed = "allowed: 0, or a section manufacture, whose teeth stand each in a place of its own"
                yield Problem(f"dynamics.{which}.eccentricity_um", str(given), allowed)
        return
    if sections["dynamics"].mesh.law == "linear":
        allowed = "allowed: null with dynamics.mesh.law: linear, whose teeth are all alike; or dynamics.mesh.law: pairs"
        yield Problem("manufacture", "errors of single teeth", allowed)


def _growth(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    states: Mapping[str, StateSection] = sections.get("states", {})
    for index, state in states.items():
        if state.grows is None or state.grows not in states:
            continue
        milder = states[state.grows]
        if milder.faulty:
            yield from _growth_problems(milder, state, f"states.{index}")
        else:
            faulty = [name for name, other in states.items() if other.faulty and name != index]
            allowed = f"allowed: {', '.join(faulty) or 'null'}; states with damage or changes"
            yield Problem(f"states.{index}.grows", f"'{state.grows}', which has neither", allowed)


def _fault_names(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    """Yield labels that do not say what a state shows, by its own damage or by that of a state before it."""
    states: Mapping[str, StateSection] = sections.get("states", {})
    for index, state in states.items():
        if not state.faulty or state.fault == HEALTHY:
            continue
        own = [word for section in state.damages for word in section.own_words]
        outranked = {word for section in state.damages for word in section.outranked}
        inherited = (word for section in _milder_damages(states, state) for word in section.own_words)
        words = dict.fromkeys([*own, *(word for word in inherited if word not in outranked)])
        words |= {COMBINED: None} if len(words) > 1 else {}
        kinds = kinds_called(state.fault)
        if state.fault not in words and (kinds or not state.changes):
            yield Problem(f"states.{index}.fault", _shown_text(state), _words_text([*words], state.fault, kinds))


def _milder_damages(states: Mapping[str, StateSection], state: StateSection) -> Iterator[Fault]:
    """Yield the damage of the states that a state has grown from."""
    while state.grows is not None and state.grows in states:
        state = states[state.grows]
        yield from state.damages


def _severities(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    """Yield severities that are a slip of the pen from a usual one, or from the name of their state."""
    states: Mapping[str, StateSection] = sections.get("states", {})
    for index, state in states.items():
        usual = [*SEVERITIES, state.name]
        if state.severity in usual:
            continue
        slips = [word for word in usual if _is_slip(state.severity, word)]
        if slips:
            allowed = f"did you mean '{slips[0]}'? allowed: that, or a name that is less like it"
            yield Problem(f"states.{index}.severity", f"'{state.severity}'", allowed)


def _is_slip(word: str, other: str) -> bool:
    """Return whether two words differ by a letter or by two that are exchanged; numbers tell sizes apart."""
    letters = ([letter for letter in one if letter.isalpha()] for one in (word, other))
    if next(letters) == next(letters) or abs(len(word) - len(other)) > 1:
        return False
    return SequenceMatcher(None, word, other).ratio() > 0.8


def _shown_text(state: StateSection) -> str:
    kinds = " and ".join(dict.fromkeys(section.kind_word() for section in state.damages))
    return f"'{state.fault}', with {f'damage of kind {kinds}' if kinds else 'changes alone'}"


def _words_text(words: Sequence[str], fault: str, kinds: Sequence[str]) -> str:
    known = f"allowed: {' or '.join(words) or 'another word'}"
    needed = f"{fault} needs kind: {' or '.join(kinds)}, here or in a milder state"
    return f"{known}; {needed}" if kinds else f"{known}{nearest(fault, words)}"


def _growth_problems(milder: StateSection, state: StateSection, path: str) -> Iterator[Problem]:
    known = all(one.severity in SEVERITIES for one in (milder, state))
    if known and SEVERITIES.index(milder.severity) > SEVERITIES.index(state.severity):
        received = f"'{state.grows}' ({milder.severity}), for a {state.severity} state"
        yield Problem(f"{path}.grows", received, "allowed: a state that is not more severe, or null")
    for where, one in state.placed(path):
        if key := next((key for older in milder.damages if (key := one.key_that_adds_nothing(older))), None):
            nouns = one.nouns or "damage"
            received = f"no {nouns} beyond those of {milder.name}, which this state contains (grows)"
            allowed = f"allowed: more {nouns} than {milder.name} has; or like: {milder.name} in place of grows"
            yield Problem(f"{where}.{key}", received, allowed)
        for problem in (problem for older in milder.damages for problem in one.contradictions(older)):
            yield replace(problem, path=f"{where}.{problem.path}")


def _tooth_indices(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    if "gears" not in sections:
        return
    of_set = sections.get("planetary") is not None
    names = names_in(sections["machine"], planetary=of_set)
    for index, state in sections.get("states", {}).items():
        hit = (
            (f"{path}.{key}", *rest) for path, one in state.placed(f"states.{index}") for key, *rest in one.hit_teeth()
        )
        for path, gear, teeth in ((path, gear, teeth) for path, gear, teeth in hit if gear in names.flanks):
            (mesh, role), selected = names.flanks[gear], most_teeth(teeth)
            ring = sections["planetary"].ring_teeth if of_set and mesh else None
            count = min(pair_of(sections, mesh).teeth_of(role)) if ring is None else ring
            called = names.called(gear)
            if isinstance(selected, int):
                if selected > count:
                    yield Problem(path, repr(selected), f"allowed: at most {count}, the teeth of {called}")
                continue
            allowed = f"allowed: an index from 0 to {count - 1}, {called} has {count} teeth"
            yield from (Problem(path, f"tooth {tooth}", allowed) for tooth in selected if tooth >= count)
