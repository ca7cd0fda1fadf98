"""Trap: the state can be told from a condition of the record (speed, noise floor, path ...) without its signal.

Mutual information between state and a binned column, against the same with permuted states. What is permuted is the
state of whole cells (specimen, state), within specimens that have several states and among specimens otherwise, since
records of a cell are not independent. Source: standard literature; the permutation scheme derived.

Trap: one draw of manufacturing errors for all healthy specimens, seen in the labels or in the averaged waveforms.

Waveforms of two specimens are compared by the phases of their sidebands, shifted against each other by every angle:
amplitudes differ with speed and supports even for equal errors. Of k independent phases the mean phasor exceeds r with
probability exp(-k r^2) at one angle (Rayleigh), which sets the bound for all angles and pairs. Source: derived.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from diagnostics.audit.finding import MEND as GENERAL_MEND
from diagnostics.audit.finding import MENDS, Finding, must_not_tell
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.base.seeding import Purpose, generator
from siggen.keys.column import Role

HARMONICS, SIDEBANDS = 5, 6
ANGLES = 2048
FEWEST_LINES = 16
LEAST_LIKENESS = 0.8
CHANCE = 1e-3
SHARE_ALLOWED = 0.1
MOST_SPECIMENS = 24
"""Pairs among the first specimens are enough to see one draw for all."""

MANUFACTURE = "manufacture"
MEND = "Draw the manufacturing errors anew for every specimen."

CHANGED = "changed_keys"
"""Label of what a state changes on purpose."""

BINS = 8
PERMUTATIONS = 200
LARGEST_DEVIATIONS = 5.0
"""Standard deviations of the permuted values: one column in 3 million exceeds that by chance, were they normal."""

LARGEST_EXCESS = 0.03
"""Share of the state's entropy beyond chance; less is a tie nobody could use."""

MEASURED_COLUMNS = {"samples": "duration_s", "pulses_per_s": "operating_points", "start_turn": "operating_points"}
"""Conditions read off signals and pulses, in case a label is missing or wrong, and the section that draws them."""


def error_draws(measured: MeasuredSet) -> list[Finding]:
    """Return a finding for equal error labels and one for equal averaged waveforms of healthy specimens."""
    return [*equal_error_labels(measured), *equal_waveforms(measured)]


def equal_error_labels(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if the error labels of all healthy specimens agree though they are not zero."""
    healthy = measured.healthy
    _, first = np.unique(measured.labels["specimen_id"][healthy], return_index=True)
    names = [name for name, section in measured.sections.items() if section == MANUFACTURE and name in measured.labels]
    columns = {name: measured.labels[name][healthy][first] for name in names}
    numeric = {name: column for name, column in columns.items() if column.dtype.kind in "fiu" and np.any(column != 0)}
    varied = [name for name, column in numeric.items() if len(set(column.tolist())) > 1]
    if len(first) < 2 or not numeric or varied:
        return []
    return [
        Finding(
            "one_error_draw",
            f"all {len(first)} healthy specimens have the same {', '.join(sorted(numeric)[:4])}",
            "specimens must differ",
            MEND,
        )
    ]


def equal_waveforms(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if averaged waveforms of healthy specimens agree after a rotation more often than allowed."""
    healthy = np.flatnonzero(measured.healthy)
    _, first = np.unique(measured.labels["specimen_id"][healthy], return_index=True)
    chosen = healthy[first][:MOST_SPECIMENS]
    pairs = list(combinations(chosen.tolist(), 2))
    judged = [
        (found, lines)
        for a, b in pairs
        for found, lines in [likeness(_sidebands(measured, a), _sidebands(measured, b))]
        if lines >= FEWEST_LINES
    ]
    alike = sum(found > max(LEAST_LIKENESS, chance_bound(lines, len(pairs))) for found, lines in judged)
    if not judged or alike / len(judged) <= SHARE_ALLOWED:
        return []
    return [
        Finding(
            "one_error_draw",
            f"{alike} of {len(judged)} pairs of healthy specimens have the same averaged waveform up to a rotation "
            f"(mean likeness of sideband phases {np.mean([found for found, _ in judged]):.2f})",
            f"a pair counts from likeness {LEAST_LIKENESS:g}, at most {SHARE_ALLOWED:.0%} of the pairs are allowed",
            MEND,
        )
    ]


def _sidebands(measured: MeasuredSet, record: int) -> dict[int, complex]:
    """Return the sidebands of the first channel that stand above its weaker lines, by order."""
    waveform, teeth = measured.waveforms[record][0], int(measured.teeth[record])
    offsets = [k * sign for k in range(1, SIDEBANDS + 1) for sign in (-1, 1)]
    orders = [h * teeth + k for h in range(1, HARMONICS + 1) for k in offsets if h * teeth + k < waveform.size]
    # the median over all orders is the noise left in the average: most orders carry no strong line
    floor = float(np.median(np.abs(waveform))) if waveform.size else 0.0
    return {order: complex(waveform[order]) for order in orders if abs(waveform[order]) > 2.0 * floor}


def likeness(first: dict[int, complex], second: dict[int, complex]) -> tuple[float, int]:
    """Return the largest mean phasor of the common lines over all rotations, and how many lines there are."""
    orders = sorted(first.keys() & second.keys())
    if not orders:
        return 0.0, 0
    product = np.array([first[order] * np.conj(second[order]) for order in orders])
    grid = np.zeros(ANGLES, dtype=np.complex128)
    np.add.at(grid, np.array(orders) % ANGLES, product / np.abs(product))
    return float(np.abs(np.fft.fft(grid)).max()) / len(orders), len(orders)


def chance_bound(lines: int, pairs: int) -> float:
    """Return the mean phasor that independent phases exceed anywhere in all pairs with probability 0.001."""
    return math.sqrt(math.log(ANGLES * max(pairs, 1) / CHANCE) / lines)


@dataclass(frozen=True, slots=True)
class Tie:
    """Share of the state's entropy that a column tells: observed, mean and spread of permutations."""

    column: str
    observed: float
    chance: float
    spread: float

    @property
    def is_found(self) -> bool:
        """Whether the column tells more than chance explains, and enough to matter."""
        excess = self.observed - self.chance
        return bool(excess > LARGEST_EXCESS and excess > LARGEST_DEVIATIONS * self.spread)


def state_ties(measured: MeasuredSet, seed: int = 0) -> list[Finding]:
    """Return one finding for the columns of each section that tell the state."""
    return [_finding(group, ties) for group, ties in tied_columns(measured, seed).items()] + failed_states(measured)


def tied_columns(measured: MeasuredSet, seed: int = 0) -> dict[str, list[Tie]]:
    """Return the columns that tell the state, by section of the configuration, else by role.

    States that change keys of the machine tell by design.
    """
    kept = unchanged(measured)
    state = _codes(measured.labels["state"][kept])
    if state.max(initial=0) == 0:
        return {}
    specimen = _codes(measured.labels["specimen_id"][kept])
    permuted = permuted_states(state, specimen, seed)
    found: dict[str, list[Tie]] = {}
    for name, values in _columns(measured).items():
        tie = strongest_tie(name, values[kept], state, specimen, permuted)
        if tie is not None and tie.is_found:
            found.setdefault(_group(measured, name), []).append(tie)
    return found


def unchanged(measured: MeasuredSet) -> np.ndarray:
    """Return which records are of states that change no key of the machine, (records,) bool."""
    changed = measured.labels.get(CHANGED)
    return np.ones(len(measured.healthy), dtype=bool) if changed is None else np.array([not one for one in changed])


def _columns(measured: MeasuredSet) -> dict[str, np.ndarray]:
    labels = {
        name: values
        for name, values in measured.labels.items()
        if values.ndim == 1 and must_not_tell(measured.roles, name)
    }
    seen = {name: measured.values[name][:, 0] for name in MEASURED_COLUMNS if name in measured.values}
    return {**labels, **seen}


def _group(measured: MeasuredSet, name: str) -> str:
    section = MEASURED_COLUMNS.get(name) or measured.sections.get(name)
    return section or measured.roles.get(name, Role.CONDITION)


def permuted_states(state: np.ndarray, specimen: np.ndarray, seed: int, count: int = PERMUTATIONS) -> np.ndarray:
    """Return states permuted by cells, (count, records) int."""
    cells, cell_of = np.unique(np.stack([specimen, state]), axis=1, return_inverse=True)
    cell_of = np.asarray(cell_of).ravel()
    rng = generator(seed, Purpose.PERMUTATION)
    several = np.unique(cells[0]).size < cells.shape[1]
    result = np.empty((count, state.size), dtype=np.int64)
    for row in range(count):
        # sorting by (specimen, random) shuffles the states of each specimen among its cells
        keys = cells[0] if several else np.zeros_like(cells[0])
        shuffled = np.lexsort((rng.random(cells.shape[1]), keys.astype(np.float64)))
        permuted = np.empty(cells.shape[1], dtype=np.int64)
        permuted[np.argsort(keys, kind="stable")] = cells[1][shuffled]
        result[row] = permuted[cell_of]
    return result


def strongest_tie(
    name: str, values: np.ndarray, state: np.ndarray, specimen: np.ndarray, permuted: np.ndarray
) -> Tie | None:
    """Return the larger of the ties of the column itself and of its differences from the specimen's mean."""
    if values.dtype.kind in "biuf":
        number = values.astype(np.float64)
        defined = np.where(np.isfinite(number), number, np.nanmax(np.where(np.isfinite(number), number, -1e300)) + 1.0)
        mean = np.bincount(specimen, defined) / np.bincount(specimen)
        centred = defined - mean[specimen]
        centred[np.abs(centred) < 1e-9 * max(float(np.abs(defined).max()), 1e-300)] = 0.0
        codes = [_bins(defined), _bins(centred)]
    else:
        codes = [_codes(np.array([str(value) for value in values.tolist()]))]
    ties = [_tie(name, code, state, permuted) for code in codes if code.max() > 0]
    return max(ties, key=lambda tie: (tie.is_found, tie.observed - tie.chance), default=None)


def _tie(name: str, code: np.ndarray, state: np.ndarray, permuted: np.ndarray) -> Tie:
    told = told_shares(code, np.concatenate([state[None], permuted]))
    return Tie(name, float(told[0]), float(told[1:].mean()), float(told[1:].std()))


def told_shares(code: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Return mutual information of a code (records,) and states (turns, records) over the entropy of these, (turns,).

    0 to 1; 0 where a turn has one state alone.
    """
    from scipy.special import entr

    turns, records = states.shape
    shape = (turns, int(code.max()) + 1, int(states.max()) + 1)
    place = (np.arange(turns)[:, None] * shape[1] + code) * shape[2] + states
    joint = np.bincount(place.ravel(), minlength=math.prod(shape)).reshape(shape) / records
    of_state, of_code = (entr(joint.sum(axis=axis)).sum(axis=1) for axis in (1, 2))
    told = of_state + of_code - entr(joint).sum(axis=(1, 2))
    return np.asarray(np.divide(told, of_state, out=np.zeros(turns), where=of_state > 0.0))


def _codes(values: np.ndarray) -> np.ndarray:
    return np.asarray(np.unique(values, return_inverse=True)[1]).ravel()


def _bins(values: np.ndarray) -> np.ndarray:
    """Return the values themselves as codes where there are few, else the bins between equal shares."""
    unique = np.unique(values)
    if unique.size <= BINS:
        return np.searchsorted(unique, values)
    edges = np.unique(np.quantile(values, np.arange(1, BINS) / BINS))
    return _codes(np.searchsorted(edges, values, side="right"))


def _finding(group: str, ties: list[Tie]) -> Finding:
    strongest = max(ties, key=lambda tie: tie.observed)
    others = f" (and {len(ties) - 1} more columns of {group})" if len(ties) > 1 else ""
    return Finding(
        f"state_tied_to_{group}",
        f"`{strongest.column}`{others} explains {strongest.observed:.0%} of the state's entropy",
        f"chance with permuted states gives {strongest.chance:.1%} (spread {strongest.spread:.1%}), at most "
        f"{LARGEST_EXCESS:.0%} more is allowed",
        MENDS.get(group, GENERAL_MEND),
    )


def failed_states(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if failed records gather in some states."""
    states = measured.states()
    if not measured.failures or len(states) < 2:
        return []
    planned = [*measured.config.get("states", {})] or list(states)
    points, repeats = (int(measured.labels[name].max()) + 1 for name in ("operating_point_id", "repeat"))
    block = points * repeats
    counts = np.bincount(
        [int(failure["record_id"]) // block % len(planned) for failure in measured.failures], minlength=len(planned)
    )
    expected = counts.sum() / len(planned)
    # a count of failures scatters by its square root
    if counts.max() - expected <= LARGEST_DEVIATIONS * np.sqrt(expected):
        return []
    worst = planned[int(counts.argmax())]
    return [
        Finding(
            "state_tied_to_status",
            f"{counts.max()} of {counts.sum()} failed records are of state {worst}",
            f"{expected:.1f} were expected, at most {LARGEST_DEVIATIONS:g} standard deviations more are allowed",
            "Change the settings that make this state fail. The records that are left of it are a selection.",
        )
    ]
