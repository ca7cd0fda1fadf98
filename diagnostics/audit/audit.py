"""Audit: what the audit of a set found."""

from __future__ import annotations

from dataclasses import dataclass

from diagnostics.audit.detectability import Detection
from diagnostics.audit.envelope import Realism
from diagnostics.audit.finding import Finding


@dataclass(frozen=True, slots=True)
class Audit:
    """What the audit found.

    Attributes
    ----------
    findings : tuple of Finding
        Traps; empty for a set without any.
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
    """

    findings: tuple[Finding, ...]
    verdict: str
    realism: Realism | None
    detections: dict[str, list[Detection]]
    notes: tuple[str, ...]
    seconds_per_record: float
    records: int
    specimens: int
    channels: int
    seed: int
