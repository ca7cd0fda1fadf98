"""Lanes: eight doubles in one vector register, for compiled loops whose vectorising no compiler finds by itself.

Every operation is that of IEEE 754 on each lane by itself, in the order written: lanes have the bytes of the scalars
that they stand for. Machines with registers of four or two doubles take several for one value; bytes stay the same.
numba knows no such type; it is told here how to lower it. Only compiled code may call these functions. Most of them
take a scalar as well, and do with it what they do with a lane: a law is written once, for one value and for eight.
"""

from typing import Any

from siggen.lanes.functions import (
    aligned,
    any_of,
    as_doubles,
    bits,
    extract,
    gather,
    gather_between,
    gather_pairs,
    hyperbolic_tangent,
    insert,
    larger,
    load,
    load_like,
    logarithm,
    magnitude,
    scalar_at,
    select,
    shuffle,
    smaller,
    splat,
    splat_of,
    square_root,
    store,
    truncated,
)
from siggen.lanes.kinds import LANES

Lanes = Any
Whole = Any
Choice = Any
"""Eight doubles, integers and truths; checkers see nothing of them: no such object exists outside compiled code."""

__all__ = [
    "LANES",
    "Choice",
    "Lanes",
    "Whole",
    "aligned",
    "any_of",
    "as_doubles",
    "bits",
    "extract",
    "gather",
    "gather_between",
    "gather_pairs",
    "hyperbolic_tangent",
    "insert",
    "larger",
    "load",
    "load_like",
    "logarithm",
    "magnitude",
    "scalar_at",
    "select",
    "shuffle",
    "smaller",
    "splat",
    "splat_of",
    "square_root",
    "store",
    "truncated",
]
