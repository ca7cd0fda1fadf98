"""Trap: the same noise in several records, or in several channels of a record."""

from __future__ import annotations

import numpy as np

from diagnostics.audit.finding import Finding
from diagnostics.audit.measured_set import MeasuredSet

LARGEST_BETWEEN_RECORDS = 0.3
"""Independent sketches of 1024 phases stay below 0.2 in 10 million pairs (spread 0.03); shared noise gives up to 1."""

LARGEST_BETWEEN_CHANNELS = 0.95
"""Channels of one gearbox may share force noise through their paths, but not all of it."""

SHARE_ALLOWED = 0.01
"""Records that share noise with another one; counted by record, since twins are a vanishing share of all pairs."""

BLOCK = 512


def noise_copies(measured: MeasuredSet) -> list[Finding]:
    """Return findings for copied signals, for noise that records share and for noise that channels share."""
    return [*copied_signals(measured), *shared_by_records(measured), *shared_by_channels(measured)]


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
    if together <= SHARE_ALLOWED * judged:
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
