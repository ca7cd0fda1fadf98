"""Lanes: the pair law over records side by side, by numba's vectoriser and with explicit vectors, and what both give.

The spring of the contact across the face (`contact_spring`, without tilt) at random approaches and positions: one
record after the other with branches; in groups of LANES with selections, all in one loop and with the reads of the
table apart from the arithmetic; and the same selections with the vector type of `siggen.lanes`. All give the same
bytes. What the compiler made of them is read off the machine code: instructions on packed doubles, and gathers.

Lanes of the time loop are the pairs of one step (`lane_forces`). Records side by side would share only what is scalar
there: their bound is Amdahl's law with the gain measured here.
"""

from __future__ import annotations

import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numba import njit

from benchmarks.row import Row
from siggen.arrays import FloatArray
from siggen.lanes import LANES, as_doubles, gather, larger, load, select, smaller, square_root, store, truncated

RECORDS, ROUNDS = 4096, 60
NODES, COLUMNS, VALUES = 24, 400, 4
REACH_M = 40e-6
GOAL_GAIN = 1.5
ASKED = """
import llvmlite.binding
for kind in ("", "-missed", "-analysis"):
    llvmlite.binding.set_option("", f"-pass-remarks{kind}=loop-vectorize")
from benchmarks import lanes
lanes.forces()
"""
"""Compiles the forms in a process that hears what the vectoriser says."""


@njit(error_model="numpy", forceinline=True)
def _at(table: FloatArray, place: int) -> float:
    """Return one number; a place is never negative, which the compiler cannot know of a signed one."""
    value: float = table[np.uint64(place)]
    return value


@njit(error_model="numpy")
def _one_by_one(table: FloatArray, approach: FloatArray, column: FloatArray, force: FloatArray) -> None:
    """Write the forces (records,), one record after the other: a plain spring by branches, as of `contact_spring`."""
    unit = REACH_M / ((NODES - 1.0) * (NODES - 1.0))
    for i in range(approach.size):
        depth = approach[i]
        if not depth > 0.0:
            force[i] = 0.0
            continue
        root = np.sqrt(depth / unit)
        node = int(root) if root < NODES - 1.0 else NODES - 2
        span = unit * (2.0 * node + 1.0)
        over = depth - unit * (node * node)
        t = over / span
        whole = int(column[i])
        share = column[i] - whole
        here = (whole * NODES + node) * VALUES
        there = here + NODES * VALUES
        f_0 = _at(table, here) * (1.0 - share) + _at(table, there) * share
        f_1 = _at(table, here + VALUES) * (1.0 - share) + _at(table, there + VALUES) * share
        s_0 = _at(table, here + 1) * (1.0 - share) + _at(table, there + 1) * share
        s_1 = _at(table, here + VALUES + 1) * (1.0 - share) + _at(table, there + VALUES + 1) * share
        if t > 1.0:
            force[i] = f_1 + s_1 * (over - span)
        else:
            rise = (f_1 - f_0) / span
            force[i] = f_0 + over * (s_0 + t * (3.0 * rise - 2.0 * s_0 - s_1 + t * (s_0 + s_1 - 2.0 * rise)))


@njit(error_model="numpy")
def _together(table: FloatArray, approach: FloatArray, column: FloatArray, force: FloatArray) -> None:
    """Write the same with selections in place of branches, LANES records in one loop of constant length."""
    unit = REACH_M / ((NODES - 1.0) * (NODES - 1.0))
    for first in range(0, approach.size, LANES):
        for lane in range(LANES):
            i = first + lane
            depth = max(approach[i], 0.0)
            node = min(int(np.sqrt(depth / unit)), NODES - 2)
            span = unit * (2.0 * node + 1.0)
            over = depth - unit * (node * node)
            t = over / span
            whole = int(column[i])
            share = column[i] - whole
            here = (whole * NODES + node) * VALUES
            there = here + NODES * VALUES
            f_0 = _at(table, here) * (1.0 - share) + _at(table, there) * share
            f_1 = _at(table, here + VALUES) * (1.0 - share) + _at(table, there + VALUES) * share
            s_0 = _at(table, here + 1) * (1.0 - share) + _at(table, there + 1) * share
            s_1 = _at(table, here + VALUES + 1) * (1.0 - share) + _at(table, there + VALUES + 1) * share
            rise = (f_1 - f_0) / span
            inside = f_0 + over * (s_0 + t * (3.0 * rise - 2.0 * s_0 - s_1 + t * (s_0 + s_1 - 2.0 * rise)))
            found = f_1 + s_1 * (over - span) if t > 1.0 else inside
            force[i] = found if approach[i] > 0.0 else 0.0


@njit(error_model="numpy")
def _apart(table: FloatArray, approach: FloatArray, column: FloatArray, force: FloatArray) -> None:
    """Write the same with the reads of the table in a loop of their own, before the arithmetic."""
    unit = REACH_M / ((NODES - 1.0) * (NODES - 1.0))
    places, shares = np.empty(LANES, dtype=np.int64), np.empty(LANES)
    spans, overs, read = np.empty(LANES), np.empty(LANES), np.empty((8, LANES))
    for first in range(0, approach.size, LANES):
        for lane in range(LANES):
            depth = max(approach[first + lane], 0.0)
            node = min(int(np.sqrt(depth / unit)), NODES - 2)
            spans[lane], overs[lane] = unit * (2.0 * node + 1.0), depth - unit * (node * node)
            whole = int(column[first + lane])
            shares[lane] = column[first + lane] - whole
            places[lane] = (whole * NODES + node) * VALUES
        for lane in range(LANES):
            here = places[lane]
            there = here + NODES * VALUES
            read[0, lane], read[1, lane] = _at(table, here), _at(table, there)
            read[2, lane], read[3, lane] = _at(table, here + VALUES), _at(table, there + VALUES)
            read[4, lane], read[5, lane] = _at(table, here + 1), _at(table, there + 1)
            read[6, lane], read[7, lane] = _at(table, here + VALUES + 1), _at(table, there + VALUES + 1)
        for lane in range(LANES):
            share, span, over = shares[lane], spans[lane], overs[lane]
            f_0 = read[0, lane] * (1.0 - share) + read[1, lane] * share
            f_1 = read[2, lane] * (1.0 - share) + read[3, lane] * share
            s_0 = read[4, lane] * (1.0 - share) + read[5, lane] * share
            s_1 = read[6, lane] * (1.0 - share) + read[7, lane] * share
            t, rise = over / span, (f_1 - f_0) / span
            inside = f_0 + over * (s_0 + t * (3.0 * rise - 2.0 * s_0 - s_1 + t * (s_0 + s_1 - 2.0 * rise)))
            found = f_1 + s_1 * (over - span) if t > 1.0 else inside
            force[first + lane] = found if approach[first + lane] > 0.0 else 0.0


@njit(error_model="numpy")
def _explicit(table: FloatArray, approach: FloatArray, column: FloatArray, force: FloatArray) -> None:
    """Write the same with explicit vectors."""
    unit = REACH_M / ((NODES - 1.0) * (NODES - 1.0))
    for first in range(0, approach.size, LANES):
        given, place = load(approach, first), load(column, first)
        depth = larger(given, 0.0)
        node = smaller(truncated(square_root(depth / unit)), NODES - 2)
        count = as_doubles(node)
        span, over = unit * (2.0 * count + 1.0), depth - unit * (count * count)
        t, whole = over / span, truncated(place)
        share = place - as_doubles(whole)
        here = (whole * NODES + node) * VALUES
        there = here + NODES * VALUES
        f_0 = gather(table, here) * (1.0 - share) + gather(table, there) * share
        f_1 = gather(table, here + VALUES) * (1.0 - share) + gather(table, there + VALUES) * share
        s_0 = gather(table, here + 1) * (1.0 - share) + gather(table, there + 1) * share
        s_1 = gather(table, here + (VALUES + 1)) * (1.0 - share) + gather(table, there + (VALUES + 1)) * share
        rise = (f_1 - f_0) / span
        inside = f_0 + over * (s_0 + t * (3.0 * rise - 2.0 * s_0 - s_1 + t * (s_0 + s_1 - 2.0 * rise)))
        found = select(t > 1.0, f_1 + s_1 * (over - span), inside)
        store(force, first, select(given > 0.0, found, 0.0))


FORMS = {
    "one record after the other": _one_by_one, "8 together": _together, "8 together, reads apart": _apart,
    "8 together, explicit vectors": _explicit,
}  # fmt: skip


def _given() -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return a table, approaches and places among its columns."""
    rng = np.random.default_rng(7)
    table = np.cumsum(rng.random(COLUMNS * NODES * VALUES))
    return table, rng.uniform(-0.1, 1.1, RECORDS) * REACH_M, rng.uniform(0.0, COLUMNS - 1.001, RECORDS)


def forces() -> list[FloatArray]:
    """Return the forces (records,) in every form."""
    found = [np.empty(RECORDS) for _ in FORMS]
    for kernel, force in zip(FORMS.values(), found, strict=True):
        kernel(*_given(), force)
    return found


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the cost of an evaluation in every form, and what the vectoriser made of it."""
    table, approach, column = _given()
    results, costs = forces(), []
    for (name, kernel), force in zip(FORMS.items(), results, strict=True):
        costs.append(_cost_s(lambda k=kernel, f=force: k(table, approach, column, f), 3 if quick else 9))  # type: ignore[misc]
        gain, asked_for = costs[0] / costs[-1], kernel is _explicit
        yield Row(
            f"pair law from the table, {name}", f"{1e9 * costs[-1]:.1f} ns per record; {_packed(kernel)}",
            "one record after the other", gain,
            f"gain >= {GOAL_GAIN}" if asked_for else "", gain >= GOAL_GAIN if asked_for else None,
        )  # fmt: skip
    asked = subprocess.run([sys.executable, "-c", ASKED], capture_output=True, text=True, check=True)
    said = dict.fromkeys(
        line.split(":0:0: ")[1].split(". ")[0] for line in asked.stderr.splitlines() if ":0:0: " in line
    )
    yield Row("the vectoriser on these loops", "; ".join(said) or "nothing")
    same = all(result.tobytes() == results[0].tobytes() for result in results)
    yield Row("pair law from the table: all forms give the same bytes", "yes" if same else "no", goal="yes", met=same)


def _cost_s(call: Callable[[], None], rounds: int) -> float:
    """Return the CPU time per record, the median of some rounds."""
    found = []
    for _ in range(rounds):
        begin = time.process_time()
        for _ in range(ROUNDS):
            call()
        found.append((time.process_time() - begin) / (ROUNDS * RECORDS))
    return float(np.median(found))


def _packed(kernel: Any) -> str:
    """Say how many instructions of the machine code work on packed doubles, and how many gather."""
    (code,) = kernel.inspect_asm().values()
    packed = len(re.findall(r"\bv(?:f?n?madd\w*|mul|div|sqrt|add|sub)\w*pd\b", code))
    scalar = len(re.findall(r"\bv(?:f?n?madd\w*|mul|div|sqrt|add|sub)\w*sd\b", code))
    return f"{packed} packed and {scalar} scalar operations, {len(re.findall(r'vp?gather', code))} gathers"
