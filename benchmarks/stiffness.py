"""Mesh stiffness: healthy curve, curve with a pitted tooth, tables of a damaged gearbox; compiled, nothing cached.

Every call gets a module of its own (1e-6 apart) and pits of its own, so that no cache of siggen can answer it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from importlib.metadata import version
from math import pi

import numpy as np

from benchmarks.quadrature import mesh_stiffness_by_quad, pair_stiffness_by_quad
from benchmarks.row import Row, cost_row, duration_text
from benchmarks.shipped import QUICKSTART, ROOT, shipped
from benchmarks.timing import Candidate, medians
from siggen.config import Config
from siggen.gears.damage.tooth_damage import Damage
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.mesh_stiffness import StiffnessOptions, mesh_stiffness
from siggen.gears.stiffness.mesh_tables import mesh_tables
from siggen.planning.specimen import draw_specimen
from siggen.record.specimen_state import specimen_state
from siggen.specimen.damage import state_damage
from siggen.specimen.gears import gear_pair
from siggen.specimen.made_gears import MadeGears

OPTIONS = StiffnessOptions("rack_trochoid", "sainsot")
POINTS = 1000
TABLE_POINTS = 2049
FEW = 10
"""Points that quad computes; its cost is scaled up to all of them."""
HEALTHY_GOAL_S, PITTED_GOAL_S, TABLES_GOAL_S, CROWDED_GOAL_S = 2e-3, 10e-3, 100e-3, 1.0
PITTED_STATE = 3
FIRST = 1
"""Number of the first measured call; call 0 compiles."""


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield CPU times of curves and tables beside quad, and of the healthy curve beside ROSS."""
    rounds = 3 if quick else 15
    yield _healthy_row(rounds)
    yield _ross_row(rounds)
    yield _pitted_row(rounds)
    yield _tables_row(rounds)
    yield _crowded_row(3 if quick else 5)


def gear_pair_number(number: int) -> GearPair:
    """Return the gear pair of the quickstart with a module that no other number has."""
    pair = _quickstart_pair()
    module = pair.pinion.module_m * (1.0 + 1e-6 * number)
    return replace(pair, pinion=replace(pair.pinion, module_m=module), gear=replace(pair.gear, module_m=module))


@cache
def _quickstart_pair() -> GearPair:
    return gear_pair(draw_specimen(shipped(QUICKSTART), 0).gears)


def pits_number(number: int, teeth: int, per_tooth: int) -> Damage:
    """Return dished pits on neighbouring pinion teeth, scattered over the flank; other ones for every number."""
    return state_damage(_pitted_config(teeth, per_tooth), number, gear_pair_number(number), PITTED_STATE)


@cache
def _pitted_config(teeth: int, per_tooth: int) -> Config:
    state = f"states.{PITTED_STATE}"
    sizes = {"teeth": teeth, "count": per_tooth, "spread_profile_mm": 1.0}
    axes = {"semi_axis_face_mm": 0.3, "semi_axis_profile_mm": 0.2}
    values = [f"{state}.damage.{name}={value}" for name, value in {**sizes, **axes}.items()]
    return shipped(QUICKSTART, f"{state}.grows_from=none", *values)


def _angles(pair: GearPair, tooth: int) -> np.ndarray:
    """Return POINTS angles over the pitch that begins when `tooth` enters contact (POINTS,) [rad]."""
    return 2.0 * pi / pair.pinion.teeth * (tooth + np.arange(POINTS) / POINTS)


def _healthy_row(rounds: int) -> Row:
    pairs = [gear_pair_number(i) for i in range(FIRST + 4 * rounds)]
    pick = slice(0, POINTS, POINTS // FEW)

    def own(i: int) -> np.ndarray:
        return mesh_stiffness(pairs[i], _angles(pairs[i], 0), OPTIONS)

    def by_quad(i: int) -> np.ndarray:
        return np.array([mesh_stiffness_by_quad(pairs[i], a) for a in _angles(pairs[i], 0)[pick]])

    difference = _difference(own(0)[pick], by_quad(0))
    cost = medians({"own": Candidate(own, 4), "quad": Candidate(by_quad)}, rounds, first=FIRST)
    name = f"quad ({FEW} points, scaled; differs {difference:.0e})"
    return cost_row(f"healthy curve, {POINTS} points", cost["own"], name, cost["quad"] * POINTS / FEW, HEALTHY_GOAL_S)


def _ross_row(rounds: int) -> Row:
    what = f"healthy curve, {POINTS} points"
    try:
        from benchmarks.ross_stiffness import healthy_curve
    except ImportError:
        return Row(what, "", "ROSS: not installed (pip install ross-rotordynamics 'plotly<6')")
    pairs = [gear_pair_number(i) for i in range(FIRST + 4 * rounds)]

    def own(i: int) -> np.ndarray:
        return mesh_stiffness(pairs[i], _angles(pairs[i], 0), OPTIONS)

    ratio = float(np.mean(healthy_curve(pairs[0], POINTS)()) / np.mean(own(0)))
    curve = healthy_curve(pairs[1], POINTS)
    cost = medians({"own": Candidate(own, 4), "ross": Candidate(lambda _: curve())}, min(rounds, 3), first=FIRST)
    name = f"ROSS {version('ross-rotordynamics')} (mean {ratio:.2f} of siggen's)"
    return cost_row(what, cost["own"], name, cost["ross"], HEALTHY_GOAL_S)


def _pitted_row(rounds: int) -> Row:
    pairs = [gear_pair_number(i) for i in range(FIRST + 2 * rounds)]
    damages = [pits_number(i, 1, 30) for i in range(FIRST + 2 * rounds)]
    pick = slice(0, POINTS, POINTS // FEW)

    def own(i: int) -> np.ndarray:
        return mesh_stiffness(pairs[i], _angles(pairs[i], damages[i][0].tooth), OPTIONS, damages[i])

    def by_quad(i: int) -> np.ndarray:
        angles = _angles(pairs[i], damages[i][0].tooth)[pick]
        return np.array([mesh_stiffness_by_quad(pairs[i], a, damages[i]) for a in angles])

    difference = _difference(own(0)[pick], by_quad(0))
    cost = medians({"own": Candidate(own, 2), "quad": Candidate(by_quad)}, rounds, first=FIRST)
    what = f"curve with 30 random pits on a tooth, {POINTS} points"
    name = f"quad ({FEW} points, scaled; differs {difference:.0e})"
    return cost_row(what, cost["own"], name, cost["quad"] * POINTS / FEW, PITTED_GOAL_S)


def _tables_row(rounds: int) -> Row:
    pairs = [gear_pair_number(i) for i in range(FIRST + rounds)]
    damages = [pits_number(i, 5, 100) for i in range(FIRST + rounds)]
    pick = slice(0, TABLE_POINTS - 1, TABLE_POINTS // FEW)

    def own(i: int) -> np.ndarray:
        return mesh_tables(pairs[i], damages[i], OPTIONS, TABLE_POINTS).pair_stiffness_n_per_m

    def by_quad(i: int) -> np.ndarray:
        positions = np.linspace(pairs[i].contact_start_m, pairs[i].contact_end_m, TABLE_POINTS)[pick]
        return np.stack([pair_stiffness_by_quad(pairs[i], damages[i], s) for s in positions.tolist()], axis=1)

    difference = _difference(own(0)[:, pick], by_quad(0))
    cost = medians({"own": Candidate(own), "quad": Candidate(by_quad)}, rounds, first=FIRST)
    what = f"tables, 5 teeth of 100 random pits, {TABLE_POINTS} points"
    name = f"quad ({FEW} points, scaled; differs {difference:.0e})"
    return cost_row(what, cost["own"], name, cost["quad"] * TABLE_POINTS / FEW, TABLES_GOAL_S)


def _crowded_row(rounds: int) -> Row:
    """Return what tables and labels of a tooth with very many pits cost, across the face and with tilt."""
    state = (
        "{name: crowded, severity: severe, damage: {kind: clustered, teeth: 1, count: 1200, spread_profile_mm: 1.0, "
    )
    state += "semi_axis_face_mm: 0.3, semi_axis_profile_mm: 0.2, depth_mm: 0.1}}"
    config = shipped(ROOT / "configs" / "quickstart.yaml", f"states=[{{name: healthy, severity: healthy}}, {state}]")
    specimens = [draw_specimen(config, number) for number in range(FIRST + rounds)]
    gears = [MadeGears(config, specimen) for specimen in specimens]
    for specimen, made in zip(specimens, gears, strict=True):
        specimen_state(config, specimen, 0, made)

    def own(i: int) -> object:
        return specimen_state(config, specimens[i], 1, gears[i])

    own(0)
    cost_s = medians({"own": Candidate(own)}, rounds, first=FIRST)["own"]
    what = "tables and labels of a state with 1,200 pits on a tooth"
    return Row(what, duration_text(cost_s), goal=f"<= {duration_text(CROWDED_GOAL_S)}", met=cost_s <= CROWDED_GOAL_S)


def _difference(own: np.ndarray, other: np.ndarray) -> float:
    return float(np.max(np.abs(own / other - 1.0)))
