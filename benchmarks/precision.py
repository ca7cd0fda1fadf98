"""Precision: errors by class with the steps that the tolerance asks for, and work against precision by law.

Errors by class are of the delivered accelerations against Runge-Kutta with REFERENCE_STEPS steps per sample, behind the
same low-pass: the median over all motions of a record of the relative rms difference. Work against precision is told in
`work_precision`. Costs are CPU time of the loop alone, per second of signal.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict

import numpy as np

from benchmarks.precision_case import Case, linear_case, precision_case, state_grid
from benchmarks.row import Row, duration_text
from benchmarks.shipped import ROOT
from benchmarks.work_precision import COMPILED, PLAIN, Point, equal_cost_s, steps_text, work_points
from siggen.motion.exponential_motion import ExponentialMotion
from siggen.motion.response import Response

PRESETS = (ROOT / "configs" / "quickstart.yaml", ROOT / "configs" / "bench.yaml")
REFERENCE_STEPS = 32
SETTLED = 1.8
"""Transients before the reference, which starts without the deflection of a softly held load by friction."""
GOAL_S = 0.025
"""Of the loop with tilt."""
GOAL_ERROR, GOAL_FACTOR = 1e-3, 1.5
LAWS = {"face, without tilt": False, "face, with tilt": True}
LINEAR = "linear, 8 coordinates"
LINEAR_GOAL_S, LINEAR_GOAL_ERROR = 0.006, 1e-4
GAINS = {PLAIN: 12.0, COMPILED: 10.0}
LINEAR_GAINS = {PLAIN: 30.0, "LSODA": 1000.0}
"""How many times cheaper than another method at equal error."""


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield work against precision of every law, then errors by class."""
    for law, tilt in LAWS.items():
        yield from _work_rows(precision_case(PRESETS[0], 0, -1, tilt=tilt), law, quick)
    yield from _work_rows(linear_case(0, -1), LINEAR, quick)
    yield from _classes(1 if quick else 6)


def _work_rows(case: Case, law: str, quick: bool) -> Iterator[Row]:
    """Yield the points of all methods, and how many times cheaper the steps of the rule are at equal error."""
    points, rule = list(work_points(case, quick=quick)), (case.method, steps_text(case.own_steps()))
    own = next(point for point in points if (point.method, point.setting) == rule)
    for point in points:
        error = f"error {point.error:.1e}" if point.error < 1.0 else "diverges"
        what = f"{law}, severe state: {point.method}, {point.setting}"
        yield Row(
            what, f"{duration_text(point.cost_s)}, {error}", numbers={"law": law, "rule": point is own, **asdict(point)}
        )
    if law == LINEAR:
        met = own.cost_s <= LINEAR_GOAL_S and own.error <= LINEAR_GOAL_ERROR
        goal = f"<= {duration_text(LINEAR_GOAL_S)}, {LINEAR_GOAL_ERROR:g}"
        what = f"{law}: {own.method} with the steps of the file ({own.setting}), time loop per s of signal"
        yield Row(what, f"{duration_text(own.cost_s)}, error {own.error:.1e}", goal=goal, met=met)
    for method in dict.fromkeys(point.method for point in points if point.method != case.method):
        yield _gain_row(law, own, [point for point in points if point.method == method])


def _gain_row(law: str, own: Point, others: Sequence[Point]) -> Row:
    """Return the row of the steps of the rule beside another method at the same error."""
    method = others[0].method
    cost, reached = equal_cost_s(others, own.error)
    errors = [point.error for point in others if np.isfinite(point.error)]
    where = f"at its error of {own.error:.1e}" if reached else f"gets no nearer than {min(errors):.1e}"
    if max(errors) < own.error:
        where = f"never as coarse, {max(errors):.1e} at its loosest"
    wanted = (LINEAR_GAINS if law == LINEAR else GAINS).get(method)
    return Row(
        f"{law}: {own.method}, {own.setting} as {'the file says' if law == LINEAR else 'the rule asks'}",
        duration_text(own.cost_s), f"{method}, {where}: {duration_text(cost)}", cost / own.cost_s,
        "" if wanted is None else f">= {wanted:g} times", None if wanted is None else cost >= wanted * own.cost_s,
        numbers={"law": law, "method": own.method, "beside": method, "gain": cost / own.cost_s},
    )  # fmt: skip


def _classes(gearboxes: int) -> Iterator[Row]:
    """Yield the errors of the healthy and of the severest state over gearboxes of all presets, and what they cost."""
    errors: dict[str, list[float]] = {"healthy": [], "severest": []}
    costs, tried = [], []
    for preset in PRESETS:
        for gearbox in range(gearboxes):
            for name, state in (("healthy", 0), ("severest", -1)):
                case = precision_case(preset, gearbox, state)
                steps = case.own_steps()
                settled = SETTLED * case.motion("runge_kutta", 1).transient_s
                fine = case.response("runge_kutta", REFERENCE_STEPS, settled)
                errors[name].append(_error(case.response("exponential", steps), fine))
                costs.append(case.loop_s("exponential", steps))
                tried.append(_attempts(case, steps))
    for name, found in errors.items():
        median = float(np.median(found))
        yield Row(
            f"face, {name}, {len(found)} records: error (median over motions)",
            f"median {median:.1e}, largest {max(found):.1e}", goal=f"<= {GOAL_ERROR:g}", met=max(found) <= GOAL_ERROR,
        )  # fmt: skip
    medians = [float(np.median(found)) for found in errors.values()]
    factor = max(medians) / min(medians)
    yield Row(
        "face: medians of the classes, factor", f"{factor:.2f}", goal=f"<= {GOAL_FACTOR}", met=factor <= GOAL_FACTOR
    )
    cost, goal = float(np.median(costs)), GOAL_S
    what = f"face: time loop per s of signal, {np.median(tried):.2f} steps tried per sample"
    yield Row(what, duration_text(cost), goal=f"<= {duration_text(goal)}", met=cost <= goal)


def _attempts(case: Case, steps: int) -> float:
    """Return how many steps are tried per sample."""
    motion = case.motion("exponential", steps)
    assert isinstance(motion, ExponentialMotion)
    pitches, inputs = case.driven_steps(motion, state_grid("exponential", steps).per_sample, 0.2)
    path = np.empty((pitches.size, 2 * len(motion.structure.coordinates)))
    path[0] = motion.start(pitches[0])
    motion.advance(pitches, inputs, path)
    return motion.steps_tried / (0.2 * case.config.fs_hz)


def _error(found: Response, wanted: Response) -> float:
    """Return the median over the motions of the relative rms difference."""
    errors = []
    for name, values in wanted.acceleration_m_s2.items():
        apart = found.acceleration_m_s2[name] - values
        errors.append(float(np.sqrt(np.mean(apart**2) / np.mean(values**2))))
    return float(np.median(errors))
