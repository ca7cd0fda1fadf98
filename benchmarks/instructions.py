"""Instructions and cycles of a tried step of the exponential integrator, counted by the processor (Linux `perf`).

Times of a shared machine move by a third from one minute to the next; counted instructions do not.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Iterator

import numpy as np

from benchmarks.precision import PRESETS
from benchmarks.precision_case import precision_case
from benchmarks.row import Row
from benchmarks.shipped import shipped
from siggen.dynamics.time.exponential_motion import ExponentialMotion

SIGNAL_S, ROUNDS = 0.5, 20
STEPS = 2


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield a row without and one with tilt: the severest state of quickstart's first gearbox, two steps per sample."""
    if shutil.which("perf") is None:
        yield Row("instructions of a tried step", "", "needs perf (Linux)")
        return
    for tilt in (False, True):
        motion, loop = _loop(tilt=tilt)
        loop()  # compiles
        tried, rounds = motion.steps_tried, ROUNDS // 4 if quick else ROUNDS
        counted = _counted(loop, rounds)
        what = f"a tried step, face, {'with' if tilt else 'without'} tilt"
        if counted is None:
            yield Row(what, "", "perf counts nothing here")
            continue
        instructions, cycles = (count / (rounds * tried) for count in counted)
        per_sample = tried / (SIGNAL_S * shipped(PRESETS[0]).fs_hz)
        yield Row(
            what, f"{instructions:,.0f} instructions, {cycles:,.0f} cycles", f"tried per sample: {per_sample:.2f}"
        )


def _loop(*, tilt: bool) -> tuple[ExponentialMotion, Callable[[], None]]:
    """Return a motion and what runs its loop over SIGNAL_S from the static start."""
    case = precision_case(PRESETS[0], 0, -1, tilt=tilt)
    motion = case.motion("exponential", STEPS)
    assert isinstance(motion, ExponentialMotion)
    pitches, inputs = case.driven_steps(motion, STEPS, SIGNAL_S)
    path = np.empty((pitches.size, 2 * len(motion.structure.coordinates)))

    def loop() -> None:
        path[0] = motion.start(pitches[0])
        motion.advance(pitches, inputs, path)

    return motion, loop


def _counted(run: Callable[[], None], rounds: int) -> tuple[float, float] | None:
    """Return instructions and cycles of this process while it runs so often; None where they cannot be counted."""
    command = ["perf", "stat", "-x", ",", "-e", "instructions:u,cycles:u", "-p", str(os.getpid())]
    perf = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    time.sleep(0.5)  # until it counts
    for _ in range(rounds):
        run()
    perf.send_signal(signal.SIGINT)
    numbers = [line.split(",")[0] for line in perf.communicate()[1].splitlines()]
    counts = [float(number) for number in numbers if number.isdigit()]
    return (counts[0], counts[1]) if len(counts) == 2 else None
