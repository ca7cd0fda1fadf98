"""Audit: what the audit of a set found."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

from diagnostics.audit.bank import ChanceLimit, ShamFound, gearboxes_needed
from diagnostics.audit.detectability import FEWEST_SPECIMENS, BestIndicator, Detectability, in_order
from diagnostics.audit.envelope import Realism
from diagnostics.audit.finding import Finding
from diagnostics.audit.reference_comparison import ReferenceComparison

SINGLE = "the best single indicator"
"""Name of the probe that takes one indicator, chosen on other gearboxes."""

UNPAIRED = "logistic regression on four indicators"
PAIRED, CHANGE = "six indicators minus own healthy record", "change of the averaged waveform"
REFERENCED = " (healthy-referenced)"
ALONE, WITH_REFERENCE = "strongest detector alone", "strongest detector with a healthy reference"


def is_referenced(name: str) -> bool:
    """Return whether a detector sees the healthy record of the same gearbox."""
    return name in (PAIRED, CHANGE) or name.endswith(REFERENCED)


@dataclass(frozen=True, slots=True)
class Audit:
    """What the audit found.

    Attributes
    ----------
    findings : tuple of Finding
        Leaks; empty for a set without any.
    verdict : str
        What they mean, in a sentence.
    realism : Realism, optional
        Where it was asked for and healthy records exist.
    detections : dict of str to list of Detection
        By variant.
    notes : tuple of str
        What could not be judged and why.
    seconds_per_record : float
        For measuring; small where the cache was read.
    records, specimens, channels : int
        How many were judged on.
    seed : int
        Of permutations, folds and bootstrap.
    best : dict of str to BestIndicator
        By state, the best single indicator.
    chance : ChanceLimit, optional
        What the strongest detector reaches by chance.
    reference : ReferenceComparison, optional
        Where the user gave recordings.
    shams : tuple of ShamFound
        What detectors tell of states in whose damage nothing is removed.
    missing : str
        `healthy` or `damaged` where the set has no such records.
    made_again : str
        The command that simulates records of the set again; empty where nothing can.
    """

    findings: tuple[Finding, ...]
    verdict: str
    realism: Realism | None
    detections: dict[str, list[Detectability]]
    notes: tuple[str, ...]
    seconds_per_record: float
    records: int
    specimens: int
    channels: int
    seed: int
    best: dict[str, BestIndicator] = field(default_factory=dict)
    chance: ChanceLimit | None = None
    reference: ReferenceComparison | None = None
    shams: tuple[ShamFound, ...] = ()
    missing: str = ""
    made_again: str = ""

    def on_sham(self, detector: str) -> float:
        """Return the AUC that a detector reaches on a sham; NaN where it was not asked.

        Of one that was not, the AUC of the strongest that tells a sham more often than chance does.
        """
        own = [found.reached[detector] for found in self.shams if detector in found.reached]
        told = [found.auc.value for found in self.shams if found.told]
        return max(own or told, default=math.nan)

    @property
    def gearboxes_needed(self) -> int | None:
        """The least number of gearboxes that may tell, where chance alone looks like damage; else None."""
        return gearboxes_needed(self.chance, self.specimens)

    @property
    def tells_too_little(self) -> bool:
        """Whether gearboxes are too few, or one class is missing, for a set without leaks to have passed."""
        return bool(self.missing) or self.specimens < FEWEST_SPECIMENS or self.gearboxes_needed is not None

    def probes(self, state: str) -> dict[str, float]:
        """Return the AUC on unseen gearboxes of everything that looked for a state, by its name."""
        found = {SINGLE: self.best[state].held_out} if state in self.best else {}
        for name, entries in self.detections.items():
            found[name] = next((entry.auc.value for entry in entries if entry.state == state), math.nan)
        return {name: auc for name, auc in found.items() if math.isfinite(auc)}

    def ladder(self, *, referenced: bool) -> list[Detectability]:
        """Return the entry of the strongest detector for every state, in the order of sizes, with or without reference.

        The name of the detector stands before what it chose.
        """
        best: dict[str, Detectability] = {}
        for name, entries in self.detections.items():
            for entry in entries if is_referenced(name) == referenced else []:
                known = best.get(entry.state)
                if math.isfinite(entry.auc.value) and (known is None or entry.auc.value > known.auc.value):
                    best[entry.state] = replace(entry, basis=": ".join(part for part in (name, entry.basis) if part))
        return in_order(list(best.values()))

    @property
    def states(self) -> tuple[str, ...]:
        """The damaged states in the order of the tables."""
        entries = next(iter(self.detections.values()), [])
        return tuple(dict.fromkeys([*(entry.state for entry in entries), *self.best]))
