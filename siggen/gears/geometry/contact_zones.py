"""The path of contact in stretches of equal numbers of tooth pairs.

Equations: reference, standard literature (involute gearing): a pair at s has its neighbours at s plus and minus whole
base pitches, so the number changes where s is a whole number of base pitches away from s_A or s_E.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.gears.geometry.gear_pair import GearPair


@dataclass(frozen=True, slots=True)
class ContactZone:
    """A stretch of the line of action, from `start_m` to `end_m` [m], and how many pairs carry the load there."""

    start_m: float
    end_m: float
    pairs: int


def contact_zones(pair: GearPair) -> tuple[ContactZone, ...]:
    """Return the zones from s_A to s_E in order; double, single, double for a contact ratio between 1 and 2.

    Source: derived.
    """
    start, end, pitch = pair.contact_start_m, pair.contact_end_m, pair.base_pitch_m
    shifts = pitch * np.arange(int(pair.contact_ratio) + 2)
    marks = np.concatenate([start + shifts, end - shifts])
    edges = np.unique(marks[(marks >= start) & (marks <= end)])
    # A contact ratio within rounding of a whole number has zones of no length.
    edges = edges[np.concatenate([[True], np.diff(edges) > 1e-9 * pitch])]
    middle = 0.5 * (edges[1:] + edges[:-1])
    others = middle[:, np.newaxis] + np.concatenate([-shifts[:0:-1], shifts])
    pairs = np.sum((others > start) & (others < end), axis=1)
    rows = zip(edges[:-1].tolist(), edges[1:].tolist(), pairs.tolist(), strict=True)
    return tuple(ContactZone(low, high, count) for low, high, count in rows)
