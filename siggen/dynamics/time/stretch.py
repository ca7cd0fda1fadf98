"""A stretch of a motion at the output rate, from a state that is at hand: to compare steps before a record is made."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.time.decimation import half_length
from siggen.dynamics.time.response_filters import acceleration_decimator
from siggen.dynamics.time.response_stream import Run, stepped_blocks

LEAD = half_length(1)
"""Samples that the low-pass reaches to either side, at any number of steps per sample."""


class Stretch(NamedTuple):
    """So many samples from `first` on; the motion begins LEAD samples before."""

    first: int
    samples: int


def state_at(run: Run, first: int, until: int) -> FloatArray:
    """Return the state (2n,) LEAD samples before sample `until` of a motion that starts as many before `first`.

    Raises
    ------
    SolverFailure
        If the motion diverges.
    """
    steps = run.steps_per_sample
    state = run.motion.start(run.pitches((first - LEAD) * steps, 1)[0])
    for _ in stepped_blocks(run, state, (first - LEAD) * steps, (until - LEAD) * steps):
        pass
    return state


class Seen(NamedTuple):
    """Accelerations (motions, samples) of a stretch, and whether no teeth of a mesh touched at one of its steps."""

    accelerations: FloatArray
    parts: bool


def seen_stretch(run: Run, state: FloatArray, stretch: Stretch) -> Seen:
    """Return what is seen of a stretch from the `state` (2n,) LEAD samples before it.

    Raises
    ------
    SolverFailure
        If the motion diverges.
    """
    steps = run.steps_per_sample
    decimator = acceleration_decimator(run.motion.structure, run.motions, run.fs_hz, steps)
    begin, end = (stretch.first - LEAD) * steps, (stretch.first + stretch.samples + LEAD) * steps
    skipped, taken, parts = LEAD * steps - half_length(steps), [], False
    for block in stepped_blocks(run, state.copy(), begin, end):
        taken.append(decimator.take(block.states[skipped:]))
        parts = parts or (block.apart is not None and bool(block.apart.any()))
        skipped = 0
    return Seen(np.concatenate(taken, axis=1)[:, : stretch.samples], parts)
