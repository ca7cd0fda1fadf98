"""All leaks of the audit, and the verdict on them.

Which label columns must not tell the state, and how a tie of the state to one is mended, follows from role and section,
which the set says of every column. A column of which it says nothing is a condition.

* One specimen in two splits; solver settings that a state carries; the same noise or samples in several records.
* A state told by a condition (speed, noise floor, path ...) without its signal: mutual information between state and a
  binned column, against the same with permuted states. What is permuted is the state of whole cells (specimen, state),
  within specimens that have several states and among specimens otherwise, since records of a cell are not independent.
* One draw of manufacturing errors for all healthy specimens, seen in the labels or in the averaged waveforms. Waveforms
  of two specimens are compared by the phases of their sidebands, shifted against each other by every angle: amplitudes
  differ with speed and supports even for equal errors. Of k independent phases the mean phasor exceeds r with
  probability exp(-k r^2) at one angle (Rayleigh), which sets the bound for all angles and pairs.
* Healthy records without sidebands, as gears without manufacturing errors give them.
* The damaged tooth stands always at the same angle, after the pulse of the tacho or at the first sample: Rayleigh's
  test, as above.
* A threshold on one simple number finds the slightest damage on specimens that were never seen. Where gearboxes differ
  more in level than a leak does, the level beside the gearbox's own healthy record gives it away. That slight damage
  changes the level a little is physics; that it doubles the power is not.

Source: standard literature (Rayleigh, mutual information); the permutation scheme and all else derived.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from diagnostics.audit.bank import ChanceLimit, gearboxes_needed
from diagnostics.audit.condition_layers import CHANNELS, LAGS, NOISE
from diagnostics.audit.condition_leaks import LEVELS, condition_leaks
from diagnostics.audit.detectability import FEWEST_SPECIMENS
from diagnostics.audit.finding import LARGEST_AUC, MEND, MENDS, Finding
from diagnostics.audit.measured_set import MeasuredSet, reference_records
from diagnostics.audit.raw_records import EDGES, ENDS, TEMPLATES
from diagnostics.base.seeding import Purpose, generator
from diagnostics.page.wording import counted, decimal
from diagnostics.statistics.evaluation import bootstrap_weights, interval, weighted_auc
from siggen.keys.column import Role

QUANTITIES = ("rms", "kurtosis")
LEAST_CHANGE_DB = 3.0
"""Twice the power: small pits cannot do that, a gain can (assumed); the AUC of the change has to be large too."""
FEWEST_TOLD = 3
RESAMPLES = 200


def slight_states(measured: MeasuredSet) -> tuple[str, ...]:
    """Return the states of severity slight, or the one with the least damaged area where there is none."""
    labels, damaged = measured.labels, ~measured.healthy
    slight = damaged & (labels["severity"] == "slight")
    if slight.any():
        return tuple(dict.fromkeys(labels["state"][slight].tolist()))
    area = {
        state: float(np.mean(labels["damaged_area_mm2"][labels["state"] == state]))
        for state in dict.fromkeys(labels["state"][damaged].tolist())
    }
    return (min(area, key=lambda state: area[state]),) if area else ()


def simple_thresholds(measured: MeasuredSet, seed: int = 0) -> list[Finding]:
    """Return a finding for each of RMS and kurtosis that separates slight damage from healthy in some channel."""
    findings = []
    for quantity in QUANTITIES:
        best = _best(measured, measured.values[quantity], seed)
        if best and best[0] > LARGEST_AUC:
            findings.append(_threshold_finding(quantity, *best))
    return findings or _change_of_level(measured, seed)


def _best(measured: MeasuredSet, values: np.ndarray, seed: int) -> tuple[float, str, str] | None:
    """Return lower limit of the AUC, state and channel where values (records, channels) separate best."""
    return max(
        (
            (_distance(measured, values[:, channel], state, seed), state, name)
            for state in slight_states(measured)
            for channel, name in enumerate(measured.channels)
        ),
        default=None,
    )


def _change_of_level(measured: MeasuredSet, seed: int) -> list[Finding]:
    """Return a finding if rms beside the healthy reference tells slight damage, by 3 dB or more."""
    reference, rms = reference_records(measured), measured.values["rms"]
    known = reference >= 0
    change_db = np.full(rms.shape, np.nan)
    with np.errstate(divide="ignore", invalid="ignore"):
        change_db[known] = 20.0 * np.log10(rms[known] / rms[reference[known]])
    # the size is asked first: among states that are told without fail the one with the gain is not always the first
    large = (
        (_distance(measured, change_db[:, channel], state, seed), state, name, median_db)
        for state in slight_states(measured)
        for channel, name in enumerate(measured.channels)
        if abs(median_db := _median(change_db[measured.labels["state"] == state, channel])) >= LEAST_CHANGE_DB
    )
    best = max(large, default=None)
    return [_level_finding(*best)] if best and best[0] > LARGEST_AUC else []


def _median(values: np.ndarray) -> float:
    """Return the median of what is finite, 0 where nothing is."""
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else 0.0


def _distance(measured: MeasuredSet, values: np.ndarray, state: str, seed: int) -> float:
    """Return the lower limit of the AUC, turned so that it is above 0.5; the AUC itself with very few specimens."""
    labels = measured.labels
    chosen = np.isfinite(values) & (measured.healthy | (labels["state"] == state))
    specimen = labels["specimen_id"][chosen]
    positive = ~measured.healthy[chosen]
    if positive.all() or not positive.any() or np.unique(specimen).size < FEWEST_TOLD:
        return 0.5
    area = weighted_auc(values[chosen], positive, bootstrap_weights(specimen, seed, RESAMPLES), specimen)
    return interval(area if area[0] > 0.5 else 1.0 - area, int(np.unique(specimen).size)).low


def _threshold_finding(quantity: str, auc: float, state: str, channel: str) -> Finding:
    return Finding(
        f"slight_separable_by_{quantity}",
        f"a threshold on the {quantity} of {channel} alone separates {state} from healthy with an AUC of at least "
        f"{auc:.2f} (lower 95 % limit over specimens)",
        f"at most {LARGEST_AUC:g} is allowed",
        "Use smaller damage, larger manufacturing errors, more noise or a wider spread of speed and torque.",
    )


def _level_finding(auc: float, state: str, channel: str, change_db: float) -> Finding:
    return Finding(
        "slight_separable_by_rms",
        f"the rms of {channel} beside the gearbox's own healthy record separates {state} with an AUC of at least "
        f"{auc:.2f} (lower 95 % limit over specimens) and changes by {change_db:+.1f} dB (median)",
        f"at most {LARGEST_AUC:g}, or less than {LEAST_CHANGE_DB:g} dB, is allowed",
        "Record all states of a gearbox at the same gain; if they are, use smaller damage.",
    )


HARMONICS, SIDEBANDS = 5, 6
ANGLES = 2048
FEWEST_LINES = 16
LEAST_LIKENESS = 0.8
CHANCE = 1e-3
ALIKE_ALLOWED = 0.1
MOST_SPECIMENS = 24
"""Pairs among the first specimens are enough to see one draw for all."""

MANUFACTURE = "manufacture"
ERRORS_MEND = "Draw the manufacturing errors anew for every specimen."

BINS = 8
PERMUTED = 200
LARGEST_DEVIATIONS = 5.0
"""Standard deviations of the permuted values: one column in 3 million exceeds that by chance, were they normal."""

LARGEST_EXCESS = 0.03
"""Share of the state's entropy beyond chance; less is a tie nobody could use."""

MEASURED_COLUMNS = {"samples": "duration_s", "pulses_per_s": "operating_points", "start_turn": "operating_points"}
"""Conditions read off signals and pulses, in case a label is missing or wrong, and the section that draws them."""


def error_draws(measured: MeasuredSet) -> list[Finding]:
    """Return a finding for equal error labels and one for equal averaged waveforms of healthy specimens."""
    return [*equal_error_labels(measured), *equal_waveforms(measured)]


def equal_error_labels(measured: MeasuredSet) -> Iterator[Finding]:
    """Yield a finding if the error labels of all healthy specimens agree though they are not zero."""
    healthy = measured.healthy
    _, first = np.unique(measured.labels["specimen_id"][healthy], return_index=True)
    names = [name for name, section in measured.sections.items() if section == MANUFACTURE and name in measured.labels]
    columns = {name: measured.labels[name][healthy][first] for name in names}
    numeric = {name: column for name, column in columns.items() if column.dtype.kind in "fiu" and np.any(column != 0)}
    varied = [name for name, column in numeric.items() if len(set(column.tolist())) > 1]
    if len(first) < 2 or not numeric or varied:
        return
    yield Finding(
        "one_error_draw",
        f"all {len(first)} healthy specimens have the same {', '.join(sorted(numeric)[:4])}",
        "specimens must differ",
        ERRORS_MEND,
    )


def equal_waveforms(measured: MeasuredSet) -> Iterator[Finding]:
    """Yield a finding if averaged waveforms of healthy specimens agree after a rotation more often than allowed."""
    healthy = np.flatnonzero(measured.healthy)
    _, first = np.unique(measured.labels["specimen_id"][healthy], return_index=True)
    chosen = healthy[first][:MOST_SPECIMENS]
    pairs = list(combinations(chosen.tolist(), 2))
    judged = [
        (alikeness, lines)
        for a, b in pairs
        for alikeness, lines in [likeness(_sidebands(measured, a), _sidebands(measured, b))]
        if lines >= FEWEST_LINES
    ]
    alike = sum(alikeness > max(LEAST_LIKENESS, chance_bound(lines, len(pairs))) for alikeness, lines in judged)
    if not judged or alike / len(judged) <= ALIKE_ALLOWED:
        return
    yield Finding(
        "one_error_draw",
        f"{alike} of {len(judged)} pairs of healthy specimens have the same averaged waveform up to a rotation "
        f"(mean likeness of sideband phases {np.mean([alikeness for alikeness, _ in judged]):.2f})",
        f"a pair counts from likeness {LEAST_LIKENESS:g}, at most {ALIKE_ALLOWED:.0%} of the pairs are allowed",
        ERRORS_MEND,
    )


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
    return [_tie_finding(group, ties) for group, ties in tied_columns(measured, seed).items()] + [
        *failed_states(measured)
    ]


def tied_columns(measured: MeasuredSet, seed: int = 0) -> dict[str, list[Tie]]:
    """Return the columns that tell the state, by section of the configuration, else by role.

    States that change keys of the machine tell by design.
    """
    kept = measured.unchanged
    state = _codes(measured.labels["state"][kept])
    if state.max(initial=0) == 0:
        return {}
    specimen = _codes(measured.labels["specimen_id"][kept])
    permuted = permuted_states(state, specimen, seed)
    ties: dict[str, list[Tie]] = {}
    for name, values in _columns(measured).items():
        tie = strongest_tie(name, values[kept], state, specimen, permuted)
        if tie is not None and tie.is_found:
            ties.setdefault(_group(measured, name), []).append(tie)
    return ties


def _columns(measured: MeasuredSet) -> dict[str, np.ndarray]:
    seen = {name: measured.values[name][:, 0] for name in MEASURED_COLUMNS if name in measured.values}
    return {**measured.conditions, **seen}


def _group(measured: MeasuredSet, name: str) -> str:
    section = MEASURED_COLUMNS.get(name) or measured.sections.get(name)
    return section or measured.roles.get(name, Role.CONDITION)


def permuted_states(state: np.ndarray, specimen: np.ndarray, seed: int, count: int = PERMUTED) -> np.ndarray:
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


def _tie_finding(group: str, ties: list[Tie]) -> Finding:
    strongest = max(ties, key=lambda tie: tie.observed)
    others = f" (and {len(ties) - 1} more columns of {group})" if len(ties) > 1 else ""
    return Finding(
        f"state_tied_to_{group}",
        f"`{strongest.column}`{others} explains {strongest.observed:.0%} of the state's entropy",
        f"chance with permuted states gives {strongest.chance:.1%} (spread {strongest.spread:.1%}), at most "
        f"{LARGEST_EXCESS:.0%} more is allowed",
        MENDS.get(group, MEND),
    )


def failed_states(measured: MeasuredSet) -> Iterator[Finding]:
    """Yield a finding if failed records gather in some states."""
    states = measured.states()
    if not measured.failures or len(states) < 2:
        return
    planned = [*measured.config.get("states", {})] or list(states)
    points, repeats = (int(measured.labels[name].max()) + 1 for name in ("operating_point_id", "repeat"))
    block = points * repeats
    counts = np.bincount(
        [int(failure["record_id"]) // block % len(planned) for failure in measured.failures], minlength=len(planned)
    )
    expected = counts.sum() / len(planned)
    # a count of failures scatters by its square root
    if counts.max() - expected <= LARGEST_DEVIATIONS * np.sqrt(expected):
        return
    worst = planned[int(counts.argmax())]
    yield Finding(
        "state_tied_to_status",
        f"{counts.max()} of {counts.sum()} failed records are of state {worst}",
        f"{expected:.1f} were expected, at most {LARGEST_DEVIATIONS:g} standard deviations more are allowed",
        "Change the settings that make this state fail. The records that are left of it are a selection.",
    )


SETTINGS = frozenset(
    {
        *(
            "integrator",
            "solver",
            "steps_per_sample",
            "time_step_s",
            "tolerance",
            "table_points",
            "stiffness",
            "dynamics",
        ),
        *("mesh_damping_ratio", "fs_hz", "duration_s", "sensors", "operating_points", "noise", "seed"),
    }
)
"""Keys of the numerics and of the recording; where a state has its own, it can be told by them."""

LEAST_PHASOR = 0.5
PHASE_MEND = {
    "tacho": "Draw the damaged tooth per specimen.",
    "start": "Draw the start angle of every record over the whole revolution.",
}

WEAKEST_DB = -40.0
"""10 dB below the weakest first sideband of the measured healthy gearboxes."""

SHARE_ALLOWED = 0.2

LARGEST_BETWEEN_RECORDS = 0.3
"""Independent sketches of 1024 phases stay below 0.2 in 10 million pairs (spread 0.03); shared noise gives up to 1."""

LARGEST_BETWEEN_CHANNELS = 0.95
"""Channels of one gearbox may share force noise through their paths, but not all of it."""

COPIES_ALLOWED = 0.01
"""Records that share noise with another one; counted by record, since twins are a vanishing share of all pairs."""

FEWEST_RUNS = 3
"""Runs of 17 samples of 12 values and more; independent noise repeats none."""

BLOCK = 512


def shared_specimens(measured: MeasuredSet) -> Iterator[Finding]:
    """Yield a finding if a specimen occurs in more than one split."""
    owners: dict[int, set[str]] = {}
    for specimen, split in zip(measured.labels["specimen_id"].tolist(), measured.labels["split"].tolist(), strict=True):
        owners.setdefault(specimen, set()).add(split)
    shared = sorted(specimen for specimen, splits in owners.items() if len(splits) > 1)
    if not shared:
        return
    shown = ", ".join(str(specimen) for specimen in shared[:5])
    yield Finding(
        "specimen_in_two_splits",
        f"{len(shared)} of {len(owners)} specimens ({shown}{', ...' if len(shared) > 5 else ''}) "
        "have records in more than one split",
        "allowed are none",
        "Split by `specimen_id`. siggen does so, so the `split` column was changed: write it again.",
    )


def solver_settings(measured: MeasuredSet) -> Iterator[Finding]:
    """Yield a finding if states of the configuration differ in settings that are not their damage."""
    states = [state for state in measured.config.get("states", {}).values() if isinstance(state, Mapping)]
    of_states = [_settings(state) for state in states]
    if len(of_states) < 2 or all(settings == of_states[0] for settings in of_states):
        return
    differing = sorted(
        {key for settings in of_states for key in settings if any(s.get(key) != settings[key] for s in of_states)}
    )
    yield Finding(
        "solver_settings_by_state",
        f"states differ in {', '.join(differing)}",
        "states may differ in their damage only",
        "Move these keys out of the states.",
    )


def _settings(section: Mapping[str, Any]) -> dict[str, Any]:
    settings: dict[str, Any] = {}
    for key, value in section.items():
        if key in SETTINGS:
            settings[key] = value
        elif isinstance(value, Mapping):
            settings |= {f"{key}.{name}": inner for name, inner in _settings(value).items()}
    return settings


def damage_phase(measured: MeasuredSet) -> list[Finding]:
    """Return findings for a constant angle of the damaged tooth after the pulse and at the first sample."""
    faulty, gear = measured.first("faulty_teeth"), measured.gears[0].gears[0]
    if faulty is None:
        return []
    teeth = measured.teeth
    damaged = np.array([len(tooth_places) > 0 for tooth_places in faulty])
    tooth = np.array(
        [tooth_places[0] / z if len(tooth_places) else 0.0 for tooth_places, z in zip(faulty, teeth, strict=True)]
    )
    _, first = np.unique(measured.labels["specimen_id"][damaged], return_index=True)
    start = measured.values["start_turn"][:, 0][damaged]
    angles = {"tacho": tooth[damaged][first], "start": (start - tooth[damaged])[np.isfinite(start)]}
    where = {"tacho": "after the tacho's pulse, over specimens", "start": "at the first sample, over records"}
    return [
        Finding(
            f"constant_damage_phase_{name}",
            f"the first damaged {gear} tooth has nearly the same angle {where[name]} "
            f"(mean phasor {mean_phasor(turns):.2f} of {turns.size})",
            f"by chance, 1 of 1000 sets exceeds {phasor_bound(turns.size):.2f}",
            PHASE_MEND[name],
        )
        for name, turns in angles.items()
        if turns.size > 1 and mean_phasor(turns) > phasor_bound(turns.size)
    ]


def mean_phasor(turns: np.ndarray) -> float:
    """Return the length of the mean phasor of angles in revolutions, 0 (spread) to 1 (equal)."""
    return float(np.abs(np.mean(np.exp(2j * np.pi * turns))))


def phasor_bound(count: int) -> float:
    """Return the larger of 0.5 and what chance exceeds once in a thousand; 0.999 where so few angles cannot tell."""
    return min(max(LEAST_PHASOR, math.sqrt(-math.log(CHANCE) / count)), 0.999)


def healthy_sidebands(measured: MeasuredSet) -> Iterator[Finding]:
    """Yield a finding if more than a fifth of the healthy channel-records has no visible sideband at mesh 1-3.

    The bound was measured with accelerometers: channels of another quantity are not judged.
    """
    if measured.gears[0].planetary:
        return  # passing planets leave lines beside the mesh frequency in any healthy set
    strongest = measured.values["strongest_sideband_db"][np.ix_(measured.healthy, measured.accelerations)]
    strongest = strongest[~np.isnan(strongest)]
    if strongest.size == 0:
        return
    share = float(np.mean(strongest < WEAKEST_DB))
    if share <= SHARE_ALLOWED:
        return
    yield Finding(
        "healthy_without_sidebands",
        f"{share:.0%} of the healthy channel-records have no {measured.gears[0].gears[0]} sideband of mesh 1-3 "
        f"above {WEAKEST_DB:g} dB of its mesh line and 10 dB above the noise",
        f"at most {SHARE_ALLOWED:.0%} are allowed, measured healthy gearboxes have -30 to -8 dB",
        "Give the gears manufacturing errors (section `manufacture`), drawn anew for every specimen.",
    )


def noise_copies(measured: MeasuredSet) -> list[Finding]:
    """Return findings for copied signals, for noise that records share and for noise that channels share."""
    return [
        *copied_signals(measured),
        *repeated_runs(measured),
        *shared_by_records(measured),
        *shared_by_channels(measured),
    ]


def copied_signals(measured: MeasuredSet) -> Iterator[Finding]:
    """Yield a finding if two channel-records hold the same samples."""
    _, counts = np.unique(measured.checksums, return_counts=True)
    copies = int((counts - 1).sum())
    if copies == 0:
        return
    yield Finding(
        "copied_signal",
        f"{copies} of {measured.checksums.size} channel-records are copies of another one, sample by sample",
        "allowed are none",
        "Give every record its own seeds and remove the copies.",
    )


def repeated_runs(measured: MeasuredSet) -> Iterator[Finding]:
    """Yield a finding if records hold runs of samples of each other, wherever they stand.

    Copies of whole channels are told by `copied_signals`.
    """
    rows = np.flatnonzero(~_copied(measured.checksums).any(axis=1))
    held = [measured.raw.marks[row] for row in rows.tolist()] if measured.raw.marks else []
    times = Counter(mark for marks in held for mark in marks)
    again = {mark for mark, count in times.items() if count > 1}
    holding = sum(not again.isdisjoint(marks) for marks in held)
    if len(again) < FEWEST_RUNS:
        return
    yield Finding(
        "repeated_samples",
        f"{holding} records share {len(again)} runs of samples with another record, bit by bit",
        f"fewer than {FEWEST_RUNS} are allowed",
        "Give every record its own seeds and fill gaps in no record from another one.",
    )


def _copied(checksums: np.ndarray) -> np.ndarray:
    """Return which channel-records are copies of others, (records, channels) bool."""
    _, place, counts = np.unique(checksums, return_inverse=True, return_counts=True)
    return np.asarray(counts[place.reshape(checksums.shape)] > 1)


def shared_by_records(measured: MeasuredSet) -> Iterator[Finding]:
    """Yield a finding if the noise of a channel in one record correlates with that in others."""
    shared, judged, largest = np.zeros(len(measured.sketches), dtype=bool), 0, 0.0
    for channel in range(len(measured.channels)):
        held = np.flatnonzero([rows[channel].size > 0 for rows in measured.sketches])
        if held.size < 2:
            continue
        judged = max(judged, held.size)
        sketches = np.stack([measured.sketches[row][channel] for row in held])
        for start in range(0, len(sketches), BLOCK):
            block = sketches[start : start + BLOCK]
            product = np.abs((block @ sketches[start:].conj().T).real) / sketches.shape[1]
            above = np.triu(product, 1)
            first, second = np.nonzero(above > LARGEST_BETWEEN_RECORDS)
            shared[held[start + first]] = shared[held[start + second]] = True
            largest = max(largest, float(above.max(initial=0.0)))
    together = int(shared.sum())
    if together <= COPIES_ALLOWED * judged:
        return
    yield Finding(
        "noise_shared_by_records",
        f"{together} of {judged} records share noise with another one (without the synchronous part, the "
        f"correlation is up to {largest:.2f})",
        f"a pair counts above {LARGEST_BETWEEN_RECORDS:g}, independent noise stays below 0.2",
        "Draw noise from a generator of its own for every record.",
    )


def shared_by_channels(measured: MeasuredSet) -> Iterator[Finding]:
    """Yield a finding if two channels hold the same noise in the median record."""
    worst, names = 0.0, ("", "")
    for a in range(len(measured.channels)):
        for b in range(a + 1, len(measured.channels)):
            both = [(row[a], row[b]) for row in measured.sketches if row[a].size and row[a].size == row[b].size]
            if both:
                shared = float(np.median([abs(np.vdot(x, y).real) / x.size for x, y in both]))
                worst, names = max((worst, names), (shared, (measured.channels[a], measured.channels[b])))
    if worst <= LARGEST_BETWEEN_CHANNELS:
        return
    yield Finding(
        "noise_shared_by_channels",
        f"channels {names[0]} and {names[1]} have the same noise (median correlation {worst:.2f})",
        f"allowed is {LARGEST_BETWEEN_CHANNELS:g}",
        "Give every channel its own noise stream and its own transfer path.",
    )


MOVED_BY_MANY = frozenset(
    {
        "noise_shared_by_records",
        *(f"state_told_by_{layer}" for layer in (NOISE, CHANNELS, ENDS, EDGES, LAGS, LEVELS, TEMPLATES)),
    }
)
"""Leaks that clocks, clipping, lost samples or a drift spring too: what names one cause speaks before them."""


def separability_findings(measured: MeasuredSet, seed: int = 0) -> list[Finding]:
    """Return every finding, in the order of the leaks; those that many causes have come last.

    One finding hides no other: detectors on conditions, which name no cause, speak behind the others.
    """
    findings = [
        *shared_specimens(measured),
        *healthy_sidebands(measured),
        *simple_thresholds(measured, seed),
        *state_ties(measured, seed),
        *solver_settings(measured),
        *error_draws(measured),
        *noise_copies(measured),
        *damage_phase(measured),
        *condition_leaks(measured, seed),
    ]
    return sorted(findings, key=lambda finding: finding.leak in MOVED_BY_MANY)


def verdict(findings: Sequence[Finding], specimens: int, chance: ChanceLimit | None = None, missing: str = "") -> str:
    """Return what the findings mean for scores on a set of so many specimens, beside what chance reaches there.

    Of several findings the first says what is told, by what, and how to correct it; the others are named.
    `missing` says which records the set has none of, `healthy` or `damaged`.
    """
    if not findings and missing:
        return (
            f"No verdict: the set has no {missing} records, so nothing can be told apart. Add such a state under "
            "`states` in its configuration."
        )
    if not findings and specimens < FEWEST_SPECIMENS:
        return (
            f"No leak was found. Few leaks can be found with {counted(specimens, 'gearbox')}. Scores on this set say "
            "nothing about other gearboxes."
        )
    needed = gearboxes_needed(chance, specimens)
    if not findings and chance and needed:
        return (
            f"There are too few gearboxes to tell: chance reaches an AUC of {decimal(chance.auc)}. Use at least "
            f"{counted(needed, 'gearbox')} in place of {specimens}."
        )
    if not findings:
        return (
            "No leak was found. As far as the audit can see, scores on unseen specimens of this set measure the damage."
        )
    first, *others = findings
    more = f" {counted(len(others), 'further leak')} found: {', '.join(one.leak for one in others)}." if others else ""
    return f"Scores on this set do not measure damage alone: {first.measured}. To correct it: {first.mend}{more}"
