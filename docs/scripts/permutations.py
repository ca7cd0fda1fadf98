"""False accusations of the audit: `python docs/scripts/permutations.py SET|noise [TURNS] [STATE ...]`.

Takes a generated set, keeps its healthy records and those of the given states, and permutes the states with all that
follows from them among the records of every gearbox, TURNS times. So no label tells anything. In every turn the states
decide anew which record is the reference, and the audit makes its own permutations. What does not depend on states is
computed once: features of every record, and of its difference from every other one of its gearbox. Prints in how many
turns the strongest detector on the signals, the bank counted as one test, has a p-value of 0.05 or less in the first
state, and in how many the audit accuses the set of a leak, with exact 95 % limits (Clopper-Pearson). With `noise` for
SET, sets of 24 gearboxes are drawn whose records are their gearbox's pattern and noise. Leaks: 200 turns at most.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from dataclasses import replace
from typing import Any

import numpy as np

import siggen
from diagnostics.audit.averaged_lines import line_array
from diagnostics.audit.bank import chance_limit
from diagnostics.audit.leaks import separability_findings
from diagnostics.audit.measured_set import MeasuredSet, measured_set, reference_records
from diagnostics.audit.signal_detectors import detectors_on, signal_detectors
from diagnostics.base.single_thread import single_thread
from diagnostics.judging.evaluation import Entry
from diagnostics.signal.innovations import residual_lines
from diagnostics.statistics.evaluation import clopper_pearson
from siggen.keys.column import Role

OF_STATE = (Role.TARGET, Role.CONSEQUENCE)
"""Roles of the labels that follow from the state."""

LEVEL = 0.05
MOST_LEAK_TURNS = 200
"""Named leaks take longer than the bank."""

GEARBOXES, ORDERS, TEETH = 24, 362, 18
"""Of drawn sets."""


def kept(found: MeasuredSet, rows: np.ndarray) -> MeasuredSet:
    """Return records of a measured set, by a mask or by numbers."""
    places = np.arange(len(found.healthy))[rows]
    lists = {name: [getattr(found, name)[k] for k in places] for name in ("waveforms", "sketches")}
    return replace(
        found,
        labels={name: values[rows] for name, values in found.labels.items()},
        values={name: values[rows] for name, values in found.values.items()},
        checksums=found.checksums[rows],
        raw=found.raw.of(places),
        **lists,
    )


def with_permuted_states(found: MeasuredSet, turn: int) -> MeasuredSet:
    """Return the set with states, and labels that follow from them, permuted within gearboxes."""
    rng, specimen = np.random.default_rng(turn), found.labels["specimen_id"]
    place = np.arange(specimen.size)
    for owner in np.unique(specimen):
        rows = np.flatnonzero(specimen == owner)
        place[rows] = rng.permutation(rows)
    moved = {name: values[place] for name, values in found.labels.items() if found.roles.get(name) in OF_STATE}
    return replace(found, labels={**found.labels, **moved})


def drawn(turn: int) -> MeasuredSet:
    """Return two healthy records and one damaged without any effect per gearbox: its pattern and as much noise."""
    rng, specimen = np.random.default_rng(turn), np.repeat(np.arange(GEARBOXES), 3)
    shapes = ((GEARBOXES, 1, ORDERS), (specimen.size, 1, ORDERS))
    pattern, noise = (rng.standard_normal(shape) + 1j * rng.standard_normal(shape) for shape in shapes)
    state = np.tile(["healthy", "again", "damaged"], GEARBOXES)
    labels = {
        "specimen_id": specimen, "state": state, "fault": np.where(state == "damaged", "spalling", "healthy"),
        "teeth_pinion": np.full(specimen.size, TEETH), "speed_hz": np.full(specimen.size, 30.0),
        "torque_nm": np.full(specimen.size, 40.0), "damaged_area_mm2": 1.0 * (state == "damaged"),
    }  # fmt: skip
    values = {"pulses_per_s": np.full((specimen.size, 1), 30.0)}
    lines = (pattern[specimen] + noise).astype(np.complex64)
    nothing = np.zeros((specimen.size, 1), np.int64)
    about = {"teeth": {"pinion": "teeth_pinion"}}
    return MeasuredSet(labels, ("a",), values, (), [list(row) for row in lines], [], nothing, {}, [], about=about)


class Prepared:
    """The bank of a set for any assignment of states: features of records, and of all differences within gearboxes."""

    def __init__(self, found: MeasuredSet) -> None:
        specimen = found.labels["specimen_id"]
        self.first, self.second = np.nonzero((specimen[:, None] == specimen) & ~np.eye(specimen.size, dtype=bool))
        residual = residual_lines(line_array(found.waveforms), found.labels["teeth_pinion"])
        self.alone = detectors_on(found, residual, None, 0, lambda: None)
        known = residual[self.second]
        pairs = kept(found, self.first)
        self.beside = detectors_on(pairs, residual[self.first] - known, known, 0, lambda: None)

    def bank(self, found: MeasuredSet) -> list[Entry]:
        """Return the detectors for the references that the states of a set give."""
        reference = reference_records(found)
        place = np.full(reference.size, -1)
        chosen = np.flatnonzero(self.second == reference[self.first])
        place[self.first[chosen]] = chosen
        beside = [
            replace(
                each,
                X=each.X[place],
                usable=(place >= 0) & each.usable[place],
            )
            for each in self.beside
        ]
        return [*self.alone, *(beside if (place >= 0).any() else [])]


def p_value(found: MeasuredSet, bank: list[Entry], state: str, turn: int) -> float:
    """Return the p-value of the bank on a state, with folds and permutations of their own in every turn."""
    return chance_limit(found, bank, turn, lambda: None).states[state].p_value


def share(count: int, turns: int) -> str:
    """Return a share with its limits."""
    low, high = clopper_pearson(count / turns, turns)
    return f"{count} of {turns}, {count / turns:.1%} ({low:.1%} to {high:.1%})"


def accused_of_leaks(found: MeasuredSet, turns: int) -> None:
    """Print how often the audit names a leak."""
    named, accused = Counter[str](), 0
    for turn in range(turns):
        leaks = [finding.leak for finding in separability_findings(with_permuted_states(found, turn), turn)]
        accused += bool(leaks)
        named.update(leaks)
    print(f"accused of a leak: {share(accused, turns)} {dict(named)}", flush=True)


@single_thread()
def main(path: str, turns: int, states: list[str]) -> None:
    """Print both shares."""
    begin = time.process_time()
    if path == "noise":
        sets = (drawn(turn) for turn in range(turns))
        found = [
            p_value(each, signal_detectors(each, turn, lambda: None), "damaged", turn) for turn, each in enumerate(sets)
        ]
    else:
        every = measured_set(siggen.open(path))
        chosen = kept(every, every.healthy | np.isin(every.labels["state"], states))
        specimen = chosen.labels["specimen_id"]
        print(
            f"{specimen.size} records of {np.unique(specimen).size} gearboxes; states {', '.join(states)}", flush=True
        )
        prepared = Prepared(chosen)
        mixed = (with_permuted_states(chosen, turn) for turn in range(turns))
        found = [p_value(each, prepared.bank(each), states[0], turn) for turn, each in enumerate(mixed)]
    below = int(np.sum(np.array(found) <= LEVEL))
    print(f"p-value of the bank on the signals at most {LEVEL}: {share(below, turns)}; median {np.median(found):.2f}; "
          f"{time.process_time() - begin:.0f} s of CPU", flush=True)  # fmt: skip
    if path != "noise":
        accused_of_leaks(chosen, min(turns, MOST_LEAK_TURNS))


if __name__ == "__main__":
    given: list[Any] = sys.argv[1:]
    main(given[0], int(given[1]) if len(given) > 1 else 200, given[2:] or ["slight", "face_20"])
