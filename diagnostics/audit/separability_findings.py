"""All traps of the separability audit, and the verdict on them.

Trap: one specimen in two splits.

Trap: solver settings that a state carries in the configuration.

Trap: the damaged tooth stands always at the same angle, after the pulse of the tacho or at the first sample.

Rayleigh's test: n independent uniform angles have a mean phasor above r with probability exp(-n r^2). Source: standard
literature.

Trap: healthy records without sidebands, as gears without manufacturing errors give them.

Trap: the same noise in several records, or in several channels of a record.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from diagnostics.audit.bank_detections import ChanceLimit, gearboxes_needed
from diagnostics.audit.condition_traps import condition_traps
from diagnostics.audit.detectability import FEWEST_SPECIMENS
from diagnostics.audit.finding import Finding
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.audit.simple_thresholds import simple_thresholds
from diagnostics.audit.state_ties import error_draws, state_ties
from diagnostics.page.wording import counted, decimal

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

CHANCE = 1e-3
LEAST_PHASOR = 0.5
MEND = {
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

TRIVIAL = (
    "healthy_without_sidebands",
    "slight_separable_by",
    "state_tied_to",
    "state_told_by",
    "constant_damage_phase",
)


def shared_specimens(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if a specimen occurs in more than one split."""
    owners: dict[int, set[str]] = {}
    for specimen, split in zip(measured.labels["specimen_id"].tolist(), measured.labels["split"].tolist(), strict=True):
        owners.setdefault(specimen, set()).add(split)
    shared = sorted(specimen for specimen, splits in owners.items() if len(splits) > 1)
    if not shared:
        return []
    shown = ", ".join(str(specimen) for specimen in shared[:5])
    return [
        Finding(
            "specimen_in_two_splits",
            f"{len(shared)} of {len(owners)} specimens ({shown}{', ...' if len(shared) > 5 else ''}) "
            "have records in more than one split",
            "allowed are none",
            "Split by `specimen_id`. siggen does so, so the `split` column was changed: write it again.",
        )
    ]


def solver_settings(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if states of the configuration differ in settings that are not their damage."""
    states = [state for state in measured.config.get("states", {}).values() if isinstance(state, Mapping)]
    own = [_settings(state) for state in states]
    if len(own) < 2 or all(settings == own[0] for settings in own):
        return []
    differing = sorted({key for settings in own for key in settings if any(s.get(key) != settings[key] for s in own)})
    return [
        Finding(
            "solver_settings_by_state",
            f"states differ in {', '.join(differing)}",
            "states may differ in their damage only",
            "Move these keys out of the states.",
        )
    ]


def _settings(section: Mapping[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in section.items():
        if key in SETTINGS:
            found[key] = value
        elif isinstance(value, Mapping):
            found |= {f"{key}.{name}": inner for name, inner in _settings(value).items()}
    return found


def damage_phase(measured: MeasuredSet) -> list[Finding]:
    """Return findings for a constant angle of the damaged tooth after the pulse and at the first sample."""
    faulty, gear = measured.first("faulty_teeth"), measured.gears[0].gears[0]
    if faulty is None:
        return []
    teeth = measured.teeth
    damaged = np.array([len(found) > 0 for found in faulty])
    tooth = np.array([found[0] / z if len(found) else 0.0 for found, z in zip(faulty, teeth, strict=True)])
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
            MEND[name],
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


def healthy_sidebands(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if more than a fifth of the healthy channel-records has no visible sideband at mesh 1-3.

    The bound was measured with accelerometers: channels of another quantity are not judged.
    """
    if measured.gears[0].planetary:
        return []  # passing planets leave lines beside the mesh frequency in any healthy set
    strongest = measured.values["strongest_sideband_db"][np.ix_(measured.healthy, measured.accelerations)]
    strongest = strongest[~np.isnan(strongest)]
    if strongest.size == 0:
        return []
    share = float(np.mean(strongest < WEAKEST_DB))
    if share <= SHARE_ALLOWED:
        return []
    return [
        Finding(
            "healthy_without_sidebands",
            f"{share:.0%} of the healthy channel-records have no {measured.gears[0].gears[0]} sideband of mesh 1-3 "
            f"above {WEAKEST_DB:g} dB of its mesh line and 10 dB above the noise",
            f"at most {SHARE_ALLOWED:.0%} are allowed, measured healthy gearboxes have -30 to -8 dB",
            "Give the gears manufacturing errors (section `manufacture`), drawn anew for every specimen.",
        )
    ]


def noise_copies(measured: MeasuredSet) -> list[Finding]:
    """Return findings for copied signals, for noise that records share and for noise that channels share."""
    return [
        *copied_signals(measured),
        *repeated_runs(measured),
        *shared_by_records(measured),
        *shared_by_channels(measured),
    ]


def copied_signals(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if two channel-records hold the same samples."""
    _, counts = np.unique(measured.checksums, return_counts=True)
    copies = int((counts - 1).sum())
    if copies == 0:
        return []
    return [
        Finding(
            "copied_signal",
            f"{copies} of {measured.checksums.size} channel-records are copies of another one, sample by sample",
            "allowed are none",
            "Give every record its own seeds and remove the copies.",
        )
    ]


def repeated_runs(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if records hold runs of samples of each other, wherever they stand.

    Copies of whole channels are told by `copied_signals`.
    """
    rows = np.flatnonzero(~_copied(measured.checksums).any(axis=1))
    held = [measured.raw.marks[row] for row in rows.tolist()] if measured.raw.marks else []
    times = Counter(mark for marks in held for mark in marks)
    again = {mark for mark, count in times.items() if count > 1}
    holding = sum(not again.isdisjoint(marks) for marks in held)
    if len(again) < FEWEST_RUNS:
        return []
    return [
        Finding(
            "repeated_samples",
            f"{holding} records share {len(again)} runs of samples with another record, bit by bit",
            f"fewer than {FEWEST_RUNS} are allowed",
            "Give every record its own seeds and fill gaps in no record from another one.",
        )
    ]


def _copied(checksums: np.ndarray) -> np.ndarray:
    """Return which channel-records are copies of others, (records, channels) bool."""
    _, place, counts = np.unique(checksums, return_inverse=True, return_counts=True)
    return np.asarray(counts[place.reshape(checksums.shape)] > 1)


def shared_by_records(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if the noise of a channel in one record correlates with that in others."""
    shared, judged, largest = np.zeros(len(measured.sketches), dtype=bool), 0, 0.0
    for channel in range(len(measured.channels)):
        held = np.flatnonzero([rows[channel].size > 0 for rows in measured.sketches])
        if held.size < 2:
            continue
        judged = max(judged, held.size)
        found = np.stack([measured.sketches[row][channel] for row in held])
        for start in range(0, len(found), BLOCK):
            block = found[start : start + BLOCK]
            product = np.abs((block @ found[start:].conj().T).real) / found.shape[1]
            above = np.triu(product, 1)
            first, second = np.nonzero(above > LARGEST_BETWEEN_RECORDS)
            shared[held[start + first]] = shared[held[start + second]] = True
            largest = max(largest, float(above.max(initial=0.0)))
    together = int(shared.sum())
    if together <= COPIES_ALLOWED * judged:
        return []
    return [
        Finding(
            "noise_shared_by_records",
            f"{together} of {judged} records share noise with another one (without the synchronous part, the "
            f"correlation is up to {largest:.2f})",
            f"a pair counts above {LARGEST_BETWEEN_RECORDS:g}, independent noise stays below 0.2",
            "Draw noise from a generator of its own for every record.",
        )
    ]


def shared_by_channels(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if two channels hold the same noise in the median record."""
    worst, names = 0.0, ("", "")
    for a in range(len(measured.channels)):
        for b in range(a + 1, len(measured.channels)):
            both = [(row[a], row[b]) for row in measured.sketches if row[a].size and row[a].size == row[b].size]
            if both:
                found = float(np.median([abs(np.vdot(x, y).real) / x.size for x, y in both]))
                worst, names = max((worst, names), (found, (measured.channels[a], measured.channels[b])))
    if worst <= LARGEST_BETWEEN_CHANNELS:
        return []
    return [
        Finding(
            "noise_shared_by_channels",
            f"channels {names[0]} and {names[1]} have the same noise (median correlation {worst:.2f})",
            f"allowed is {LARGEST_BETWEEN_CHANNELS:g}",
            "Give every channel its own noise stream and its own transfer path.",
        )
    ]


def separability_findings(measured: MeasuredSet, seed: int = 0) -> list[Finding]:
    """Return every finding, in the order of the traps.

    One finding hides no other: attackers on conditions, which name no cause, speak last.
    """
    return [
        *shared_specimens(measured),
        *healthy_sidebands(measured),
        *simple_thresholds(measured, seed),
        *state_ties(measured, seed),
        *solver_settings(measured),
        *error_draws(measured),
        *noise_copies(measured),
        *damage_phase(measured),
        *condition_traps(measured, seed),
    ]


def verdict(findings: Sequence[Finding], specimens: int, chance: ChanceLimit | None = None) -> str:
    """Return what the findings mean for scores on a set of so many specimens, beside what chance reaches there."""
    if not findings and specimens < FEWEST_SPECIMENS:
        return (
            f"No trap was found. Few traps can be found with {counted(specimens, 'gearbox')}. Scores on this set say "
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
            "No trap was found. As far as the audit can see, scores on unseen specimens of this set measure the damage."
        )
    trivial = [finding.trap for finding in findings if finding.trap.startswith(TRIVIAL)]
    if trivial:
        return (
            f"The set is trivially separable ({', '.join(trivial)}). A detection score on it says nothing about real "
            "gearboxes."
        )
    found = "A trap was" if len(findings) == 1 else f"{len(findings)} traps were"
    return f"{found} found. Scores on this set do not measure what they seem to measure."
